//! Three levels of modelling behind one interface: what is to be run, and what comes out, do not depend on the level.
//!
//! | level | graphics processors | ring | renderers |
//! |---|---|---|---|
//! | [`Level::Analytic`] | closed form of the stage rules | time of copies and of clumps | a constant per command |
//! | [`Level::Transaction`] | timing table per primitive | an event per message | timing table per command: the clocks of its program in Rendering Control's layout |
//! | [`Level::Cycle`] | clocks of the i860 code that runs for every triangle, over the board's memory | as the transaction level | the clocks of every instruction of a command's program in the pipeline's own layout |
//!
//! The ring needs no third form: its word-by-word reference and the event form give the same picosecond for every
//! message (a property test of the ring's crate), so the cycle level uses the event form.
//!
//! Of the graphics processor's code the triangle's way from the display list to commands and bins is i860 code
//! (docs/gp-timing.md). The clipper, spheres, edits, the beginning of a pass and messages have none: there the table's
//! times stay. So they do where an experiment has changed the time per triangle. A preset whose code did not fit the
//! instruction cache runs the compiled kernel, the others the one scheduled by hand.

mod chart;
mod compare;

pub use chart::svg;
pub use compare::{LevelReport, cases, compare};

use crate::analytic;
use crate::config::MachineConfig;
use crate::experiment::{Experiment, ExperimentError, Outcome, Pixels};
use crate::head_to_light::Head;
use crate::pipelines::{Frameless, Jitp, Pipeline, RenderingControl, Slats};
use crate::report::Statistics;
use pxpl5_renderer::{CommandKind, Layout, RendererTiming};
use pxpl5_scene::Scene;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Eye, MAX_MESSAGE_WORDS, RegionGrid};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// How literally the machine is modelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// Closed form of the stage rules; no events.
    Analytic,
    /// An event per message and command list.
    Transaction,
    /// The same, with clocks that come from instructions instead of the timing tables.
    Cycle,
}

/// The machine with every clock of a renderer that follows from an instruction list; what an experiment has changed
/// stays changed.
pub(crate) fn literal(machine: &MachineConfig, layout: &Layout) -> MachineConfig {
    let mut machine = machine.clone();
    let (timing, table) = (&mut machine.renderer, RendererTiming::PAPERS);
    for (kind, clocks, of_table) in [
        (CommandKind::SelectRegion, &mut timing.select_clocks, table.select_clocks),
        (CommandKind::Clear, &mut timing.clear_clocks, table.clear_clocks),
        (CommandKind::Triangle, &mut timing.triangle_clocks, table.triangle_clocks),
        (CommandKind::PhongTriangle, &mut timing.phong_triangle_clocks, table.phong_triangle_clocks),
        (CommandKind::Sphere, &mut timing.sphere_clocks, table.sphere_clocks),
        (CommandKind::PhongSphere, &mut timing.phong_sphere_clocks, table.phong_sphere_clocks),
        (CommandKind::Shade, &mut timing.shade_clocks, table.shade_clocks),
    ] {
        // A layout without the fields that a command needs never gets that command.
        let of_program = kind.clocks(layout).map_or(of_table, u64::from);
        *clocks = if *clocks == of_table { of_program } else { *clocks };
    }
    machine
}

/// A pipeline with its variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// Rendering Control.
    RenderingControl(RenderingControl),
    /// Slats.
    Slats(Slats),
    /// Just-in-time pixels.
    Jitp(Jitp),
    /// Frameless rendering.
    Frameless(Frameless),
}

impl Program {
    /// As an experiment takes it.
    #[must_use]
    pub fn pipeline(self) -> Arc<dyn Pipeline> {
        match self {
            Self::RenderingControl(pipeline) => Arc::new(pipeline),
            Self::Slats(pipeline) => Arc::new(pipeline),
            Self::Jitp(pipeline) => Arc::new(pipeline),
            Self::Frameless(pipeline) => Arc::new(pipeline),
        }
    }
}

impl From<RenderingControl> for Program {
    fn from(pipeline: RenderingControl) -> Self {
        Self::RenderingControl(pipeline)
    }
}

impl From<Slats> for Program {
    fn from(pipeline: Slats) -> Self {
        Self::Slats(pipeline)
    }
}

/// What is to be run.
#[derive(Clone, Debug)]
pub struct Case {
    /// The machine.
    pub machine: MachineConfig,
    /// The pipeline.
    pub program: Program,
    /// The scene.
    pub scene: Arc<Scene>,
    /// Fields to simulate.
    pub fields: u64,
    /// Seed of the head motion.
    pub seed: u64,
    /// The head with its tracker, where it is not the scene's own motion that is seen without delay.
    pub head: Option<Arc<Head>>,
}

/// What came of it, over the pictures after the warm-up.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Latency of every picture as its pipeline defines it, milliseconds.
    pub latencies_ms: Vec<f64>,
    /// Complete pictures a second.
    pub updates_hz: f64,
    /// Missed retraces.
    pub missed_retraces: u64,
    /// From the start of an eye's TRANSFORM to the end of its COPY, milliseconds; Rendering Control only.
    pub eye_latencies_ms: Vec<f64>,
    /// Port time of a region of 15,360 pixels, microseconds.
    pub region_copy_us: f64,
    /// COPY of the left eye (Rendering Control), of the top regions or all (Slats), of all (others): first to last word.
    pub first_copy_ms: f64,
    /// COPY of the right eye, or of the bottom regions; 0 where there is none.
    pub last_copy_ms: f64,
    /// From the start of a picture to the first word of its first copy.
    pub copy_begins_ms: f64,
}

impl Summary {
    /// Latency in milliseconds.
    #[must_use]
    pub fn latency_ms(&self) -> Statistics {
        Statistics::of(self.latencies_ms.iter().copied())
    }

    /// Latency in fields of 1001/60000 s.
    #[must_use]
    pub fn latency_fields(&self) -> Statistics {
        Statistics::of(self.latencies_ms.iter().map(|ms| ms / FIELD_MS))
    }
}

/// An NTSC field.
pub const FIELD_MS: f64 = 1001.0 / 60.0;

impl Level {
    /// All, from the fastest to the most literal.
    pub const ALL: [Self; 3] = [Self::Analytic, Self::Transaction, Self::Cycle];

    /// Runs a case.
    ///
    /// # Errors
    ///
    /// [`ExperimentError`] as [`Experiment::run`].
    pub fn run(self, case: &Case) -> Result<Summary, ExperimentError> {
        match self {
            Self::Analytic => analytic::run(case),
            Self::Transaction | Self::Cycle => Ok(summary(case.program, &case.experiment().level(self).run()?)),
        }
    }

    /// As experiment files name it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Analytic => "analytic",
            Self::Transaction => "transaction",
            Self::Cycle => "cycle",
        }
    }
}

impl Case {
    /// The experiment at the transaction level, without pixels.
    #[must_use]
    pub fn experiment(&self) -> Experiment {
        let experiment = Experiment::with(self.machine.clone(), self.program.pipeline(), Arc::clone(&self.scene))
            .fields(self.fields)
            .seed(self.seed)
            .pixels(Pixels::Off);
        match &self.head {
            Some(head) => experiment.head(Arc::clone(head)),
            None => experiment,
        }
    }
}

