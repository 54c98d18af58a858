use crate::pose::Pose;

/// What the host gets of one solution of the tracker: a pose with its times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackerReport {
    /// Number of the solution; a step of more than one tells of dropped solutions.
    pub solution: u64,
    /// When the orientation was true, ps.
    pub measured_ps: u64,
    /// When the position was true, ps: as `measured_ps`, except that the Flock's is older.
    pub position_measured_ps: u64,
    /// When the host sees the report, ps.
    pub arrives_ps: u64,
    /// The pose, wrong as trackers are.
    pub pose: Pose,
}
