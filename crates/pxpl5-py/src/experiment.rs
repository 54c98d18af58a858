//! An experiment that is ready to run.

use crate::attended::{Progress, attended};
use crate::errors::{failed_run, raised, wrong_setting};
use crate::motion::{CallableMotion, Motion};
use crate::outcome::Outcome;
use crate::policy::{Asked, PolicyPipeline};
use crate::scene::Scene;
use crate::settings::Settings;
use pxpl5::machine::PixelWorker;
use pxpl5::{
    Experiment as Native, ExperimentError, Host, Keep, Measure, PeriodNumber, Pipeline, Plan, Results, Workstation,
    levels, registry,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fmt;
use std::sync::Arc;

/// A checked experiment: a machine, a pipeline, a scene and a head.
#[pyclass(frozen, module = "pxpl5._native")]
pub(crate) struct Experiment {
    plan: Plan,
    native: Native,
    /// Python callable that supplies the motion during the run, if any.
    motion: Option<Arc<CallableMotion>>,
    policy: Option<Arc<Asked>>,
}

#[pymethods]
impl Experiment {
    /// Creates an experiment from settings. ``scene``, ``motion`` and ``policy`` replace the values in the settings.
    ///
    /// Raises :class:`pxpl5.SettingError` for the first invalid or missing setting, and for a scene that cannot be
    /// loaded.
    #[new]
    #[pyo3(signature = (settings, *, scene = None, motion = None, policy = None, phong = true))]
    fn new(
        py: Python<'_>,
        settings: &Settings,
        scene: Option<&Scene>,
        motion: Option<&Motion>,
        policy: Option<Py<PyAny>>,
        phong: bool,
    ) -> PyResult<Self> {
        let plan = settings.plan()?;
        // A given scene replaces the one in the settings.
        let scene = match scene {
            Some(scene) => Arc::clone(&scene.scene),
            None => py.detach(|| plan.load_scene()).map_err(wrong_setting)?,
        };
        let mut native = plan.experiment(scene);
        let policy = policy.map(|policy| Arc::new(Asked::new(policy)));
        // A policy is a pipeline of its own, so the experiment is built anew with the other settings.
        if let Some(asked) = &policy {
            let pipeline: Arc<dyn Pipeline> = Arc::new(PolicyPipeline::new(Arc::clone(asked), phong));
            native = Native::with(plan.machine.clone(), pipeline, Arc::clone(native.scene()))
                .fields(plan.fields)
                .seed(plan.seed)
                .pixels(plan.pixels)
                .level(plan.level);
            if let Some(head) = &plan.head {
                native = native.head(head.head());
            }
        }
        // A motion replaces the motion of the tracked head.
        if let Some(motion) = motion {
            let Some(head) = native.tracked_head().cloned() else {
                return Err(wrong_setting("a motion: expected a head with a tracker, found none"));
            };
            native = native.head(pxpl5::Head::clone(&head).moving(Arc::clone(&motion.moving)));
        }
        let motion = motion.and_then(|motion| motion.called.clone());
        Ok(Self { plan, native, motion, policy })
    }

    /// Returns a hash of everything on which the trace depends.
    ///
    /// Raises any exception of a callable.
    fn config_hash(&self, py: Python<'_>) -> PyResult<String> {
        let hash = py.detach(|| self.native.config_hash().to_string());
        self.check()?;
        Ok(hash)
    }

    /// Returns warnings about results that no source supports: parameters outside their range, and work without code at
    /// the cycle level.
    fn warnings(&self) -> Vec<String> {
        self.native.warnings()
    }

    /// Returns the paths of all parameters with values, units and sources, including those of the tracker.
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        crate::catalogue::python(py, &crate::catalogue::described(&self.plan.parameters()))
    }

    /// Runs the experiment. ``threads`` threads compute pixels. ``keep_everything`` keeps the records for tables and
    /// timelines, otherwise only statistics.
    ///
    /// Raises :class:`pxpl5.RunError` with the observations until the error, :class:`pxpl5.TooShortError`, and
    /// KeyboardInterrupt.
    #[pyo3(signature = (progress = None, threads = None, keep_everything = true))]
    fn run(
        &self,
        py: Python<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        threads: Option<usize>,
        keep_everything: bool,
    ) -> PyResult<Outcome> {
        let keep = if keep_everything { Keep::Everything } else { Keep::Statistics };
        let workstation = threads.map_or_else(Workstation::new, Workstation::with_threads);
        let asked = (self.motion.clone(), self.policy.clone());
        let native = self.native.clone().keep(keep);
        let result = attended(py, progress, true, move |told| run(&native, workstation, asked, told));
        // An exception of a callable takes precedence over the error of the run.
        self.check()?;
        match result? {
            Ok(outcome) => Ok(Outcome::of(outcome, &self.plan.measure)),
            Err(error) => Err(exception(py, *error, &self.plan.measure)),
        }
    }

    /// Returns the measured quantities by name, at the experiment's own level, which may be the analytic one. A
    /// quantity without a value is None.
    ///
    /// Raises the same exceptions as :meth:`run`.
    fn measure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let native = self.native.clone().pixels(pxpl5::Pixels::Off).host(Workstation::with_threads(1));
        let result = py.detach(|| match self.plan.level {
            pxpl5::Level::Analytic => levels::summarise(&registry(), &native).map(Results::of_closed_form),
            _ => native.run().map(Results::of_run),
        });
        self.check()?;
        let results = result.map_err(|error| exception(py, error, &self.plan.measure))?;
        let measured = PyDict::new(py);
        for measure in &self.plan.measure {
            measured.set_item(measure.name(), measure.of(&results))?;
        }
        Ok(measured)
    }
}

impl Experiment {
    /// Raises any exception that a callable has raised.
    fn check(&self) -> PyResult<()> {
        self.motion.iter().try_for_each(|called| called.check())?;
        self.policy.iter().try_for_each(|asked| asked.check())
    }
}

/// Largest number of fields of a run that stops in every field, so that Ctrl-C takes effect soon.
const LOOKED_AT: u64 = 20_000;

type AskedOfPython = (Option<Arc<CallableMotion>>, Option<Arc<Asked>>);

fn run(
    native: &Native,
    workstation: Workstation,
    (motion, policy): AskedOfPython,
    told: Arc<Progress>,
) -> Result<pxpl5::Outcome, Box<ExperimentError>> {
    let fields = native.length();
    // A short run stops in every field, a long one only for progress.
    let each = if fields <= LOOKED_AT { fields } else { 0 };
    let stops: Vec<PeriodNumber> = PeriodNumber::FIRST.until(PeriodNumber::FIRST.after(each)).collect();
    let host = StoppableHost { workstation, told: Arc::clone(&told), motion, policy };
    let at = |field: PeriodNumber, _: &mut pxpl5::Machine| {
        told.tell(field.since(PeriodNumber::FIRST), fields);
        Ok(())
    };
    native.clone().host(host).run_stopping(&stops, at).map_err(Box::new)
}

/// The host computer of a run that Python may stop.
struct StoppableHost {
    workstation: Workstation,
    told: Arc<Progress>,
    motion: Option<Arc<CallableMotion>>,
    policy: Option<Arc<Asked>>,
}

impl fmt::Debug for StoppableHost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Attended").field("workstation", &self.workstation).finish_non_exhaustive()
    }
}

impl Host for StoppableHost {
    fn seconds(&self) -> Option<f64> {
        self.workstation.seconds()
    }

    fn is_stopped(&self) -> bool {
        self.told.is_stopped()
            || self.motion.as_ref().is_some_and(|called| called.has_raised())
            || self.policy.as_ref().is_some_and(|asked| asked.has_raised())
    }

    fn pixel_worker(&self) -> Box<dyn PixelWorker> {
        self.workstation.pixel_worker()
    }
}

/// Converts an error of the library to an exception, with the observations until the error.
fn exception(py: Python<'_>, error: ExperimentError, measures: &[Measure]) -> PyErr {
    let text = error.to_string();
    let (name, partial, needed) = match error {
        ExperimentError::TooShort { needed, partial, .. } => ("TooShortError", partial, needed),
        ExperimentError::Run { partial, .. } => ("RunError", partial, None),
        ExperimentError::Stopped(_) => return failed_run(text),
        _ => return wrong_setting(text),
    };
    // The exception carries the partial outcome and the number of fields that a run would need.
    let exception = raised(name, &text);
    let value = exception.value(py);
    let partial = Py::new(py, Outcome::of(*partial, measures));
    let set = partial
        .and_then(|partial| value.setattr("_native", partial))
        .and_then(|()| value.setattr("fields_needed", needed));
    match set {
        Ok(()) => exception,
        Err(error) => error,
    }
}
