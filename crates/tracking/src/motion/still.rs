use glam::DVec3;

use super::Motion;
use crate::identity::{SettingSink, write_pose};
use crate::pose::Pose;

/// A head that does not move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Still(pub Pose);

impl Motion for Still {
    fn pose(&self, _t_ps: u64) -> Pose {
        self.0
    }
    fn identify(&self, settings: &mut SettingSink) {
        settings("motion", &"still");
        write_pose(settings, "motion.pose", &self.0);
    }
    fn velocity(&self, _t_ps: u64) -> DVec3 {
        DVec3::ZERO
    }
    fn angular_velocity(&self, _t_ps: u64) -> DVec3 {
        DVec3::ZERO
    }
}
