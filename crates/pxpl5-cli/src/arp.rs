//! The command `pxpl5 arp`, with experiments on address recalculation in which a viewer walks through a scene.

mod compare;
mod interpretations;
mod run;
pub(crate) mod settings;
mod texel;

use crate::error::CliError;
use clap::{Args, Subcommand};

/// Walk through a scene with a display that follows the head's rotation (address recalculation, priority rendering,
/// region warping).
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 arp run --scene gallery --warp linear --out out/walk
  pxpl5 arp run --policy objects --set walk.frames=3600 --json
  pxpl5 arp compare --scene gallery --out out/policies
  pxpl5 figures --group address-recalculation
  pxpl5 arp interpretations
  pxpl5 arp texel 0 0 --yaw 30

These commands use an ideal renderer for the faces. With `pxpl5 run --pipeline arp-priority`, Pixel-Planes 5 draws the faces.")]
pub(crate) struct ArpArgs {
    #[command(subcommand)]
    command: ArpCommand,
}

#[derive(Subcommand, Debug)]
enum ArpCommand {
    /// Simulate one walk of a viewer through a scene. Print how often parts of objects are drawn, the update rates, and
    /// the widths of the gaps where objects are cut.
    Run(run::RunArgs),
    /// Compare all policies and warps on one walk through a scene.
    Compare(compare::CompareArgs),
    /// Rank the possible answers to the questions that the paper on priority rendering leaves open about its table 1.
    /// As a check, each update rate of the table is left out in turn.
    Interpretations(interpretations::InterpretationsArgs),
    /// Print the cube face and the texels that a pixel shows at an orientation of the head.
    Texel(texel::TexelArgs),
}

pub(crate) fn run(args: ArpArgs) -> Result<(), CliError> {
    match args.command {
        ArpCommand::Run(args) => run::run(args),
        ArpCommand::Compare(args) => compare::run(args),
        ArpCommand::Interpretations(args) => interpretations::run(args),
        ArpCommand::Texel(args) => texel::run(args),
    }
}
