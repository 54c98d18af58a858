//! The Python functions that a run calls on its own thread, and their exceptions.

use crate::motion::CallableMotion;
use crate::policy::Asked;
use pyo3::prelude::*;
use std::sync::Arc;

#[derive(Clone, Default)]
pub(crate) struct PythonFunctions {
    pub(crate) motion: Option<Arc<CallableMotion>>,
    pub(crate) policy: Option<Arc<Asked>>,
}

impl PythonFunctions {
    /// Raises the exception that a Python function has raised during the run, if any.
    pub(crate) fn check(&self) -> PyResult<()> {
        self.motion.iter().try_for_each(|called| called.check())?;
        self.policy.iter().try_for_each(|asked| asked.check())
    }

    /// Returns true if a Python function has raised an exception that is not yet reported.
    pub(crate) fn has_raised(&self) -> bool {
        self.motion.as_ref().is_some_and(|called| called.has_raised())
            || self.policy.as_ref().is_some_and(|asked| asked.has_raised())
    }
}
