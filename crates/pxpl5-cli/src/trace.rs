//! The command `pxpl5 trace`, which writes a trace of one run for Perfetto, or a waveform for GTKWave and Surfer.

use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::interrupt;
use crate::numbers::count_of;
use crate::one_picture;
use crate::output::OutputFile;
use crate::settings::SettingArgs;
use crate::simulate::{How, Simulated, simulate};
use crate::terminal::{print, warn};
use clap::Args;
use pxpl5::views::trace_export::{Trace, chrome, vcd};
use pxpl5::{Outcome, Time};
use std::path::PathBuf;

/// Run one experiment and write a trace of its events for ui.perfetto.dev, or a waveform for GTKWave and Surfer.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 trace --pipeline slats --scene mig --triangles 140 --fields 20 --out slats.json
  pxpl5 trace --pipeline rendering-control --scene mig --fields 30 --out mig.json
  pxpl5 trace --pipeline rendering-control --scene mig --fields 300 --picture 57 --out picture-57.vcd

A trace holds every message. About 30 fields are enough to show how a pipeline works.")]
pub(crate) struct TraceArgs {
    #[command(flatten)]
    settings: SettingArgs,
    /// The file to write: .vcd is a waveform (value change dump), any other name is Chrome's JSON format.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    #[command(flatten)]
    range: PictureRange,
    #[command(flatten)]
    budget: BudgetArgs,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

/// The pictures whose span is written.
#[derive(Args, Debug)]
struct PictureRange {
    /// Write only the span of one picture, from its head pose to the end of the field that first shows it.
    #[arg(long, value_name = "N", conflicts_with_all = ["from", "to"])]
    picture: Option<u64>,
    /// Begin with the head pose of this picture.
    #[arg(long, value_name = "N")]
    from: Option<u64>,
    /// End with the field that first shows this picture.
    #[arg(long, value_name = "N")]
    to: Option<u64>,
}

pub(crate) fn run(args: TraceArgs) -> Result<(), CliError> {
    let plan = args.settings.gather()?.resolve()?;
    warn(&plan.warnings(), args.quiet);
    // Open the output first, so that a bad path fails before the run.
    let file = OutputFile::open(&args.out, "--out")?;
    // A run that is too short for statistics still has a trace.
    let how = How { traffic: true, budget: args.budget, quiet: args.quiet, ..How::default() };
    let Simulated { outcome, too_short } = simulate(&plan, how)?;
    match too_short {
        Some(ended) if interrupt::flag().is_stopped() => return Err(ended),
        note => warn(note.map(|note| note.message().to_owned()).as_slice(), args.quiet),
    }
    let span = args.range.span(&outcome)?;
    let trace = Trace::of(&outcome).between(span);
    // The whole file is built in memory and then written at once.
    let mut bytes = Vec::new();
    let is_waveform = args.out.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("vcd"));
    let made = if is_waveform { vcd(&trace, span, &mut bytes) } else { chrome(&trace, &mut bytes) };
    made.map_err(CliError::failure)?;
    let silent = args.quiet || file.is_standard_output();
    file.write(&bytes)?;
    if silent {
        return Ok(());
    }
    let path = args.out.display();
    let (fields, tracks) = (count_of(plan.fields, "field"), count_of(trace.tracks.len(), "track"));
    let viewer = if is_waveform { "GTKWave or Surfer" } else { "ui.perfetto.dev" };
    print(&format!("{path}: {fields}, {tracks}; open it with {viewer}.\n"))
}

impl PictureRange {
    /// Returns the span of the chosen pictures, by default the whole run.
    fn span(&self, outcome: &Outcome) -> Result<[Time; 2], CliError> {
        let find = |number| one_picture::find(outcome, number).map(|times| one_picture::span(outcome, times));
        let first = self.picture.or(self.from).map(find).transpose()?;
        let last = self.picture.or(self.to).map(find).transpose()?;
        let [begin, end] = [first.map_or(Time::ZERO, |span| span[0]), last.map_or(outcome.end(), |span| span[1])];
        if begin >= end {
            return Err(CliError::usage("--from, --to: expected the first and the last picture, in this order"));
        }
        Ok([begin, end])
    }
}
