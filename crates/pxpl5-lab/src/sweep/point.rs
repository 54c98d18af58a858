//! One point of a sweep.

use super::Sweep;
use super::header::json;
use crate::experiment_file::{FileError, Plan};
use pxpl5_scene::Scene;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// Whether a point could be simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It could be simulated; `measured` holds what came of it.
    Done,
    /// It could not; `error` says why.
    Failed,
}

/// What came of a point; the same on every host.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Number of the point, from 0, in the order of the space.
    pub point: u64,
    /// Whether it could be simulated.
    pub status: Status,
    /// The settings of the point that are not those of all, by key.
    pub parameters: BTreeMap<String, Value>,
    /// Quantities by name; null where the run shows none.
    pub measured: BTreeMap<String, Option<f64>>,
    /// Name of everything on which the trace depends; null for an experiment that could not be made.
    pub config_hash: Option<String>,
    /// Hash of everything that happened; null at a level without events.
    pub trace_hash: Option<String>,
    /// Why it could not be simulated.
    pub error: Option<String>,
}

impl Sweep {
    /// The experiment at a point.
    ///
    /// # Errors
    ///
    /// [`FileError`] when its settings make no experiment.
    pub fn plan(&self, point: u64) -> Result<Plan, FileError> {
        let mut file = self.base.clone();
        for (path, value) in self.space.settings(point) {
            file.put(&path, value, format!("point {point}"), &self.folder())?;
        }
        file.resolve()
    }

    /// The scene of a point's plan, loaded once for all points that share it.
    ///
    /// # Errors
    ///
    /// As [`crate::experiment_file::SceneChoice::load`].
    pub fn scene(&self, plan: &Plan) -> Result<Arc<Scene>, FileError> {
        self.scenes.scene_of(plan)
    }

    /// Simulates a point; what is wrong with it, even a panic, becomes its row.
    pub(super) fn row(&self, point: u64) -> SweepRow {
        let result = catch_unwind(AssertUnwindSafe(|| self.simulate(point)));
        let result = result.unwrap_or_else(|panic| Err(format!("a bug of the emulator: {}", panic_text(&*panic))));
        let parameters = self.space.settings(point).iter().map(|(path, value)| (path.clone(), json(value))).collect();
        let empty = SweepRow {
            point,
            status: Status::Failed,
            parameters,
            measured: BTreeMap::new(),
            config_hash: None,
            trace_hash: None,
            error: None,
        };
        match result {
            Ok(simulated) => SweepRow {
                status: Status::Done,
                measured: simulated.measured,
                config_hash: Some(simulated.config_hash),
                trace_hash: simulated.trace_hash,
                ..empty
            },
            Err(error) => SweepRow { error: Some(error), ..empty },
        }
    }

    fn simulate(&self, point: u64) -> Result<Simulated, String> {
        let plan = self.plan(point).map_err(|error| error.to_string())?;
        let scene = self.scenes.scene_of(&plan).map_err(|error| error.to_string())?;
        let config_hash = plan.experiment(scene.clone()).config_hash().to_string();
        // Nobody looks at the pictures of a sweep, and pixels change no time.
        let results = plan.run(scene).map_err(|error| error.to_string())?;
        let measured = plan.measure.iter().map(|m| (m.name().to_owned(), m.of(&results))).collect();
        let trace_hash = results.run.map(|(_, report)| report.trace_hash);
        Ok(Simulated { measured, config_hash, trace_hash })
    }
}

struct Simulated {
    measured: BTreeMap<String, Option<f64>>,
    config_hash: String,
    trace_hash: Option<String>,
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason given")
}
