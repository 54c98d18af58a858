//! The position and size that an imported model gets in a scene.

/// The position and size that an imported model gets in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Placement {
    /// The model is moved to the origin and scaled. Both eyes see the whole model at every pose of the head's motion
    /// [`Scene::motion`](crate::Scene::motion).
    #[default]
    Fitted,
    /// The model keeps the coordinates of its file, and one unit of the file is a metre. The head stands at the origin
    /// and looks along -z.
    AsInFile,
}
