//! A head motion that receives new samples while a run goes on.

use super::{End, Motion, Recording};
use crate::identity::SettingSink;
use crate::pose::Pose;
use glam::DVec3;
use pxpl5_sim::parameters::SettingError;
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard};

/// A recorded head motion to which samples can be added during a run. Clones share the same recording.
///
/// After the last sample the head stands still until more samples arrive. Samples must be added before the simulation
/// needs them: every instant that the simulation reads must lie between two samples. Otherwise a sample added later
/// would change a pose that the simulation has already used.
#[derive(Clone, Debug)]
pub struct GrowingRecording(Arc<RwLock<Recording>>);

impl GrowingRecording {
    /// Creates a growing motion that starts with the samples of `begin`.
    pub fn new(begin: Recording) -> Self {
        Self(Arc::new(RwLock::new(begin.ending(End::Hold))))
    }

    /// Appends the samples of another recording.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] unless the first new sample is later than the last existing sample. Nothing is
    /// appended in this case.
    pub fn extend(&self, more: &Recording) -> Result<(), SettingError> {
        let mut recording = self.0.write().unwrap_or_else(PoisonError::into_inner);
        let (last_ps, found_ps) = (recording.span_ps().1, more.span_ps().0);
        if found_ps <= last_ps {
            let found = format_args!("one at {found_ps} ps");
            return Err(SettingError::value("", format_args!("samples after {last_ps} ps"), found));
        }
        recording.append(more);
        Ok(())
    }

    /// Returns a copy of the samples received so far.
    pub fn recorded(&self) -> Recording {
        self.recording().clone()
    }

    fn recording(&self) -> RwLockReadGuard<'_, Recording> {
        self.0.read().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Motion for GrowingRecording {
    fn pose(&self, t_ps: u64) -> Pose {
        self.recording().pose(t_ps)
    }
    fn identify(&self, settings: &mut SettingSink) {
        settings("motion", &"growing");
        self.recording().identify(settings);
    }
    fn grows(&self) -> bool {
        true
    }
    fn velocity(&self, t_ps: u64) -> DVec3 {
        self.recording().velocity(t_ps)
    }
    fn angular_velocity(&self, t_ps: u64) -> DVec3 {
        self.recording().angular_velocity(t_ps)
    }
}
