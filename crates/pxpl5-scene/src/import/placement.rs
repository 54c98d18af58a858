//! Where a model stands.

/// Where a model stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Placement {
    /// Moved to the origin and scaled so that both eyes see all of it, from wherever [`Scene::motion`](crate::Scene::motion) takes the head.
    #[default]
    Fitted,
    /// Where its file says: a unit of the file is a metre, and the head stands at the origin and looks along -z.
    AsInFile,
}
