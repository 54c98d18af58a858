mod axes;
mod columns;
mod decimal;
mod error;
mod read;
#[cfg(test)]
mod tests;

pub use axes::Axes;
pub use columns::Columns;
pub use error::RecordingError;

use std::io::Read;

use glam::DVec3;

use super::Motion;
use crate::identity::{SettingSink, write_pose};
use crate::pose::Pose;
use crate::rotation;
use crate::time::span_s;

/// Latest time stamp of a recording: 10^7 s (115 days), safely below the end of simulated time.
const LATEST_S: f64 = 1e7;

/// Farthest coordinate of a recording, m. Assumed: 1e6 to 1e12; the coordinates of maps, which count from the equator, reach 1e7,
/// and squares of this are far from the end of single precision.
const FARTHEST_M: f64 = 1e8;

/// Fastest movement between two samples, m/s, and fastest turn, rad/s. Assumed: 1e3 to 1e9; no head moves so, but where a tracker
/// loses its place and finds it again a recording jumps within a millisecond.
const FASTEST: f64 = 1e6;

/// Time stamp (ps) and pose.
type Sample = (u64, Pose);

/// What is behind the last sample of a recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum End {
    /// Nothing: a run that goes on after it is refused.
    #[default]
    Refuse,
    /// The head stands still.
    Hold,
    /// The recording begins again; unless it ends where it began, the head jumps.
    Loop,
}

impl End {
    /// All of them, by the names under which experiments know them.
    pub const NAMES: [(&'static str, Self); 3] = [("error", Self::Refuse), ("hold", Self::Hold), ("loop", Self::Loop)];

    /// Its name in experiment files and on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, end)| *end == self).map_or("", |(name, _)| name)
    }
}

/// How the file of a recording is to be read, where it is not to be told by its contents.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordingFormat {
    /// Which column holds what; empty for a file that says so itself.
    pub columns: Columns,
    /// What its axes mean; `None` for what is usual for the kind of file.
    pub axes: Option<Axes>,
}

/// A recorded trace, replayed: straight lines between positions, slerp between orientations. Before the first sample
/// the head stands still; [`End`] says what comes after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    samples: Vec<Sample>,
    end: End,
}

impl Recording {
    /// Reads a file of poses; times must rise strictly. What it is, is told by its contents:
    ///
    /// | file | first line | time | quaternion | axes |
    /// |---|---|---|---|---|
    /// | own | `time_s,x,y,z,qw,qx,qy,qz` | seconds, as they are | real part first | [`Axes::OpenGl`] |
    /// | EuRoC | `#timestamp [ns],p_RS_R_x [m],...,q_RS_w [],...` and any more columns | nanoseconds, from the first line | real part first | [`Axes::Euroc`] |
    /// | TUM | eight numbers apart by spaces, behind comments (`#`) | seconds, from the first line | real part last | [`Axes::Optical`] |
    ///
    /// Positions are in metres, and quaternions turn the head's axes into the world's.
    ///
    /// # Errors
    ///
    /// [`RecordingError`] names line and column, what was expected and what was found.
    pub fn read(input: impl Read) -> Result<Self, RecordingError> {
        Self::read_as(input, &RecordingFormat::default())
    }

    /// The same, with columns and axes that are said. With columns the file may have any others beside them, parted by commas,
    /// semicolons, tabs or blanks, and time counts from its first line.
    ///
    /// # Errors
    ///
    /// As [`Self::read`].
    pub fn read_as(mut input: impl Read, format: &RecordingFormat) -> Result<Self, RecordingError> {
        let mut bytes = Vec::new();
        let unreadable = |error: std::io::Error| RecordingError::Unreadable { why: error.to_string() };
        input.read_to_end(&mut bytes).map_err(unreadable)?;
        let text = parameters::text_of(&bytes).map_err(|why| RecordingError::Unreadable { why })?;
        Ok(Self { samples: read::samples(text, &format.columns, format.axes)?, end: End::default() })
    }

    /// The same recording with another end.
    #[must_use]
    pub fn ending(self, end: End) -> Self {
        Self { end, ..self }
    }

    /// Time stamps of the first and the last sample.
    pub fn span_ps(&self) -> (u64, u64) {
        (self.samples[0].0, self.samples[self.samples.len() - 1].0)
    }

    /// Number of samples, at least 1.
    pub fn n_samples(&self) -> usize {
        self.samples.len()
    }

    /// Goes on with the samples of another one, all of which are later.
    pub(super) fn append(&mut self, more: &Self) {
        self.samples.extend_from_slice(&more.samples);
    }

    /// Where in the recording an instant is.
    fn within(&self, t_ps: u64) -> u64 {
        let (first_ps, last_ps) = self.span_ps();
        match self.end {
            End::Loop if t_ps > last_ps && last_ps > first_ps => first_ps + (t_ps - first_ps) % (last_ps - first_ps),
            _ => t_ps,
        }
    }

    /// The samples about `t_ps`; `None` outside of the recording.
    fn bracket(&self, t_ps: u64) -> Option<(&Sample, &Sample)> {
        let after = self.samples.partition_point(|(t, _)| *t <= t_ps);
        Some((self.samples.get(after.checked_sub(1)?)?, self.samples.get(after)?))
    }
}

impl Motion for Recording {
    fn pose(&self, t_ps: u64) -> Pose {
        let t_ps = self.within(t_ps);
        match self.bracket(t_ps) {
            Some((a, b)) => a.1.interpolate(&b.1, span_s(a.0, t_ps) / span_s(a.0, b.0)),
            None if t_ps < self.samples[0].0 => self.samples[0].1,
            None => self.samples[self.samples.len() - 1].1,
        }
    }
    fn identify(&self, settings: &mut SettingSink) {
        settings("motion", &"recording");
        settings("motion.end", &self.end.name());
        for (t_ps, pose) in &self.samples {
            settings("motion.at_ps", t_ps);
            write_pose(settings, "motion.pose", pose);
        }
    }
    fn ends_ps(&self) -> Option<u64> {
        (self.end == End::Refuse).then_some(self.span_ps().1)
    }
    fn moves_until_ps(&self) -> Option<u64> {
        (self.end != End::Loop).then_some(self.span_ps().1)
    }
    fn velocity(&self, t_ps: u64) -> DVec3 {
        let between = self.bracket(self.within(t_ps));
        between.map_or(DVec3::ZERO, |(a, b)| (b.1.position - a.1.position) / span_s(a.0, b.0))
    }
    fn angular_velocity(&self, t_ps: u64) -> DVec3 {
        self.bracket(self.within(t_ps))
            .map_or(DVec3::ZERO, |(a, b)| rotation::difference(a.1.orientation, b.1.orientation) / span_s(a.0, b.0))
    }
}
