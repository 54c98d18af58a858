use glam::DVec3;

use super::Motion;
use crate::identity::{SettingSink, write_pose};
use crate::pose::Pose;
use crate::rotation;
use crate::time::seconds;

/// A head that turns about the vertical axis at constant speed. The head has the pose `start` at time 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pan {
    /// Pose of the head at time 0.
    pub start: Pose,
    /// Yaw rate in degrees per second, positive to the left. A fast head turn has 200, and the measured peak is 370
    /// (LIST83).
    pub deg_per_s: f64,
}

impl Pan {
    /// Creates a turn at `deg_per_s` degrees per second, positive to the left, from the identity pose at time 0.
    pub fn at(deg_per_s: f64) -> Self {
        Self { start: Pose::IDENTITY, deg_per_s }
    }
}

impl Motion for Pan {
    fn pose(&self, t_ps: u64) -> Pose {
        let yaw = libm::fmod(self.deg_per_s * seconds(t_ps), 360.0).to_radians();
        Pose { orientation: rotation::about_y(yaw) * self.start.orientation, ..self.start }
    }
    fn identify(&self, settings: &mut SettingSink) {
        let Self { start, deg_per_s } = self;
        settings("motion", &"pan");
        write_pose(settings, "motion.start", start);
        settings("motion.deg_per_s", deg_per_s);
    }
    fn velocity(&self, _t_ps: u64) -> DVec3 {
        DVec3::ZERO
    }
    fn angular_velocity(&self, _t_ps: u64) -> DVec3 {
        DVec3::Y * self.deg_per_s.to_radians()
    }
}

#[cfg(test)]
mod tests {
    use super::super::assert_rates_agree_with_poses;
    use super::*;
    use crate::time::PS_PER_S;

    #[test]
    fn the_angle_of_a_pan_is_still_exact_after_an_hour() {
        // 200 deg/s x 3,600.45 s = 2,000 turns and 90 degrees.
        let pose = Pan::at(200.0).pose(3600 * PS_PER_S + 450_000_000_000);
        assert!(pose.angle_deg(&Pose::facing(rotation::about_y(90f64.to_radians()))) < 1e-9);
    }

    #[test]
    fn the_angular_velocity_is_the_derivative_of_the_poses() {
        let start = Pose::facing(rotation::from_yaw_pitch_roll(1.0, 0.4, 0.2));
        assert_rates_agree_with_poses(&Pan { start, deg_per_s: -370.0 }, 7 * PS_PER_S, 1e-8);
    }
}
