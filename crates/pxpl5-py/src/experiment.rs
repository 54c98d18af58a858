//! An experiment with checked settings, which Python can run.

use crate::background::{Progress, in_background};
use crate::catalogue::python;
use crate::errors::{failed_run, wrong_setting};
use crate::frames::{Frames, film_bytes};
use crate::outcome::{Outcome, exception, outcome_of_run};
use crate::policy::{Asked, PythonFunctions};
use crate::scene::Scene;
use crate::settings::Settings;
use crate::stepper::{MachineThread, Stepper};
use pxpl5::firmware::Shading;
use pxpl5::views::{Film, FilmSurfaces};
use pxpl5::{
    Experiment as Native, ExperimentError, KeptRecords, Level, PeriodNumber, Pixels, Plan, PolicyPipeline,
    RegionPolicy, Results, Study, StudyError, SurfaceId, WhatIfQuery, Workstation, levels, registry,
};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::sync::Arc;

/// A checked experiment: a machine, a pipeline, a scene and a head.
#[pyclass(frozen, module = "pxpl5._native")]
pub(crate) struct Experiment {
    plan: Plan,
    native: Native,
    level: String,
    functions: PythonFunctions,
}

#[pymethods]
impl Experiment {
    /// Creates an experiment from settings. An argument ``scene`` or ``policy`` replaces the scene or the policy in the
    /// settings.
    ///
    /// Raises :class:`pxpl5.SettingError` for the first invalid or missing setting, and for a scene that cannot be
    /// loaded.
    #[new]
    #[pyo3(signature = (settings, *, scene = None, policy = None, phong = true))]
    fn new(
        py: Python<'_>,
        settings: &Settings,
        scene: Option<&Scene>,
        policy: Option<Py<PyAny>>,
        phong: bool,
    ) -> PyResult<Self> {
        let mut plan = settings.plan()?;
        // A scene in the arguments replaces the scene in the settings.
        let scene = match scene {
            Some(scene) => Arc::clone(&scene.scene),
            None => py.detach(|| plan.load_scene()).map_err(wrong_setting)?,
        };
        let policy = policy.map(|policy| Arc::new(Asked::new(py, policy)));
        // A policy in the arguments has a pipeline of its own. All other settings stay.
        if let Some(asked) = &policy {
            let shading = if phong { Shading::Phong } else { Shading::Gouraud };
            let policy: Arc<dyn RegionPolicy> = Arc::<Asked>::clone(asked);
            plan.pipeline = Arc::new(PolicyPipeline::new(policy, shading));
        }
        // Runs in Python have events.
        let (native, choice) = plan.with_chosen_level(scene, true);
        let level = choice.map_or_else(|| plan.level_name(), |choice| choice.to_string());
        let functions = PythonFunctions { policy, ..settings.functions.clone() };
        Ok(Self { plan, native, level, functions })
    }

    /// Returns a hash of all settings and inputs on which the trace of the run depends.
    ///
    /// Raises any exception that a Python function of the experiment raises, such as the function of a motion.
    fn config_hash(&self, py: Python<'_>) -> PyResult<String> {
        let hash = py.detach(|| self.native.config_hash().to_string());
        self.functions.check()?;
        Ok(hash)
    }

    /// Returns warnings about results that no source supports. The warnings concern parameters outside their plausible
    /// range, and runs at the cycle level in which some times do not come from executed code.
    fn warnings(&self) -> Vec<String> {
        self.native.warnings()
    }

    /// Returns the level of modelling of the run. For ``level = "auto"``, the reason follows.
    fn level(&self) -> String {
        self.level.clone()
    }

    /// Returns all parameters by path with values, units and sources, including the parameters of the tracker.
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        crate::catalogue::python(py, &crate::catalogue::described(&self.plan.parameters()))
    }

    /// Runs the experiment. ``threads`` is the number of threads that compute pixels. If ``keep_everything`` is true,
    /// all records for tables and timelines are kept, otherwise only statistics.
    ///
    /// Raises :class:`pxpl5.RunError`, which carries the observations until the error, :class:`pxpl5.TooShortError` or
    /// KeyboardInterrupt.
    #[pyo3(signature = (progress = None, threads = None, keep_everything = true))]
    fn run(
        &self,
        py: Python<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        threads: Option<usize>,
        keep_everything: bool,
    ) -> PyResult<Outcome> {
        let keep = if keep_everything { KeptRecords::Everything } else { KeptRecords::Statistics };
        let workstation = threads.map_or_else(Workstation::new, Workstation::with_threads);
        let functions = self.functions.clone();
        let native = self.native.clone().keep(keep);
        let result = in_background(py, progress, true, move |watch| run(&native, workstation, &functions, &watch));
        // An exception of a Python function takes precedence over the error that it causes in the run.
        self.functions.check()?;
        outcome_of_run(py, result?, &self.plan.measure)
    }

    /// Begins the run and returns a stepper, which advances the run on request. ``keep_everything`` is as in
    /// :meth:`run`.
    ///
    /// Raises :class:`pxpl5.SettingError` if the machine cannot be built.
    #[pyo3(signature = (keep_everything = true))]
    fn stepper(&self, py: Python<'_>, keep_everything: bool) -> PyResult<Stepper> {
        let keep = if keep_everything { KeptRecords::Everything } else { KeptRecords::Statistics };
        let (native, watch) = self.on_host(Workstation::with_threads(0));
        let thread = MachineThread::start(py, native.keep(keep), watch.stop_flag());
        self.functions.check()?;
        let thread = thread?.map_err(|error| exception(py, error, &self.plan.measure))?;
        Ok(Stepper { thread, checks: self.functions.clone(), measures: self.plan.measure.clone() })
    }

    /// Returns an iterator over the pictures of a run, one for each of ``fields`` display periods from ``first`` on. A
    /// picture shows the screen at the end of its period. ``surface`` is the number of a surface, or None for all
    /// surfaces side by side. The experiment runs again with pixels to compute the pictures.
    ///
    /// Raises :class:`pxpl5.SettingError` for a surface or a number of fields that does not exist.
    fn frames(&self, surface: Option<u16>, first: u64, fields: u64) -> PyResult<Frames> {
        let (film, watch) = self.film_of(surface, first, fields);
        Frames::start(film, watch, self.functions.clone())
    }

    /// Returns the pictures of :meth:`frames` as an animated PNG at the true rate.
    ///
    /// Raises the same exceptions as :meth:`frames`.
    fn film<'py>(
        &self,
        py: Python<'py>,
        surface: Option<u16>,
        first: u64,
        fields: u64,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let (film, watch) = self.film_of(surface, first, fields);
        let texts = [
            ("config_hash", self.native.config_hash().to_string()),
            ("settings", self.plan.settings_for_any_folder().to_string()),
        ];
        let texts = texts.map(|(key, text)| (key.to_owned(), text)).into();
        Ok(PyBytes::new(py, &film_bytes(py, film, texts, &watch, &self.functions)?))
    }

    /// Returns the number of display periods that the experiment simulates.
    #[getter]
    fn fields(&self) -> u64 {
        self.native.fields
    }

    /// Returns the effect of 10 % more of each resource of the machine, as dictionaries. The experiment runs again for
    /// each resource.
    ///
    /// Raises the same exceptions as :meth:`run`.
    fn what_if<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (native, functions) = (self.native.clone(), self.functions.clone());
        let result = in_background(py, None, true, move |watch| {
            let stop = watch.stop_flag();
            functions.end(&stop);
            let experiment = native.host(Workstation::with_threads(1)).stopped_by(stop.clone());
            WhatIfQuery { registry: registry(), experiment }.run(&mut stop.clone())
        });
        self.functions.check()?;
        python(
            py,
            &result?.map_err(|error| match error {
                StudyError::Experiment(error) => exception(py, error, &self.plan.measure),
                error => failed_run(error),
            })?,
        )
    }

    /// Returns the measured quantities by name, at the experiment's own level of modelling, which may be the analytic
    /// level. The value is None for a quantity that the run does not define, such as the latency of a run without
    /// complete pictures.
    ///
    /// Raises the same exceptions as :meth:`run`.
    fn measure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (native, functions) = (self.native.clone().pixels(Pixels::Off), self.functions.clone());
        let is_analytic = self.plan.level == Level::Analytic;
        // Formulas do not check for a stop, so Ctrl-C does not wait for their result.
        let result = in_background(py, None, !is_analytic, move |watch| {
            let workstation = Workstation::with_threads(1);
            if !is_analytic {
                return run(&native, workstation, &functions, &watch).map(Results::of_run);
            }
            let summary = levels::summarise(&registry(), &native.host(workstation)).map_err(Box::new);
            summary.map(Results::of_closed_form)
        });
        self.functions.check()?;
        let results = result?.map_err(|error| exception(py, *error, &self.plan.measure))?;
        let measured = PyDict::new(py);
        for measure in &self.plan.measure {
            measured.set_item(measure.name(), measure.of(&results))?;
        }
        Ok(measured)
    }
}

impl Experiment {
    /// Returns the experiment on a host computer that Python can stop, and the flag with which Python stops the run.
    fn on_host(&self, workstation: Workstation) -> (Native, Arc<Progress>) {
        let watch = Arc::new(Progress::default());
        self.functions.end(&watch.stop_flag());
        (self.native.clone().host(workstation).stopped_by(watch.stop_flag()), watch)
    }

    fn film_of(&self, surface: Option<u16>, first: u64, fields: u64) -> (Film, Arc<Progress>) {
        let (native, watch) = self.on_host(Workstation::with_threads(0));
        // The last picture is final only one field later.
        let length = self.native.fields.max(first.saturating_add(fields).saturating_add(1));
        let surfaces = surface.map_or(FilmSurfaces::All, |surface| FilmSurfaces::One(SurfaceId(surface)));
        let native = native.pixels(Pixels::Lazy).fields(length);
        (Film::new(native, PeriodNumber(first), fields, surfaces), watch)
    }
}

/// Greatest number of fields for which a run pauses in every field. The pauses let the run report progress, and let
/// Ctrl-C take effect soon. A longer run does not pause.
const LOOKED_AT: u64 = 20_000;

fn run(
    native: &Native,
    workstation: Workstation,
    functions: &PythonFunctions,
    watch: &Progress,
) -> Result<pxpl5::Outcome, Box<ExperimentError>> {
    let fields = native.fields;
    // A short run stops in every field so that Ctrl-C takes effect soon. A long run stops only to report progress.
    let each = if fields <= LOOKED_AT { fields } else { 0 };
    let stops: Vec<PeriodNumber> = PeriodNumber::FIRST.until(PeriodNumber::FIRST.after(each)).collect();
    functions.end(&watch.stop_flag());
    let at = |field: PeriodNumber, _: &mut pxpl5::Stepper| {
        watch.report(field.since(PeriodNumber::FIRST), fields);
        Ok(())
    };
    native.clone().host(workstation).stopped_by(watch.stop_flag()).run_stopping(&stops, at).map_err(Box::new)
}
