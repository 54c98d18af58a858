//! Region warping: vertices near a border to a slower memory are moved so that both sides meet.

use crate::error::PriorityError;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Decrease of the displacement with the distance from the border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Falloff {
    /// No displacement, so that cuts tear.
    None,
    /// Linear decrease to 0.
    #[default]
    Linear,
    /// Smooth decrease to 0, with slope 0 at both ends.
    Smoothstep,
    /// Full displacement up to the length of the falloff, and none beyond.
    Step,
}

impl Falloff {
    /// All variants with their names on the command line.
    pub const ALL: [(&str, Self); 4] =
        [("none", Self::None), ("linear", Self::Linear), ("smoothstep", Self::Smoothstep), ("step", Self::Step)];

    /// Returns the fraction of the displacement at a distance from the border, for a falloff of length `length_m`.
    #[must_use]
    pub fn weight(self, distance_m: f64, length_m: f64) -> f64 {
        let left = (1.0 - distance_m / length_m).clamp(0.0, 1.0);
        match self {
            Self::None => 0.0,
            Self::Linear => left,
            Self::Smoothstep => left * left * (3.0 - 2.0 * left),
            Self::Step => f64::from(u8::from(left > 0.0)),
        }
    }
}

/// The displacement between a memory and its slower neighbour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionWarp {
    falloff: Falloff,
    length_m: f64,
    displacement: DVec3,
}

impl RegionWarp {
    /// Creates the warp of a memory from its own eye position and that of its slower neighbour.
    ///
    /// # Errors
    ///
    /// [`PriorityError`] if the falloff has no length.
    pub fn new(falloff: Falloff, length_m: f64, drawn_from: DVec3, slower_from: DVec3) -> Result<Self, PriorityError> {
        if !(length_m > 0.0 && length_m.is_finite()) {
            return Err(PriorityError(format!("priority.falloff_m: expected a length above 0, found {length_m}")));
        }
        Ok(Self { falloff, length_m, displacement: drawn_from - slower_from })
    }

    /// Returns the position at which a vertex is drawn. `to_slower_m` is its distance to the border of the slower
    /// memory.
    ///
    /// On the border, the vertex moves by the whole displacement, so its direction and depth are the same from both eye
    /// positions. `None` means that there is no slower memory.
    #[must_use]
    pub fn moved(&self, vertex: DVec3, to_slower_m: Option<f64>) -> DVec3 {
        to_slower_m.map_or(vertex, |distance| vertex + self.displacement * self.falloff.weight(distance, self.length_m))
    }
}
