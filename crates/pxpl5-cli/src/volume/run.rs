//! The command `pxpl5 volume run`, which draws one volume and prints a report about the volume.

use super::settings::{VolumeSettingArgs, png};
use crate::error::CliError;
use crate::numbers::count_of;
use crate::output::OutputFolder;
use crate::terminal::{Column, answer, columns_text, json_text};
use clap::Args;
use pxpl5::views::results::csv_table;
use pxpl5::volume::pictures::{EyeView, before_and_after, sheet, tile_map};
use pxpl5::volume::pixel_planes::{BoundRow, SimulatedRow};
use pxpl5::volume::{PixelPlanesReport, Volume, VolumeReport};
use std::fmt::Write as _;
use std::path::PathBuf;

/// Draw a volume and print its counts.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 volume run --scene mig --clip hyperbolic:0.25 --projection jittered --seed 1 --out out/volume --json
  pxpl5 volume run --scene head --set display.slices=200 --set display.spin_rpm=600
  pxpl5 volume run --scene molecules --clip exact --set gpu.readback_mb_s=1000
  pxpl5 volume run --scene head --strobes mirror --coverage connected
  pxpl5 volume run --scene mig --projection orthographic --strobes mirror --on pixel-planes")]
pub(super) struct RunArgs {
    #[command(flatten)]
    volume: VolumeSettingArgs,
    /// Write report.json, slices.csv and pictures into this folder. The pictures show all slices on one sheet, slice 0
    /// before and after halftoning, the tiles of all batches of slices, and the volume as an eye sees it.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the report as one JSON object.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: RunArgs) -> Result<(), CliError> {
    // Open the output first, so that a bad path fails before the volume is drawn.
    let folder = args.out.as_deref().map(|out| OutputFolder::of_run(out, "volume run")).transpose()?;
    let volume = args.volume.draw(&args.volume.settings.gather()?)?;
    let report = volume.report();
    let json = json_text(&report)?;
    let threads = args.volume.settings.threads();
    if let Some(mut folder) = folder {
        folder.put("report.json", json.as_bytes())?;
        folder.put("slices.csv", slices_csv(&volume).as_bytes())?;
        folder.put("sheet.png", &png(&sheet(&volume), &volume)?)?;
        folder.put("slice-0.png", &png(&before_and_after(&volume, 0), &volume)?)?;
        // A volume without tiles has no map of tiles.
        if let Some(map) = tile_map(&volume) {
            folder.put("tiles.png", &png(&map, &volume)?)?;
        }
        let view = EyeView::around(&volume.settings, 40.0, 25.0, 512);
        folder.put("view.png", &png(&view.picture(&volume, None, &threads)?, &volume)?)?;
        folder.commit()?;
    }
    answer(args.json, args.volume.settings.quiet, &json, || text(&report, args.out.as_deref()))
}

/// Closed-form bounds for several sizes of the machine.
const BOUNDS: [Column<BoundRow>; 8] = [
    ("renderers", |row| row.renderers.to_string()),
    ("processors", |row| row.processors.to_string()),
    ("renderers, ms", |row| format!("{:.1}", row.ms[0])),
    ("ring, ms", |row| format!("{:.1}", row.ms[1])),
    ("port, ms", |row| format!("{:.1}", row.ms[2])),
    ("processors, ms", |row| format!("{:.1}", row.ms[3])),
    ("volumes/s", |row| format!("{:.2}", row.volumes_hz)),
    ("limited by", |row| row.limited_by.to_string()),
];

/// The simulation of all events, which shows how close the machine comes to the bounds, because they ignore waiting.
const SIMULATED: [Column<SimulatedRow>; 8] = [
    ("renderers", |row| row.renderers.to_string()),
    ("processors", |row| row.processors.to_string()),
    ("ms", |row| format!("{:.1}", row.ms)),
    ("over bound", |row| format!("{:.1} %", row.over_bound_percent)),
    ("volumes/s", |row| format!("{:.2}", row.volumes_hz)),
    ("renderers busy", |row| format!("{:.1} %", row.renderers_busy_percent)),
    ("processors busy", |row| format!("{:.1} %", row.processors_busy_percent)),
    ("channels busy", |row| format!("{:.1} %", row.channels_busy_percent)),
];

/// Describes the work of the renderers, and the part of the machine that limits the number of volumes per second.
fn bounds(planes: &PixelPlanesReport) -> String {
    let work = &planes.counts.work;
    let mut text = format!(
        "\nPixel-Planes 5: {} slice triangles, {} commands in {} regions, {} left out, {} clocks\n",
        work.triangles, work.commands, work.regions, work.left_out, work.clocks
    );
    text.push_str(&columns_text(&BOUNDS, &planes.bounds, 0));
    if !planes.simulated.is_empty() {
        text.push_str("\nOne volume event by event\n");
        text.push_str(&columns_text(&SIMULATED, &planes.simulated, 0));
    }
    text
}

fn slices_csv(volume: &Volume) -> String {
    let columns = ["slice", "draws", "fragments_generated", "fragments_accepted", "fragments_added"];
    // Renderers of Pixel-Planes 5 do not count fragments.
    let counts = volume.bounds.is_none();
    let rows = volume.frame.stats.slices.iter().enumerate().map(|(slice, stats)| {
        let fragments =
            [stats.generated, stats.accepted].map(|count| if counts { count.to_string() } else { String::new() });
        let [generated, accepted] = fragments;
        [slice.to_string(), stats.draws.to_string(), generated, accepted, stats.added.to_string()]
    });
    csv_table(columns, rows)
}

/// Cell of a quantity that exists only if a GPU drew the volume.
const NOT_COUNTED: &str = "- (no GPU drew it)";

fn fragments(report: &VolumeReport) -> String {
    match (report.fragments_accepted, report.fragments_generated) {
        (Some(accepted), Some(generated)) => format!("{accepted} accepted of {generated} generated"),
        _ => NOT_COUNTED.to_owned(),
    }
}

fn model_of_time(report: &VolumeReport) -> String {
    let Some(model) = &report.model_ms else { return NOT_COUNTED.to_owned() };
    format!("processor {:.1} ms, GPU {:.1} ms, bus {:.1} ms", model.cpu.ms, model.gpu.ms, model.bus.ms)
}

fn volumes_a_second(report: &VolumeReport) -> String {
    match (report.volumes_hz_serial, report.volumes_hz_overlapped) {
        (Some(serial), Some(overlapped)) => {
            let eye = report.display.volumes_hz;
            format!("{serial:.2} one after the other, {overlapped:.2} overlapped; the eye gets {eye}")
        }
        _ => NOT_COUNTED.to_owned(),
    }
}

fn text(report: &VolumeReport, out: Option<&std::path::Path>) -> String {
    let display = &report.display;
    let mut text = format!(
        "{} ({}) on {}: {} of {} x {}, {} rpm\nclip {}, projection {}, seed {}\n\n",
        report.scene,
        count_of(report.triangles, "primitive"),
        display.name,
        count_of(display.slices, "slice"),
        display.width,
        display.height,
        display.spin_rpm,
        report.clip,
        report.projection,
        report.seed
    );
    let draws = 100.0 * report.draws as f64 / report.draws_unbinned.max(1) as f64;
    let megabytes = |bytes: u64| format!("{:.1} MB", bytes as f64 / 1e6);
    // Counts of the drawing, then the model of its time.
    let rows = [
        (
            "slices drawn",
            format!("{} in {} passes, {} empty", report.slices_rendered, report.passes, report.slices_empty),
        ),
        ("draws", format!("{} of {} ({draws:.1} %)", report.draws, report.draws_unbinned)),
        ("fragments", fragments(report)),
        ("tiles occupied", format!("{:.1} % of {} queried", report.tile_occupancy_percent, report.queries)),
        (
            "bytes",
            format!(
                "{} unpacked, {} packed, {} sent",
                megabytes(report.bytes_unpacked),
                megabytes(report.bytes_packed),
                megabytes(report.bytes_sent)
            ),
        ),
        ("lit voxels", report.lit_voxels.to_string()),
        ("connected", format!("{:.1} %", report.connected_percent)),
        ("outside the volume", format!("{} with a corner outside", count_of(report.outside_volume, "primitive"))),
        ("modelled times", model_of_time(report)),
        ("volumes per second", volumes_a_second(report)),
        ("volume hash", report.volume_hash.clone()),
        ("host time", format!("{:.2} s", report.host_seconds)),
    ];
    for (name, value) in rows {
        let _ = writeln!(text, "{name:<20} {value}");
    }
    // Only volumes drawn by Pixel-Planes 5 have bounds.
    if let Some(planes) = &report.pixel_planes {
        text.push_str(&bounds(planes));
    }
    if !report.beyond_paper.is_empty() {
        let _ = writeln!(text, "\nBeyond the paper: {}.", report.beyond_paper.join(", "));
    }
    if let Some(path) = out {
        let _ = writeln!(text, "\nWritten to {}.", path.display());
    }
    text
}
