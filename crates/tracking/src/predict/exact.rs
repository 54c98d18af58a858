use glam::DQuat;

use super::Predictor;
use super::gate::{Gate, ReportCounts, Verdict};
use crate::config as table;
use crate::motion::Motion;
use crate::pose::Pose;
use crate::tracker::TrackerReport;

/// A predictor that has access to the true motion. The predictor moves the newest reported pose along the true motion
/// and keeps the error of the report.
///
/// No real machine has access to the true motion. The predictor is a reference for all real predictors: the errors of
/// its poses come only from the tracker, not from the prediction.
#[derive(Clone, Debug)]
pub struct ExactPredictor<M> {
    motion: M,
    gate: Gate,
    newest: Option<TrackerReport>,
}

impl<M: Motion> ExactPredictor<M> {
    /// Creates a predictor for the true motion `motion`. `gate` has the limits by which reports are accepted or
    /// rejected.
    pub fn new(motion: M, gate: table::Gate) -> Self {
        Self { motion, gate: Gate::new(gate), newest: None }
    }
}

impl<M: Motion + Send> Predictor for ExactPredictor<M> {
    fn observe(&mut self, report: &TrackerReport) {
        if self.gate.check(report) != Verdict::Reject {
            self.newest = Some(*report);
        }
    }

    fn predict(&self, at_ps: u64) -> Pose {
        let Some(report) = &self.newest else { return Pose::IDENTITY };
        let moved = self.motion.pose(at_ps);
        let place = self.motion.pose(report.position_measured_ps).position;
        let attitude = self.motion.pose(report.measured_ps).orientation;
        // The errors of the report stay constant along the true motion.
        let wrong: DQuat = report.pose.orientation * attitude.conjugate();
        Pose {
            position: moved.position + (report.pose.position - place),
            orientation: (wrong * moved.orientation).normalize(),
        }
    }

    fn counts(&self) -> ReportCounts {
        self.gate.counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Pan, Pendulum};
    use crate::tracker::{TrackerConfig, TrackerModel};

    #[test]
    fn without_noise_the_prediction_is_exact() {
        let motion = Pendulum::rig();
        let tracker = TrackerModel::new(TrackerConfig::flock_of_birds().without_noise()).unwrap();
        let mut exact = ExactPredictor::new(&motion, table::Gate::PAPERS);
        for report in tracker.reports(&motion, 1).take(40) {
            exact.observe(&report);
            let later = report.measured_ps + 200_000_000_000;
            let predicted = exact.predict(later);
            let truth = motion.pose(later);
            assert!(predicted.distance_m(&truth) < 1e-12 && predicted.angle_deg(&truth) < 1e-6);
        }
    }

    #[test]
    fn the_error_is_the_error_of_the_report_at_any_interval() {
        let motion = Pan::at(200.0);
        let tracker = TrackerModel::new(TrackerConfig::optical_ceiling()).unwrap();
        let mut exact = ExactPredictor::new(&motion, table::Gate::PAPERS);
        for report in tracker.reports(&motion, 1).take(40) {
            exact.observe(&report);
            let of_report = report.pose.angle_deg(&motion.pose(report.measured_ps));
            let later = report.measured_ps + 300_000_000_000;
            assert!((exact.predict(later).angle_deg(&motion.pose(later)) - of_report).abs() < 1e-6);
        }
    }
}
