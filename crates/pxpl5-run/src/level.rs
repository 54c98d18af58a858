//! Three levels of modelling: what is to be run, and what comes out, do not depend on the level.
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
//! All that graphics processors do under Rendering Control, Slats, just-in-time pixels, frameless rendering and the pipelines that draw six
//! faces is i860 code (docs/gp-timing.md), so that no time of the cycle level is the table's; `tests/cycle.rs` holds it to that. Pipelines of
//! others keep the table's times for what has no code ([`Pipeline::without_code`](crate::Pipeline::without_code)), and their
//! reports say so. Which code runs is a value of the machine ([`MachineConfig::code`]), whatever its table of times says. The table may be
//! that of the code ([`MachineConfig::with_times_of_code`]): then the transaction level says in the mean what the cycle level does.

use pxpl5_machine::MachineConfig;
use pxpl5_renderer::{CommandKind, Layout, RendererTiming};
use serde::{Deserialize, Serialize};

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

impl Level {
    /// All, from the fastest to the most literal.
    pub const ALL: [Self; 3] = [Self::Analytic, Self::Transaction, Self::Cycle];

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

/// The machine with every clock of a renderer that follows from an instruction list; what an experiment has changed
/// stays changed.
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
        // A layout without the fields that a command needs never gets that command.
        let of_program = kind.clocks(layout).map_or(of_table, u64::from);
        *clocks = if *clocks == of_table { of_program } else { *clocks };
    }
    machine
}
