use glam::DVec3;

use super::Motion;
use crate::identity::SettingSink;
use crate::pose::Pose;

/// A motion that is ahead of another motion by a constant time. The pose of this motion at time t is the other motion's
/// pose at t + `by_ps`.
#[derive(Clone, Copy, Debug)]
pub struct AdvancedMotion<M> {
    /// The original motion, whose poses are reached `by_ps` later.
    pub motion: M,
    /// Time by which this motion is ahead of the original motion, ps.
    pub by_ps: u64,
}

impl<M: Motion> Motion for AdvancedMotion<M> {
    fn pose(&self, t_ps: u64) -> Pose {
        self.motion.pose(t_ps.saturating_add(self.by_ps))
    }

    fn identify(&self, settings: &mut SettingSink) {
        settings("motion.shifted_ps", &self.by_ps);
        self.motion.identify(settings);
    }

    fn velocity(&self, t_ps: u64) -> DVec3 {
        self.motion.velocity(t_ps.saturating_add(self.by_ps))
    }

    fn angular_velocity(&self, t_ps: u64) -> DVec3 {
        self.motion.angular_velocity(t_ps.saturating_add(self.by_ps))
    }
}
