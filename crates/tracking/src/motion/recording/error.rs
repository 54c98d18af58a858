use thiserror::Error;

use super::{FARTHEST_M, FASTEST, LATEST_S};

/// Why a recording cannot be replayed. Lines count from 1; times are in seconds.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The recording holds no samples.
    #[error("expected at least one sample, found none")]
    Empty,
    /// The text cannot be read: input/output failed, or it is not UTF-8.
    #[error("cannot read the recording: {why}")]
    Unreadable {
        /// What the reader said, with its place.
        why: String,
    },
    /// Nothing says which columns the file has.
    #[error(
        "line {line}: expected the columns time_s,x,y,z,qw,qx,qy,qz, a EuRoC file (#timestamp [ns],p_RS_R_x [m],...), a TUM \
         file (eight numbers apart by spaces) or a mapping of columns, found {found}"
    )]
    Format {
        /// Number of the line, from 1.
        line: u64,
        /// The line, as it was read.
        found: String,
    },
    /// A mapped column is not in the file.
    #[error("line {line}: expected a column `{expected}` for {field}, found {found}")]
    Column {
        /// Number of the header's line, from 1.
        line: u64,
        /// What was to be read from it.
        field: String,
        /// Name or number of the column that was asked for.
        expected: String,
        /// The columns that there are.
        found: String,
    },
    /// A mapping leaves something out, says it twice, or does not know it.
    #[error("columns: expected {expected}, found {found}")]
    Mapping {
        /// What a mapping consists of.
        expected: &'static str,
        /// What was given.
        found: String,
    },
    /// A line has too few fields, or too many.
    #[error("line {line}: expected {expected} fields, found {found}")]
    Fields {
        /// Number of the line, from 1.
        line: u64,
        /// How many fields it should have.
        expected: usize,
        /// How many fields it has.
        found: usize,
    },
    /// A field is not a finite number.
    #[error("line {line}, {column}: expected a finite number, found {found:?}")]
    NotANumber {
        /// Number of the line, from 1.
        line: u64,
        /// Name of the column, as in the header.
        column: String,
        /// Text of the field, as it was read.
        found: String,
    },
    /// A time stamp is negative or beyond 10^7 s.
    #[error("line {line}, {column}: expected 0 to {LATEST_S} s, found {found_s} s")]
    TimeOutOfRange {
        /// Number of the line, from 1.
        line: u64,
        /// Name of the column, as in the header.
        column: String,
        /// Time stamp of this line, s; where a file counts from its first line, from there.
        found_s: f64,
    },
    /// A time stamp is before that of the line before.
    #[error("line {line}, {column}: expected {previous_s} s or more, the time of the line before, found {found_s} s")]
    NotRising {
        /// Number of the line, from 1.
        line: u64,
        /// Name of the column, as in the header.
        column: String,
        /// Time stamp of the line before, s.
        previous_s: f64,
        /// Time stamp of this line, s.
        found_s: f64,
    },
    /// The length of a quaternion is not 1.
    #[error("line {line}, {columns}: expected a quaternion of length 1, found {found}")]
    NotUnit {
        /// Number of the line, from 1.
        line: u64,
        /// Names of its columns, as in the header.
        columns: String,
        /// Length of its quaternion.
        found: f64,
    },
    /// A position is farther away than any place on Earth.
    #[error("line {line}, {column}: expected -{FARTHEST_M:e} to {FARTHEST_M:e} m, found {found_m:e} m")]
    TooFar {
        /// Number of the line, from 1.
        line: u64,
        /// Name of the column, as in the header.
        column: String,
        /// The coordinate, m.
        found_m: f64,
    },
    /// From one sample to the next the head moves or turns faster than anything does.
    #[error(
        "line {line}: expected at most {FASTEST:e} m/s and {FASTEST:e} rad/s from the line before, found {found:e} {unit}"
    )]
    TooFast {
        /// Number of the line, from 1.
        line: u64,
        /// The speed.
        found: f64,
        /// Its unit.
        unit: &'static str,
    },
}
