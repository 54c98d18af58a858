//! `pxpl5 check`.

use crate::error::CliError;
use crate::settings::SettingArgs;
use crate::terminal::{print, warn};
use clap::Args;

/// Print the effective configuration of an experiment; nothing is run.
///
/// What is printed is itself an experiment file that says the same.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 check experiments/figure-04.toml
  pxpl5 check --pipeline slats --scene mig --set gp.triangle_ns=30000")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    settings: SettingArgs,
}

pub(crate) fn run(args: CheckArgs) -> Result<(), CliError> {
    let plan = args.settings.gather()?.resolve()?;
    warn(&plan.warnings(), false);
    let scene = plan.load_scene()?;
    let version = env!("CARGO_PKG_VERSION");
    let hash = plan.experiment(scene).config_hash();
    print(&format!(
        "# machine: {}\n# config_hash: {hash}\n# version: {version}\n# level: {}\n# seed: {}\n{}",
        plan.machine.preset,
        plan.level_name(),
        plan.seed,
        plan.settings()
    ))
}
