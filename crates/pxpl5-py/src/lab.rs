//! Functions that evaluate many experiments: published figures, limits and comparisons.

use crate::background::{in_background, study};
use crate::catalogue::python;
use crate::errors::{failed_run, failed_sweep, wrong_setting};
use crate::settings::Settings;
use pxpl5::compare::{CONFIDENCE, CompareQuery, MAX_SEEDS, Precision, RowChoice, UntilPrecise};
use pxpl5::figures::{FigureQuery, FigureRow, FigureSettings, all};
use pxpl5::interpretations::InterpretationQuery;
use pxpl5::lab::diff::DiffQuery;
use pxpl5::levels::{LevelQuery, LevelRecord};
use pxpl5::limit::{Limit, LimitQuery, OverQuery};
use pxpl5::rig::{PASSES, Rig, RigQuery};
use pxpl5::{Level, SettingError, Study, StudyError};
use pyo3::prelude::*;
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;

fn level(name: &str) -> PyResult<Level> {
    name.parse().map_err(|error: SettingError| wrong_setting(error.at("level")))
}

/// Returns the identifiers of the published figures, such as 4b, each with the statement of its paper.
#[pyfunction]
pub(crate) fn figure_ids() -> Vec<(&'static str, &'static str)> {
    all().map(|figure| (figure.id, figure.statement)).collect()
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
    let Some(figure) = all().find(|figure| figure.id == id) else {
        return Err(wrong_setting(SettingError::unknown("figure", id, all().map(|figure| figure.id))));
    };
    let query = FigureQuery { settings: FigureSettings::new(level), intervals: false, only: vec![figure] };
    let figures = study(py, progress, query)?.map_err(failed_run)?;
    python(py, &figures.rows().map(row).next())
}

fn row(row: &FigureRow) -> serde_json::Value {
    let mut value = serde_json::to_value(row).unwrap_or_default();
    if let Some(object) = value.as_object_mut() {
        object.insert("misses".to_owned(), (!row.is_met).into());
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
    let query = FigureQuery { settings: FigureSettings::new(level), intervals: true, only: Vec::new() };
    let rows: Vec<serde_json::Value> = study(py, progress, query)?.map_err(failed_run)?.rows().map(row).collect();
    python(py, &rows)
}

/// Runs several pipelines with the same settings and compares the results. Returns a dictionary whose `pipelines` has
/// one row for each pipeline. Without names in ``only``, the usual rows run, or all rows if ``all_rows`` is true.
///
/// ``confidence`` is the confidence of all intervals, between 0 and 1. With ``until_precision``, such as 10% or 0.2px,
/// a row gets up to ``max_seeds`` seeds. Finished rows are stored in ``folder``. If ``resume`` is true, the rows in the
/// folder are kept.
///
/// Raises :class:`pxpl5.SettingError` for an invalid setting, and :class:`pxpl5.SweepError` if the folder cannot be
/// used, is in use, or contains another comparison.
#[pyfunction]
#[pyo3(signature = (settings, only, seeds, *, all_rows = false, limits = false, causes = false, predictors = false, confidence = None, until_precision = None, max_seeds = None, folder = None, resume = false, progress = None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn compare<'py>(
    py: Python<'py>,
    settings: &Settings,
    only: Vec<String>,
    seeds: Vec<u64>,
    all_rows: bool,
    limits: bool,
    causes: bool,
    predictors: bool,
    confidence: Option<f64>,
    until_precision: Option<&str>,
    max_seeds: Option<usize>,
    folder: Option<PathBuf>,
    resume: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let width: Option<Precision> = until_precision
        .map(str::parse)
        .transpose()
        .map_err(|error: SettingError| wrong_setting(format!("until_precision: {error}")))?;
    let until = width.map(|width| UntilPrecise { width, max_seeds: max_seeds.unwrap_or(MAX_SEEDS) });
    let shared = settings.file.clone();
    let confidence = confidence.unwrap_or(CONFIDENCE);
    let only = if all_rows { RowChoice::All } else { only.into() };
    let mut query =
        CompareQuery { only, seeds, limits, causes, predictors, confidence, until, ..CompareQuery::new(shared) };
    query.set_length().map_err(wrong_setting)?;
    // With a folder, Ctrl-C waits until all runs have stopped, so that the comparison can be resumed at once.
    let waits = folder.is_some();
    let functions = settings.functions.clone();
    let comparison = in_background(py, progress, waits, move |watch| {
        functions.end(&watch.stop_flag());
        query.store = folder.map(|folder| query.open_store(&folder, resume)).transpose()?.map(Arc::new);
        query.run(&mut &*watch)
    });
    settings.functions.check()?;
    python(py, &comparison?.map_err(wrong_study)?)
}

fn wrong_study(error: StudyError) -> PyErr {
    match error {
        StudyError::File(_) => failed_sweep(error),
        error => wrong_setting(error),
    }
}

/// Finds the largest number of triangles that a pipeline draws in time. Returns a dictionary with triangles,
/// first_miss, island, unbroken_from, tried, goal, fields and scene. ``triangles`` is None if there is no limit.
///
/// If ``of_scene`` is true, the triangles are those of the settings' own scene instead of the pipeline's test scene.
/// ``first_miss`` is the smallest tried number that misses the goal. ``island`` is the largest tried number above
/// first_miss that reaches the goal. From ``unbroken_from`` on, all numbers up to ``triangles`` were tried. ``fields``
/// is the length of each run.
///
/// Raises :class:`pxpl5.SettingError` for an invalid setting.
#[pyfunction]
#[pyo3(signature = (settings, *, of_scene = false, fields = None, progress = None))]
pub(crate) fn limit<'py>(
    py: Python<'py>,
    settings: &Settings,
    of_scene: bool,
    fields: Option<u64>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let plan = settings.plan()?;
    let query = py.detach(|| if of_scene { LimitQuery::of_scene(&plan) } else { Ok(LimitQuery::of_plan(&plan)) });
    let mut query = query.map_err(wrong_setting)?;
    query.criterion.fields = fields.unwrap_or(query.criterion.fields);
    let drawn =
        query.model.as_ref().map_or(query.criterion.scene.name().to_owned(), |model| model.whole.name().to_owned());
    let criterion = query.criterion;
    let found = study(py, progress, query);
    settings.functions.check()?;
    let found = found?.map_err(wrong_setting)?;
    let Limit { triangles, first_miss, island, unbroken_from, tried } = found;
    python(
        py,
        &json!({
            "triangles": found.has_limit().then_some(triangles),
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

/// Finds the values of a setting with which an experiment reaches a goal. Returns a dictionary with over, goal, values,
/// fields, least, most, reached, tried, missed_at and because.
///
/// ``low`` and ``high`` are the ends of the range that is searched. Without these two arguments, the search covers the
/// range that the sources of the setting allow. ``missed_at`` is a value that misses the goal, and ``because`` names the
/// resource that limits the experiment with this value. ``fields`` is the length of each run.
///
/// Raises :class:`pxpl5.SettingError` for an invalid setting or range.
#[pyfunction]
#[pyo3(signature = (settings, key, *, low = None, high = None, fields = None, progress = None))]
pub(crate) fn limit_over<'py>(
    py: Python<'py>,
    settings: &Settings,
    key: &str,
    low: Option<f64>,
    high: Option<f64>,
    fields: Option<u64>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut file = settings.file.clone();
    let first = file.resolve().map_err(wrong_setting)?;
    let fields = fields.unwrap_or(first.limit.fields);
    file.set("fields", i64::try_from(fields).unwrap_or(i64::MAX), "keyword").map_err(wrong_setting)?;
    let values = OverQuery::values(&first, key, low, high).map_err(|error| wrong_setting(error.at("low and high")))?;
    let query = OverQuery { file, key: key.to_owned(), values, goal: first.limit.goal };
    let limit = study(py, progress, query.clone());
    settings.functions.check()?;
    let mut found = serde_json::to_value(limit?.map_err(wrong_setting)?).map_err(wrong_setting)?;
    found["over"] = key.into();
    found["goal"] = json!(query.goal);
    found["fields"] = fields.into();
    found["low"] = query.values.from.into();
    found["high"] = query.values.last().into();
    python(py, &found)
}

/// Compares two reports, each as JSON text. Returns a dictionary with same_trace, settings, results and equal.
///
/// Raises :class:`pxpl5.SettingError` for invalid text.
#[pyfunction]
pub(crate) fn diff<'py>(py: Python<'py>, a: &str, b: &str) -> PyResult<Bound<'py, PyAny>> {
    let read = |text: &str| serde_json::from_str::<serde_json::Value>(text).map_err(wrong_setting);
    let found = DiffQuery { reports: [read(a)?, read(b)?] }.run(&mut ()).map_err(wrong_setting)?;
    python(py, &found)
}

/// Measures the latency of a pipeline with the pendulum rig of I3D95: from outside with photodiodes, and from inside
/// with time stamps. ``passes`` is the number of passes of the pendulum through its lowest point, and ``line`` the line
/// of the photodiode. Returns a dictionary with outside_ms, inside_ms, outside_less_inside_ms, agrees and bounds.
///
/// Raises :class:`pxpl5.SettingError` for invalid settings, and for a pipeline that the rig cannot measure.
#[pyfunction]
#[pyo3(signature = (settings, passes = None, line = None))]
pub(crate) fn rig<'py>(
    py: Python<'py>,
    settings: &Settings,
    passes: Option<usize>,
    line: Option<u32>,
) -> PyResult<Bound<'py, PyAny>> {
    let plan = settings.plan()?;
    let tracker = plan.head.as_ref().map(|head| head.head().tracker().config().clone());
    let tracker = tracker.ok_or_else(|| wrong_setting("the rig: expected a head with a tracker, found none"))?;
    let mut rig = Rig { seed: plan.seed, passes: passes.unwrap_or(PASSES), ..Rig::assumed(tracker) };
    rig.rig.photodiode_line = line.unwrap_or(rig.rig.photodiode_line);
    let query = RigQuery { rig, machine: plan.machine.clone(), pipeline: plan.pipeline.clone() };
    python(py, &study(py, None, query)?.map_err(wrong_setting)?)
}

const LEVELS: &str = include_str!("../../pxpl5-cli/src/levels.json");

/// Compares the levels of modelling by error and speed. Without ``experiments`` the result is the measurement that is
/// recorded in the repository. With ``experiments``, the errors are measured anew over this number of random
/// experiments. If ``speeds`` is true, the simulation speeds are measured too. Returns the record as a dictionary.
///
/// Raises :class:`pxpl5.RunError` if an experiment fails.
#[pyfunction]
#[pyo3(signature = (experiments = None, speeds = false, progress = None))]
pub(crate) fn levels<'py>(
    py: Python<'py>,
    experiments: Option<u64>,
    speeds: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let record = match experiments {
        None => LevelRecord::read(LEVELS).map_err(failed_run)?,
        Some(experiments) => study(py, progress, LevelQuery { experiments, speeds })?.map_err(failed_run)?,
    };
    python(py, &record)
}

/// Ranks the interpretations of the papers' open questions by their fit to the figures of Rendering Control. The best
/// ``best`` interpretations are also simulated with events. ``seeds`` and ``frames`` are the size of the fly-throughs.
/// Returns a dictionary with analytic, transaction and left_out. ``left_out`` predicts each figure by the interpretation
/// under which all other figures are likeliest.
///
/// Raises :class:`pxpl5.RunError` if a figure cannot be simulated.
#[pyfunction]
#[pyo3(signature = (best = 20, seeds = 6, frames = 150, progress = None))]
pub(crate) fn interpretations<'py>(
    py: Python<'py>,
    best: usize,
    seeds: u64,
    frames: u64,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let settings = FigureSettings::new(Level::Analytic).with_mig(seeds, frames);
    python(py, &study(py, progress, InterpretationQuery { settings, best })?.map_err(failed_run)?)
}
