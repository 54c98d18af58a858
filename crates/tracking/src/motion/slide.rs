use glam::DVec3;

use super::Motion;
use crate::identity::{SettingSink, write_pose, write_vector};
use crate::pose::Pose;
use crate::time::seconds;

/// A head that moves in a straight line at constant speed without turning. The head has the pose `start` at time 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slide {
    /// Pose of the head at time 0.
    pub start: Pose,
    /// Velocity in the world, m/s.
    pub m_per_s: DVec3,
}

impl Slide {
    /// Creates a motion to the right (+x) at `m_per_s` metres per second, from the identity pose at time 0.
    pub fn right_at(m_per_s: f64) -> Self {
        Self { start: Pose::IDENTITY, m_per_s: DVec3::X * m_per_s }
    }
}

impl Motion for Slide {
    fn pose(&self, t_ps: u64) -> Pose {
        Pose { position: self.start.position + self.m_per_s * seconds(t_ps), ..self.start }
    }
    fn identify(&self, settings: &mut SettingSink) {
        let Self { start, m_per_s } = self;
        settings("motion", &"slide");
        write_pose(settings, "motion.start", start);
        write_vector(settings, "motion.m_per_s", *m_per_s);
    }
    fn velocity(&self, _t_ps: u64) -> DVec3 {
        self.m_per_s
    }
    fn angular_velocity(&self, _t_ps: u64) -> DVec3 {
        DVec3::ZERO
    }
}
