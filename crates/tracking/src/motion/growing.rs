//! A head that somebody moves while a run goes on.

use super::{End, Motion, Recording};
use crate::identity::SettingSink;
use crate::pose::Pose;
use glam::DVec3;
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard};
use thiserror::Error;

/// A recording that grows: what is known of a motion so far. Clones are the same motion.
///
/// Behind its last sample it stands still until more come. Whoever simulates with it keeps it ahead: an instant that has been asked for
/// must lie between two samples, or the answer was not that of the recording which it becomes.
#[derive(Clone, Debug)]
pub struct Growing(Arc<RwLock<Recording>>);

/// Samples that do not go on where the motion has come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("expected samples after {last_ps} ps, found one at {found_ps} ps")]
pub struct GrowthError {
    /// The last sample so far.
    pub last_ps: u64,
    /// The first one of those that were to follow.
    pub found_ps: u64,
}

impl Growing {
    /// Begins as a recording does.
    #[must_use]
    pub fn new(begin: Recording) -> Self {
        Self(Arc::new(RwLock::new(begin.ending(End::Hold))))
    }

    /// Goes on with the samples of another recording.
    ///
    /// # Errors
    ///
    /// [`GrowthError`] unless its first sample is later than the last one so far; nothing is added then.
    pub fn extend(&self, more: &Recording) -> Result<(), GrowthError> {
        let mut known = self.0.write().unwrap_or_else(PoisonError::into_inner);
        let (last_ps, found_ps) = (known.span_ps().1, more.span_ps().0);
        if found_ps <= last_ps {
            return Err(GrowthError { last_ps, found_ps });
        }
        known.append(more);
        Ok(())
    }

    /// What is known of it so far.
    #[must_use]
    pub fn recorded(&self) -> Recording {
        self.known().clone()
    }

    fn known(&self) -> RwLockReadGuard<'_, Recording> {
        self.0.read().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Motion for Growing {
    fn pose(&self, t_ps: u64) -> Pose {
        self.known().pose(t_ps)
    }
    fn identify(&self, settings: &mut SettingSink) {
        settings("motion", &"growing");
        self.known().identify(settings);
    }
    fn grows(&self) -> bool {
        true
    }
    fn velocity(&self, t_ps: u64) -> DVec3 {
        self.known().velocity(t_ps)
    }
    fn angular_velocity(&self, t_ps: u64) -> DVec3 {
        self.known().angular_velocity(t_ps)
    }
}
