//! The command `pxpl5 volume compare`. It draws one volume with each combination of a clip (a rule that cuts the scene
//! into slices) and a projection, and compares the results.

use super::settings::{SMALLER, VolumeSettingArgs};
use crate::error::CliError;
use crate::interrupt;
use crate::numbers::{count_of, dash, whole};
use crate::output::OutputFolder;
use crate::progress::Progress;
use crate::terminal::{Column, answer, columns_text, json_text};
use clap::Args;
use pxpl5::lab::volumes::VolumeComparisonQuery;
use pxpl5::views::charts::{ChartAxes, ChartSeries, curve_chart};
use pxpl5::views::png_bytes;
use pxpl5::views::results::csv_table;
use pxpl5::volume::compare::{ComparePoint, VariantRow, VolumeComparison};
use std::path::PathBuf;

/// Compare all clips (ways to cut the scene into slices) and projections. The results are brightness over radius, dead
/// zone, connected share, fragments, passes, and volumes per second.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 volume compare --scene mig
  pxpl5 volume compare --scene head --out out/head --json

The command draws every variant of clip, projection, samples and coverage. Of these options, only the numbers have an effect.")]
pub(super) struct CompareArgs {
    #[command(flatten)]
    volume: VolumeSettingArgs,
    /// Write into this folder: comparison.json, rows.csv, brightness.svg, and a picture of every variant as an eye sees
    /// it.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Width and height of each picture, pixels.
    #[arg(long, value_name = "PX", default_value_t = 256, value_parser = whole::<u32>(1, 4096))]
    size: u32,
    /// Print JSON: an object whose `variants` lists one row for each variant.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: CompareArgs) -> Result<(), CliError> {
    let mut folder = args.out.as_deref().map(|out| OutputFolder::of_run(out, "volume compare")).transpose()?;
    let options = &args.volume.settings;
    let settings = options.gather()?;
    // Pictures are rendered only for an output folder.
    let viewpoint =
        folder.is_some().then_some(ComparePoint { azimuth_deg: 40.0, elevation_deg: 25.0, side: args.size });
    let study = VolumeComparisonQuery { volume: args.volume.query(&settings)?, viewpoint };
    let comparison = Progress::new("volumes", options.quiet).run_within(options.budget, SMALLER, &study)?;
    let json = json_text(&comparison)?;
    // A part of the variants does not replace the files of a whole comparison.
    folder = folder.filter(|_| !interrupt::flag().is_stopped());
    if let Some(folder) = &mut folder {
        folder.put("comparison.json", json.as_bytes())?;
        folder.put("rows.csv", rows_csv(&comparison).as_bytes())?;
        folder.put("brightness.svg", brightness(&comparison).as_bytes())?;
        pictures(folder, &comparison)?;
    }
    folder.map(OutputFolder::commit).transpose()?;
    // Files and JSON hold all numbers; the terminal shows a table.
    answer(args.json, options.quiet, &json, || text(&comparison))
}

fn pictures(folder: &mut OutputFolder, comparison: &VolumeComparison) -> Result<(), CliError> {
    let texts = [("scene", comparison.scene.clone()), ("seed", comparison.seed.to_string())];
    let all =
        [("variants.png", comparison.clips_and_projections()), ("samples.png", comparison.samples_and_coverage())];
    for (name, picture) in all {
        if let Some(picture) = picture {
            folder.put(name, &png_bytes(&picture, &texts).map_err(CliError::failure)?)?;
        }
    }
    Ok(())
}

const COLUMNS: [Column<VariantRow>; 16] = [
    ("clip", |row| row.clip.clone()),
    ("projection", |row| row.projection.to_owned()),
    ("samples", |row| row.samples.to_string()),
    ("coverage", |row| row.coverage.to_owned()),
    ("passes", |row| row.passes.to_string()),
    ("fragments_generated", |row| row.fragments_generated.to_string()),
    ("fragments_accepted", |row| row.fragments_accepted.to_string()),
    ("draws_percent", |row| format!("{:.2}", row.draws_percent)),
    ("tiles_percent", |row| format!("{:.2}", row.tile_occupancy_percent)),
    ("connected_percent", |row| format!("{:.2}", row.connected_percent)),
    ("dead_zone_px", |row| row.dead_zone_radius_px.map_or_else(dash, |radius| radius.to_string())),
    ("lit_voxels", |row| row.lit_voxels.to_string()),
    ("over_exact_near", |row| over_exact(row, 1..4)),
    ("over_exact_far", |row| over_exact(row, 32..43)),
    ("volumes_hz_serial", |row| format!("{:.2}", row.volumes_hz_serial)),
    ("volumes_hz_overlapped", |row| format!("{:.2}", row.volumes_hz_overlapped)),
];

/// Formats the brightness of a volume divided by the brightness with exact clipping, as a mean over the rings `rings`
/// around the axis. Rings in which exact clipping lights no pixel are left out.
fn over_exact(row: &VariantRow, rings: std::ops::Range<usize>) -> String {
    let rings = row.brightness_over_exact.get(rings).unwrap_or_default();
    let all: Vec<f64> = rings.iter().flatten().copied().collect();
    if all.is_empty() { "-".to_owned() } else { format!("{:.2}", all.iter().sum::<f64>() / all.len() as f64) }
}

fn rows_csv(comparison: &VolumeComparison) -> String {
    let rows = comparison.variants.iter().map(|row| COLUMNS.map(|(_, cell)| cell(row)));
    csv_table(COLUMNS.map(|(name, _)| name), rows)
}

fn text(comparison: &VolumeComparison) -> String {
    let mut text =
        format!("{} ({}), seed {}\n\n", comparison.scene, count_of(comparison.triangles, "primitive"), comparison.seed);
    text.push_str(&columns_text(&COLUMNS, &comparison.variants, 2));
    text.push_str(
        "\nover_exact: lit pixels divided by those of the exact clip with the same projection, at 8 to 32 px and at 256 to 344 px from the axis;\n\
         connected_percent: share of the mesh's intersections with the slices that is shown; volumes/s: rate of the model, with its parts one after\n\
         the other and at the same time. The paper rejects more than one sample as too expensive; connected is beyond the paper.\n",
    );
    text
}

/// Returns a chart of the number of lit pixels over the distance from the axis, divided by the width of a ring in
/// pixels. The chart has one curve for each clip (a rule that cuts the scene into slices), projected along the normal.
fn brightness(comparison: &VolumeComparison) -> String {
    let axes = ChartAxes {
        title: format!("Lit pixels over radius: {}, along the normal", comparison.scene),
        across: "distance from the axis, px".to_owned(),
        up: "lit pixels of all slices, a pixel of radius".to_owned(),
    };
    let ring = f64::from(comparison.ring_px);
    // Only variants that differ in the clip are comparable in one chart.
    let plain = comparison.variants.iter().filter(|row| row.projection == "orthographic" && row.samples == 1);
    let curves = plain.filter(|row| row.coverage == "sampled").map(|row| {
        let points = row.brightness_by_radius.iter().enumerate();
        let points = points.map(|(i, lit)| ((i as f64 + 0.5) * ring, *lit as f64 / ring));
        ChartSeries::line(&row.clip, &points.collect::<Vec<_>>())
    });
    curve_chart(axes, curves.collect())
}
