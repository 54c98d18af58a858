use crate::config as table;
use crate::pose::Pose;
use crate::time::span_s;
use crate::tracker::TrackerReport;

/// Greatest difference between 1 and the squared length of a reported quaternion. Reports outside this limit are
/// rejected.
const LENGTH_TOLERANCE: f64 = 1e-3;

/// Numbers of reports that a predictor has received: accepted reports, and rejected reports by the reason of rejection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReportCounts {
    /// Number of accepted reports, which the filters used.
    pub accepted: u64,
    /// Number of reports rejected because of NaN, infinity or a quaternion that is not of unit length.
    pub malformed: u64,
    /// Number of reports rejected because of their time stamp. The time stamp is earlier than the last accepted time
    /// stamp, or later by less than the `interval` of [`table::Gate`].
    pub untimely: u64,
    /// Number of reports that were rejected because the head would have to move or turn faster than a head can.
    pub jumps: u64,
    /// Number of accepted reports that restarted the filters. A filter restarts at the first report, at the first
    /// report after a gap, and at a report that confirms a jump of the pose.
    pub restarts: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    Reject,
    Update,
    Restart,
}

/// A check that rejects impossible reports before the reports reach the prediction filters. The check counts every
/// decision.
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

    pub(super) fn check(&mut self, report: &TrackerReport) -> Verdict {
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
        // Position and orientation have separate time stamps. The shorter of the two spans limits the possible motion.
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
