use crate::config as table;
use crate::pose::Pose;
use crate::time::span_s;
use crate::tracker::TrackerReport;

/// How far the squared length of a reported quaternion may be from 1.
const LENGTH_TOLERANCE: f64 = 1e-3;

/// What became of the reports that a predictor was given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReportCounts {
    /// Believed, and given to the filters.
    pub accepted: u64,
    /// Rejected: NaN, infinite, or not a unit quaternion.
    pub malformed: u64,
    /// Rejected: not newer than the report before, or nearer to it than 50 us.
    pub untimely: u64,
    /// Rejected: faster than a head moves.
    pub jumps: u64,
    /// Starts afresh: the first report, the first after a gap of 250 ms, and the one that confirmed a jump.
    pub restarts: u64,
}

/// What to do with a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    Reject,
    Update,
    Restart,
}

/// Decides which reports can be true. It keeps no secrets: every decision is counted.
#[derive(Clone, Debug)]
pub(super) struct Gate {
    limits: table::Gate,
    last: Option<TrackerReport>,
    jumps_in_a_row: u64,
    pub(super) counts: ReportCounts,
}

impl Gate {
    pub(super) fn new(limits: table::Gate) -> Self {
        Self { limits, last: None, jumps_in_a_row: 0, counts: ReportCounts::default() }
    }

    pub(super) fn judge(&mut self, report: &TrackerReport) -> Verdict {
        let verdict = self.verdict(report);
        if verdict != Verdict::Reject {
            self.last = Some(*report);
            self.jumps_in_a_row = 0;
            self.counts.accepted += 1;
            self.counts.restarts += u64::from(verdict == Verdict::Restart);
        }
        verdict
    }

    fn verdict(&mut self, report: &TrackerReport) -> Verdict {
        if !is_well_formed(&report.pose) {
            self.counts.malformed += 1;
            return Verdict::Reject;
        }
        let Some(last) = self.last else { return Verdict::Restart };
        let dt_s = span_s(last.measured_ps, report.measured_ps)
            .min(span_s(last.position_measured_ps, report.position_measured_ps));
        if dt_s < self.limits.interval / 1e3 {
            self.counts.untimely += 1;
            return Verdict::Reject;
        }
        if dt_s > self.limits.gap / 1e3 {
            return Verdict::Restart;
        }
        if self.is_possible(&last.pose, &report.pose, dt_s) { Verdict::Update } else { self.jump() }
    }

    fn jump(&mut self) -> Verdict {
        self.jumps_in_a_row += 1;
        if self.jumps_in_a_row > self.limits.patience {
            return Verdict::Restart;
        }
        self.counts.jumps += 1;
        Verdict::Reject
    }

    fn is_possible(&self, from: &Pose, to: &Pose, dt_s: f64) -> bool {
        from.distance_m(to) <= self.limits.distance / 1e3 + self.limits.speed * dt_s
            && from.angle_deg(to) <= self.limits.angle + self.limits.turn * dt_s
    }
}

fn is_well_formed(pose: &Pose) -> bool {
    pose.is_finite() && (pose.orientation.length_squared() - 1.0).abs() < LENGTH_TOLERANCE
}
