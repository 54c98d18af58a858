//! The pose of the head at any instant: closed forms, a random generator with a seed, and replay of recorded traces.

mod from_fn;
mod growing;
mod pan;
mod pendulum;
mod recording;
mod shifted;
mod sinusoid;
mod slide;
mod spline;
mod still;
mod synthetic;
mod walk;

pub use from_fn::{FnMotion, from_fn};
pub use growing::{GrowingRecording, GrowthError};
pub use pan::Pan;
pub use pendulum::Pendulum;
pub use recording::{Axes, Columns, End, Recording, RecordingError, RecordingFormat};
pub use shifted::AdvancedMotion;
pub use sinusoid::Sinusoid;
pub use slide::Slide;
pub use still::Still;
pub use synthetic::{Band, Synthetic, SyntheticConfig};
pub use walk::Walk;

use glam::DVec3;
use std::fmt::Debug;
use std::sync::Arc;

use crate::identity::{SettingSink, write_pose};
use crate::pose::Pose;
use crate::rotation;
use crate::time::{PS_PER_S, span_s};

/// Half the step of the default central differences: 50 us. At this step the error for a 2 Hz motion is 2 parts in
/// 10^8.
const HALF_STEP_PS: u64 = 50_000_000;

/// Time between the poses that the default [`Motion::identify`] writes, and their number.
const SAMPLE_PS: u64 = PS_PER_S / 8;
const SAMPLES: u64 = 512;

/// A motion of the head (or of a pendulum's bob) as a pure function of simulated time.
pub trait Motion: Debug {
    /// Returns the pose of the head in the world at `t_ps` (ps of simulated time).
    fn pose(&self, t_ps: u64) -> Pose;

    /// Writes settings that distinguish this motion from every other motion. The names of experiments derive from these
    /// settings.
    ///
    /// The default writes the poses at every eighth of a second of the first 64 seconds. A motion type must override
    /// this method if two of its motions can differ only between or after these instants.
    fn identify(&self, settings: &mut SettingSink) {
        settings("motion", &"sampled");
        for sample in 0..SAMPLES {
            write_pose(settings, "motion.pose", &self.pose(sample * SAMPLE_PS));
        }
    }

    /// Returns the end of the motion (ps) if runs must not continue after it. Returns `None` if the motion continues
    /// for ever or stands still at its end.
    fn ends_ps(&self) -> Option<u64> {
        None
    }

    /// Returns the first gap before `until_ps`: the times (ps) of the last pose before the gap and of the first pose
    /// after it. A run must not read poses within a gap. Returns `None` if the motion has no such gap, or if the head
    /// stands still during the gap.
    fn gap_ps(&self, _until_ps: u64) -> Option<(u64, u64)> {
        None
    }

    /// Returns warnings about the file of this motion, one sentence each.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// Returns the last known time of movement, ps. Tuning a filter needs only the motion up to this time. The default
    /// is the end of the motion, if the motion has one.
    fn moves_until_ps(&self) -> Option<u64> {
        self.ends_ps()
    }

    /// Returns true if the motion is known only up to the present of a run ([`GrowingRecording`]). Later poses must not be read
    /// then.
    fn grows(&self) -> bool {
        false
    }

    /// Returns another motion of the same kind with different random numbers, or `None` if the motion has no variants.
    /// Filters are tuned on the sibling, so that the evaluation uses a motion unknown to the filter.
    fn sibling(&self) -> Option<Box<dyn Motion + Send + Sync>> {
        None
    }

    /// Returns the velocity in the world frame, m/s. The default is a central difference.
    fn velocity(&self, t_ps: u64) -> DVec3 {
        let before = t_ps.saturating_sub(HALF_STEP_PS);
        let after = t_ps.saturating_add(HALF_STEP_PS);
        (self.pose(after).position - self.pose(before).position) / span_s(before, after)
    }

    /// Returns the angular velocity in the world frame, rad/s. The default is a central difference.
    fn angular_velocity(&self, t_ps: u64) -> DVec3 {
        let before = t_ps.saturating_sub(HALF_STEP_PS);
        let after = t_ps.saturating_add(HALF_STEP_PS);
        let turn = rotation::difference(self.pose(before).orientation, self.pose(after).orientation);
        turn / span_s(before, after)
    }
}

/// Implements [`Motion`] for pointers to a motion by forwarding every call.
macro_rules! forward {
    ($($pointer:ty),*) => {$(
        impl<M: Motion + ?Sized> Motion for $pointer {
            fn pose(&self, t_ps: u64) -> Pose {
                (**self).pose(t_ps)
            }
            fn identify(&self, settings: &mut SettingSink) {
                (**self).identify(settings);
            }
            fn ends_ps(&self) -> Option<u64> {
                (**self).ends_ps()
            }
            fn gap_ps(&self, until_ps: u64) -> Option<(u64, u64)> {
                (**self).gap_ps(until_ps)
            }
            fn warnings(&self) -> Vec<String> {
                (**self).warnings()
            }
            fn moves_until_ps(&self) -> Option<u64> {
                (**self).moves_until_ps()
            }
            fn grows(&self) -> bool {
                (**self).grows()
            }
            fn sibling(&self) -> Option<Box<dyn Motion + Send + Sync>> {
                (**self).sibling()
            }
            fn velocity(&self, t_ps: u64) -> DVec3 {
                (**self).velocity(t_ps)
            }
            fn angular_velocity(&self, t_ps: u64) -> DVec3 {
                (**self).angular_velocity(t_ps)
            }
        }
    )*};
}

forward!(&M, Box<M>, Arc<M>);

/// Checks the closed forms of velocity and angular velocity against the pose alone.
#[cfg(test)]
fn assert_rates_agree_with_poses(motion: &impl Motion, t_ps: u64, tolerance: f64) {
    #[derive(Debug)]
    struct PosesOnly<'a, M>(&'a M);
    impl<M: Motion> Motion for PosesOnly<'_, M> {
        fn pose(&self, t_ps: u64) -> Pose {
            self.0.pose(t_ps)
        }
    }
    let differences = PosesOnly(motion);
    assert!((motion.velocity(t_ps) - differences.velocity(t_ps)).length() < tolerance);
    let closed = motion.angular_velocity(t_ps);
    let difference = differences.angular_velocity(t_ps);
    assert!((closed - difference).length() < tolerance, "{closed} {difference} at {t_ps}");
}
