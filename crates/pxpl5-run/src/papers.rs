//! The pipelines and displays of the papers.

use crate::displays;
use crate::pipelines;
use crate::registry::Registry;

impl Registry {
    /// Those of the papers. Their closed forms are added by the crate that has them.
    #[must_use]
    pub fn of_papers() -> Self {
        Self::with(pipelines::entries(), displays::entries())
    }
}
