use crate::displays;
use crate::pipelines;
use crate::registry::{PipelineEntry, Registry};

const USUAL: [&str; 7] =
    ["rendering-control", "slats", "frameless", "jitp-field", "jitp-scanline-racing", "arp-full", "arp-priority-line"];

impl Registry {
    /// Returns a registry with the pipelines and displays of the papers. The crate pxpl5-analytic adds the closed
    /// forms.
    #[must_use]
    pub fn of_papers() -> Self {
        Self::with(pipelines::entries(), displays::entries())
    }

    /// Returns true if a short comparison, with one row per family of pipelines, includes `pipeline`.
    ///
    /// Each family of the papers has one such pipeline. In any other family, the first compared pipeline is included.
    #[must_use]
    pub fn is_usual(&self, pipeline: &PipelineEntry) -> bool {
        let mut family = self.pipelines().iter().filter(|other| other.compared && other.family == pipeline.family);
        let first = family.clone().next().map(|first| first.name);
        USUAL.contains(&pipeline.name)
            || (first == Some(pipeline.name) && !family.any(|other| USUAL.contains(&other.name)))
    }
}
