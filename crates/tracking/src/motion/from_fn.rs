use super::Motion;
use crate::pose::Pose;
use crate::time::PS_PER_S;
use std::fmt;

/// A motion defined by a function from the time in seconds to the pose of the head. [`from_fn`] creates such a motion.
#[derive(Clone)]
pub struct FnMotion<F>(F);

/// Returns a motion whose pose is computed by a function of the simulated time in seconds.
///
/// The function must always return the same pose for the same time. [`Motion::identify`] compares poses at every eighth
/// of a second of the first 64 seconds. Two functions with equal poses at all these instants count as the same motion.
///
/// ```
/// use glam::{DQuat, DVec3};
/// use tracking::Pose;
/// use tracking::motion::{Motion, from_fn};
///
/// let walk = from_fn(|seconds| Pose { position: DVec3::new(0.5 * seconds, 1.7, 0.0), orientation: DQuat::IDENTITY });
/// assert_eq!(walk.pose(2_000_000_000_000).position.x, 1.0);
/// ```
pub const fn from_fn<F: Fn(f64) -> Pose>(pose: F) -> FnMotion<F> {
    FnMotion(pose)
}

impl<F> fmt::Debug for FnMotion<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("FnMotion")
    }
}

impl<F: Fn(f64) -> Pose> Motion for FnMotion<F> {
    fn pose(&self, t_ps: u64) -> Pose {
        (self.0)(t_ps as f64 / PS_PER_S as f64)
    }
}
