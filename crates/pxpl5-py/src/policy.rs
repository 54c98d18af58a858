//! A policy in Python: a function that decides which renderer draws which region, and in which order. The pipeline
//! itself is `pxpl5::PolicyPipeline`.

use crate::errors::{Raised, wrong_setting};
use crate::motion::CallableMotion;
use pxpl5::firmware::RegionId;
use pxpl5::{PolicyFrame, RegionAssignment, RegionPolicy, StopFlag, Time};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fmt;
use std::sync::Arc;

/// A Python function that assigns regions to renderers.
pub(crate) struct Asked {
    policy: Py<PyAny>,
    name: String,
    raised: Raised,
}

impl Asked {
    pub(crate) fn new(py: Python<'_>, policy: Py<PyAny>) -> Self {
        let name = policy.getattr(py, "__qualname__").and_then(|name| name.extract(py));
        Self { policy, name: name.unwrap_or_else(|_| "callable".to_owned()), raised: Raised::default() }
    }

    fn ask(&self, py: Python<'_>, frame: &PolicyFrame) -> PyResult<Vec<RegionAssignment>> {
        let about = PyDict::new(py);
        about.set_item("frame", frame.frame.0)?;
        about.set_item("time_s", frame.time.since(Time::ZERO).as_ms() * 1e-3)?;
        about.set_item("columns", frame.columns)?;
        about.set_item("primitives", &frame.primitives)?;
        about.set_item("renderers", frame.renderers)?;
        let answer = self.policy.call1(py, (about,))?;
        let found: Vec<(u16, usize)> = answer.extract(py).map_err(|_| {
            let found = answer.bind(py).repr().map_or_else(|_| "an object".to_owned(), |text| text.to_string());
            let found: String = found.chars().take(MAX_SHOWN).collect();
            wrong_setting(format!("a policy: expected a list of pairs (region, renderer), found {found}"))
        })?;
        let assignments: Vec<RegionAssignment> =
            found.into_iter().map(|(region, renderer)| (RegionId(region), renderer)).collect();
        frame.check(&assignments).map_err(wrong_setting)?;
        Ok(assignments)
    }
}

/// Maximum number of characters of an invalid answer in an error message.
const MAX_SHOWN: usize = 80;

impl fmt::Debug for Asked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Asked").field("name", &self.name).finish_non_exhaustive()
    }
}

impl RegionPolicy for Asked {
    fn name(&self) -> &str {
        &self.name
    }

    /// Returns the assignments of regions to renderers from the Python function. After an exception of the function,
    /// the result is `None`, and the run ends at the next field.
    fn assign(&self, frame: &PolicyFrame) -> Option<Vec<RegionAssignment>> {
        let answer = Python::attach(|py| self.ask(py, frame));
        answer.map_err(|error| self.raised.keep(error)).ok()
    }
}

#[derive(Clone, Default)]
pub(crate) struct PythonFunctions {
    pub(crate) motion: Option<Arc<CallableMotion>>,
    pub(crate) policy: Option<Arc<Asked>>,
}

impl PythonFunctions {
    fn raised(&self) -> impl Iterator<Item = &Raised> {
        self.motion.iter().map(|called| &called.raised).chain(self.policy.iter().map(|asked| &asked.raised))
    }

    /// Raises the exception that a Python function has raised during the run, if any.
    pub(crate) fn check(&self) -> PyResult<()> {
        self.raised().try_for_each(Raised::check)
    }

    /// Lets exceptions of the Python functions end the run that `stop` ends.
    pub(crate) fn end(&self, stop: &StopFlag) {
        self.raised().for_each(|raised| raised.ends(stop.clone()));
    }
}
