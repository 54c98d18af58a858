use address_recalculation::Lens;
use address_recalculation::priority::Falloff;
use pxpl5_sim::parameters::{Key, KeyValues, names};

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

/// Names of the pipelines of each policy, and of the ideal renderer, by the latched part of a field.
pub(super) const NAMES: [[&str; 3]; 5] = [
    ["arp-full", "arp-full-line", "arp-full-pixel"],
    ["arp-priority", "arp-priority-line", "arp-priority-pixel"],
    ["arp-cells", "arp-cells-line", "arp-cells-pixel"],
    ["arp-cells-warp", "arp-cells-warp-line", "arp-cells-warp-pixel"],
    ["arp-ideal", "arp-ideal-line", "arp-ideal-pixel"],
];

pub(super) const LENS: Key = Key::new(
    "lens",
    "lens before the eye; errors in pixels are those of a flat picture",
    KeyValues::Text(Lens::FORMS, |text| text.parse::<Lens>().map(drop)),
)
.with_default("that of the display");

pub(super) const POLICY: Key = Key::new(
    "policy",
    "policy that selects what is drawn when: full, objects, cells or cells-warp (segment and warp need cells)",
    KeyValues::Names(&const { names(&FacePolicy::ALL) }),
)
.with_default("full");

/// Names of the falloffs (rules for the decrease of warping with distance), in the order of [`Falloff`], without its
/// first value, `None`.
const FALLOFFS: [&str; 3] = [Falloff::ALL[1].0, Falloff::ALL[2].0, Falloff::ALL[3].0];

pub(super) const SEGMENT: Key = Key::new(
    "segment",
    "cut structures at the borders of cells (an uncut structure is drawn as often as its nearest part)",
    KeyValues::Flag,
)
.with_default("true");

pub(super) const WARP: Key = Key::new(
    "warp",
    "decrease of the displacement of vertices from a border to a slower memory: linear, smoothstep or step",
    KeyValues::Names(&FALLOFFS),
)
.with_default("linear");
