//! Names and settings of the address recalculation pipelines.

use super::policy::FacePolicy;
use crate::keys::{Key, KeyValues};
use address_recalculation::priority::Falloff;

/// Pipeline names by policy and latch mode.
pub(super) const NAMES: [[&str; 3]; 4] = [
    ["arp-full", "arp-full-line", "arp-full-pixel"],
    ["arp-priority", "arp-priority-line", "arp-priority-pixel"],
    ["arp-cells", "arp-cells-line", "arp-cells-pixel"],
    ["arp-cells-warp", "arp-cells-warp-line", "arp-cells-warp-pixel"],
];

/// Names of pipelines with an ideal renderer, by latch mode.
pub(super) const IDEAL_NAMES: [&str; 3] = ["arp-ideal", "arp-ideal-line", "arp-ideal-pixel"];

pub(super) const LENS: Key = Key {
    name: "lens",
    about: "lens before the eye: flat, equidistant, radial:K1 or radial:K1:K2; errors in pixels are those of a flat picture",
    values: KeyValues::Lens,
    sets: &[],
};

/// Names of the policies.
const POLICIES: [&str; 4] = [FacePolicy::ALL[0].0, FacePolicy::ALL[1].0, FacePolicy::ALL[2].0, FacePolicy::ALL[3].0];

pub(super) const POLICY: Key = Key {
    name: "policy",
    about: "policy that selects what is drawn when: full, objects, cells or cells-warp (segment and warp need cells)",
    values: KeyValues::Names(&POLICIES),
    sets: &[],
};

/// Names of the falloffs (rules for the decrease of warping with distance), in the order of [`Falloff`], without its
/// first value, `None`.
const FALLOFFS: [&str; 3] = [Falloff::ALL[1].0, Falloff::ALL[2].0, Falloff::ALL[3].0];

pub(super) const SEGMENT: Key = Key {
    name: "segment",
    about: "cut structures at the borders of cells: true or false (an uncut structure is drawn as often as its nearest part)",
    values: KeyValues::Flag,
    sets: &[],
};

pub(super) const WARP: Key = Key {
    name: "warp",
    about: "decrease of the displacement of vertices from a border to a slower memory: linear, smoothstep or step",
    values: KeyValues::Names(&FALLOFFS),
    sets: &[],
};
