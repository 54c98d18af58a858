use std::io::Read;

use glam::{DQuat, DVec3};
use thiserror::Error;

use super::Motion;
use crate::identity::{Settings, write_pose};
use crate::pose::Pose;
use crate::rotation;
use crate::time::{nearest_ps, span_s};

/// Columns of a recorded trace, in this order: seconds, metres, unit quaternion (head to world, real part first).
const COLUMNS: [&str; 8] = ["time_s", "x", "y", "z", "qw", "qx", "qy", "qz"];

/// Latest time stamp of a recording: 10^7 s (115 days), safely below the end of simulated time.
const LATEST_S: f64 = 1e7;

/// How far the length of a recorded quaternion may be from 1; four printed decimals stay well within it.
const LENGTH_TOLERANCE: f64 = 1e-2;

/// Time stamp (ps) and pose.
type Sample = (u64, Pose);

/// A recorded trace, replayed: straight lines between positions, slerp between orientations. Before the first sample
/// and after the last the head stands still.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    samples: Vec<Sample>,
}

impl Recording {
    /// Reads CSV with the header `time_s,x,y,z,qw,qx,qy,qz`. Times must rise strictly.
    pub fn from_csv(input: impl Read) -> Result<Self, LoadError> {
        let mut reader =
            csv::ReaderBuilder::new().has_headers(false).flexible(true).trim(csv::Trim::All).from_reader(input);
        let mut records = reader.records();
        let header = records.next().ok_or(LoadError::Empty)?.map_err(unreadable)?;
        check_header(&header)?;
        let mut samples: Vec<Sample> = Vec::new();
        for record in records {
            let record = record.map_err(unreadable)?;
            let sample = parse_sample(&record)?;
            if let Some(&(previous_ps, _)) = samples.last().filter(|(t_ps, _)| *t_ps >= sample.0) {
                return Err(LoadError::NotRising { line: line_number(&record), previous_ps, found_ps: sample.0 });
            }
            samples.push(sample);
        }
        if samples.is_empty() { Err(LoadError::Empty) } else { Ok(Self { samples }) }
    }

    /// Time stamps of the first and the last sample.
    pub fn span_ps(&self) -> (u64, u64) {
        (self.samples[0].0, self.samples[self.samples.len() - 1].0)
    }

    /// Number of samples, at least 1.
    pub fn n_samples(&self) -> usize {
        self.samples.len()
    }

    /// The samples about `t_ps`; `None` outside of the recording.
    fn bracket(&self, t_ps: u64) -> Option<(&Sample, &Sample)> {
        let after = self.samples.partition_point(|(t, _)| *t <= t_ps);
        Some((self.samples.get(after.checked_sub(1)?)?, self.samples.get(after)?))
    }
}

impl Motion for Recording {
    fn pose(&self, t_ps: u64) -> Pose {
        match self.bracket(t_ps) {
            Some((a, b)) => a.1.interpolate(&b.1, span_s(a.0, t_ps) / span_s(a.0, b.0)),
            None if t_ps < self.samples[0].0 => self.samples[0].1,
            None => self.samples[self.samples.len() - 1].1,
        }
    }
    fn identify(&self, settings: &mut Settings) {
        settings("motion", &"recording");
        for (t_ps, pose) in &self.samples {
            settings("motion.at_ps", t_ps);
            write_pose(settings, "motion.pose", pose);
        }
    }
    fn velocity(&self, t_ps: u64) -> DVec3 {
        self.bracket(t_ps).map_or(DVec3::ZERO, |(a, b)| (b.1.position - a.1.position) / span_s(a.0, b.0))
    }
    fn angular_velocity(&self, t_ps: u64) -> DVec3 {
        self.bracket(t_ps)
            .map_or(DVec3::ZERO, |(a, b)| rotation::difference(a.1.orientation, b.1.orientation) / span_s(a.0, b.0))
    }
}

/// Why a recording cannot be replayed. Lines count from 1, the header's.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The recording holds no samples.
    #[error("expected at least one sample, found none")]
    Empty,
    /// The text cannot be read: input/output failed, or it is not UTF-8.
    #[error("cannot read the recording: {why}")]
    Unreadable {
        /// What the reader said, with its place.
        why: String,
    },
    /// The first line does not name the columns.
    #[error("line 1: expected {}, found {found}", COLUMNS.join(","))]
    Header {
        /// The first line, as it was read.
        found: String,
    },
    /// A line has not 8 fields.
    #[error("line {line}: expected 8 fields, found {found}")]
    Fields {
        /// Number of the line, from 1.
        line: u64,
        /// How many fields it has.
        found: usize,
    },
    /// A field is not a finite number.
    #[error("line {line}, {column}: expected a finite number, found {found:?}")]
    NotANumber {
        /// Number of the line, from 1.
        line: u64,
        /// Name of the column, as in the header.
        column: &'static str,
        /// Text of the field, as it was read.
        found: String,
    },
    /// A time stamp is negative or beyond 10^7 s.
    #[error("line {line}, time_s: expected 0 to {LATEST_S}, found {found_s}")]
    TimeOutOfRange {
        /// Number of the line, from 1.
        line: u64,
        /// Time stamp of this line, s.
        found_s: f64,
    },
    /// Time stamps do not rise.
    #[error("line {line}, time_s: expected more than {previous_ps} ps, found {found_ps} ps")]
    NotRising {
        /// Number of the line, from 1.
        line: u64,
        /// Time stamp of the line before, ps.
        previous_ps: u64,
        /// Time stamp of this line, ps.
        found_ps: u64,
    },
    /// The length of a quaternion is not 1.
    #[error("line {line}: expected a quaternion of length 1, found {found}")]
    NotUnit {
        /// Number of the line, from 1.
        line: u64,
        /// Length of its quaternion.
        found: f64,
    },
}

fn unreadable(error: csv::Error) -> LoadError {
    LoadError::Unreadable { why: error.to_string() }
}

fn line_number(record: &csv::StringRecord) -> u64 {
    record.position().map_or(0, csv::Position::line)
}

fn check_header(header: &csv::StringRecord) -> Result<(), LoadError> {
    if header.iter().eq(COLUMNS) {
        return Ok(());
    }
    Err(LoadError::Header { found: header.iter().collect::<Vec<_>>().join(",") })
}

fn parse_sample(record: &csv::StringRecord) -> Result<Sample, LoadError> {
    if record.len() != COLUMNS.len() {
        return Err(LoadError::Fields { line: line_number(record), found: record.len() });
    }
    let mut fields = [0.0; COLUMNS.len()];
    for (i, field) in fields.iter_mut().enumerate() {
        *field = parse_number(record, i)?;
    }
    let [time, x, y, z, qw, qx, qy, qz] = fields;
    if !(0.0..=LATEST_S).contains(&time) {
        return Err(LoadError::TimeOutOfRange { line: line_number(record), found_s: time });
    }
    let orientation = unit_quaternion(DQuat::from_xyzw(qx, qy, qz, qw), line_number(record))?;
    Ok((nearest_ps(time), Pose { position: DVec3::new(x, y, z), orientation }))
}

fn parse_number(record: &csv::StringRecord, i: usize) -> Result<f64, LoadError> {
    record[i].parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| LoadError::NotANumber {
        line: line_number(record),
        column: COLUMNS[i],
        found: record[i].to_owned(),
    })
}

fn unit_quaternion(q: DQuat, line: u64) -> Result<DQuat, LoadError> {
    let found = q.length();
    if (found - 1.0).abs() <= LENGTH_TOLERANCE { Ok(q.normalize()) } else { Err(LoadError::NotUnit { line, found }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::PS_PER_S;

    const HEADER: &str = "time_s,x,y,z,qw,qx,qy,qz\n";

    fn load(rows: &str) -> Result<Recording, LoadError> {
        Recording::from_csv(format!("{HEADER}{rows}").as_bytes())
    }

    #[test]
    fn half_way_between_two_samples_lie_half_the_way_and_half_the_turn() {
        let recording = load("1,0,0,0,1,0,0,0\n2, 2,0,0, 0.70710678,0,0.70710678,0\n").unwrap();
        let pose = recording.pose(PS_PER_S * 3 / 2);
        assert!((pose.position - DVec3::X).length() < 1e-12);
        assert!(pose.angle_deg(&Pose::facing(rotation::about_y(45f64.to_radians()))) < 1e-6);
        assert!((recording.angular_velocity(PS_PER_S * 3 / 2).y - 90f64.to_radians()).abs() < 1e-6);
        assert_eq!(recording.velocity(PS_PER_S), DVec3::X * 2.0);
    }

    #[test]
    fn outside_of_the_recording_the_head_stands_still() {
        let recording = load("1,5,0,0,1,0,0,0\n2,6,0,0,1,0,0,0\n").unwrap();
        assert_eq!(recording.pose(0).position.x, 5.0);
        assert_eq!(recording.pose(3 * PS_PER_S).position.x, 6.0);
        assert_eq!(recording.velocity(3 * PS_PER_S), DVec3::ZERO);
    }

    #[test]
    fn a_sign_change_of_the_quaternion_is_no_motion() {
        let recording = load("0,0,0,0,1,0,0,0\n1,0,0,0,-1,0,0,0\n").unwrap();
        assert!(recording.pose(PS_PER_S / 2).angle_deg(&Pose::IDENTITY) < 1e-12);
    }

    #[test]
    fn bad_rows_are_named_by_their_line() {
        let good = "0,0,0,0,1,0,0,0\n";
        let cases = [
            ("1,0,0,NaN,1,0,0,0\n", "line 3, z: expected a finite number, found \"NaN\""),
            ("1,0,0,0,inf,0,0,0\n", "line 3, qw: expected a finite number, found \"inf\""),
            ("1,0,0,zero,1,0,0,0\n", "line 3, z: expected a finite number, found \"zero\""),
            ("1,0,0,0,1,0,0\n", "line 3: expected 8 fields, found 7"),
            ("1,0,0,0,1,0,0,0,9\n", "line 3: expected 8 fields, found 9"),
            ("0,0,0,0,1,0,0,0\n", "line 3, time_s: expected more than 0 ps, found 0 ps"),
            ("-1,0,0,0,1,0,0,0\n", "line 3, time_s: expected 0 to 10000000, found -1"),
            ("1e9,0,0,0,1,0,0,0\n", "line 3, time_s: expected 0 to 10000000, found 1000000000"),
            ("1,0,0,0,0,0,0,0\n", "line 3: expected a quaternion of length 1, found 0"),
        ];
        for (row, message) in cases {
            assert_eq!(load(&format!("{good}{row}")).unwrap_err().to_string(), message);
        }
    }

    #[test]
    fn an_unsorted_recording_is_an_error() {
        let error = load("2,0,0,0,1,0,0,0\n1,0,0,0,1,0,0,0\n").unwrap_err();
        assert!(matches!(error, LoadError::NotRising { line: 3, .. }));
    }

    #[test]
    fn an_empty_recording_is_an_error() {
        assert_eq!(Recording::from_csv(&b""[..]), Err(LoadError::Empty));
        assert_eq!(load(""), Err(LoadError::Empty));
    }

    #[test]
    fn other_columns_are_an_error() {
        let error = Recording::from_csv(&b"t,x,y,z\n0,0,0,0\n"[..]).unwrap_err();
        assert_eq!(error.to_string(), "line 1: expected time_s,x,y,z,qw,qx,qy,qz, found t,x,y,z");
    }

    #[test]
    fn bytes_that_are_not_text_are_an_error() {
        assert!(matches!(Recording::from_csv(&b"\xff\xfe"[..]), Err(LoadError::Unreadable { .. })));
    }
}
