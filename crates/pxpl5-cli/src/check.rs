//! The command `pxpl5 check`, which prints the effective configuration of an experiment.

use crate::error::CliError;
use crate::scenes;
use crate::settings::SettingArgs;
use crate::terminal::{print, warn};
use crate::version::{VERSION, commit_text};
use clap::Args;
use pxpl5::sweep::Sweep;
use pxpl5::{ExperimentFile, Plan};
use std::fmt::Write as _;

/// Print the effective configuration of an experiment without running it.
///
/// The output is itself an experiment file with the same settings. For a sweep, the output describes the first point
/// that is a valid experiment.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 check experiments/figure-04.toml
  pxpl5 check experiments/sweep-slats.toml
  pxpl5 check --pipeline slats --scene mig --set gp.triangle_ns=30000")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    settings: SettingArgs,
}

pub(crate) fn run(args: CheckArgs) -> Result<(), CliError> {
    let file = args.settings.gather()?;
    let (plan, about) = if file.is_sweep() { of_sweep(file)? } else { (file.resolve()?, String::new()) };
    warn(&plan.warnings(), false);
    let scene = scenes::load(&plan, false)?;
    let experiment = plan.experiment(scene);
    // A machine that cannot be built is refused here too.
    experiment.check()?;
    let hash = experiment.config_hash();
    print(&format!(
        "{about}# machine: {}\n# config_hash: {hash}\n# version: {VERSION}\n# commit: {}\n# level: {}\n# seed: {}\n{}",
        plan.machine.preset,
        commit_text(),
        plan.level_name(),
        plan.seed,
        plan.settings()
    ))
}

/// Maximum number of points of a sweep that are checked. Assumed: checking so many points takes some seconds.
const MAX_CHECKED: u64 = 1_000;

/// Returns the plan of the first valid point of a sweep, and comment lines about the sweep. Returns an error for each
/// sweep that `pxpl5 sweep` refuses.
fn of_sweep(file: ExperimentFile) -> Result<(Plan, String), CliError> {
    let sweep = Sweep::new(file)?;
    sweep.header()?;
    let points = sweep.space().points();
    let checked = points.min(MAX_CHECKED);
    let mut first = None;
    let mut failed: Option<(u64, u64, String)> = None;
    // Resolve each point, keep the first plan, and count points that are invalid.
    for point in 0..checked {
        match sweep.plan(point) {
            Ok(plan) => first = first.or(Some((point, plan))),
            Err(error) => {
                let (count, ..) = failed.get_or_insert((0, point, error.to_string()));
                *count += 1;
            }
        }
    }
    // `Sweep::header` found a valid point, which may come after the points checked here.
    let (point, plan) = match first {
        Some(first) => first,
        None => (0, sweep.plan(0)?),
    };
    if let Some((count, point, error)) = failed {
        warn(&[format!("{count} of {checked} points are not valid experiments; point {point}: {error}")], false);
    }
    let mut about = format!("# sweep of {points} points, of which {checked} were checked; point {point}:\n");
    for axis in sweep.space().axes() {
        let _ = writeln!(about, "#   {}: {} values", axis.paths.join(", "), axis.len());
    }
    Ok((plan, about))
}
