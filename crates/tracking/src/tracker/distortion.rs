use glam::DVec3;
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};

use crate::error::{check, contradiction};
use crate::pose::Pose;
use crate::rotation;

/// Distortion of measured poses by metal near a magnetic tracker. The error is smooth and depends only on the position.
/// Measured positions on a flat surface form a bowl, and even a still head sees objects in wrong places (TR94).
///
/// At distance r from the transmitter, measured positions move towards the metal by depth r^2 / (1 + (r / reach)^2).
/// Near the transmitter this is a parabola. Measured orientations tilt with the bowl's surface. The true magnetic field
/// is not modelled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MagneticDistortion {
    /// Position of the transmitter, m. The distortion is 0 at this position.
    pub transmitter_m: DVec3,
    /// Direction from the transmitter to the metal. The vector can have any length except 0.
    pub towards_metal: DVec3,
    /// Position error per squared distance from the transmitter, m per square metre, valid near the transmitter.
    pub depth_per_m2: f64,
    /// Distance from the transmitter at which the position error is half of `depth_per_m2` times the squared distance,
    /// m.
    pub reach_m: f64,
}

impl MagneticDistortion {
    /// Returns the distortion by metal in the floor below a transmitter at the position `transmitter_m`. Near the
    /// transmitter, the error at a distance of r metres is `bowl_mm` times r^2. Farther away than `reach_m`, the error
    /// grows more slowly.
    pub fn floor_below([bowl_mm, reach_m]: [f64; 2], transmitter_m: DVec3) -> Self {
        Self { transmitter_m, towards_metal: DVec3::NEG_Y, depth_per_m2: bowl_mm / 1e3, reach_m }
    }

    /// Returns the pose that the tracker reports for the true pose `pose`.
    pub fn distort(&self, pose: &Pose) -> Pose {
        let from_transmitter = pose.position - self.transmitter_m;
        let axis = self.towards_metal.normalize();
        let saturation = 1.0 + from_transmitter.length_squared() / (self.reach_m * self.reach_m);
        let depth = self.depth_per_m2 * from_transmitter.length_squared() / saturation;
        // The slope of the bowl is the part of the depth's gradient that is perpendicular to the axis.
        let gradient = from_transmitter * (2.0 * self.depth_per_m2 / (saturation * saturation));
        Pose {
            position: pose.position + axis * depth,
            orientation: rotation::exp(gradient.cross(axis)) * pose.orientation,
        }
    }

    pub(super) fn check(&self) -> Result<(), SettingError> {
        if !(self.transmitter_m.is_finite() && self.towards_metal.try_normalize().is_some()) {
            return Err(contradiction("magnetic distortion needs a place and a direction"));
        }
        check("depth of magnetic distortion", self.depth_per_m2, -1.0, 1.0)?;
        check("reach of magnetic distortion", self.reach_m, 1e-3, 1e3)
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

    /// Returns the curvature of the measured height at `x`, as a second difference with steps of 10 mm. A negative
    /// value means that a flat plane appears curved downwards.
    fn second_difference(x: f64) -> f64 {
        height(x + 0.01) - 2.0 * height(x) + height(x - 0.01)
    }

    #[test]
    fn metal_makes_a_level_plane_look_like_a_bowl() {
        // The depth is 20 mm at 1 m, divided by 1 + 1/4 because of the reach.
        assert_eq!(height(0.0), 0.0);
        assert!((height(1.0) + 0.016).abs() < 1e-12);
        assert!((-100..=100).all(|i| second_difference(f64::from(i) / 100.0) < 0.0), "curved towards the metal");
    }

    #[test]
    fn the_reported_orientation_of_the_head_tilts_with_the_distorted_plane() {
        let tilted = METAL.distort(&Pose::at(DVec3::X)).orientation * DVec3::X;
        let slope = (height(1.0 + 1e-6) - height(1.0 - 1e-6)) / 2e-6;
        assert!((tilted.y / tilted.x - slope).abs() < 1e-4, "{tilted} {slope}");
    }

    #[test]
    fn a_still_head_has_a_constant_position_error() {
        let head = Pose::at(DVec3::new(0.5, 0.7, -0.4));
        assert_eq!(METAL.distort(&head), METAL.distort(&head));
        assert!(METAL.distort(&head).distance_m(&head) > 5e-3);
    }

    #[test]
    fn far_from_the_metal_the_position_error_stays_below_depth_times_reach_squared() {
        assert!(height(1e6).abs() <= 0.02 * 4.0);
    }
}
