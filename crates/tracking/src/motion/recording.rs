mod axes;
mod columns;
mod decimal;
mod pose_log;
mod read;
#[cfg(test)]
mod tests;

pub use axes::Axes;
pub use columns::Columns;

use pxpl5_sim::parameters::{FileError, FileErrorKind};
use std::io::Read;

use glam::DVec3;

use super::Motion;
use crate::identity::{SettingSink, write_pose};
use crate::pose::Pose;
use crate::rotation;
use crate::time::span_s;

/// Latest time stamp of a recording in seconds: 10^7 s (115 days). Simulated time ends after 213 days.
const LATEST_S: f64 = 1e7;

/// Greatest absolute coordinate in a recording, m. The value is assumed, with a range of 1e6 to 1e12. Map coordinates,
/// which count from the equator, reach 1e7. The square of this limit still fits into single precision.
const FARTHEST_M: f64 = 1e8;

/// Fastest movement (m/s) and fastest turn (rad/s) between two samples. The value is assumed, with a range of 1e3 to
/// 1e9. A head never moves so fast. The limit is high because a recorded position can jump within a millisecond, after
/// the tracker has lost and found the head.
const FASTEST: f64 = 1e6;

/// Least length of a gap, as a multiple of the median time between two samples. Assumed, 3 to 20. A gap must also be
/// longer than `GAP_S`.
const GAP_TIMES: u64 = 5;
/// Least length of a gap, seconds. Assumed, 0.1 to 1. At 200 degrees per second a head turns by 40 degrees in 0.2 s,
/// which no interpolation can reconstruct.
const GAP_S: f64 = 0.2;

/// Greatest number of samples that can be far apart in time without a warning, because such a recording may be a list
/// of a few poses. Assumed.
const FEW_SAMPLES: usize = 10;

type Sample = (u64, Pose);

/// The behaviour of the replayed head after the last sample of a recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum End {
    /// A run that would continue after the last sample is an error.
    #[default]
    Refuse,
    /// The head stands still after the last sample, and also during gaps.
    Hold,
    /// The recording starts again from its first sample. The head jumps unless the first and the last pose are equal.
    Loop,
}

impl End {
    /// Every behaviour at the end of a recording, with its name in experiment files.
    pub const NAMES: [(&'static str, Self); 3] = [("error", Self::Refuse), ("hold", Self::Hold), ("loop", Self::Loop)];

    /// Returns the name of this behaviour in experiment files and on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, end)| *end == self).map_or("", |(name, _)| name)
    }
}

pxpl5_sim::parameters::named!(End, "end of a recording", End::NAMES);

/// The parts of a recorded file's format that cannot be recognized from the contents of the file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordingFormat {
    /// Mapping from quantities to columns. The mapping is empty for a file whose format is recognized from its header
    /// or first line.
    pub columns: Columns,
    /// Convention for the coordinate axes of the file. `None` selects the usual convention of the file's format.
    pub axes: Option<Axes>,
    /// Treatment of lines in which the head moves faster than a head can.
    pub jumps: Jumps,
}

/// The treatment of lines in which the head moves faster than 8 m/s or turns faster than 2,000 degrees per second.
/// Trackers write such lines when they lose the head.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Jumps {
    /// All lines are used. [`Motion::warnings`] reports the lines.
    #[default]
    Keep,
    /// The lines are left out, together with lines whose quaternion is zero and with lines that repeat such a pose.
    LeaveOut,
}

impl Jumps {
    /// Both treatments with their names in experiment files.
    pub const NAMES: [(&'static str, Self); 2] = [("keep", Self::Keep), ("leave-out", Self::LeaveOut)];

    /// Returns the name of this treatment in experiment files.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, jumps)| *jumps == self).map_or("", |(name, _)| name)
    }
}

pxpl5_sim::parameters::named!(Jumps, "treatment of jumps", Jumps::NAMES);

/// A replayed recording of head poses.
///
/// Positions are interpolated linearly, and orientations by slerp. Before the first sample the head stands still.
/// [`End`] defines the behaviour after the last sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    samples: Vec<Sample>,
    end: End,
    /// Gaps in the order of time. A gap is stored as the times (ps) of the last sample before the gap and of the first
    /// sample after the gap.
    gaps: Vec<(u64, u64)>,
    warnings: Vec<String>,
}

impl Recording {
    /// Recordings of real heads that come with the library, by name, with what they show. Their origin and terms are in
    /// `data/README.md` of this crate.
    pub const SHIPPED: [(&'static str, &'static str); 2] = [
        ("vive-tracked", "a user of an HTC Vive walks and looks around, 29 s"),
        ("vive-dev", "the same headset on a standing user, 9 s"),
    ];

    /// Returns the file of a recording in [`Self::SHIPPED`], or `None` for another name.
    pub fn shipped(name: &str) -> Option<&'static [u8]> {
        match name {
            "vive-tracked" => Some(include_bytes!("../../data/vive-tracked.csv")),
            "vive-dev" => Some(include_bytes!("../../data/vive-dev.csv")),
            _ => None,
        }
    }

    /// Reads a file of poses with ascending time stamps. If several samples have the same time stamp, only the first is
    /// kept, and [`Motion::warnings`] reports this. The contents of the file determine its format:
    ///
    /// | file | first line | time | quaternion | axes |
    /// |---|---|---|---|---|
    /// | own | `time_s,x,y,z,qw,qx,qy,qz` in any order | seconds, unchanged | by name | [`Axes::OpenGl`] |
    /// | EuRoC | `#timestamp [ns],p_RS_R_x [m],...,q_RS_w [],...` and any more columns | nanoseconds, from the first line | real part first | [`Axes::Euroc`] |
    /// | TUM | eight numbers separated by spaces, after comments (`#`) or the names `timestamp tx ty tz qx qy qz qw` | seconds, from the first line | real part last | [`Axes::Optical`] |
    /// | pose log | a header with `predicted_display_time`, `position_x`, ..., `orientation_w` in any order, or a line of JSON with these names | nanoseconds unless the name ends in `_us`, `_ms` or `_s`, from the first line | by name | [`Axes::OpenGl`], as in OpenXR |
    ///
    /// Names of columns may be written in any case, with any separator and among other columns. Positions are in metres
    /// unless the name ends in `_mm` or `_cm`. Quaternions rotate the head's axes into the world's axes.
    ///
    /// # Errors
    ///
    /// [`FileError`] names the line, the column, the expected content and the found content.
    pub fn read(input: impl Read) -> Result<Self, FileError> {
        Self::read_as(input, &RecordingFormat::default())
    }

    /// Reads a file of poses with the columns and axes of `format`. If [`RecordingFormat::columns`] is not empty, the
    /// file may have other columns too, and time counts from the first line. Commas, semicolons, tabs or blanks
    /// separate the columns.
    ///
    /// # Errors
    ///
    /// The same as [`Self::read`].
    pub fn read_as(mut input: impl Read, format: &RecordingFormat) -> Result<Self, FileError> {
        let mut bytes = Vec::new();
        let unreadable = |why: String| {
            FileError::new(FileErrorKind::Unreadable, "", format_args!("cannot read the recording: {why}"))
        };
        input.read_to_end(&mut bytes).map_err(|error| unreadable(error.to_string()))?;
        if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
            return Err(unreadable("expected UTF-8 text, found text in units of 16 bits".to_owned()));
        }
        // UTF-16 was rejected above. Comments may have any encoding, so invalid UTF-8 is replaced.
        let text = String::from_utf8_lossy(&bytes);
        read::samples(&text, format).map(Self::of_samples)
    }

    /// Creates a recording from samples: ascending times in seconds, each with the pose at this time.
    ///
    /// The axes follow [`Axes::OpenGl`]. Times are rounded to picoseconds. Times and positions have the same
    /// limits as in a file. If several samples have the same time, only the first is kept.
    ///
    /// ```
    /// use glam::DVec3;
    /// use tracking::Pose;
    /// use tracking::motion::{Motion, Recording};
    ///
    /// let walk = [0.0, 1.0, 2.0].map(|s| (s, Pose { position: DVec3::X * s, ..Pose::IDENTITY }));
    /// let walk = Recording::from_samples(walk)?;
    /// assert_eq!(walk.pose(1_500_000_000_000).position.x, 1.5);
    /// # Ok::<(), pxpl5_sim::parameters::FileError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns [`FileError`] with the expected and the found value. The number of a line is the number of the sample,
    /// counted from 1.
    pub fn from_samples(samples: impl IntoIterator<Item = (f64, Pose)>) -> Result<Self, FileError> {
        read::given_samples(samples).map(Self::of_samples)
    }

    fn of_samples(samples: read::Samples) -> Self {
        let read::Samples { samples, mut warnings } = samples;
        let usual_ps = usual_ps(&samples);
        let gaps = gaps(&samples, usual_ps);
        warnings.extend(gap_warning(&gaps));
        if samples.len() > FEW_SAMPLES && span_s(0, usual_ps) > GAP_S {
            let seconds = span_s(0, usual_ps);
            warnings.push(format!("poses are {seconds} s apart, longer than a gap: is the unit of time right?"));
        }
        Self { samples, end: End::default(), gaps, warnings }
    }

    fn holds_between(&self, (before_ps, _): &Sample) -> bool {
        self.end == End::Hold && self.gaps.binary_search_by_key(before_ps, |(from_ps, _)| *from_ps).is_ok()
    }

    /// Returns the same recording with the behaviour `end` after its last sample.
    #[must_use]
    pub fn ending(self, end: End) -> Self {
        Self { end, ..self }
    }

    /// Returns the time stamps (ps) of the first and the last sample.
    pub fn span_ps(&self) -> (u64, u64) {
        (self.samples[0].0, self.samples[self.samples.len() - 1].0)
    }

    /// Returns the number of samples, at least 1.
    pub fn n_samples(&self) -> usize {
        self.samples.len()
    }

    /// Appends samples, all of which must be later than the last sample of this recording.
    pub(super) fn append(&mut self, more: &Self) {
        self.samples.extend_from_slice(&more.samples);
    }

    /// Returns the time at which the samples are read for the time `t_ps`. The two times differ only after the end of a
    /// recording that loops.
    fn within(&self, t_ps: u64) -> u64 {
        let (first_ps, last_ps) = self.span_ps();
        match self.end {
            End::Loop if t_ps > last_ps && last_ps > first_ps => first_ps + (t_ps - first_ps) % (last_ps - first_ps),
            _ => t_ps,
        }
    }

    /// Returns the two samples before and after the time `t_ps`, or `None` for a time outside the recording.
    fn bracket(&self, t_ps: u64) -> Option<(&Sample, &Sample)> {
        let after = self.samples.partition_point(|(t, _)| *t <= t_ps);
        Some((self.samples.get(after.checked_sub(1)?)?, self.samples.get(after)?))
    }
}

impl Motion for Recording {
    fn pose(&self, t_ps: u64) -> Pose {
        let t_ps = self.within(t_ps);
        match self.bracket(t_ps) {
            Some((a, _)) if self.holds_between(a) => a.1,
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
    fn gap_ps(&self, until_ps: u64) -> Option<(u64, u64)> {
        let first = self.gaps.first().copied().filter(|(from_ps, _)| *from_ps < until_ps);
        first.filter(|_| self.end != End::Hold)
    }
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }
    fn moves_until_ps(&self) -> Option<u64> {
        (self.end != End::Loop).then_some(self.span_ps().1)
    }
    fn velocity(&self, t_ps: u64) -> DVec3 {
        let between = self.bracket(self.within(t_ps)).filter(|(a, _)| !self.holds_between(a));
        between.map_or(DVec3::ZERO, |(a, b)| (b.1.position - a.1.position) / span_s(a.0, b.0))
    }
    fn angular_velocity(&self, t_ps: u64) -> DVec3 {
        self.bracket(self.within(t_ps))
            .filter(|(a, _)| !self.holds_between(a))
            .map_or(DVec3::ZERO, |(a, b)| rotation::difference(a.1.orientation, b.1.orientation) / span_s(a.0, b.0))
    }
}

/// Returns the median time between two samples, in picoseconds. It is 0 for a single sample.
fn usual_ps(samples: &[Sample]) -> u64 {
    let mut lengths: Vec<u64> = samples.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    let middle = lengths.len() / 2;
    if lengths.is_empty() { 0 } else { *lengths.select_nth_unstable(middle).1 }
}

/// Returns the gaps of a recording. A gap lies between successive samples that are much farther apart in time than
/// `usual_ps`. The time before the first sample can be a gap, too.
fn gaps(samples: &[Sample], usual_ps: u64) -> Vec<(u64, u64)> {
    let is_gap = |(from_ps, to_ps): &(u64, u64)| {
        to_ps - from_ps > usual_ps.saturating_mul(GAP_TIMES) && span_s(*from_ps, *to_ps) > GAP_S
    };
    let first = samples.first().map(|(first_ps, _)| (0, *first_ps));
    first.into_iter().chain(samples.windows(2).map(|pair| (pair[0].0, pair[1].0))).filter(is_gap).collect()
}

const GAPS_LISTED: usize = 3;

fn gap_warning(gaps: &[(u64, u64)]) -> Option<String> {
    if gaps.is_empty() {
        return None;
    }
    let one =
        |&(from_ps, to_ps): &(u64, u64)| format!("{:.3} s from {:.3} s on", span_s(from_ps, to_ps), span_s(0, from_ps));
    let listed: Vec<String> = gaps.iter().take(GAPS_LISTED).map(one).collect();
    let more = match gaps.len().saturating_sub(GAPS_LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    Some(format!("no pose for {}{more}", listed.join(", ")))
}
