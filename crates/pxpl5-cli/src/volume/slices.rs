//! The commands `pxpl5 volume sheet` and `pxpl5 volume slice`, which draw slices as flat pictures.

use super::settings::{VolumeSettingArgs, png};
use crate::error::CliError;
use crate::numbers::count_of;
use crate::output::OutputFile;
use crate::terminal::print;
use clap::{Args, ValueEnum};
use image::RgbImage;
use pxpl5::volume::Volume;
use pxpl5::volume::pictures::{before_and_after, coloured, halftoned, sheet as sheet_of, tiles_of_slice};
use pxpl5::volume::spatialgl::Tiling;
use std::path::{Path, PathBuf};

/// Draw all slices as thumbnails on one sheet, 22 in a row.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 volume sheet --scene head --out sheet.png
  pxpl5 volume sheet --scene mig --projection orthographic --clip prism --out prism.png")]
pub(super) struct SheetArgs {
    #[command(flatten)]
    volume: VolumeSettingArgs,
    /// The file to write (PNG).
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// Draw one slice: before halftoning on the left, after halftoning on the right.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 volume slice 50 --scene head --out slice.png
  pxpl5 volume slice 50 --scene head --show tiles --out tiles.png")]
pub(super) struct SliceArgs {
    /// Number of the slice within one turn of the display, from 0.
    #[arg(value_name = "K")]
    slice: u32,
    #[command(flatten)]
    volume: VolumeSettingArgs,
    /// Form of the slice to show.
    #[arg(long, value_enum, default_value_t = Part::Both)]
    show: Part,
    /// The file to write (PNG).
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Part {
    /// The slice before and after halftoning, side by side.
    Both,
    /// The slice before halftoning, with all 256 levels.
    Before,
    /// The slice after halftoning, as the projector shows it.
    After,
    /// The tiles of the slice, with occupied tiles marked.
    Tiles,
}

pub(super) fn sheet(args: SheetArgs) -> Result<(), CliError> {
    let file = OutputFile::open(&args.out, "--out")?;
    let volume = args.volume.draw(&args.volume.settings.gather()?)?;
    let slices = volume.frame.planes.slices();
    write(file, &sheet_of(&volume), &volume)?;
    say(args.volume.settings.quiet, &args.out, &format!("{} of {}", count_of(u64::from(slices), "slice"), volume.scene))
}

pub(super) fn slice(args: SliceArgs) -> Result<(), CliError> {
    let file = OutputFile::open(&args.out, "--out")?;
    // The slice's number is checked before anything is drawn.
    let settings = args.volume.settings.gather()?;
    let slices = settings.display.slices;
    if u64::from(args.slice) >= slices {
        return Err(CliError::usage(format!("K: expected a slice from 0 to {}, found {}", slices - 1, args.slice)));
    }
    let volume = args.volume.draw(&settings)?;
    let slice = volume.check_slice(args.slice)?;
    let picture = match args.show {
        Part::Both => before_and_after(&volume, slice),
        Part::Before => coloured(&volume, slice),
        Part::After => halftoned(&volume, slice),
        Part::Tiles => tiles_of_slice(&volume, slice, tiling(&volume)),
    };
    write(file, &picture, &volume)?;
    say(args.volume.settings.quiet, &args.out, &format!("slice {slice} of {}", volume.scene))
}

/// Returns the division of each slice into tiles. A slice that is not drawn in tiles counts as one tile.
fn tiling(volume: &Volume) -> Tiling {
    let size = volume.settings.tile.size as u32;
    Tiling { tile: (size > 0).then_some(size), batch: 1 }
}

pub(super) fn write(file: OutputFile, picture: &RgbImage, volume: &Volume) -> Result<(), CliError> {
    file.write(&png(picture, volume)?)
}

pub(super) fn say(quiet: bool, path: &Path, what: &str) -> Result<(), CliError> {
    if quiet { Ok(()) } else { print(&format!("{}: {what}.\n", path.display())) }
}
