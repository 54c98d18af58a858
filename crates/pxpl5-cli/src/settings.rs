//! Options that describe an experiment. Each option sets one key of an experiment file.

use crate::error::CliError;
use crate::numbers::signed;
use crate::options::{PipelineOptions, option_of, registry};
use clap::Args;
use pxpl5::{ExperimentFile, Raster};
use std::path::PathBuf;

/// An experiment file and the options that override its keys.
#[derive(Args, Debug, Default)]
pub(crate) struct SettingArgs {
    /// Experiment file (TOML).
    #[arg(value_name = "FILE")]
    experiment: Option<PathBuf>,
    /// Experiment file (TOML), given as an option.
    #[arg(long, value_name = "FILE", conflicts_with = "experiment")]
    file: Option<PathBuf>,
    #[command(flatten)]
    pipeline: PipelineOptions,
    /// A built-in scene (see `pxpl5 scenes`) or a model file: .ply, .obj, .stl, .gltf, .glb or .pdb.
    #[arg(long, value_name = "NAME|FILE")]
    scene: Option<String>,
    /// Decimate the scene to at most N primitives, keeping its shape.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = signed)]
    triangles: Option<i64>,
    /// Keep the coordinates of a model file, in metres; by default the model is fitted into the view of both eyes.
    #[arg(long)]
    no_fit: bool,
    /// Place of the middle of the scene in its world: metres to the right, upwards and backwards.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    model_at: Option<String>,
    /// Length of the longest side of the scene, in metres.
    #[arg(long, value_name = "METRES")]
    model_size: Option<f64>,
    /// Turn of the scene about the vertical axis, in degrees to the left.
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    model_turn: Option<f64>,
    /// Add the walls of the scene `room` around the viewer.
    #[arg(long)]
    in_room: bool,
    /// Drop triangles that face away from the eye. A surface without holes looks the same.
    #[arg(long)]
    cull: bool,
    /// Preset of the machine (see `pxpl5 machines`); default: the machine of the pipeline's paper.
    #[arg(long, value_name = "PRESET")]
    machine: Option<String>,
    /// Number of graphics processors, including the master.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = signed)]
    gps: Option<i64>,
    /// Number of renderers.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = signed)]
    renderers: Option<i64>,
    /// Motion of a head with a tracker: still, pan:DEG_PER_S, slide:M_PER_S, sine:DEG:HZ, pendulum, synthetic:SEED,
    /// walk:M_PER_S along the scene's path, walk:M_PER_S:SEED (which looks around as synthetic:SEED does), or a
    /// recording. The heads recorded:vive-tracked and recorded:vive-dev are real. Any other recording is a FILE.csv,
    /// .txt, .tum or .jsonl: a table with time_s,x,y,z,qw,qx,qy,qz, a file of EuRoC or TUM, a pose log, or any table
    /// with --columns.
    #[arg(long, value_name = "MOTION", allow_hyphen_values = true)]
    head: Option<String>,
    /// Columns of a recording, by name or number: t_ns=stamp,x=px,y=py,z=pz,qw=qw,qx=qx,qy=qy,qz=qz. The time is t,
    /// t_ms, t_us or t_ns; positions are x,y,z or x_mm and so on.
    #[arg(long, value_name = "FIELD=COLUMN,...")]
    columns: Option<String>,
    /// Distance from the eye, in metres, at which pixel errors are evaluated; default: the distance of the scene's
    /// content.
    #[arg(long, value_name = "METRES")]
    evaluate_at: Option<f64>,
    /// Tracker of the head: optical, fastrak, fastrak-polled, flock, flock-patched, 3space, 3space-patched or ideal;
    /// default optical.
    #[arg(long)]
    tracker: Option<String>,
    /// Predictor of the head's pose: none, velocity, acceleration or kalman; default kalman.
    #[arg(long)]
    predict: Option<String>,
    /// Meaning of the poses of --head. With scene, the motion begins where the scene's own motion begins. With world,
    /// the poses are metres in the scene's coordinates. With content, the default before a model file, the head faces
    /// the scene as long as it can.
    #[arg(long)]
    place: Option<String>,
    /// Instant during a picture's display for which the head's pose is predicted: middle, first-pixel, last-pixel or
    /// retrace; default middle.
    #[arg(long)]
    aim: Option<String>,
    /// Display of the pipeline's pictures: ntsc, hires, oled-90, lcd-120 or panel; default ntsc. Also plain and vdrt,
    /// with the meaning of --raster.
    #[arg(long)]
    display: Option<String>,
    /// Correction of the picture at scan-out, for a tracked head; default plain (none). vdrt shifts the raster by the
    /// error of the predicted pose. With shift, rotation or depth, a device moves the picture to the newest pose.
    #[arg(long)]
    raster: Option<String>,
    /// Number of display periods to simulate: NTSC fields of 1/60 s; default 120.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = signed)]
    fields: Option<i64>,
    /// Level of modelling: transaction, cycle, (for sweeps) analytic, or auto; default transaction. auto takes the
    /// cheapest level whose deviation from the cycle level stays within a bound, and prints which and why.
    #[arg(long)]
    level: Option<String>,
    /// Bound of --level auto, such as 2% or 2; default 5%.
    #[arg(long, value_name = "PERCENT")]
    within: Option<String>,
    /// Pixels that are computed: off, lazy (only pixels that are read) or all; default lazy.
    #[arg(long)]
    pixels: Option<String>,
    /// Seed of the random sway of the head or, with --head, of the tracker's noise; default 1.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = signed)]
    seed: Option<i64>,
    /// Set any key of an experiment file, such as machine.gp.triangle_ns=30000 or tracking.optical.latency=20; `pxpl5
    /// machines small-hmd` lists all numbers; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
}

/// Sets the bound of `--level auto`, with or without a percent sign.
pub(crate) fn set_within(file: &mut ExperimentFile, within: Option<&str>) -> Result<(), CliError> {
    let Some(within) = within else { return Ok(()) };
    Ok(file.set_text(&format!("within={}", within.trim_end_matches('%')), "--within")?)
}

impl SettingArgs {
    /// Returns the experiment file after all options. `--set` is applied last, so that its values replace all others.
    pub(crate) fn gather(self) -> Result<ExperimentFile, CliError> {
        let file = ExperimentFile::with(registry());
        let mut file = match self.experiment.as_ref().or(self.file.as_ref()) {
            Some(path) => file.and_load(path)?,
            None => file,
        };
        // Options of the pipeline override the file.
        for (key, value) in &self.pipeline.given {
            file.set_text(&format!("{key}={value}"), &format!("--{}", option_of(key)))?;
        }
        // Options with text, each with its key.
        let texts = [
            ("scene", "--scene", self.scene),
            ("machine.preset", "--machine", self.machine),
            ("head.motion", "--head", self.head),
            ("head.tracker", "--tracker", self.tracker),
            ("head.predict", "--predict", self.predict),
            ("head.aim", "--aim", self.aim),
            ("head.place", "--place", self.place),
            (display_key(self.display.as_deref()), "--display", self.display),
            ("head.raster", "--raster", self.raster),
            ("level", "--level", self.level),
            ("pixels", "--pixels", self.pixels),
        ];
        for (key, option, value) in texts {
            value.map(|value| file.set(key, value, option)).transpose()?;
        }
        set_within(&mut file, self.within.as_deref())?;
        // Options with whole numbers, each with its key.
        let numbers = [
            ("triangles", "--triangles", self.triangles),
            ("machine.n_gps", "--gps", self.gps),
            ("machine.n_renderers", "--renderers", self.renderers),
            ("fields", "--fields", self.fields),
            ("seed", "--seed", self.seed),
        ];
        for (key, option, value) in numbers {
            value.map(|value| file.set(key, value, option)).transpose()?;
        }
        self.evaluate_at.map(|metres| file.set("head.evaluate_at", metres, "--evaluate-at")).transpose()?;
        // `--columns` sets one key for each column.
        for column in self.columns.iter().flat_map(|columns| columns.split(',')) {
            let (field, name) = column.split_once('=').unwrap_or((column, ""));
            file.set(&format!("head.columns.{}", field.trim()), name.trim(), "--columns")?;
        }
        let places = self.model_at.iter().flat_map(|places| places.splitn(3, ','));
        for (axis, place) in ["x", "y", "z"].into_iter().zip(places) {
            file.set_text(&format!("model.{axis}={place}"), "--model-at")?;
        }
        self.model_size.map(|metres| file.set("model.size", metres, "--model-size")).transpose()?;
        self.model_turn.map(|degrees| file.set("model.turn", degrees, "--model-turn")).transpose()?;
        if self.in_room {
            file.set("model.room", true, "--in-room")?;
        }
        if self.no_fit {
            file.set("fit", false, "--no-fit")?;
        }
        if self.cull {
            file.set("cull", true, "--cull")?;
        }
        // `--set` comes last and overrides everything else.
        for assignment in &self.sets {
            file.set_text(assignment, "--set")?;
        }
        Ok(file)
    }
}

/// Returns the key that `--display NAME` sets. The name of a raster (a correction of pictures during the scan) sets the
/// key of the raster, as in earlier versions.
fn display_key(name: Option<&str>) -> &'static str {
    if Raster::ALL.iter().any(|(raster, _)| Some(*raster) == name) { "head.raster" } else { "display" }
}
