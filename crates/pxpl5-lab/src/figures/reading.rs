//! What the papers leave open about Rendering Control, as values.

use pxpl5_machine::{ConfigError, MachineConfig};
use pxpl5_run::{FinishedRegions, RenderingControl, Summary};
use serde::Serialize;

/// Whose latency a published mean is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Samples {
    /// One sample a frame: from the start of TRANSFORM of its first eye.
    FirstEye,
    /// One sample for each eye of a frame: from the start of that eye's TRANSFORM.
    EachEye,
}

/// How a published latency in fields was counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FieldCount {
    /// As a time, in fields of 1001/60000 s.
    Exact,
    /// The retraces up to and with the one of the swap.
    Whole,
}

/// One answer to each question that the papers leave open about the figures of Rendering Control.
///
/// The first two are about the figures, the others about the machine and the scenes. All figures are measured with one
/// reading: none is chosen for a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Reading {
    /// Whose latency a mean is of.
    pub samples: Samples,
    /// How latencies that are printed in fields were counted.
    pub fields: FieldCount,
    /// Finished regions that a renderer keeps in its backing store (`renderer.backing_regions`).
    pub kept: u64,
    /// What the master does with a renderer whose region is finished while the frame buffer is not available.
    #[serde(serialize_with = "by_name")]
    pub finished: FinishedRegions,
    /// Preset of the machine that drew the application scenes.
    pub machine: &'static str,
    /// Whether the application scenes were drawn without their back faces.
    pub culled: bool,
}

fn by_name<S: serde::Serializer>(finished: &FinishedRegions, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(finished.name())
}

/// Regions that a renderer's backing store has room for: 4,096 bits a pixel (TR94), of which the colours of a region take a block of 32.
pub const ROOM: u64 = 4_096 / 32;

impl Reading {
    /// The one with which figures are measured.
    pub const USUAL: Self = Self {
        samples: Samples::FirstEye,
        fields: FieldCount::Exact,
        kept: 1,
        finished: FinishedRegions::Wait,
        machine: "small-hmd",
        culled: false,
    };

    /// The pipeline as it reads the rules.
    #[must_use]
    pub const fn pipeline(&self) -> RenderingControl {
        RenderingControl { finished: self.finished, ..RenderingControl::stereo() }
    }

    /// A machine on which Rendering Control runs, as it reads the renderers.
    ///
    /// # Errors
    ///
    /// [`ConfigError`] for a number of regions beyond the parameter's limits.
    pub fn on(&self, mut machine: MachineConfig) -> Result<MachineConfig, ConfigError> {
        if self.kept != Self::USUAL.kept {
            machine.set("renderer.backing_regions", self.kept)?;
        }
        Ok(machine)
    }

    /// The samples of a latency to the swap, milliseconds.
    #[must_use]
    pub fn latencies_ms<'a>(&self, summary: &'a Summary) -> &'a [f64] {
        match self.samples {
            Samples::FirstEye => &summary.latencies_ms,
            Samples::EachEye => &summary.eye_swap_latencies_ms,
        }
    }

    /// A latency in fields.
    #[must_use]
    pub fn fields_of(&self, latency_ms: f64, field_ms: f64) -> f64 {
        /// A latency of exactly so many fields ends with a retrace, whatever the last bit of the quotient is.
        const ROUNDING: f64 = 1e-9;
        let exact = latency_ms / field_ms;
        match self.fields {
            FieldCount::Exact => exact,
            FieldCount::Whole => (exact - ROUNDING).ceil(),
        }
    }
}

impl std::fmt::Display for Reading {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { samples, fields, kept, finished, machine, culled } = self;
        let samples = if *samples == Samples::FirstEye { "first eye" } else { "each eye" };
        let fields = if *fields == FieldCount::Exact { "exact" } else { "whole fields" };
        let room = if *kept == ROOM { "no limit".to_owned() } else { format!("{kept} kept") };
        let faces = if *culled { "culled" } else { "all faces" };
        write!(f, "{samples}, {fields}, {room}, {}, {machine}, {faces}", finished.name())
    }
}
