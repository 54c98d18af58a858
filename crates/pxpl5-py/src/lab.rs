//! Functions that evaluate many experiments: published figures, limits and comparisons.

use crate::attended::attended;
use crate::catalogue::python;
use crate::errors::{failed_run, wrong_setting};
use crate::settings::Settings;
use pxpl5::compare::CompareQuery;
use pxpl5::figures::{Bench, FIGURES, FigureRow, run_all_with};
use pxpl5::limit::{Limit, LimitQuery, Model};
use pxpl5::{Goal, Level, TestScene};
use pyo3::prelude::*;
use serde_json::json;

/// Returns the level of modelling called `name`, or raises an exception for an unknown name.
fn level(name: &str) -> PyResult<Level> {
    let names = Level::ALL.map(Level::name).join(", ");
    let found = Level::ALL.into_iter().find(|level| level.name() == name);
    found.ok_or_else(|| wrong_setting(format!("level: expected {names}, found {name}")))
}

/// Returns the identifiers of the published figures, such as 4b, each with the statement of its paper.
#[pyfunction]
pub(crate) fn figure_ids() -> Vec<(&'static str, &'static str)> {
    FIGURES.iter().map(|figure| (figure.id, figure.statement)).collect()
}

/// Measures a published figure at a level of modelling. ``id`` is the figure's identifier, such as 4b. Returns a
/// dictionary with published, simulated, unit and more.
///
/// Raises :class:`pxpl5.SettingError` for an unknown identifier, and :class:`pxpl5.RunError` if the experiment fails.
#[pyfunction]
#[pyo3(signature = (id, level = "transaction", progress = None))]
pub(crate) fn figure<'py>(
    py: Python<'py>,
    id: &str,
    level: &str,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let level = self::level(level)?;
    let Some(figure) = FIGURES.iter().find(|figure| figure.id == id) else {
        let ids: Vec<&str> = FIGURES.iter().map(|figure| figure.id).collect();
        return Err(wrong_setting(format!("there is no figure {id}; expected one of {}", ids.join(", "))));
    };
    let measured =
        attended(py, progress, false, move |_| Bench::new(level).measure(figure.id).map_err(|e| e.to_string()))?;
    let measured = measured.map_err(|error| failed_run(format!("figure {id}: {error}")))?;
    python(py, &row(&FigureRow::new(figure, measured)))
}

fn row(row: &FigureRow) -> serde_json::Value {
    let mut value = serde_json::to_value(row).unwrap_or_default();
    if let Some(object) = value.as_object_mut() {
        object.insert("misses".to_owned(), row.misses().into());
        let [low, high] = row.interval.map_or([None, None], |[low, high]| [Some(low), Some(high)]);
        object.insert("low".to_owned(), low.into());
        object.insert("high".to_owned(), high.into());
    }
    value
}

/// Measures all published figures and the intervals of their values. This takes minutes. Returns a list with a
/// dictionary for each figure.
///
/// Raises :class:`pxpl5.RunError` if an experiment fails.
#[pyfunction]
#[pyo3(signature = (level = "transaction", progress = None))]
pub(crate) fn figures<'py>(
    py: Python<'py>,
    level: &str,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let level = self::level(level)?;
    let figures =
        attended(py, progress, false, move |told| run_all_with(&Bench::new(level), |done, of| told.tell(done, of)))?;
    let rows: Vec<serde_json::Value> = figures.map_err(failed_run)?.rows.iter().map(row).collect();
    python(py, &rows)
}

/// Runs all pipelines with the same settings and compares them. Returns a dictionary whose `pipelines` has one row for
/// each pipeline.
///
/// Raises :class:`pxpl5.SettingError` for an invalid setting.
#[pyfunction]
#[pyo3(signature = (settings, only, seeds, limits, progress = None))]
pub(crate) fn compare<'py>(
    py: Python<'py>,
    settings: &Settings,
    only: Vec<String>,
    seeds: Vec<u64>,
    limits: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut query = CompareQuery {
        shared: settings.file.clone(),
        only,
        seeds,
        limits,
        pictures: false,
        confidence: pxpl5::compare::CONFIDENCE,
        until: None,
    };
    query.set_length().map_err(wrong_setting)?;
    let comparison = attended(py, progress, false, move |told| query.run(|done, of| told.tell(done, of)))?;
    python(py, &comparison.map_err(wrong_setting)?)
}

/// Finds the largest number of triangles that a pipeline draws in time. Returns a dictionary with triangles,
/// first_miss, island, unbroken_from, tried, goal, fields and scene.
///
/// ``test_scene`` is full-screen, typical or None. If ``thinned`` is true, triangles of the settings' own scene are
/// removed instead of using a test scene. ``rate_hz`` or ``latency_fields`` replaces the pipeline's own goal.
/// ``fields`` is the length of each run.
///
/// Raises :class:`pxpl5.SettingError` for an invalid setting.
#[pyfunction]
#[pyo3(signature = (settings, *, test_scene = None, thinned = false, rate_hz = None, latency_fields = None, fields = None))]
pub(crate) fn limit<'py>(
    py: Python<'py>,
    settings: &Settings,
    test_scene: Option<&str>,
    thinned: bool,
    rate_hz: Option<f64>,
    latency_fields: Option<f64>,
    fields: Option<u64>,
) -> PyResult<Bound<'py, PyAny>> {
    let plan = settings.plan()?;
    let mut query = LimitQuery::of_plan(&plan);
    query.criterion.fields = fields.unwrap_or(query.criterion.fields);
    // A goal in the arguments replaces the goal of the pipeline.
    let own = query.criterion.goal;
    query.criterion.goal = rate_hz.map(Goal::RateHz).or(latency_fields.map(Goal::LatencyFields)).unwrap_or(own);
    if let Some(name) = test_scene {
        let found = TestScene::ALL.into_iter().find(|scene| scene.name() == name);
        let expected = TestScene::ALL.map(TestScene::name).join(" or ");
        query.criterion.scene =
            found.ok_or_else(|| wrong_setting(format!("scene: expected {expected}, found {name}")))?;
    }
    // With `thinned`, a reduced version of the settings' scene replaces the test scene.
    if thinned {
        query.model = Some(py.detach(|| Model::load(plan.scene)).map_err(wrong_setting)?);
    }
    let drawn =
        query.model.as_ref().map_or(query.criterion.scene.name().to_owned(), |model| model.whole.name().to_owned());
    let criterion = query.criterion;
    let found = attended(py, None, false, move |_| query.search().map_err(|error| error.to_string()))?;
    let Limit { triangles, first_miss, island, unbroken_from, tried } = found.map_err(wrong_setting)?;
    python(
        py,
        &json!({
            "triangles": triangles,
            "first_miss": first_miss,
            "island": island,
            "unbroken_from": unbroken_from,
            "tried": tried,
            "goal": criterion.goal,
            "fields": criterion.fields,
            "scene": drawn,
        }),
    )
}
