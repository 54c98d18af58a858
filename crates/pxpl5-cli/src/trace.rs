//! The command `pxpl5 trace`, which writes a trace of one run for Perfetto or Chrome.

use crate::budget::{BudgetArgs, EARLY_CHECK_FIELDS};
use crate::error::CliError;
use crate::estimate::RunWork;
use crate::numbers::count_of;
use crate::output::OutputFile;
use crate::scenes;
use crate::settings::SettingArgs;
use crate::snapshot::Simulated;
use crate::terminal::{print, progress, warn};
use crate::too_heavy::too_heavy;
use clap::{Args, ValueEnum};
use pxpl5::views::trace_export::{Trace, chrome, perfetto};
use pxpl5::{ExperimentError, PeriodNumber};
use pxpl5::{Observation, Traffic};
use std::path::{Path, PathBuf};

/// Run one experiment and write a trace of its events for ui.perfetto.dev.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 trace --pipeline slats --scene mig --triangles 140 --fields 20 --out slats.pftrace
  pxpl5 trace --pipeline rendering-control --scene mig --fields 30 --out mig.json

A trace holds every message. About 30 fields are enough to show how a pipeline works.")]
pub(crate) struct TraceArgs {
    #[command(flatten)]
    settings: SettingArgs,
    /// The file to write: .pftrace (or .perfetto-trace) for Perfetto's format, .json for Chrome's.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Format of the file; default: by the extension of its name.
    #[arg(long, value_enum)]
    format: Option<Format>,
    #[command(flatten)]
    budget: BudgetArgs,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Perfetto's protobuf format, with times in nanoseconds.
    Perfetto,
    /// Chrome's JSON format, with exact times in microseconds.
    Chrome,
}

impl Format {
    /// Returns the trace format for the extension of a file name. Pipes and devices get the format of Perfetto.
    fn of(path: &Path) -> Result<Self, CliError> {
        let end = path.extension().map(|end| end.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        match end.as_str() {
            "pftrace" | "perfetto-trace" => Ok(Self::Perfetto),
            "json" => Ok(Self::Chrome),
            _ if std::fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir()) => Ok(Self::Perfetto),
            _ => Err(CliError::usage(format!(
                "--out: expected a name that ends in .pftrace or .json, or a --format, found {}",
                path.display()
            ))),
        }
    }
}

/// Bytes in memory for each event of the trace while the file is made (measured, rounded up).
const EVENT_BYTES: f64 = 200.0;

/// Returns the memory that the trace of the records so far will take, in bytes. A message is an event of two ports.
fn trace_bytes(observation: &Observation) -> f64 {
    let of_traffic =
        |traffic: &Traffic| 2 * traffic.transfers.len() + traffic.busy_channels.len() + traffic.fifo_changes.len();
    EVENT_BYTES * (observation.records() + observation.traffic.as_deref().map_or(0, of_traffic)) as f64
}

pub(crate) fn run(args: TraceArgs) -> Result<(), CliError> {
    let format = args.format.map_or_else(|| Format::of(&args.out), Ok)?;
    let plan = args.settings.gather()?.resolve()?;
    warn(&plan.warnings(), args.quiet);
    // Open the output first, so that a bad path fails before the run.
    let file = OutputFile::open(&args.out, "--out")?;
    let bar = progress(plan.fields, "fields", args.quiet);
    let scene = scenes::load(&plan, args.quiet)?;
    args.budget.admit(&RunWork::of(&plan, &scene, true))?;
    warn(too_heavy(&plan, &scene, plan.fields).as_slice(), args.quiet);
    // A trace needs every message, which a run does not record by default.
    let experiment = plan.experiment(scene).record_traffic(true);
    let watch = args.budget.watch(plan.fields);
    let run =
        experiment.run_stopping(&EARLY_CHECK_FIELDS.map(|field| PeriodNumber::FIRST.after(field)), |field, machine| {
            let done = field.since(PeriodNumber::FIRST);
            bar.set_position(done);
            watch.check(done, trace_bytes(machine.record().observation())).map_err(ExperimentError::Stopped)
        });
    bar.finish_and_clear();
    // A run that is too short for statistics still has a trace.
    let Simulated { outcome, too_short } = Simulated::of(run)?;
    warn(&too_short.iter().map(|note| note.message().to_owned()).collect::<Vec<_>>(), args.quiet);
    let trace = Trace::of(&outcome);
    let mut bytes = Vec::new();
    // The whole file is built in memory and then written at once.
    let written = match format {
        Format::Perfetto => perfetto(&trace, &mut bytes),
        Format::Chrome => chrome(&trace, &mut bytes),
    };
    written.map_err(CliError::failure)?;
    let silent = args.quiet || file.is_standard_output();
    file.write(&bytes)?;
    if silent {
        return Ok(());
    }
    let path = args.out.display();
    let (fields, tracks) = (count_of(plan.fields, "field"), count_of(trace.tracks.len(), "track"));
    print(&format!("{path}: {fields}, {tracks}; open it with ui.perfetto.dev.\n"))
}
