//! One run of a compared pipeline with one seed.

use super::compared::ComparedPipeline;
use super::gallery::LastPicture;
use crate::edges::near_edges;
use crate::experiment_file::{ExperimentFile, Plan};
use pxpl5_measure::{Budget, ErrorCauses, Measured, PixelErrors, Showing, tracking_and_rendering_ms};
use pxpl5_run::{Coverage, DryRun, DuePictures, Experiment, Head, Outcome, ResultWindow, WARM_UP_PERIODS};
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::{PeriodNumber, ViewNumber};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Results of one run in a comparison. A row combines the runs of all seeds.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    pub(super) latency_ms: Vec<f64>,
    pub(super) head_to_light_ms: Vec<f64>,
    pub(super) turn_to_light_ms: Vec<f64>,
    pub(super) tracking_and_rendering_ms: Option<f64>,
    pub(super) prediction_interval_ms: Vec<f64>,
    pub(super) budget: Budget,
    pub(super) errors: PixelErrors,
    pub(super) causes: Option<ErrorCauses>,
    /// Wrong prediction intervals: milliseconds later, and mean error in pixels.
    pub(super) prediction_interval_errors: Vec<(i64, f64)>,
    pub(super) updates_hz: Option<f64>,
    pub(super) due: Option<DuePictures>,
    pub(super) window: Option<ResultWindow>,
    /// Number of complete pictures in the evaluated part of the run.
    pub(super) shown: usize,
    pub(super) late_regions: usize,
    /// Warnings about results near an edge ([`near_edges`]).
    pub(super) near_edges: Vec<String>,
    pub(super) host_seconds: Option<f64>,
    pub(super) dry_run: Option<Arc<DryRun>>,
    /// Last picture of the run. `None` if the run computed no pixels or showed no picture.
    pub(super) picture: Option<LastPicture>,
}

impl ComparedPipeline {
    /// Returns the checked settings of one run, from the shared settings, the settings of this row, and a seed.
    pub(super) fn plan(&self, shared: &ExperimentFile, seed: u64) -> Result<Plan, SettingError> {
        let mut file = shared.clone();
        file.set("pipeline", self.pipeline, "compare")?;
        // A row with a raster of its own ignores the numbers of another device.
        let has_raster = self.settings.iter().any(|(key, _)| *key == "head.raster");
        file.settings.retain(|key, _| !(has_raster && key.starts_with("head.reprojection.")));
        for (key, value) in self.settings {
            file.set(key, *value, "compare")?;
        }
        file.resolve_for(seed)
    }

    /// Runs one experiment of the row. If `causes` is true, the error is split by its causes.
    pub(super) fn trial(&self, experiment: Experiment, causes: bool) -> Result<Trial, String> {
        let from = common_window_from(experiment.fields);
        let outcome =
            experiment.results_from(from).after_dry_run().and_then(|it| it.run()).map_err(|error| error.to_string())?;
        Ok(Trial::of(&outcome, self.showing, causes))
    }
}

/// Returns the earliest evaluated display period of runs with `fields` fields. This period comes after a quarter of the
/// run and after the shortest warm-up.
///
/// Most rows are thus evaluated over the same periods. A pipeline with a longer warm-up is evaluated from a later
/// period.
pub(super) fn common_window_from(fields: u64) -> PeriodNumber {
    PeriodNumber(WARM_UP_PERIODS.max(fields / 4))
}

impl Trial {
    fn of(outcome: &Outcome, showing: Showing, causes: bool) -> Self {
        let report = outcome.report();
        let showing = with_raster(showing, outcome.head().map(|views| views.head()));
        // The reference has errors but no times.
        let is_timed = showing != Showing::Ideal;
        let times = |values: Vec<f64>| if is_timed { values } else { Vec::new() };
        let errors = PixelErrors::shown(outcome, showing);
        Self {
            latency_ms: times(latencies_ms(outcome)),
            head_to_light_ms: times(Budget::totals_ms(outcome)),
            turn_to_light_ms: times(turns_ms(outcome)),
            tracking_and_rendering_ms: tracking_and_rendering_ms(outcome).filter(|_| is_timed),
            prediction_interval_ms: times(prediction_intervals_ms(outcome)),
            budget: Budget::of(outcome),
            causes: if causes { ErrorCauses::of(outcome, showing, &errors) } else { None },
            prediction_interval_errors: if causes { prediction_interval_errors(outcome, showing) } else { Vec::new() },
            errors,
            updates_hz: report.updates_hz.filter(|_| is_timed),
            due: report.due.filter(|_| is_timed),
            window: report.window,
            shown: report.pictures,
            late_regions: report.late_regions,
            near_edges: if is_timed { near_edges(outcome) } else { Vec::new() },
            host_seconds: outcome.host_seconds(),
            dry_run: outcome.experiment().dry_run.clone(),
            picture: LastPicture::of(outcome, report.ends_complete).filter(|_| is_timed),
        }
    }
}

/// Returns the way in which a row shows its pictures: with the raster of the settings, unless the row has its own way.
pub(super) fn with_raster(showing: Showing, head: Option<&Head>) -> Showing {
    head.filter(|_| showing == Showing::Plain).map_or(showing, |head| head.raster.into())
}

/// Errors of the prediction interval whose effect is evaluated, in milliseconds.
const INTERVAL_ERRORS_MS: [i64; 4] = [-20, -10, 10, 20];

fn prediction_interval_errors(outcome: &Outcome, showing: Showing) -> Vec<(i64, f64)> {
    // The reference has no pictures and so no interval.
    let later_ms = INTERVAL_ERRORS_MS.into_iter().filter(|_| showing != Showing::Ideal);
    later_ms
        .map(|later_ms| (later_ms, PixelErrors::with_prediction_interval_error(outcome, showing, later_ms).pixels.mean))
        .collect()
}

fn latencies_ms(outcome: &Outcome) -> Vec<f64> {
    outcome.complete_pictures().map(|times| (times.shown_at - times.transform_at).as_ms()).collect()
}

/// Returns the times from the measurement of an orientation until its picture is displayed, in milliseconds. Cube faces
/// get the newest orientation at scan-out. All other pictures have the orientation of the pose for which they were
/// drawn.
fn turns_ms(outcome: &Outcome) -> Vec<f64> {
    if outcome.pipeline().properties().coverage == Coverage::View {
        return Budget::totals_ms(outcome);
    }
    outcome.rotation_latencies().iter().map(|turn| turn.total().as_ms()).collect()
}

/// Returns the prediction intervals in milliseconds. Each interval begins at the newest measurement before the
/// prediction of a head pose. The interval ends at the instant for which the picture with this pose is drawn.
fn prediction_intervals_ms(outcome: &Outcome) -> Vec<f64> {
    let Some(head) = outcome.head() else { return Vec::new() };
    // Only views whose pictures were shown completely count.
    let views: BTreeSet<ViewNumber> = outcome.complete_pictures().map(|times| times.view).collect();
    let sampled = head.sampled().into_iter().filter(|sampled| views.contains(&sampled.number));
    sampled
        .filter_map(|sampled| Some(sampled.objects_at.0 as f64 - sampled.measured_at?.0 as f64))
        .map(|ps| ps * 1e-9)
        .collect()
}
