//! The command `pxpl5 trace`, which writes a trace of one run for the viewer Perfetto.

use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::numbers::count_of;
use crate::output::OutputFile;
use crate::settings::SettingArgs;
use crate::simulate::{How, Simulated, simulate};
use crate::terminal::{print, warn};
use clap::Args;
use pxpl5::views::trace_export::{Trace, chrome};
use std::path::PathBuf;

/// Run one experiment and write a trace of its events for ui.perfetto.dev.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 trace --pipeline slats --scene mig --triangles 140 --fields 20 --out slats.json
  pxpl5 trace --pipeline rendering-control --scene mig --fields 30 --out mig.json

A trace holds every message. About 30 fields are enough to show how a pipeline works.")]
pub(crate) struct TraceArgs {
    #[command(flatten)]
    settings: SettingArgs,
    /// The file to write, in Chrome's JSON format.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    #[command(flatten)]
    budget: BudgetArgs,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

pub(crate) fn run(args: TraceArgs) -> Result<(), CliError> {
    let plan = args.settings.gather()?.resolve()?;
    warn(&plan.warnings(), args.quiet);
    // Open the output first, so that a bad path fails before the run.
    let file = OutputFile::open(&args.out, "--out")?;
    // A run that is too short for statistics still has a trace.
    let how = How { traffic: true, budget: args.budget, quiet: args.quiet, ..How::default() };
    let Simulated { outcome, too_short } = simulate(&plan, how)?;
    warn(&too_short.iter().map(|note| note.message().to_owned()).collect::<Vec<_>>(), args.quiet);
    let trace = Trace::of(&outcome);
    let mut bytes = Vec::new();
    // The whole file is built in memory and then written at once.
    chrome(&trace, &mut bytes).map_err(CliError::failure)?;
    let silent = args.quiet || file.is_standard_output();
    file.write(&bytes)?;
    if silent {
        return Ok(());
    }
    let path = args.out.display();
    let (fields, tracks) = (count_of(plan.fields, "field"), count_of(trace.tracks.len(), "track"));
    print(&format!("{path}: {fields}, {tracks}; open it with ui.perfetto.dev.\n"))
}
