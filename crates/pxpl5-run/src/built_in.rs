use crate::pipelines;
use crate::registry::{DisplayEntry, PipelineEntry, Registry};
use address_recalculation::ArpConfig;
use pxpl5_framebuffer::{FrameBufferConfig, HiResConfig, LcdConfig, OledConfig, PanelConfig};

const USUAL: [&str; 7] =
    ["rendering-control", "slats", "frameless", "jitp-field", "jitp-scanline-racing", "arp-full", "arp-priority-line"];

impl Registry {
    /// Returns a registry with the pipelines and displays of the papers. The crate pxpl5-analytic adds the closed
    /// forms.
    pub fn of_papers() -> Self {
        Self::with(pipelines::entries(), displays())
    }

    /// Returns true if a short comparison, with one row per family of pipelines, includes `pipeline`.
    ///
    /// Each family of the papers has one such pipeline. In any other family, the first compared pipeline is included.
    pub fn is_usual(&self, pipeline: &PipelineEntry) -> bool {
        let mut family = self.pipelines().iter().filter(|other| other.compared && other.family == pipeline.family);
        let first = family.clone().next().map(|first| first.name);
        USUAL.contains(&pipeline.name)
            || (first == Some(pipeline.name) && !family.any(|other| USUAL.contains(&other.name)))
    }
}

/// Returns the displays of the papers, two current displays, and a display whose parameters the user sets.
pub(crate) fn displays() -> Vec<DisplayEntry> {
    vec![
        DisplayEntry { name: "ntsc", config: || Box::new(FrameBufferConfig::NTSC) },
        DisplayEntry { name: "hires", config: || Box::new(HiResConfig::PAPERS) },
        DisplayEntry { name: "oled-90", config: || Box::new(OledConfig::PAPERS) },
        DisplayEntry { name: "lcd-120", config: || Box::new(LcdConfig::PAPERS) },
        DisplayEntry { name: "panel", config: || Box::new(PanelConfig::PAPERS) },
        DisplayEntry { name: "arp", config: || Box::new(ArpConfig::MACHINE) },
    ]
}
