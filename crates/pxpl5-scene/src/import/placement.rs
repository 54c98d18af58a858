//! The placement of an imported model.

/// The placement of an imported model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Placement {
    /// The model is moved to the origin and scaled. Both eyes see all of it wherever
    /// [`Scene::motion`](crate::Scene::motion) takes the head.
    #[default]
    Fitted,
    /// The model keeps the coordinates of its file. A unit of the file is a metre. The head stands at the origin and
    /// looks along -z.
    AsInFile,
}
