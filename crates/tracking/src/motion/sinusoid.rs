use core::f64::consts::TAU;

use glam::DVec3;

use super::Motion;
use crate::identity::{SettingSink, write_pose};
use crate::pose::Pose;
use crate::rotation;
use crate::time::seconds;

/// A head whose yaw and whose position along x follow sine waves of one frequency around the pose `start`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sinusoid {
    /// Pose of the head at the centre of both sine waves, which is also the pose at time 0.
    pub start: Pose,
    /// Frequency of the sine waves, Hz.
    pub hz: f64,
    /// Amplitude of the yaw, degrees. A positive value turns the head to the left first.
    pub yaw_deg: f64,
    /// Amplitude of the position along the world's x axis, metres.
    pub sway_m: f64,
}

impl Sinusoid {
    /// Creates a motion that changes only the yaw, with the identity pose at its centre.
    pub fn of_yaw(yaw_deg: f64, hz: f64) -> Self {
        Self { start: Pose::IDENTITY, hz, yaw_deg, sway_m: 0.0 }
    }

    fn phase(&self, t_ps: u64) -> (f64, f64) {
        libm::sincos(TAU * libm::fmod(self.hz * seconds(t_ps), 1.0))
    }
}

impl Motion for Sinusoid {
    fn pose(&self, t_ps: u64) -> Pose {
        let (sin, _) = self.phase(t_ps);
        Pose {
            position: self.start.position + DVec3::X * (self.sway_m * sin),
            orientation: rotation::about_y(self.yaw_deg.to_radians() * sin) * self.start.orientation,
        }
    }
    fn identify(&self, settings: &mut SettingSink) {
        let Self { start, hz, yaw_deg, sway_m } = self;
        settings("motion", &"sinusoid");
        write_pose(settings, "motion.start", start);
        settings("motion.hz", hz);
        settings("motion.yaw_deg", yaw_deg);
        settings("motion.sway_m", sway_m);
    }
    fn velocity(&self, t_ps: u64) -> DVec3 {
        let (_, cos) = self.phase(t_ps);
        DVec3::X * (self.sway_m * TAU * self.hz * cos)
    }
    fn angular_velocity(&self, t_ps: u64) -> DVec3 {
        let (_, cos) = self.phase(t_ps);
        DVec3::Y * (self.yaw_deg.to_radians() * TAU * self.hz * cos)
    }
}

#[cfg(test)]
mod tests {
    use super::super::assert_rates_agree_with_poses;
    use super::*;
    use crate::time::PS_PER_S;

    #[test]
    fn the_rates_are_the_derivatives_of_the_poses() {
        let motion = Sinusoid { hz: 1.3, yaw_deg: 20.0, sway_m: 0.4, start: Pose::at(DVec3::ONE) };
        assert_rates_agree_with_poses(&motion, 7 * PS_PER_S / 3, 1e-6);
    }

    #[test]
    fn after_a_quarter_period_a_sinusoid_is_at_its_amplitude() {
        let motion = Sinusoid { sway_m: 0.4, ..Sinusoid::of_yaw(20.0, 0.5) };
        let pose = motion.pose(PS_PER_S / 2);
        assert!((pose.position.x - 0.4).abs() < 1e-15);
        assert!(pose.angle_deg(&Pose::facing(rotation::about_y(20f64.to_radians()))) < 1e-12);
    }
}
