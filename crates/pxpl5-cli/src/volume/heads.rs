//! The command `pxpl5 volume view --head`, which compares a volume with a head-mounted display for a moving head.

use super::settings::{VolumeSettingArgs, origin};
use crate::error::CliError;
use crate::numbers::{count_of, whole};
use crate::output::OutputFolder;
use crate::progress::Bar;
use crate::terminal::{json_text, print};
use clap::Args;
use pxpl5::lab::motion;
use pxpl5::views::Animation;
use pxpl5::views::charts::{ChartAxes, ChartSeries, decade_chart};
use pxpl5::views::results::csv_of;
use pxpl5::volume::heads::{HeadComparison, HeadSample, HeadStudy, HeadStudyConfig};
use std::path::Path;

/// Options of a viewer whose head moves around the volume.
#[derive(Args, Debug)]
pub(super) struct HeadArgs {
    /// Show the volume to a moving head, and compare it with a head-mounted display. Motions: still, pan:DEG_PER_S,
    /// slide:M_PER_S, sine:DEG:HZ, pendulum, synthetic:SEED or a recording (FILE.csv, FILE.txt, FILE.tum or
    /// FILE.jsonl).
    #[arg(long, value_name = "MOTION", conflicts_with_all = ["azimuth", "elevation", "distance", "cut", "lambert", "undithered", "exposure"])]
    pub(super) head: Option<String>,
    /// Latency of the head-mounted display, ms; default: the estimated latency of the volume itself.
    #[arg(long, value_name = "MS", requires = "head", allow_negative_numbers = true)]
    latency: Option<f64>,
    /// Duration of the head's motion, seconds.
    #[arg(long, value_name = "S", requires = "head", default_value_t = 2.0, allow_negative_numbers = true)]
    seconds: f64,
    /// Number of pictures in the film; errors are evaluated at eight times as many instants.
    #[arg(long, value_name = "N", requires = "head", default_value_t = 24, value_parser = whole::<u32>(2, 2000))]
    frames: u32,
}

/// Number of instants per picture of the film at which errors are evaluated.
const INSTANTS_PER_FRAME: u32 = 8;

pub(super) fn run(
    name: &str,
    args: &HeadArgs,
    options: &VolumeSettingArgs,
    side: u32,
    out: &Path,
) -> Result<(), CliError> {
    // The renderer accepts only pictures whose width is a multiple of 8.
    if !side.is_multiple_of(8) {
        return Err(CliError::usage(format!("--size: expected a multiple of 8 with --head, found {side}")));
    }
    let motion = motion(name).map_err(|error| CliError::usage(format!("--head: {error}")))?;
    let mut folder = OutputFolder::of_run(out, "volume view")?;
    let settings = options.settings.gather()?;
    let volume = options.draw(&settings)?;
    let threads = options.settings.threads();
    let before = HeadComparison::new(&volume, motion.as_ref(), args.latency)?;
    let question =
        HeadStudyConfig { latency_ms: args.latency, seconds: args.seconds, instants: args.frames * INSTANTS_PER_FRAME };
    let study = before.study(&question)?;
    let json = json_text(&study)?;
    // Write the report and the errors, then render the film with the exposure of its first picture.
    folder.put("report.json", json.as_bytes())?;
    folder.put("errors.csv", csv_of(&study.samples).as_bytes())?;
    folder.put("errors.svg", errors_svg(&study, name).as_bytes())?;
    // All pictures have one exposure, so that the film does not flicker.
    let instants = before.film_instants(&question, args.frames)?;
    let exposure = before.exposure(instants[0], side, &threads)?;
    let mut bytes = Vec::new();
    let rate = (f64::from(args.frames - 1) / args.seconds).round().clamp(1.0, 1000.0) as u16;
    let size = (2 * side, 2 * side);
    let mut film =
        Animation::begin(&mut bytes, size, args.frames, (1, rate), &origin(&volume)).map_err(CliError::failure)?;
    let mut bar = Bar::new("pictures", options.settings.quiet);
    for (done, time_ps) in (1..).zip(instants) {
        film.add(&before.picture(time_ps, side, exposure, &threads)?).map_err(CliError::failure)?;
        bar.advance(done, u64::from(args.frames));
        bar.check("nothing was written")?;
    }
    bar.clear();
    film.finish().map_err(CliError::failure)?;
    folder.put("eyes.png", &bytes)?;
    folder.commit()?;
    if options.settings.quiet { Ok(()) } else { print(&text(&study, name, out)) }
}

/// Returns a chart of angles over time: the error due to latency, the size of a voxel and the size of a dither cell.
fn errors_svg(study: &HeadStudy, motion: &str) -> String {
    let axes = ChartAxes {
        title: format!(
            "{}, head {motion}: a head-mounted display {:.0} ms late, and a volume",
            study.scene, study.latency_ms
        ),
        across: "time, s".to_owned(),
        up: "angle seen by the eye, degrees".to_owned(),
    };
    // A missing value is a gap in the curve.
    let curve = |name: &str, value: &dyn Fn(&HeadSample) -> Option<f64>| {
        let points = study.samples.iter().map(|sample| (sample.time_s, value(sample).unwrap_or(f64::NAN)));
        ChartSeries::line(name, &points.collect::<Vec<_>>())
    };
    let curves = vec![
        curve("head-mounted: worst", &|sample| sample.hmd_worst_deg),
        curve("head-mounted: mean", &|sample| sample.hmd_mean_deg),
        curve("one of its pixels", &|_| Some(study.hmd_pixel_deg)),
        curve("volume: dither cell", &|sample| Some(sample.dither_cell_deg)),
        curve("volume: worst voxel", &|sample| Some(sample.voxel_worst_deg)),
        curve("volume: mean voxel", &|sample| Some(sample.voxel_mean_deg)),
    ];
    decade_chart(axes, curves)
}

fn mean(study: &HeadStudy, value: impl Fn(&HeadSample) -> Option<f64>) -> f64 {
    let values: Vec<f64> = study.samples.iter().filter_map(value).collect();
    values.iter().sum::<f64>() / values.len() as f64
}

fn text(study: &HeadStudy, motion: &str, out: &Path) -> String {
    let own = study.volume_latency_ms.map_or_else(|| "unknown".to_owned(), |ms| format!("{ms:.1} ms"));
    format!(
        "{} before a head that moves as {motion}, {}\n\
         head-mounted display, {:.1} ms late ({}): mean error {:.3} degrees, {:.1} of its pixels, {:.1} mm\n\
         volume: mean error of voxels {:.4} degrees, {:.3} mm; a dither cell {:.3} degrees; latency of changes {own}\n\
         {}: report.json, errors.csv, errors.svg, eyes.png.\n",
        study.scene,
        count_of(study.samples.len(), "instant"),
        study.latency_ms,
        study.latency_is,
        mean(study, |sample| sample.hmd_mean_deg),
        mean(study, |sample| sample.hmd_mean_px),
        mean(study, |sample| sample.hmd_mean_mm),
        mean(study, |sample| Some(sample.voxel_mean_deg)),
        mean(study, |sample| Some(sample.voxel_mean_mm)),
        mean(study, |sample| Some(sample.dither_cell_deg)),
        out.display()
    )
}
