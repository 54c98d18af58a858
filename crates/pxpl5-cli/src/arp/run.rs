//! The command `pxpl5 arp run`, which simulates one walk of a viewer along a path.

use super::settings::{FEWER_FRAMES, WalkArgs, put};
use crate::error::CliError;
use crate::interrupt;
use crate::numbers::{count_of, dash};
use crate::output::OutputFolder;
use crate::progress::Progress;
use crate::terminal::{answer, json_text};
use crate::version::{VERSION, commit_text};
use clap::Args;
use pxpl5::Fingerprint;
use pxpl5::arp::pictures::of_walk;
use pxpl5::arp::{ArpReport, TearWidths, WalkMemoryReport, WalkOutcome, WalkReport};
use pxpl5::lab::walks::WalkQuery;
use pxpl5::scene::Scene;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Simulate one walk of a viewer through a scene. Print how often parts of objects are drawn, the update rates, and the
/// widths of the gaps where objects are cut.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 arp run --scene gallery --out out/walk --json
  pxpl5 arp run --scene gallery:full --policy objects --segment off
  pxpl5 arp run --warp none --set walk.hall_scale=0.5 --set walk.frames=7200
  pxpl5 arp run --set priority.ring_growth=1 --set priority.threshold=1texel --set priority.cell_m=5
  pxpl5 arp run --lens radial:0.32 --latch line --set arp.face_texels=1024
  pxpl5 arp run --source 20000                             a renderer that draws 20,000 triangles per second")]
pub(super) struct RunArgs {
    #[command(flatten)]
    walk: WalkArgs,
    /// Write report.json, experiment.toml (which makes the walk again), frames.csv and pictures into this folder. Some pictures show the cube faces of all display
    /// memories, and the view of the eye with its lens and (up to 170 degrees) without a lens. Others show the memory
    /// chosen at each pixel, errors, the cells from above, the cuts as wires, and updates. The rest show the scene with
    /// gaps at the cuts, with warping, and without cuts.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the report as one JSON object.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: RunArgs) -> Result<(), CliError> {
    // Open the output first, so that a bad path fails before the walk.
    let folder = args.out.as_deref().map(|out| OutputFolder::of_run(out, "arp run")).transpose()?;
    let (scene, plan) = args.walk.gather()?;
    let study = WalkQuery { scene, plan, has_pictures: args.out.is_some() };
    let outcome = Progress::new("frames", args.walk.quiet).run_within(args.walk.budget, FEWER_FRAMES, &study)?;
    let json = json_text(&outcome)?;
    // A part of the walk does not replace the files of a whole one.
    if let Some(mut folder) = folder.filter(|_| !interrupt::flag().is_stopped()) {
        folder.put("report.json", json.as_bytes())?;
        folder.put("experiment.toml", experiment(&outcome, &study.scene).as_bytes())?;
        folder.put("frames.csv", frames_csv(&outcome).as_bytes())?;
        // The pictures need the scene at all poses, so they are drawn only for an output folder.
        let walk = &study.plan.walk;
        let pictures =
            of_walk(outcome.world.clone(), &outcome.path, &outcome.settings, walk.m_per_s, outcome.report.frames)?;
        put(&mut folder, &pictures, &origin(&outcome))?;
        folder.commit()?;
    }
    answer(args.json, args.walk.quiet, &json, || text(&outcome, args.out.as_deref()))
}

/// Returns the settings of the walk as a file for `pxpl5 arp run`, with the origin of the results in comments.
fn experiment(outcome: &WalkOutcome, scene: &Scene) -> String {
    let WalkReport { scene: name, settings, .. } = &outcome.report;
    let mut hash = Fingerprint::of_scene(scene);
    settings.iter().for_each(|(path, value)| hash.setting(path, value));
    let lines = settings.iter().map(|(path, value)| format!("{path} = {value:?}\n"));
    format!(
        "# version: {VERSION}\n# commit: {}\n# config_hash: {hash}\nscene = {name:?}\n{}",
        commit_text(),
        lines.collect::<String>()
    )
}

fn origin(outcome: &WalkOutcome) -> Vec<(&'static str, String)> {
    let report = &outcome.report;
    let settings: Vec<String> = report.settings.iter().map(|(path, value)| format!("{path}={value}")).collect();
    vec![
        ("version", VERSION.to_owned()),
        ("commit", commit_text().to_owned()),
        ("scene", report.scene.clone()),
        ("frames", report.frames.to_string()),
        ("m_per_s", report.m_per_s.to_string()),
        ("settings", settings.join(" ")),
    ]
}

/// Returns the text of frames.csv. Each line has the position of the eye in one frame. For each display memory, the
/// line has three columns with 1 or 0: update due, update shown, update missed.
fn frames_csv(outcome: &WalkOutcome) -> String {
    let memories = outcome.tally.memories.len();
    let columns = (0..memories).map(|k| format!(",due_{k},shown_{k},missed_{k}")).collect::<String>();
    let mut text = format!("frame,x_m,y_m,z_m,reassigns_cells{columns}\n");
    for (number, frame) in outcome.tally.outcomes.iter().enumerate() {
        let [x, y, z] = frame.eye.to_array();
        let _ = write!(text, "{number},{x},{y},{z},{}", u8::from(frame.reassigns_cells));
        // Three columns for each memory: update due, picture shown, update missed.
        for k in 0..memories {
            let [due, shown, missed] = [&frame.due, &frame.swapped, &frame.missed].map(|list| u8::from(list[k]));
            let _ = write!(text, ",{due},{shown},{missed}");
        }
        text.push('\n');
    }
    text
}

fn text(outcome: &WalkOutcome, out: Option<&Path>) -> String {
    let walk = &outcome.report;
    let report = &walk.report;
    let mut text = format!(
        "{} ({} in {}): {} at {} m/s, policy {}\n\n{:>6} {:>10} {:>10} {:>10} {:>8} {:>12}\n",
        walk.scene,
        count_of(walk.triangles, "triangle"),
        count_of(walk.segments, "segment"),
        count_of(walk.frames, "frame"),
        walk.m_per_s,
        report.priority.policy,
        "memory",
        "updates/s",
        "segments",
        "triangles",
        "missed",
        "eye age, mm"
    );
    report.memories.iter().enumerate().for_each(|(k, memory)| line(&mut text, k, memory));
    let priority = &report.priority;
    let rows = [
        ("segments drawn per second", format!("{:.0} ({:.1} % saved)", priority.draws_per_s, priority.saved_percent)),
        ("triangles drawn per second", format!("{:.0}", outcome.triangles_per_s())),
        ("new assignments of cells", priority.redeals.map_or_else(dash, |n| n.to_string())),
        ("objects that changed memory", priority.moved_objects.map_or_else(dash, |n| n.to_string())),
        ("tears without warping, texels", widths(report.tears_texels.before)),
        ("tears as displayed, texels", widths(report.tears_texels.after)),
        ("moved by warping, texels", widths(report.tears_texels.stretch)),
        ("pipeline", format!("{} ns, before each {}", report.pipeline_ns, report.latch)),
        ("from latch to light", report.rotation_latency_ms.total.map_or_else(dash, |ms| format!("{ms:.3} ms, mean"))),
        ("from eye position to light", steps(report)),
        ("bytes per memory", report.memories.first().map_or(0, |memory| memory.bytes).to_string()),
    ];
    text.push('\n');
    for (name, value) in rows {
        let _ = writeln!(text, "{name:<29} {value}");
    }
    if let Some(path) = out {
        let _ = writeln!(text, "\nWritten to {}.", path.display());
    }
    text
}

/// Formats the mean latency of each display memory, in ms. The latency is the time from a translation of the head until
/// the picture of the memory is lit.
fn steps(report: &ArpReport) -> String {
    let totals = report.memories.iter().map(|memory| memory.translation_latency_ms.total);
    let totals: Vec<String> = totals.map(|total| total.map_or_else(dash, |ms| format!("{ms:.1}"))).collect();
    format!("{} ms", totals.join(", "))
}

fn line(text: &mut String, number: usize, memory: &WalkMemoryReport) {
    let WalkMemoryReport { updates_hz, segments, missed, eye_age_mm, .. } = memory;
    let triangles = memory.triangles.map_or_else(dash, |triangles| format!("{triangles:.0}"));
    let _ = writeln!(
        text,
        "{number:>6} {updates_hz:>10.2} {segments:>10.1} {triangles:>10} {missed:>8} {eye_age_mm:>12.2}"
    );
}

/// Formats the median, the 95th percentile and the maximum of the widths of tears. Widths below 1e-6 are rounding
/// errors and appear as 0.
pub(super) fn widths(widths: Option<TearWidths>) -> String {
    let number = |width: f64| if width < 1e-6 { "0".to_owned() } else { format!("{width:.2}") };
    widths.map_or_else(dash, |TearWidths { p50, p95, max }| [p50, p95, max].map(number).join(", "))
}
