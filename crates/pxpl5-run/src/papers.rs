//! Registry of the papers' pipelines and displays.

use crate::displays;
use crate::pipelines;
use crate::registry::Registry;

impl Registry {
    /// Returns a registry with the pipelines and displays of the papers. The crate pxpl5-analytic adds the analytic
    /// models.
    #[must_use]
    pub fn of_papers() -> Self {
        Self::with(pipelines::entries(), displays::entries())
    }
}
