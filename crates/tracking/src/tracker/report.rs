use crate::pose::Pose;

/// A report that the host receives from the tracker: a measured pose with its time stamps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackerReport {
    /// Index of the measurement (called a solution). If the index grows by more than 1 between two reports,
    /// measurements were dropped.
    pub solution: u64,
    /// Instant at which the measured orientation was true, ps.
    pub measured_ps: u64,
    /// Instant at which the measured position was true, ps. The instant differs from `measured_ps` only for the Flock
    /// of Birds, whose position is older than its orientation.
    pub position_measured_ps: u64,
    /// Instant at which the host receives the report, ps.
    pub arrives_ps: u64,
    /// Measured pose, which includes the tracker's errors.
    pub pose: Pose,
}
