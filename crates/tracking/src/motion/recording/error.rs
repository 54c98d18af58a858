use thiserror::Error;

use super::{FARTHEST_M, FASTEST, LATEST_S};

/// The reason why a recorded head motion cannot be replayed. Line numbers count from 1, and times are in seconds.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The recording contains no samples.
    #[error("expected at least one sample, found none")]
    Empty,
    /// The text cannot be read: input or output failed, or the text is not UTF-8.
    #[error("cannot read the recording: {why}")]
    Unreadable {
        /// Message of the reader, including its position.
        why: String,
    },
    /// The columns of the file cannot be recognized and no mapping was given.
    #[error(
        "line {line}: expected the columns time_s,x,y,z,qw,qx,qy,qz, a EuRoC file (#timestamp [ns],p_RS_R_x [m],...), a TUM \
         file (eight numbers separated by spaces), a pose log (predicted_display_time,position_x,...,orientation_w as CSV or JSON lines) or a \
         mapping of columns, found {found}"
    )]
    Format {
        /// Line number of the first line with content, counted from 1.
        line: u64,
        /// Text of the line, as it was read.
        found: String,
    },
    /// The header of a pose log lacks required columns.
    #[error("line {line}: expected all columns of a pose log, found {found} without {missing}")]
    PoseLog {
        /// Line number of the error in the file, counted from 1.
        line: u64,
        /// Required columns that the header lacks, separated by commas.
        missing: String,
        /// Columns that the header contains, separated by commas.
        found: String,
    },
    /// A line of a file with one JSON object per line cannot be parsed.
    #[error("line {line}: expected an object of JSON, found {found}")]
    Json {
        /// Line number of the error in the file, counted from 1.
        line: u64,
        /// Message of the JSON parser, or a description of the missing columns.
        found: String,
    },
    /// A column that the user's mapping names does not exist in the file.
    #[error("line {line}: expected a column `{expected}` for {field}, found {found}")]
    Column {
        /// Line number of the header, counted from 1.
        line: u64,
        /// Name of the quantity that is mapped to the missing column.
        field: String,
        /// Name or number of the missing column.
        expected: String,
        /// Columns that the header contains, separated by commas.
        found: String,
    },
    /// The user's mapping of quantities to columns is incomplete, has a quantity twice, or has an unknown quantity.
    #[error("columns: expected {expected}, found {found}")]
    Mapping {
        /// Description of a complete mapping.
        expected: &'static str,
        /// The mapping that the user gave, or the erroneous part of it.
        found: String,
    },
    /// A line has too few or too many fields.
    #[error("line {line}: expected {expected} fields, found {found}")]
    Fields {
        /// Line number of the error in the file, counted from 1.
        line: u64,
        /// Number of fields that the line must have.
        expected: usize,
        /// Number of fields that the line has.
        found: usize,
    },
    /// A field is not a finite number.
    #[error("line {line}, {column}: expected a finite number, found {found:?}")]
    NotANumber {
        /// Line number of the error in the file, counted from 1.
        line: u64,
        /// Name of the column with the error, as the header has it.
        column: String,
        /// Text of the field, as it was read.
        found: String,
    },
    /// A time stamp is negative or beyond 10^7 s.
    #[error("line {line}, {column}: expected 0 to {LATEST_S} s, found {found_s} s")]
    TimeOutOfRange {
        /// Line number of the error in the file, counted from 1.
        line: u64,
        /// Name of the column with the error, as the header has it.
        column: String,
        /// Time stamp of this line, s. In most formats the time counts from the first line of the file, and then this
        /// is the time since the first line.
        found_s: f64,
    },
    /// A time stamp is earlier than the time stamp of the line before.
    #[error("line {line}, {column}: expected {previous_s} s or more, the time of the line before, found {found_s} s")]
    NotRising {
        /// Line number of the error in the file, counted from 1.
        line: u64,
        /// Name of the column with the error, as the header has it.
        column: String,
        /// Time stamp of the line before, s.
        previous_s: f64,
        /// Time stamp of this line, s.
        found_s: f64,
    },
    /// The length of a quaternion differs from 1 by more than the tolerance.
    #[error("line {line}, {columns}: expected a quaternion of length 1, found {found}")]
    NotUnit {
        /// Line number of the error in the file, counted from 1.
        line: u64,
        /// Names of the quaternion's four columns, as the header has them.
        columns: String,
        /// Length of the recorded quaternion.
        found: f64,
    },
    /// A coordinate of a position exceeds the limit of 10^8 m, which is more than the size of the Earth.
    #[error("line {line}, {column}: expected -{FARTHEST_M:e} to {FARTHEST_M:e} m, found {found_m:e} m")]
    TooFar {
        /// Line number of the error in the file, counted from 1.
        line: u64,
        /// Name of the column with the error, as the header has it.
        column: String,
        /// The coordinate that is out of range, m.
        found_m: f64,
    },
    /// The head moves or turns between two samples faster than the limit of 10^6 m/s or 10^6 rad/s.
    #[error(
        "line {line}: expected at most {FASTEST:e} m/s and {FASTEST:e} rad/s from the line before, found {found:e} {unit}"
    )]
    TooFast {
        /// Line number of the error in the file, counted from 1.
        line: u64,
        /// Speed of the head since the previous sample, in `unit`.
        found: f64,
        /// Unit of the speed: m/s or rad/s.
        unit: &'static str,
    },
}
