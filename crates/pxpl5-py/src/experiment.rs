//! An experiment that is ready to be run.

use crate::attended::{Progress, attended};
use crate::errors::{failed_run, raised, wrong_setting};
use crate::motion::{Called, Motion};
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

/// A machine, a pipeline, a scene and a head, checked.
#[pyclass(frozen, module = "pxpl5._native")]
pub(crate) struct Experiment {
    plan: Plan,
    native: Native,
    /// What Python is asked while it runs.
    motion: Option<Arc<Called>>,
    policy: Option<Arc<Asked>>,
}

#[pymethods]
impl Experiment {
    /// Of settings; ``scene``, ``motion`` and ``policy`` stand in the place of what the settings name.
    ///
    /// Raises :class:`pxpl5.SettingError` for the first setting that is wrong or missing, and for a scene that cannot be loaded.
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
        let scene = match scene {
            Some(scene) => Arc::clone(&scene.scene),
            None => py.detach(|| plan.load_scene()).map_err(wrong_setting)?,
        };
        let mut native = plan.experiment(scene);
        let policy = policy.map(|policy| Arc::new(Asked::new(policy)));
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
        if let Some(motion) = motion {
            let Some(head) = native.tracked_head().cloned() else {
                return Err(wrong_setting("a motion: expected a head with a tracker, found none"));
            };
            native = native.head(pxpl5::Head::clone(&head).moving(Arc::clone(&motion.moving)));
        }
        let motion = motion.and_then(|motion| motion.called.clone());
        Ok(Self { plan, native, motion, policy })
    }

    /// Name of everything on which the trace depends.
    ///
    /// Raises what a callable raises.
    fn config_hash(&self, py: Python<'_>) -> PyResult<String> {
        let hash = py.detach(|| self.native.config_hash().to_string());
        self.check()?;
        Ok(hash)
    }

    /// What no source allows: parameters outside of their range, each with range and source; and what has no code at the cycle level.
    fn warnings(&self) -> Vec<String> {
        self.native.warnings()
    }

    /// Paths of all parameters with their values, units and sources, those of the tracker included.
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        crate::catalogue::python(py, &crate::catalogue::described(&self.plan.parameters()))
    }

    /// Runs it, with as many threads for pixels as are said; keeps what tables and timelines need, or statistics only.
    ///
    /// Raises :class:`pxpl5.RunError` (with everything observed until then) and :class:`pxpl5.TooShortError`; KeyboardInterrupt.
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
        self.check()?;
        match result? {
            Ok(outcome) => Ok(Outcome::of(outcome, &self.plan.measure)),
            Err(error) => Err(exception(py, *error, &self.plan.measure)),
        }
    }

    /// The measured quantities at the experiment's own level, also the analytic one, by name; None where there is none.
    ///
    /// Raises as :meth:`run`.
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
    /// Raises what a callable has raised.
    fn check(&self) -> PyResult<()> {
        self.motion.iter().try_for_each(|called| called.check())?;
        self.policy.iter().try_for_each(|asked| asked.check())
    }
}

/// Fields up to which a run is looked at in every one of them, so that Ctrl-C is heard soon.
const LOOKED_AT: u64 = 20_000;

type AskedOfPython = (Option<Arc<Called>>, Option<Arc<Asked>>);

fn run(
    native: &Native,
    workstation: Workstation,
    (motion, policy): AskedOfPython,
    told: Arc<Progress>,
) -> Result<pxpl5::Outcome, Box<ExperimentError>> {
    let fields = native.length();
    let each = if fields <= LOOKED_AT { fields } else { 0 };
    let stops: Vec<PeriodNumber> = PeriodNumber::FIRST.until(PeriodNumber::FIRST.after(each)).collect();
    let host = Attended { workstation, told: Arc::clone(&told), motion, policy };
    let at = |field: PeriodNumber, _: &mut pxpl5::Machine| {
        told.tell(field.since(PeriodNumber::FIRST), fields);
        Ok(())
    };
    native.clone().host(host).run_stopping(&stops, at).map_err(Box::new)
}

/// This computer, as long as somebody wants the result.
struct Attended {
    workstation: Workstation,
    told: Arc<Progress>,
    motion: Option<Arc<Called>>,
    policy: Option<Arc<Asked>>,
}

impl fmt::Debug for Attended {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Attended").field("workstation", &self.workstation).finish_non_exhaustive()
    }
}

impl Host for Attended {
    fn seconds(&self) -> Option<f64> {
        self.workstation.seconds()
    }

    fn is_given_up(&self) -> bool {
        self.told.is_given_up()
            || self.motion.as_ref().is_some_and(|called| called.has_raised())
            || self.policy.as_ref().is_some_and(|asked| asked.has_raised())
    }

    fn pixel_worker(&self) -> Box<dyn PixelWorker> {
        self.workstation.pixel_worker()
    }
}

/// An error of the library as an exception; what was observed goes with it.
fn exception(py: Python<'_>, error: ExperimentError, measures: &[Measure]) -> PyErr {
    let text = error.to_string();
    let (name, partial, needed) = match error {
        ExperimentError::TooShort { needed, partial, .. } => ("TooShortError", partial, needed),
        ExperimentError::Run { partial, .. } => ("RunError", partial, None),
        ExperimentError::Stopped(_) => return failed_run(text),
        _ => return wrong_setting(text),
    };
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
