//! The three levels of modelling. An experiment and the form of its results do not depend on the level.
//!
//! | level | graphics processors | ring | renderers |
//! |---|---|---|---|
//! | [`Level::Analytic`] | formulas for the times of the stages | formulas for the times of copies and of clumps | a constant time per command |
//! | [`Level::Transaction`] | timing table per primitive | an event per message | timing table per command: the clocks of its program in Rendering Control's layout |
//! | [`Level::Cycle`] | clocks of the i860 code that runs for every triangle, over the board's memory | as the transaction level | the clocks of every instruction of a command's program in the pipeline's own layout |
//!
//! The cycle level needs no more detailed model of the ring. A property test of the ring's crate shows that the events
//! and a word-by-word reference model give the same picosecond for every message.
//!
//! This crate has Rendering Control, Slats, just-in-time pixels, frameless rendering and address recalculation.
//! In these pipelines, all work of graphics processors is i860 code (docs/gp-timing.md). At the cycle level no time
//! comes from the timing table, and `tests/cycle.rs` checks this. Other pipelines take the times of the table for work
//! without code ([`PipelineProperties::without_code`](crate::PipelineProperties::without_code)), and their reports state this.
//!
//! The machine selects the code that runs ([`MachineConfig::code`]), independent of its table of times. With the times
//! of the code in the table ([`MachineConfig::with_times_of_code`]), the transaction level agrees with the cycle level
//! on average.

use pxpl5_machine::MachineConfig;
use pxpl5_renderer::{CommandKind, Layout, RendererTiming};
use serde::{Deserialize, Serialize};

/// The level of detail of a simulation, from formulas to single instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// Formulas for the times of the stages, without simulated events.
    Analytic,
    /// Each message and each list of commands is one simulated event.
    Transaction,
    /// Events are simulated as at [`Level::Transaction`], but clocks come from executed instructions instead of timing
    /// tables.
    Cycle,
}

impl Level {
    /// All levels, from the fastest to the most detailed.
    pub const ALL: [Self; 3] = [Self::Analytic, Self::Transaction, Self::Cycle];

    /// Returns the name of the level in experiment files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Analytic => "analytic",
            Self::Transaction => "transaction",
            Self::Cycle => "cycle",
        }
    }
}

pxpl5_sim::parameters::named!(Level, "level", Level::ALL.map(|level| (level.name(), level)));

/// Replaces the clocks of renderer commands by the lengths of the commands' programs. Clocks that an experiment has
/// changed keep their values.
pub(crate) fn with_clocks_of_instructions(machine: &MachineConfig, layout: &Layout) -> MachineConfig {
    let mut machine = machine.clone();
    let timing = &mut machine.renderer;
    let table = RendererTiming::PAPERS;
    for (kind, clocks, of_table) in [
        (CommandKind::SelectRegion, &mut timing.select_clocks, table.select_clocks),
        (CommandKind::Clear, &mut timing.clear_clocks, table.clear_clocks),
        (CommandKind::Triangle, &mut timing.triangle_clocks, table.triangle_clocks),
        (CommandKind::PhongTriangle, &mut timing.phong_triangle_clocks, table.phong_triangle_clocks),
        (CommandKind::Sphere, &mut timing.sphere_clocks, table.sphere_clocks),
        (CommandKind::PhongSphere, &mut timing.phong_sphere_clocks, table.phong_sphere_clocks),
        (CommandKind::Shade, &mut timing.shade_clocks, table.shade_clocks),
    ] {
        // A layout without the fields of a command never gets that command.
        let of_program = kind.clocks(layout).map_or(of_table, u64::from);
        // A value that differs from the table was set by the experiment and stays.
        *clocks = if *clocks == of_table { of_program } else { *clocks };
    }
    machine
}
