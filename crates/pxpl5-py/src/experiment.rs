//! An experiment with checked settings, which Python can run.

use crate::attended::{Progress, attended};
use crate::errors::{failed_run, raised, wrong_setting};
use crate::motion::{CallableMotion, Motion};
use crate::outcome::Outcome;
use crate::policy::{Asked, PolicyPipeline};
use crate::scene::Scene;
use crate::settings::Settings;
use pxpl5::device::PixelWorker;
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
    /// Python function that computes the head's motion during the run, or `None` for another motion.
    motion: Option<Arc<CallableMotion>>,
    policy: Option<Arc<Asked>>,
}

#[pymethods]
impl Experiment {
    /// Creates an experiment from settings. If ``scene``, ``motion`` or ``policy`` is given, it replaces the one in the
    /// settings.
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
        // A scene in the arguments replaces the scene in the settings.
        let scene = match scene {
            Some(scene) => Arc::clone(&scene.scene),
            None => py.detach(|| plan.load_scene()).map_err(wrong_setting)?,
        };
        let mut native = plan.experiment(scene);
        let policy = policy.map(|policy| Arc::new(Asked::new(policy)));
        // A policy needs a pipeline of its own, so the experiment is built again from the other settings.
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
        // A motion in the arguments replaces the motion of the tracked head.
        if let Some(motion) = motion {
            let Some(head) = native.tracked_head().cloned() else {
                return Err(wrong_setting("a motion: expected a head with a tracker, found none"));
            };
            native = native.head(pxpl5::Head::clone(&head).moving(Arc::clone(&motion.moving)));
        }
        let motion = motion.and_then(|motion| motion.called.clone());
        Ok(Self { plan, native, motion, policy })
    }

    /// Returns a hash of all settings and inputs on which the trace of the run depends.
    ///
    /// Raises any exception of a Python function that the experiment calls.
    fn config_hash(&self, py: Python<'_>) -> PyResult<String> {
        let hash = py.detach(|| self.native.config_hash().to_string());
        self.check()?;
        Ok(hash)
    }

    /// Returns warnings about results that no source supports. They concern parameters outside their plausible range,
    /// and work at the cycle level that no code executes.
    fn warnings(&self) -> Vec<String> {
        self.native.warnings()
    }

    /// Returns all parameters by path with values, units and sources, including those of the tracker.
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
        let keep = if keep_everything { Keep::Everything } else { Keep::Statistics };
        let workstation = threads.map_or_else(Workstation::new, Workstation::with_threads);
        let asked = (self.motion.clone(), self.policy.clone());
        let native = self.native.clone().keep(keep);
        let result = attended(py, progress, true, move |told| run(&native, workstation, asked, told));
        // An exception of a Python function takes precedence over the error that it causes in the run.
        self.check()?;
        match result? {
            Ok(outcome) => Ok(Outcome::of(outcome, &self.plan.measure)),
            Err(error) => Err(exception(py, *error, &self.plan.measure)),
        }
    }

    /// Returns the measured quantities by name, at the experiment's own level of modelling, which may be the analytic
    /// one. The value is None for a quantity that the run does not have.
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
    /// Raises the exception that a Python function of the experiment has raised, if there is one.
    fn check(&self) -> PyResult<()> {
        self.motion.iter().try_for_each(|called| called.check())?;
        self.policy.iter().try_for_each(|asked| asked.check())
    }
}

/// Greatest number of fields of a run that checks for Ctrl-C in every field.
const LOOKED_AT: u64 = 20_000;

type AskedOfPython = (Option<Arc<CallableMotion>>, Option<Arc<Asked>>);

fn run(
    native: &Native,
    workstation: Workstation,
    (motion, policy): AskedOfPython,
    told: Arc<Progress>,
) -> Result<pxpl5::Outcome, Box<ExperimentError>> {
    let fields = native.length();
    // A short run stops in every field so that Ctrl-C takes effect soon. A long run stops only to report progress.
    let each = if fields <= LOOKED_AT { fields } else { 0 };
    let stops: Vec<PeriodNumber> = PeriodNumber::FIRST.until(PeriodNumber::FIRST.after(each)).collect();
    let host = StoppableHost { workstation, told: Arc::clone(&told), motion, policy };
    let at = |field: PeriodNumber, _: &mut pxpl5::Machine| {
        told.tell(field.since(PeriodNumber::FIRST), fields);
        Ok(())
    };
    native.clone().host(host).run_stopping(&stops, at).map_err(Box::new)
}

/// The host computer for a run, which lets Python stop the run.
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

/// Converts an error of the library to an exception, which carries the values measured until the error.
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
