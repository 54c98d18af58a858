use crate::config::MachineConfig;
use pxpl5_framebuffer::FrameBufferConfig;
use pxpl5_gp::{CodeUse, CodeVersion, GpTiming, HostTiming};
use pxpl5_renderer::RendererTiming;
use pxpl5_ring::RingTiming;
use pxpl5_sim::parameters::SettingError;
use serde::Serialize;

/// A built-in machine: name, description and parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Preset {
    /// Name of the preset on the command line.
    pub name: &'static str,
    /// Description of the machine and its source.
    pub about: &'static str,
    n_gps: usize,
    n_renderers: usize,
    #[serde(skip)]
    gp: GpTiming,
    #[serde(skip)]
    code: CodeVersion,
}

/// The built-in machines.
///
/// Machines described in the papers come first.
pub const PRESETS: [Preset; 7] = [
    Preset {
        name: "small-hmd",
        about: "13 GPs (1 master, 12 slaves), 5 renderers: the machine of the Rendering Control measurements (TR94)",
        n_gps: 13,
        n_renderers: 5,
        gp: GpTiming::PAPERS,
        code: CodeVersion::Scheduled,
    },
    Preset {
        name: "slats",
        about: "1 GP, 5 renderers, code of 1994 (TR94)",
        n_gps: 1,
        n_renderers: 5,
        gp: GpTiming::SLATS_1994,
        code: CodeVersion::Compiled,
    },
    Preset {
        name: "slats-1995",
        about: "1 GP, 5 renderers, code of 1995 (I3D95)",
        n_gps: 1,
        n_renderers: 5,
        gp: GpTiming::SLATS_1995,
        code: CodeVersion::Compiled,
    },
    Preset {
        name: "slats-optimised",
        about: "1 GP, 5 renderers, code of 1994 at a third of the time per triangle, the gain of code that fits the cache (I3D95)",
        n_gps: 1,
        n_renderers: 5,
        gp: GpTiming::SLATS_OPTIMISED,
        code: CodeVersion::Scheduled,
    },
    Preset {
        name: "medium",
        about: "24 GPs, 10 renderers: a middle-sized configuration (assumed)",
        n_gps: 24,
        n_renderers: 10,
        gp: GpTiming::PAPERS,
        code: CodeVersion::Scheduled,
    },
    Preset {
        name: "design-maximum",
        about: "32 GPs, 16 renderers: the design maximum (F89)",
        n_gps: 32,
        n_renderers: 16,
        gp: GpTiming::PAPERS,
        code: CodeVersion::Scheduled,
    },
    Preset {
        name: "large",
        about: "50 GPs, 20 renderers: the largest number of GPs published (I3D95)",
        n_gps: 50,
        n_renderers: 20,
        gp: GpTiming::PAPERS,
        code: CodeVersion::Scheduled,
    },
];

pxpl5_sim::parameters::named!(Preset, "machine", PRESETS.map(|preset| (preset.name, preset)));

impl MachineConfig {
    /// Returns the machine of a preset.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] with the most similar valid name if no preset is called `name`.
    pub fn preset(name: &str) -> Result<Self, SettingError> {
        let preset = PRESETS
            .iter()
            .find(|preset| preset.name == name)
            .ok_or_else(|| SettingError::unknown_path("machine", name, PRESETS.iter().map(|preset| preset.name)))?;
        Ok(Self::from_preset(preset))
    }

    /// Returns this machine with the times per primitive that the i860 code needs, instead of published or fitted
    /// times. The machine `slats` has these times already.
    ///
    /// `of` is the pipeline whose code is used. A machine without a code version gets the times of compiled code.
    #[must_use]
    pub fn with_times_of_code(self, of: CodeUse) -> Self {
        let gp = self.gp.of_code(self.code.unwrap_or(CodeVersion::Compiled), of);
        Self { gp, ..self }
    }

    /// Returns this machine with published or fitted times per primitive. Only the machines of Slats whose times come
    /// from i860 code change.
    #[must_use]
    pub fn with_times_of_papers(self) -> Self {
        let of_code = [GpTiming::SLATS_1994, GpTiming::SLATS_OPTIMISED];
        let fitted = [GpTiming::SLATS_FITTED, GpTiming::SLATS_FITTED.optimised()];
        let of_papers = of_code.iter().zip(fitted).find(|(code, _)| **code == self.gp);
        Self { gp: of_papers.map_or(self.gp, |(_, gp)| gp), ..self }
    }

    fn from_preset(preset: &Preset) -> Self {
        Self {
            preset: preset.name.to_owned(),
            n_gps: preset.n_gps,
            n_renderers: preset.n_renderers,
            ring: RingTiming::PAPERS,
            gp: preset.gp,
            code: Some(preset.code),
            i860: i860::Config::cycle(),
            renderer: RendererTiming::PAPERS,
            host: HostTiming::PAPERS,
            displays: vec![Box::new(FrameBufferConfig::NTSC)],
            firmware: Vec::new(),
        }
    }

    /// Returns the machine of the Rendering Control measurements: 13 graphics processors and 5 renderers (TR94).
    pub fn small_hmd() -> Self {
        Self::from_preset(&PRESETS[0])
    }

    /// Returns the machine of the Slats prototype: 1 graphics processor and 5 renderers (TR94).
    pub fn slats() -> Self {
        Self::from_preset(&PRESETS[1])
    }
}
