use crate::pose::Pose;

/// A report as the host receives it: a pose with its times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackerReport {
    /// Number of the measurement (called a solution). A step of more than one from report to report means that
    /// measurements were dropped.
    pub solution: u64,
    /// Instant at which the orientation was true, ps.
    pub measured_ps: u64,
    /// Instant at which the position was true, ps. This instant equals `measured_ps` except for the Flock of Birds,
    /// whose position is older.
    pub position_measured_ps: u64,
    /// Instant at which the host receives the report, ps.
    pub arrives_ps: u64,
    /// Measured pose, including the tracker's errors.
    pub pose: Pose,
}
