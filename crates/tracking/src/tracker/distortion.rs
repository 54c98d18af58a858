use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::config::Tables;
use crate::error::SettingError;
use crate::pose::Pose;
use crate::rotation;

/// Distortion by metal near a magnetic tracker: a smooth error that depends only on the position. A plane appears as a
/// bowl, and even a still head sees objects in wrong places (TR94).
///
/// At distance r from the transmitter, positions move towards the metal by depth r^2 / (1 + (r / reach)^2). This
/// function is a parabola near the transmitter. Orientations tilt with the bowl's surface. The true magnetic field is
/// not modelled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MagneticDistortion {
    /// Position of the transmitter, m. The error is 0 there.
    pub transmitter_m: DVec3,
    /// Direction from the transmitter to the metal, with any length except 0.
    pub towards_metal: DVec3,
    /// Depth of the bowl per square metre, m.
    pub depth_per_m2: f64,
    /// Distance from the transmitter at which the depth is half of the parabola's, m.
    pub reach_m: f64,
}

impl MagneticDistortion {
    /// Returns the distortion by metal in the floor below a transmitter at this position: 20 mm at 1 m (assumed).
    pub fn floor_below(transmitter_m: DVec3) -> Self {
        Self::floor_below_by(&Tables::PAPERS, transmitter_m)
    }

    /// Returns the distortion by metal in the floor with the numbers of these tables.
    pub fn floor_below_by(tables: &Tables, transmitter_m: DVec3) -> Self {
        Self {
            transmitter_m,
            towards_metal: DVec3::NEG_Y,
            depth_per_m2: tables.space.bowl / 1e3,
            reach_m: tables.space.bowl_reach,
        }
    }

    /// Returns the pose that the tracker reports for the true pose `pose`.
    pub fn distort(&self, pose: &Pose) -> Pose {
        let from_transmitter = pose.position - self.transmitter_m;
        let axis = self.towards_metal.normalize();
        let saturation = 1.0 + from_transmitter.length_squared() / (self.reach_m * self.reach_m);
        let depth = self.depth_per_m2 * from_transmitter.length_squared() / saturation;
        // The component of the depth's gradient across the axis is the slope of the bowl.
        let gradient = from_transmitter * (2.0 * self.depth_per_m2 / (saturation * saturation));
        Pose {
            position: pose.position + axis * depth,
            orientation: rotation::exp(gradient.cross(axis)) * pose.orientation,
        }
    }

    pub(super) fn check(&self) -> Result<(), SettingError> {
        if !(self.transmitter_m.is_finite() && self.towards_metal.try_normalize().is_some()) {
            return Err(SettingError::Contradiction { what: "magnetic distortion needs a place and a direction" });
        }
        SettingError::check("depth of magnetic distortion", self.depth_per_m2, -1.0, 1.0)?;
        SettingError::check("reach of magnetic distortion", self.reach_m, 1e-3, 1e3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const METAL: MagneticDistortion = MagneticDistortion {
        transmitter_m: DVec3::ZERO,
        towards_metal: DVec3::NEG_Y,
        depth_per_m2: 0.02,
        reach_m: 2.0,
    };

    fn height(x: f64) -> f64 {
        METAL.distort(&Pose::at(DVec3::new(x, 0.0, 0.0))).position.y
    }

    /// Returns the second difference of the height over 10 mm, which is negative if the plane is curved downwards.
    fn second_difference(x: f64) -> f64 {
        height(x + 0.01) - 2.0 * height(x) + height(x - 0.01)
    }

    #[test]
    fn a_level_plane_looks_like_a_bowl() {
        // 20 mm at 1 m, less the saturation 1 + 1/4.
        assert_eq!(height(0.0), 0.0);
        assert!((height(1.0) + 0.016).abs() < 1e-12);
        assert!((-100..=100).all(|i| second_difference(f64::from(i) / 100.0) < 0.0), "curved towards the metal");
    }

    #[test]
    fn the_head_tilts_as_the_surface_does() {
        let tilted = METAL.distort(&Pose::at(DVec3::X)).orientation * DVec3::X;
        let slope = (height(1.0 + 1e-6) - height(1.0 - 1e-6)) / 2e-6;
        assert!((tilted.y / tilted.x - slope).abs() < 1e-4, "{tilted} {slope}");
    }

    #[test]
    fn a_still_head_is_misplaced_always_by_the_same() {
        let head = Pose::at(DVec3::new(0.5, 0.7, -0.4));
        assert_eq!(METAL.distort(&head), METAL.distort(&head));
        assert!(METAL.distort(&head).distance_m(&head) > 5e-3);
    }

    #[test]
    fn far_away_the_error_stays_below_depth_times_reach_squared() {
        assert!(height(1e6).abs() <= 0.02 * 4.0);
    }
}
