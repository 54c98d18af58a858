//! The command `pxpl5 volume`, which draws a scene as slices of a spinning volumetric display.

mod compare;
mod heads;
mod run;
pub(crate) mod settings;
mod slices;
mod sweep;
mod view;

use crate::error::CliError;
use clap::{Args, Subcommand};

/// Draw a scene as the 396 slices of a spinning volumetric display (SpatialGL on Perspecta, 2005).
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 volume run --scene mig --clip hyperbolic:0.25 --projection jittered --seed 1 --out out/volume
  pxpl5 volume slice 50 --scene head --out slice.png
  pxpl5 volume view --scene head --azimuth 40 --elevation 25 --cut 0:90 --out view.png
  pxpl5 volume compare --scene mig --out out/variants
  pxpl5 figures --group volumetric

The display does not draw a picture for one eye. It lights everything within a slice, and an eye at any position sees the sum of one turn.")]
pub(crate) struct VolumeArgs {
    #[command(subcommand)]
    command: VolumeCommand,
}

#[derive(Subcommand, Debug)]
enum VolumeCommand {
    /// Draw a volume and print its counts.
    Run(run::RunArgs),
    /// Draw all slices as thumbnails on one sheet.
    Sheet(slices::SheetArgs),
    /// Draw one slice, before and after halftoning.
    Slice(slices::SliceArgs),
    /// Render what an eye sees during one turn of the display.
    View(view::ViewArgs),
    /// Write an animated PNG in which the eye goes once around the volume.
    Film(view::FilmArgs),
    /// Compare all clips (ways to cut the scene into slices) and projections.
    Compare(compare::CompareArgs),
    /// Draw a volume at every point of a parameter space.
    Sweep(sweep::SweepArgs),
}

pub(crate) fn run(args: VolumeArgs) -> Result<(), CliError> {
    match args.command {
        VolumeCommand::Run(args) => run::run(args),
        VolumeCommand::Sheet(args) => slices::sheet(args),
        VolumeCommand::Slice(args) => slices::slice(args),
        VolumeCommand::View(args) => view::view(args),
        VolumeCommand::Film(args) => view::film(args),
        VolumeCommand::Compare(args) => compare::run(args),
        VolumeCommand::Sweep(args) => sweep::run(args),
    }
}
