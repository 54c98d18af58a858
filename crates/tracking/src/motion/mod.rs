//! Where the head is at any instant: closed forms, a seeded generator, and replay of recorded traces.

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

pub use growing::{Growing, GrowthError};
pub use pan::Pan;
pub use pendulum::Pendulum;
pub use recording::{Axes, Columns, End, Recording, RecordingError, RecordingFormat};
pub use shifted::Shifted;
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

/// Half the step of the default central differences: 50 us, at which a 2 Hz motion is off by 2 parts in 10^8.
const HALF_STEP_PS: u64 = 50_000_000;

/// Time between the poses by which a motion that does not say what it is is told from others, and their number.
const SAMPLE_PS: u64 = PS_PER_S / 8;
const SAMPLES: u64 = 512;

/// A motion of the head (or of a pendulum's bob): a pure function of simulated time.
pub trait Motion: Debug {
    /// Pose of the head in the world at `t_ps`, ps of simulated time.
    fn pose(&self, t_ps: u64) -> Pose;

    /// Writes what tells it from every other motion: names of experiments rest on it.
    ///
    /// By default its poses at every eighth of a second of the first 64. Motions that differ only between these instants or
    /// after them must say themselves what they are.
    fn identify(&self, settings: &mut SettingSink) {
        settings("motion", &"sampled");
        for sample in 0..SAMPLES {
            write_pose(settings, "motion.pose", &self.pose(sample * SAMPLE_PS));
        }
    }

    /// When it ends, ps, if no run may go on after that; `None` where it goes on for ever, or stands still at its end.
    fn ends_ps(&self) -> Option<u64> {
        None
    }

    /// The first stretch before `until_ps` of which nothing is known, ps: from its last pose to its next. No run may need it. `None`
    /// where there is none, or where the head is to stand still there.
    fn gap_ps(&self, _until_ps: u64) -> Option<(u64, u64)> {
        None
    }

    /// What is to be said of the file that it was read from, a sentence each.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// When it has moved for the last time, ps, as far as that is known: a filter that is tuned on it learns nothing from a head that
    /// stands still for ever. By default its end, if it has one.
    fn moves_until_ps(&self) -> Option<u64> {
        self.ends_ps()
    }

    /// Whether it is only known as far as a run has come ([`Growing`]): then nobody may ask ahead.
    fn grows(&self) -> bool {
        false
    }

    /// Another motion of the same kind, drawn with other random numbers: filters are tuned on it, so that they do not know
    /// the motion on which they are judged. `None` where there is only this one.
    fn sibling(&self) -> Option<Box<dyn Motion + Send + Sync>> {
        None
    }

    /// Velocity in m/s, world frame. By default a central difference.
    fn velocity(&self, t_ps: u64) -> DVec3 {
        let before = t_ps.saturating_sub(HALF_STEP_PS);
        let after = t_ps.saturating_add(HALF_STEP_PS);
        (self.pose(after).position - self.pose(before).position) / span_s(before, after)
    }

    /// Angular velocity in rad/s, world frame. By default a central difference.
    fn angular_velocity(&self, t_ps: u64) -> DVec3 {
        let before = t_ps.saturating_sub(HALF_STEP_PS);
        let after = t_ps.saturating_add(HALF_STEP_PS);
        let turn = rotation::difference(self.pose(before).orientation, self.pose(after).orientation);
        turn / span_s(before, after)
    }
}

/// What points to a motion is that motion.
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
