use super::policy::FacePolicy;
use address_recalculation::Lens;
use address_recalculation::priority::Falloff;
use pxpl5_sim::parameters::{Key, KeyValues, names};

pub(super) const NAMES: [[&str; 3]; 4] = [
    ["arp-full", "arp-full-line", "arp-full-pixel"],
    ["arp-priority", "arp-priority-line", "arp-priority-pixel"],
    ["arp-cells", "arp-cells-line", "arp-cells-pixel"],
    ["arp-cells-warp", "arp-cells-warp-line", "arp-cells-warp-pixel"],
];

pub(super) const IDEAL_NAMES: [&str; 3] = ["arp-ideal", "arp-ideal-line", "arp-ideal-pixel"];

pub(super) const LENS: Key = Key::new(
    "lens",
    "lens before the eye; errors in pixels are those of a flat picture",
    KeyValues::Text(Lens::FORMS, |text| text.parse::<Lens>().map(drop)),
);

pub(super) const POLICY: Key = Key::new(
    "policy",
    "policy that selects what is drawn when: full, objects, cells or cells-warp (segment and warp need cells)",
    KeyValues::Names(&const { names(&FacePolicy::ALL) }),
);

/// Names of the falloffs (rules for the decrease of warping with distance), in the order of [`Falloff`], without its
/// first value, `None`.
const FALLOFFS: [&str; 3] = [Falloff::ALL[1].0, Falloff::ALL[2].0, Falloff::ALL[3].0];

pub(super) const SEGMENT: Key = Key::new(
    "segment",
    "cut structures at the borders of cells (an uncut structure is drawn as often as its nearest part)",
    KeyValues::Flag,
);

pub(super) const WARP: Key = Key::new(
    "warp",
    "decrease of the displacement of vertices from a border to a slower memory: linear, smoothstep or step",
    KeyValues::Names(&FALLOFFS),
);
