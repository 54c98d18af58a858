use glam::{DQuat, DVec3};

use super::Predictor;
use super::channel::Channel;
use super::gate::{Gate, ReportCounts, Verdict};
use crate::config as table;
use crate::pose::Pose;
use crate::time::span_s;
use crate::tracker::TrackerReport;

/// A predictor with one filter for position and one filter for orientation. A check rejects impossible reports before
/// the reports reach the filters.
#[derive(Clone, Debug)]
pub(super) struct GatedFilterPair<P, O> {
    gate: Gate,
    position: P,
    orientation: O,
    /// Time stamps (ps) of the newest position and orientation, or `None` before the first report.
    newest_ps: Option<(u64, u64)>,
    horizon_s: f64,
}

impl<P, O> GatedFilterPair<P, O> {
    pub(super) fn new(position: P, orientation: O, horizon_s: f64, limits: table::Gate) -> Self {
        Self { gate: Gate::new(limits), position, orientation, newest_ps: None, horizon_s }
    }

    /// Returns the time for which a filter extrapolates, in seconds. The time is negative if `at_ps` is before the newest
    /// measurement. If the absolute time is longer than the horizon, the result is 0, because the newest estimate is
    /// then the best.
    fn ahead(&self, newest_ps: u64, at_ps: u64) -> f64 {
        let dt_s = span_s(newest_ps, at_ps);
        if dt_s.abs() <= self.horizon_s { dt_s } else { 0.0 }
    }
}

impl<P: Channel<DVec3>, O: Channel<DQuat>> Predictor for GatedFilterPair<P, O> {
    fn observe(&mut self, report: &TrackerReport) {
        let stamps = (report.position_measured_ps, report.measured_ps);
        // The gate accepts quaternions of nearly unit length.
        let orientation = report.pose.orientation.normalize();
        match self.gate.check(report) {
            Verdict::Reject => return,
            Verdict::Restart => {
                self.position.restart(stamps.0, report.pose.position);
                self.orientation.restart(stamps.1, orientation);
            }
            Verdict::Update => {
                self.position.update(stamps.0, report.pose.position);
                self.orientation.update(stamps.1, orientation);
            }
        }
        self.newest_ps = Some(stamps);
    }

    fn predict(&self, at_ps: u64) -> Pose {
        let Some((position_ps, orientation_ps)) = self.newest_ps else { return Pose::IDENTITY };
        Pose {
            position: self.position.extrapolate(self.ahead(position_ps, at_ps)),
            orientation: self.orientation.extrapolate(self.ahead(orientation_ps, at_ps)),
        }
    }

    fn counts(&self) -> ReportCounts {
        self.gate.counts
    }
}
