//! Names of address recalculation pipelines, and of what can be set in them.

use crate::keys::{Key, KeyValues};
use priority_rendering::Falloff;

/// Names by policy and latch.
pub(super) const NAMES: [[&str; 3]; 4] = [
    ["arp-full", "arp-full-line", "arp-full-pixel"],
    ["arp-priority", "arp-priority-line", "arp-priority-pixel"],
    ["arp-cells", "arp-cells-line", "arp-cells-pixel"],
    ["arp-cells-warp", "arp-cells-warp-line", "arp-cells-warp-pixel"],
];

/// Names of what an ideal renderer draws, by latch.
pub(super) const IDEAL_NAMES: [&str; 3] = ["arp-ideal", "arp-ideal-line", "arp-ideal-pixel"];

pub(super) const LENS: Key = Key {
    name: "lens",
    about: "what lies before the eye: flat, equidistant, radial:K1 or radial:K1:K2; errors in pixels are those of a flat picture",
    values: KeyValues::Lens,
    sets: &[],
};

/// Policies by their names, in their order.
pub(super) const POLICIES: [&str; 4] = ["full", "objects", "cells", "cells-warp"];

pub(super) const POLICY: Key = Key {
    name: "policy",
    about: "what is drawn when: full, objects, cells or cells-warp (segment and warp mean nothing without cells)",
    values: KeyValues::Names(&POLICIES),
    sets: &[],
};

/// Ways in which warping can fall off, as [`Falloff`] has them behind none.
const FALLOFFS: [&str; 3] = [Falloff::ALL[1].0, Falloff::ALL[2].0, Falloff::ALL[3].0];

pub(super) const SEGMENT: Key = Key {
    name: "segment",
    about: "cut structures at the borders of cells (without, all of one is drawn as often as its nearest part): true or false",
    values: KeyValues::Flag,
    sets: &[],
};

pub(super) const WARP: Key = Key {
    name: "warp",
    about: "how the displacement of vertices falls off from a border to a slower memory: linear, smoothstep or step",
    values: KeyValues::Names(&FALLOFFS),
    sets: &[],
};
