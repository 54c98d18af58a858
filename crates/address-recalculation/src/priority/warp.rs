//! Region warping: vertices near the border to a less often drawn memory are moved, so that the images of both memories
//! meet at the border.

use glam::DVec3;
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};

/// Falloff: how the displacement of vertices decreases with the distance from the border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Falloff {
    /// No displacement. The images of the two memories do not meet at the border.
    None,
    /// The displacement decreases linearly to 0.
    #[default]
    Linear,
    /// The displacement decreases smoothly to 0. As a function of the distance, it has slope 0 at the border and where
    /// it reaches 0.
    Smoothstep,
    /// Full displacement up to a certain distance from the border (the length of the falloff), and no displacement
    /// beyond.
    Step,
}

pxpl5_sim::parameters::named!(Falloff, "falloff", Falloff::ALL);

impl Falloff {
    pub const ALL: [(&str, Self); 4] =
        [("none", Self::None), ("linear", Self::Linear), ("smoothstep", Self::Smoothstep), ("step", Self::Step)];

    /// Returns the fraction of the displacement that applies at `distance_m` from the border. `length_m` is the
    /// distance over which the displacement decreases.
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

/// The displacement of a memory's vertices near a border. Beyond the border lie the objects of the slower memory, the
/// memory with the next higher index. The slower memory is drawn less often.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionWarp {
    falloff: Falloff,
    length_m: f64,
    displacement: DVec3,
}

impl RegionWarp {
    /// Creates the warp of a memory. `drawn_from` is the eye position from which this memory was drawn. `slower_from`
    /// is the eye position from which the slower memory was drawn.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the distance over which the displacement decreases is not positive and finite.
    pub fn new(falloff: Falloff, length_m: f64, drawn_from: DVec3, slower_from: DVec3) -> Result<Self, SettingError> {
        if !(length_m > 0.0 && length_m.is_finite()) {
            return Err(SettingError::value("priority.falloff_m", "a length above 0", length_m));
        }
        Ok(Self { falloff, length_m, displacement: drawn_from - slower_from })
    }

    /// Returns the position at which a vertex is drawn. `to_slower_m` is the vertex's distance to the border of the
    /// less often drawn memory, or `None` if there is no such memory.
    ///
    /// A vertex on the border moves by the whole displacement. Its direction and depth are then the same in both
    /// memories.
    pub fn moved(&self, vertex: DVec3, to_slower_m: Option<f64>) -> DVec3 {
        to_slower_m.map_or(vertex, |distance| vertex + self.displacement * self.falloff.weight(distance, self.length_m))
    }
}
