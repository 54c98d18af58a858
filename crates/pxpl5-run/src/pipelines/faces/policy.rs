/// Policy that decides which structures are drawn into which display memory, and when.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FacePolicy {
    /// One display memory holds all structures and is redrawn as often as possible.
    Full,
    /// Each structure is drawn into the slowest (least often updated) display memory in which its image stays correct
    /// (CPR05).
    Objects,
    /// Each structure is drawn into the display memory of its cell. The memory depends on the cell's distance from the
    /// user's cell (CPR05).
    Cells,
    /// Structures are assigned as under [`FacePolicy::Cells`], but vertices are moved so that images of adjacent
    /// display memories meet at their borders.
    CellsWarped,
}

impl FacePolicy {
    /// All policies for display memories, with their names in experiment files.
    pub const ALL: [(&str, Self); 4] =
        [("full", Self::Full), ("objects", Self::Objects), ("cells", Self::Cells), ("cells-warp", Self::CellsWarped)];
}

pxpl5_sim::parameters::named!(FacePolicy, "policy", FacePolicy::ALL);
