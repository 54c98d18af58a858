//! Region warping: vertices near a border to a slower memory are moved so that both sides meet.

use crate::error::PriorityError;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// How the displacement falls with the distance from the border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Falloff {
    /// No vertex is moved: cuts tear.
    None,
    /// It falls evenly to nothing.
    #[default]
    Linear,
    /// With a smooth beginning and end.
    Smoothstep,
    /// Whole up to the distance of the falloff, and nothing beyond.
    Step,
}

impl Falloff {
    /// All, by their names on the command line.
    pub const ALL: [(&str, Self); 4] =
        [("none", Self::None), ("linear", Self::Linear), ("smoothstep", Self::Smoothstep), ("step", Self::Step)];

    /// The share of the displacement at a distance from the border, with a falloff of this length.
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
    /// For a memory drawn from one place and its slower neighbour drawn from another.
    ///
    /// # Errors
    ///
    /// [`PriorityError`] for a falloff that has no length.
    pub fn new(falloff: Falloff, length_m: f64, drawn_from: DVec3, slower_from: DVec3) -> Result<Self, PriorityError> {
        if !(length_m > 0.0 && length_m.is_finite()) {
            return Err(PriorityError(format!("priority.falloff_m: expected a length above 0, found {length_m}")));
        }
        Ok(Self { falloff, length_m, displacement: drawn_from - slower_from })
    }

    /// Where a vertex is drawn that lies at a distance from the border to the slower memory (`None`: there is no such border).
    ///
    /// On the border it is moved by the whole displacement, and so has the same direction and depth from both places.
    #[must_use]
    pub fn moved(&self, vertex: DVec3, to_slower_m: Option<f64>) -> DVec3 {
        to_slower_m.map_or(vertex, |distance| vertex + self.displacement * self.falloff.weight(distance, self.length_m))
    }
}
