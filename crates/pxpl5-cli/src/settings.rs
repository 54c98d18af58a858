//! Options that say what an experiment is; each stands for a key of an experiment file.

use crate::error::CliError;
use crate::numbers::signed;
use crate::options::{PipelineOptions, option_of, registry};
use clap::Args;
use pxpl5::{ExperimentFile, Raster};
use std::path::PathBuf;

/// An experiment file, and options that take precedence over it.
#[derive(Args, Debug, Default)]
pub(crate) struct SettingArgs {
    /// Experiment file (TOML).
    #[arg(value_name = "FILE")]
    experiment: Option<PathBuf>,
    /// The same, as an option.
    #[arg(long, value_name = "FILE", conflicts_with = "experiment")]
    file: Option<PathBuf>,
    #[command(flatten)]
    pipeline: PipelineOptions,
    /// A built-in scene (see `pxpl5 scenes`) or a model file: .ply, .obj, .pdb.
    #[arg(long, value_name = "NAME|FILE")]
    scene: Option<String>,
    /// Decimate the scene to at most N primitives, keeping its shape.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = signed)]
    triangles: Option<i64>,
    /// Leave a model file where its coordinates say, in metres, instead of fitting it into the view of both eyes.
    #[arg(long)]
    no_fit: bool,
    /// Drop triangles that face away from the eye: of surfaces without holes nothing is missing then.
    #[arg(long)]
    cull: bool,
    /// Preset of the machine (see `pxpl5 machines`); default: the one on which the pipeline was published.
    #[arg(long, value_name = "PRESET")]
    machine: Option<String>,
    /// Graphics processors, the master included.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = signed)]
    gps: Option<i64>,
    /// Renderers.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = signed)]
    renderers: Option<i64>,
    /// Motion of a head with a tracker: still, pan:DEG_PER_S, slide:M_PER_S, sine:DEG:HZ, pendulum, synthetic:SEED, walk:M_PER_S
    /// along the scene's path (walk:M_PER_S:SEED looks around as synthetic:SEED) or a recording (FILE.csv, .txt, .tum: time_s,x,y,z,qw,qx,qy,qz, EuRoC, TUM, or any with --columns).
    #[arg(long, alias = "motion", value_name = "MOTION", allow_hyphen_values = true)]
    head: Option<String>,
    /// Columns of a recording, by name or number: t_ns=stamp,x=px,y=py,z=pz,qw=qw,qx=qx,qy=qy,qz=qz (t, t_ms, t_us or t_ns; x or
    /// x_mm).
    #[arg(long, value_name = "FIELD=COLUMN,...")]
    columns: Option<String>,
    /// Metres from the eye at which pixel errors are judged; default where the scene's content lies.
    #[arg(long, value_name = "METRES")]
    judge_at: Option<f64>,
    /// Its tracker: optical, fastrak, fastrak-polled, flock, flock-patched, 3space, 3space-patched or ideal; default optical.
    #[arg(long)]
    tracker: Option<String>,
    /// Prediction: none, velocity, acceleration or kalman; default kalman.
    #[arg(long)]
    predict: Option<String>,
    /// The instant of what is shown from it that a view is predicted for: middle, first-pixel, last-pixel or retrace; default
    /// middle.
    #[arg(long)]
    aim: Option<String>,
    /// What the pipeline draws for: ntsc or hires; default ntsc. (plain and vdrt are taken for --raster.)
    #[arg(long)]
    display: Option<String>,
    /// Raster before a tracked head's eyes: plain, or vdrt (shifted by what the pose was wrong); default plain.
    #[arg(long)]
    raster: Option<String>,
    /// Periods of the display to simulate: NTSC fields of 1/60 s; default 120.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = signed)]
    fields: Option<i64>,
    /// Level of modelling: transaction, cycle or (for sweeps) analytic; default transaction.
    #[arg(long)]
    level: Option<String>,
    /// Which pixels are computed: off, lazy (those looked at) or all; default lazy.
    #[arg(long)]
    pixels: Option<String>,
    /// Seed of the head motion's sway, or of the tracker's noise; default 1.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = signed)]
    seed: Option<i64>,
    /// Set any key of an experiment file, such as machine.gp.triangle_ns=30000 or tracking.optical.latency=20; `pxpl5 machines
    /// small-hmd` lists all numbers; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
}

impl SettingArgs {
    /// The file with the options applied; `--set` last.
    ///
    /// # Errors
    ///
    /// For an unusable file or an unknown key.
    pub(crate) fn gather(self) -> Result<ExperimentFile, CliError> {
        let file = ExperimentFile::with(registry());
        let mut file = match self.experiment.as_ref().or(self.file.as_ref()) {
            Some(path) => file.and_load(path)?,
            None => file,
        };
        for (key, value) in &self.pipeline.given {
            file.set_text(&format!("{key}={value}"), &format!("--{}", option_of(key)))?;
        }
        let texts = [
            ("scene", "--scene", self.scene),
            ("machine.preset", "--machine", self.machine),
            ("head.motion", "--head", self.head),
            ("head.tracker", "--tracker", self.tracker),
            ("head.predict", "--predict", self.predict),
            ("head.aim", "--aim", self.aim),
            (display_key(self.display.as_deref()), "--display", self.display),
            ("head.raster", "--raster", self.raster),
            ("level", "--level", self.level),
            ("pixels", "--pixels", self.pixels),
        ];
        for (key, option, value) in texts {
            value.map(|value| file.set(key, value, option)).transpose()?;
        }
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
        self.judge_at.map(|metres| file.set("head.judge_at", metres, "--judge-at")).transpose()?;
        for column in self.columns.iter().flat_map(|columns| columns.split(',')) {
            let (field, name) = column.split_once('=').unwrap_or((column, ""));
            file.set(&format!("head.columns.{}", field.trim()), name.trim(), "--columns")?;
        }
        if self.no_fit {
            file.set("fit", false, "--no-fit")?;
        }
        if self.cull {
            file.set("cull", true, "--cull")?;
        }
        for assignment in &self.sets {
            file.set_text(assignment, "--set")?;
        }
        Ok(file)
    }
}

/// A display's name is the machine's; a raster's was given by the same option before there were other displays.
fn display_key(name: Option<&str>) -> &'static str {
    if Raster::ALL.iter().any(|(raster, _)| Some(*raster) == name) { "head.raster" } else { "display" }
}
