//! Simulates one point of a sweep. Each point of a sweep is one experiment.

use super::header::json;
use super::{Shard, Sweep, SweepSpace, is_run, measures};
use crate::StudyError;
use crate::estimate::Estimate;
use crate::experiment_file::Plan;
use crate::limit::LimitQuery;
use crate::study::Study;
use pxpl5_measure::Measure;
use pxpl5_run::BareHost;
use pxpl5_scene::Scene;
use pxpl5_sim::StopFlag;
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// Status of a point of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// The point was simulated. The results are in [`SweepRow::measured`].
    Done,
    /// The point could not be simulated. The reason is in [`SweepRow::error`].
    Failed,
}

/// Results of a point of a sweep. The results are identical on every computer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Index of the point in the parameter space, counted from 0.
    pub point: u64,
    /// Result status of the point: simulated or failed.
    pub status: Status,
    /// Settings that vary in the sweep, with their values at this point, by key.
    pub parameters: BTreeMap<String, Value>,
    /// Measured quantities by name. Null if the run does not define the quantity.
    pub measured: BTreeMap<String, Option<f64>>,
    /// Hash of all settings that the simulated events depend on. Null if the experiment is invalid.
    pub config_hash: Option<String>,
    /// Hash over the trace of all events. Null at the analytic level, which has no events.
    pub trace_hash: Option<String>,
    /// Level of detail that `level = "auto"` chose for the point, with the reason.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<String>,
    /// Reason why the point could not be simulated.
    pub error: Option<String>,
}

impl fmt::Display for SweepRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parameters = self.parameters.iter().map(|(key, value)| format!("{key}={value}"));
        let result = self.error.as_deref().unwrap_or("simulated");
        write!(f, "point {}, {}: {result}", self.point, parameters.collect::<Vec<_>>().join(" "))
    }
}

impl Sweep {
    /// Checks the settings of a point and returns its experiment.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the settings of the point are invalid.
    pub fn plan(&self, point: u64) -> Result<Plan, SettingError> {
        let mut file = self.base.clone();
        for (path, value) in self.space.settings(point) {
            file.put(&path, value, format!("point {point}"), &self.folder())?;
        }
        file.resolve()
    }

    /// Returns the scene of a point's experiment. Each scene is loaded once for all its points.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`crate::experiment_file::SceneChoice::load`].
    pub fn scene(&self, plan: &Plan) -> Result<Arc<Scene>, SettingError> {
        self.scenes.load(&plan.scene)
    }
}

/// Results of a simulated point.
#[derive(Clone, Debug, PartialEq)]
pub struct PointResults {
    /// Measured quantities by name, as in [`SweepRow::measured`].
    pub measured: BTreeMap<String, Option<f64>>,
    /// Hash of all settings that the results depend on.
    pub config_hash: String,
    /// Hash of the simulated events or of the drawn volume, if there is one.
    pub trace_hash: Option<String>,
    /// Chosen level of detail with the reason, as in [`SweepRow::level`].
    pub level: Option<String>,
}

/// An experiment with settings that vary in a parameter space.
pub trait Swept: Sync {
    /// Returns the parameter space. Each of its points is an experiment.
    fn space(&self) -> &SweepSpace;

    /// Simulates a point. The simulation may end early when another thread sets `stop`.
    ///
    /// # Errors
    ///
    /// Returns the error of a point that cannot be simulated.
    fn simulate(&self, point: u64, stop: &StopFlag) -> Result<PointResults, StudyError>;

    /// Estimates the memory and time of the points of a shard on `threads` threads.
    fn estimate(&self, shard: Shard, threads: usize) -> Estimate;
}

impl Swept for Sweep {
    fn space(&self) -> &SweepSpace {
        &self.space
    }

    fn estimate(&self, shard: Shard, threads: usize) -> Estimate {
        let sample = self.sample();
        let points = shard.share_of(self.space.points()) as f64;
        let threads = threads.max(1) as f64;
        Estimate { bytes: sample.most_bytes * threads, seconds: sample.mean_s * points / threads }
    }

    fn simulate(&self, point: u64, stop: &StopFlag) -> Result<PointResults, StudyError> {
        let plan = self.plan(point)?;
        let scene = self.scene(&plan)?;
        let needs_events = plan.measure.iter().any(Measure::needs_events);
        let (experiment, choice) = plan.with_chosen_level(scene, needs_events);
        // The hash identifies the point even if its run fails later.
        let config_hash = experiment.config_hash().to_string();
        // No pixels are computed, because a sweep keeps no pictures and pixels do not change simulated times. A point
        // whose only quantity is the result of a search needs no run of its own.
        let is_run = is_run(&plan);
        let results =
            is_run.then(|| plan.results_of(experiment.host(BareHost).stopped_by(stop.clone()))).transpose()?;
        let value = |m: &Measure| -> Result<Option<f64>, StudyError> {
            if m.name() != Measure::TRIANGLES {
                return Ok(results.as_ref().and_then(|results| m.of(results)));
            }
            let limit = LimitQuery::of_scene(&plan)?.run(&mut stop.clone())?;
            Ok(limit.has_limit().then_some(f64::from(limit.triangles)))
        };
        let level = choice.filter(|_| is_run).map(|choice| choice.to_string());
        let named = |m: Measure| Ok((m.name().to_owned(), value(&m)?));
        let measured = measures(&plan).into_iter().map(named).collect::<Result<_, StudyError>>()?;
        let trace_hash = results.and_then(|results| results.run).map(|(_, report)| report.trace_hash);
        Ok(PointResults { measured, config_hash, trace_hash, level })
    }
}

/// Simulates a point and returns its row. An error, even a panic, is stored in the row, so that the sweep continues
/// with all remaining points.
pub(super) fn row(sweep: &impl Swept, point: u64, stop: &StopFlag) -> SweepRow {
    let results = match catch_unwind(AssertUnwindSafe(|| sweep.simulate(point, stop))) {
        Ok(results) => results.map_err(|error| error.to_string()),
        Err(panic) => Err(format!("a bug of the emulator: {}", panic_text(&*panic))),
    };
    let parameters = sweep.space().settings(point).iter().map(|(path, value)| (path.clone(), json(value))).collect();
    // A failed row has the parameters and the error only.
    let empty = SweepRow {
        point,
        status: Status::Failed,
        parameters,
        measured: BTreeMap::new(),
        config_hash: None,
        trace_hash: None,
        level: None,
        error: None,
    };
    match results {
        Ok(PointResults { measured, config_hash, trace_hash, level }) => {
            SweepRow { status: Status::Done, measured, config_hash: Some(config_hash), trace_hash, level, ..empty }
        }
        Err(error) => SweepRow { error: Some(error), ..empty },
    }
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason given")
}
