//! The pose of the head at any instant: formulas, random motion from a seed, and replay of recorded files.

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
pub use growing::GrowingRecording;
pub use pan::Pan;
pub use pendulum::Pendulum;
pub use recording::{Axes, Columns, End, Jumps, Recording, RecordingFormat};
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

/// Half the time between the two poses of a central difference: 50 us. The relative error of the velocity of a 2 Hz
/// motion is then 2 parts in 10^8.
const HALF_STEP_PS: u64 = 50_000_000;

/// Time (ps) between the poses that the default [`Motion::identify`] writes.
const SAMPLE_PS: u64 = PS_PER_S / 8;
const SAMPLES: u64 = 512;

/// The motion of a head as a pure function of simulated time.
///
/// The trait also describes the pendulum of the latency rig, because this pendulum carries a tracker.
pub trait Motion: Debug {
    /// Returns the pose of the head in the world at `t_ps` (ps of simulated time).
    fn pose(&self, t_ps: u64) -> Pose;

    /// Writes settings that distinguish this motion from all others. The names of experiments derive from these
    /// settings.
    ///
    /// The default writes the poses at every eighth of a second of the first 64 seconds. If two motions of a type can
    /// agree at all these instants but differ at other instants, the type must override this method.
    fn identify(&self, settings: &mut SettingSink) {
        settings("motion", &"sampled");
        for sample in 0..SAMPLES {
            write_pose(settings, "motion.pose", &self.pose(sample * SAMPLE_PS));
        }
    }

    /// Returns the time (ps) at which the motion ends, if a run must stop at this time. Returns `None` if the motion
    /// continues for ever or the head stands still at the end.
    fn ends_ps(&self) -> Option<u64> {
        None
    }

    /// Returns the first gap of a recording that begins before `_until_ps`. The two numbers are the times (ps) of the
    /// last pose before the gap and of the first pose after the gap. A run must not read poses within a gap. Returns
    /// `None` without a gap, or if the head stands still during gaps.
    fn gap_ps(&self, _until_ps: u64) -> Option<(u64, u64)> {
        None
    }

    /// Returns warnings about the file of this motion, one sentence each.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// Returns the time (ps) after which no motion of the head is known. The tuning of a prediction filter needs no
    /// motion after this time. The default is the end of the motion, if the motion has an end.
    fn moves_until_ps(&self) -> Option<u64> {
        self.ends_ps()
    }

    /// Returns true if poses are added while a run goes on ([`GrowingRecording`]). No pose later than the present
    /// instant of the run can then be read.
    fn grows(&self) -> bool {
        false
    }

    /// Returns a motion of the same kind with different random numbers. Returns `None` if the motion has no random
    /// numbers. Prediction filters are tuned on the returned motion, so the evaluated motion has no influence on the
    /// tuning.
    fn sibling(&self) -> Option<Box<dyn Motion + Send + Sync>> {
        None
    }

    /// Returns the velocity of the head in the world frame, m/s. The default computes a central difference of two
    /// poses.
    fn velocity(&self, t_ps: u64) -> DVec3 {
        let before = t_ps.saturating_sub(HALF_STEP_PS);
        let after = t_ps.saturating_add(HALF_STEP_PS);
        (self.pose(after).position - self.pose(before).position) / span_s(before, after)
    }

    /// Returns the angular velocity of the head in the world frame, rad/s. The default computes a central difference of
    /// two poses.
    fn angular_velocity(&self, t_ps: u64) -> DVec3 {
        let before = t_ps.saturating_sub(HALF_STEP_PS);
        let after = t_ps.saturating_add(HALF_STEP_PS);
        let turn = rotation::difference(self.pose(before).orientation, self.pose(after).orientation);
        turn / span_s(before, after)
    }
}

/// Forwards all methods that give poses, rates and times to another motion.
macro_rules! forward_poses {
    ($own:ident, $to:expr) => {
        fn pose(&$own, t_ps: u64) -> Pose {
            $to.pose(t_ps)
        }
        fn ends_ps(&$own) -> Option<u64> {
            $to.ends_ps()
        }
        fn gap_ps(&$own, until_ps: u64) -> Option<(u64, u64)> {
            $to.gap_ps(until_ps)
        }
        fn warnings(&$own) -> Vec<String> {
            $to.warnings()
        }
        fn moves_until_ps(&$own) -> Option<u64> {
            $to.moves_until_ps()
        }
        fn grows(&$own) -> bool {
            $to.grows()
        }
        fn velocity(&$own, t_ps: u64) -> DVec3 {
            $to.velocity(t_ps)
        }
        fn angular_velocity(&$own, t_ps: u64) -> DVec3 {
            $to.angular_velocity(t_ps)
        }
    };
}

macro_rules! forward {
    ($($pointer:ty),*) => {$(
        impl<M: Motion + ?Sized> Motion for $pointer {
            forward_poses!(self, (**self));
            fn identify(&self, settings: &mut SettingSink) {
                (**self).identify(settings);
            }
            fn sibling(&self) -> Option<Box<dyn Motion + Send + Sync>> {
                (**self).sibling()
            }
        }
    )*};
}

forward!(&M, Box<M>, Arc<M>);

/// A motion whose predictor is tuned on another motion, as the predictor of a real system is tuned on other users.
#[derive(Clone, Debug)]
pub struct TrainedOn {
    /// Motion of the head.
    pub motion: Arc<dyn Motion + Send + Sync>,
    /// Motion on which prediction filters are tuned.
    pub training: Arc<dyn Motion + Send + Sync>,
}

impl Motion for TrainedOn {
    forward_poses!(self, self.motion);
    fn identify(&self, settings: &mut SettingSink) {
        self.motion.identify(settings);
        settings("motion.training", &"the settings that follow");
        self.training.identify(settings);
    }
    fn sibling(&self) -> Option<Box<dyn Motion + Send + Sync>> {
        Some(Box::new(Arc::clone(&self.training)))
    }
}

/// Tests the velocity and the angular velocity of a motion at `t_ps` against differences between poses.
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
