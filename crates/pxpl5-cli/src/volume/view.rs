//! The commands `pxpl5 volume view` and `pxpl5 volume film`, which draw a volume as seen by an eye in front of the
//! display.

use super::heads::{self, HeadArgs};
use super::settings::{VolumeSettingArgs, origin};
use super::slices::{say, write};
use crate::error::CliError;
use crate::numbers::{count_of, whole};
use crate::output::OutputFile;
use crate::progress::Bar;
use clap::Args;
use pxpl5::views::Animation;
use pxpl5::volume::VolumeSettings;
use pxpl5::volume::pictures::EyeView;
use std::path::PathBuf;

/// Options of the eye that looks at a volume.
#[derive(Args, Debug)]
struct EyeArgs {
    /// Direction of the eye around the axis, from +z to +x, in degrees.
    #[arg(long, value_name = "DEG", default_value_t = 40.0, allow_negative_numbers = true)]
    azimuth: f64,
    /// Direction of the eye above the horizon, in degrees.
    #[arg(long, value_name = "DEG", default_value_t = 25.0, allow_negative_numbers = true)]
    elevation: f64,
    /// Distance from the eye to the middle of the display, in radii of the display.
    #[arg(long, value_name = "RADII", default_value_t = 4.0, allow_negative_numbers = true)]
    distance: f64,
    /// Width and height of the picture, pixels.
    #[arg(long, value_name = "PX", default_value_t = 512, value_parser = whole::<u32>(1, 8192))]
    size: u32,
    /// Cut away the part of the volume between two angles, in degrees around the axis from +x to +z.
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true, value_parser = cut)]
    cut: Option<[f64; 2]>,
    /// Dim each pixel according to the angle between the screen and the eye.
    #[arg(long)]
    lambert: bool,
}

/// Render what an eye sees during one turn of the display: the sum of all lit pixels of all slices.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 volume view --scene head --azimuth 40 --elevation 25 --out view.png
  pxpl5 volume view --scene head --cut 0:90 --out cutaway.png
  pxpl5 volume view --scene mig --undithered --lambert --out undithered.png
  pxpl5 volume view --scene mig --head synthetic:1 --seconds 4 --latency 60 --out out/head

With --head, the command writes report.json, errors.csv, errors.svg and the film eyes.png to DIR. The upper half of the film shows the
volume as seen by the left and the right eye. The lower half shows the pictures of a head-mounted display with the given latency.")]
pub(super) struct ViewArgs {
    #[command(flatten)]
    volume: VolumeSettingArgs,
    #[command(flatten)]
    eye: EyeArgs,
    /// Show the colours as they are before halftoning.
    #[arg(long)]
    undithered: bool,
    /// Brightness of one lit pixel of one slice, in units of 1/255; default: 98 % of the picture stays below white.
    #[arg(long, value_name = "STEPS", allow_negative_numbers = true)]
    exposure: Option<f64>,
    #[command(flatten)]
    head: HeadArgs,
    /// The file to write (PNG); with --head a folder.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// Write an animated PNG in which the eye goes once around the volume, with the same exposure for all pictures.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 volume film --scene mig --frames 60 --size 256 --out turn.png

Browsers play the file.")]
pub(super) struct FilmArgs {
    #[command(flatten)]
    volume: VolumeSettingArgs,
    #[command(flatten)]
    eye: EyeArgs,
    /// Number of pictures in one turn around the volume.
    #[arg(long, value_name = "N", default_value_t = 72, value_parser = whole::<u32>(1, 10_000))]
    frames: u32,
    /// Number of pictures per second in the film.
    #[arg(long, value_name = "HZ", default_value_t = 24, value_parser = whole::<u16>(1, 1000))]
    rate: u16,
    /// The file to write (PNG).
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// Parses the value of `--cut`: two angles separated by a colon, such as `0:90`.
fn cut(text: &str) -> Result<[f64; 2], String> {
    let angles = text.split_once(':').and_then(|(from, to)| Some([from.parse().ok()?, to.parse().ok()?]));
    let finite = angles.filter(|angles: &[f64; 2]| angles.iter().all(|angle| angle.is_finite()));
    finite.ok_or_else(|| format!("expected two angles such as 0:90, found {text}"))
}

impl EyeArgs {
    /// Returns the settings of the eye. Fails if the eye cannot see the volume.
    fn eye_view(&self, settings: &VolumeSettings) -> Result<EyeView, CliError> {
        let mut view = EyeView::around(settings, self.azimuth, self.elevation, self.size);
        view.camera.distance = self.distance * settings.radius();
        view.options.cut_deg = self.cut;
        view.options.lambert = self.lambert;
        view.check(settings)?;
        Ok(view)
    }
}

pub(super) fn view(args: ViewArgs) -> Result<(), CliError> {
    // With --head the command writes a folder instead of a picture.
    if let Some(motion) = &args.head.head {
        return heads::run(motion, &args.head, &args.volume, args.eye.size, &args.out);
    }
    let exposure = args.exposure.filter(|steps| steps.is_finite() && *steps > 0.0);
    if let (Some(found), None) = (args.exposure, exposure) {
        return Err(CliError::usage(format!("--exposure: expected a number above 0, found {found}")));
    }
    let file = OutputFile::open(&args.out, "--out")?;
    let settings = args.volume.settings.gather()?;
    let view = EyeView { is_undithered: args.undithered, ..args.eye.eye_view(&settings)? };
    let volume = args.volume.draw(&settings)?;
    let picture = view.picture(&volume, exposure, &args.volume.settings.threads())?;
    write(file, &picture, &volume)?;
    let from = format!("{} from azimuth {}, elevation {}", volume.scene, args.eye.azimuth, args.eye.elevation);
    say(args.volume.settings.quiet, &args.out, &from)
}

pub(super) fn film(args: FilmArgs) -> Result<(), CliError> {
    let file = OutputFile::open(&args.out, "--out")?;
    let settings = args.volume.settings.gather()?;
    let view = args.eye.eye_view(&settings)?;
    let volume = args.volume.draw(&settings)?;
    let threads = args.volume.settings.threads();
    let mut bytes = Vec::new();
    let size = (args.eye.size, args.eye.size);
    // Pictures are encoded one by one, so that only one is in memory.
    let mut animation =
        Animation::begin(&mut bytes, size, args.frames, (1, args.rate), &origin(&volume)).map_err(CliError::failure)?;
    let mut bar = Bar::new("pictures", args.volume.settings.quiet);
    for (done, picture) in (1..).zip(view.film(&volume, args.frames, &threads)) {
        animation.add(&picture?).map_err(CliError::failure)?;
        bar.advance(done, u64::from(args.frames));
        bar.check("nothing was written")?;
    }
    bar.clear();
    animation.finish().map_err(CliError::failure)?;
    file.write(&bytes)?;
    say(
        args.volume.settings.quiet,
        &args.out,
        &format!("{} of a turn around {}", count_of(u64::from(args.frames), "picture"), volume.scene),
    )
}
