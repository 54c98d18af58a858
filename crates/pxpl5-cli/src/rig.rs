//! The command `pxpl5 rig`. A simulated pendulum measures the latency of a system from outside, as in the paper I3D95.
//! The command compares this latency with the latency from time stamps inside the system.

use crate::error::CliError;
use crate::numbers::whole;
use crate::progress::Progress;
use crate::settings::SettingArgs;
use crate::terminal::{AnswerArgs, json_text};
use clap::Args;
use pxpl5::Statistics;
use pxpl5::rig::{PASSES, Rig, RigQuery, RigReport};
use pxpl5::tracking::rig::{Measurement, Side};
use pxpl5::{ExperimentFile, Plan};
use std::fmt::Write;

/// Measure the latency of a pipeline from outside with a pendulum and photodiodes, and compare it with the pipeline's
/// time stamps.
///
/// A tracker on a pendulum's bob feeds the host. When the host detects the low point, the host starts a frame. Frames
/// alternate between dark and light under a photodiode in the middle of a line of the screen. The pipeline draws
/// nothing else, so a frame never waits for earlier frames. Displays that follow the head's rotation and frameless
/// rendering are refused, because their light does not identify a frame. A disagreement between outside and inside
/// measurements is an error.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 rig --pipeline rendering-control
  pxpl5 rig --pipeline slats --tracker fastrak --passes 100 --json
  pxpl5 rig --pipeline rendering-control --machine large --set gp.triangle_ns=30000

The rig has its own scene, motion and length. The options --scene, --triangles, --head, --fields, --predict, --aim, --raster and --pixels
do not apply.")]
pub(crate) struct RigArgs {
    #[command(flatten)]
    settings: SettingArgs,
    /// Number of passes of the pendulum through its low point to measure, 2 to 10,000.
    #[arg(long, default_value_t = PASSES as u64, value_name = "N", value_parser = whole::<u64>(2, 10_000))]
    passes: u64,
    /// Position of the photodiode: line of a field on the screen, 0 at the top; default 120, the middle of NTSC's 240.
    #[arg(long, value_name = "N")]
    line: Option<u32>,
    #[command(flatten)]
    answer: AnswerArgs,
}

/// Keys with values from the command itself, which the user must not set.
const KEYS_SET_BY_RIG: [&str; 9] =
    ["scene", "triangles", "head.motion", "head.place", "head.predict", "head.aim", "head.raster", "fields", "pixels"];

/// Keys of motions along a path in front of a scene. The rig has no such motion.
const KEYS_OF_PATH: [&str; 4] = ["head.path", "head.sway", "head.distance", "head.deg_per_s"];

/// Runs the command `pxpl5 rig`. Fails if nothing can be measured, or if the latency from outside differs from the
/// latency by time stamps.
pub(crate) fn run(args: RigArgs) -> Result<(), CliError> {
    let plan = plan(args.settings.gather()?)?;
    let tracker = plan.head.as_ref().map(|head| head.head().tracker().config().clone());
    let tracker = tracker.ok_or_else(|| CliError::failure("no tracker"))?;
    // Options replace single values of the assumed rig.
    let mut rig = Rig { seed: plan.seed, passes: args.passes as usize, ..Rig::assumed(tracker) };
    rig.rig.photodiode_line = args.line.unwrap_or(rig.rig.photodiode_line);
    let study = RigQuery { rig, machine: plan.machine.clone(), pipeline: plan.pipeline.clone() };
    let report =
        Progress::new("fields", args.answer.quiet).run_within(args.answer.budget, "measure fewer --passes", &study)?;
    let measured = &report.measured;
    // The result is printed even if both sides disagree.
    args.answer.print(&json_text(&report)?, || text(&report))?;
    if report.agrees { Ok(()) } else { Err(CliError::failure(verdict(measured))) }
}

/// Returns the experiment of the measurement. The user chooses pipeline, machine, tracker and seed. The command sets
/// scene and motion.
fn plan(mut file: ExperimentFile) -> Result<Plan, CliError> {
    if let Some(key) = file.keys().find(|key| KEYS_SET_BY_RIG.contains(key) || KEYS_OF_PATH.contains(key)) {
        return Err(CliError::usage(format!(
            "{key}: does not apply to the rig, which has its own scene, motion and length"
        )));
    }
    file.set("scene", "full-screen:2", "the rig")?;
    file.set("head.motion", "pendulum", "the rig")?;
    Ok(file.resolve()?)
}

type Column = (&'static str, fn(&Side) -> &Statistics);

fn text(report: &RigReport) -> String {
    let (outside, inside) = (&report.outside_ms, &report.inside_ms);
    let mut text = format!(
        "{} on {}: {} low points, {}, photodiode at line {}\n\n{:<20} {:^36} {:^36}\n",
        report.pipeline,
        report.machine,
        report.n,
        report.tracker,
        report.photodiode_line,
        "mean, sd (range) ms",
        "outside",
        "inside"
    );
    // The table compares the latencies that were measured from outside and from inside.
    let rows: [Column; 3] = [
        ("tracking latency", |side| &side.tracking),
        ("rendering latency", |side| &side.rendering),
        ("together", |side| &side.total),
    ];
    for (name, latency) in rows {
        let _ = writeln!(text, "{name:<20} {:^36} {:^36}", cell(latency(outside)), cell(latency(inside)));
    }
    let _ = writeln!(text, "\n{}", verdict(&report.measured));
    text.push_str(DEFINITIONS);
    text
}

const DEFINITIONS: &str = "
Outside, tracking: from the bob's low point to the step of the D/A line, which the program that starts the frame switches
(Rendering Control: the host, at SEND; Slats: the graphics processor, with its field).
Outside, rendering: from that step to the light of the frame under the photodiode.
Inside, tracking: from the time stamp of the report that shows the low point to the start of the frame.
Inside, rendering: from the start of the frame to the time at which the pipeline counts the frame as shown.
";

fn cell(latency: &Statistics) -> String {
    let Statistics { mean, sd, min, max, .. } = latency;
    format!("{:.2}, {:.2} ({:.2} to {:.2})", mean, sd, min, max)
}

fn verdict(measured: &Measurement) -> String {
    format!(
        "Outside minus inside: {:.2} ms. Expected: 0 to {:.2} ms of tracking (a report's interval) and {:.2} to {:.2} ms of rendering (the \
         photodiode's place in the scan). They {}.",
        measured.outside_less_inside_s() * 1e3,
        measured.tracking_bound_ps as f64 * 1e-9,
        // The subtraction from 0.0 avoids the output "-0.00".
        0.0 - measured.rendering_early_ps as f64 * 1e-9,
        measured.rendering_bound_ps as f64 * 1e-9,
        if measured.agrees() { "agree" } else { "DO NOT AGREE" }
    )
}
