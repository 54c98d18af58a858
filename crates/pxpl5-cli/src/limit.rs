//! `pxpl5 limit`.

use crate::error::CliError;
use crate::terminal::print;
use clap::{Args, ValueEnum};
use pxpl5::levels::{Level, Program};
use pxpl5::limit::{Goal, Growing, LIMIT_FIELDS, Limit, LimitQuery, STEREO_LIMIT_FIELDS};
use pxpl5::{Binning, Code, CopySchedule, MachineConfig, RenderingControl, Slats};
use serde_json::json;

/// Find the most triangles that a pipeline draws in time.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 limit --pipeline slats                            140 triangles were published (TR94)
  pxpl5 limit --pipeline slats --copy whole               110 triangles were published
  pxpl5 limit --pipeline slats --gps 4 --renderers 10 --binning touched
  pxpl5 limit --pipeline rendering-control --rate 30
  pxpl5 limit --pipeline rendering-control --latency 5    fields")]
pub(crate) struct LimitArgs {
    /// The pipeline.
    #[arg(long, value_enum, default_value = "slats")]
    pipeline: PipelineArg,
    /// When Slats copies regions.
    #[arg(long, value_enum, default_value = "split")]
    copy: CopyArg,
    /// Which code of Slats runs.
    #[arg(long, value_enum, default_value = "1994")]
    code: CodeArg,
    /// Regions to which Slats sends a triangle.
    #[arg(long, value_enum, default_value = "all")]
    binning: BinningArg,
    /// Graphics processors.
    #[arg(long)]
    gps: Option<u64>,
    /// Renderers.
    #[arg(long)]
    renderers: Option<u64>,
    /// Preset of the machine; default: the one on which the pipeline was measured.
    #[arg(long, value_name = "PRESET")]
    machine: Option<String>,
    /// Triangles: full-screen or typical; default: full-screen where every region gets them all, typical otherwise.
    #[arg(long, value_enum)]
    scene: Option<SceneArg>,
    /// Least updates per second (Rendering Control).
    #[arg(long, value_name = "HZ", conflicts_with = "latency")]
    rate: Option<f64>,
    /// Greatest mean latency in fields (Rendering Control).
    #[arg(long, value_name = "FIELDS")]
    latency: Option<f64>,
    /// Fields that each size is simulated for; default: 16 for Slats, 90 for Rendering Control.
    #[arg(long)]
    fields: Option<u64>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum PipelineArg {
    Slats,
    RenderingControl,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum CopyArg {
    Whole,
    Split,
    /// Whole, and the last complete field is shown again when a retrace is missed (beyond the prototype).
    Backup,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum CodeArg {
    #[value(name = "1994")]
    Of1994,
    #[value(name = "1995")]
    Of1995,
    Optimised,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum BinningArg {
    All,
    Touched,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum SceneArg {
    FullScreen,
    Typical,
}

pub(crate) fn run(args: LimitArgs) -> Result<(), CliError> {
    let query = args.query()?;
    let limit = query.search()?;
    print(&if args.json { json_text(&query, limit) } else { text(&query, limit) })
}

impl LimitArgs {
    fn query(&self) -> Result<LimitQuery, CliError> {
        let program = self.program();
        let mut config =
            MachineConfig::preset(self.machine.as_deref().unwrap_or(program.preset())).map_err(CliError::usage)?;
        for (path, value) in [("n_gps", self.gps), ("n_renderers", self.renderers)] {
            value.map_or(Ok(()), |value| config.set(path, value)).map_err(CliError::usage)?;
        }
        config.check().map_err(CliError::usage)?;
        Ok(LimitQuery {
            config,
            program,
            growing: self.growing(program),
            goal: self.goal()?,
            fields: self.fields.unwrap_or(match program {
                Program::Slats(_) => LIMIT_FIELDS,
                _ => STEREO_LIMIT_FIELDS,
            }),
            level: Level::Transaction,
        })
    }

    fn program(&self) -> Program {
        if self.pipeline == PipelineArg::RenderingControl {
            return RenderingControl::stereo().into();
        }
        let copy = match self.copy {
            CopyArg::Whole => CopySchedule::Whole,
            CopyArg::Split => CopySchedule::Split,
            CopyArg::Backup => CopySchedule::Backup,
        };
        let code = match self.code {
            CodeArg::Of1994 => Code::Of1994,
            CodeArg::Of1995 => Code::Of1995,
            CodeArg::Optimised => Code::Optimised,
        };
        let binning = match self.binning {
            BinningArg::All => Binning::All,
            BinningArg::Touched => Binning::Touched,
        };
        Slats { copy, binning, code: Some(code) }.into()
    }

    fn growing(&self, program: Program) -> Growing {
        match (self.scene, program) {
            (Some(SceneArg::FullScreen), _) => Growing::FullScreen,
            (None, Program::Slats(slats)) if slats.binning == Binning::All => Growing::FullScreen,
            (Some(SceneArg::Typical) | None, _) => Growing::Typical,
        }
    }

    fn goal(&self) -> Result<Goal, CliError> {
        match (self.rate, self.latency) {
            (None, None) => Ok(Goal::NoMissedRetrace),
            (Some(hz), _) if hz > 0.0 => Ok(Goal::RateHz(hz)),
            (_, Some(fields)) if fields > 0.0 => Ok(Goal::LatencyFields(fields)),
            _ => Err(CliError::usage("--rate and --latency must be greater than 0")),
        }
    }
}

fn json_text(query: &LimitQuery, limit: Limit) -> String {
    let object = json!({
        "schema": "pxpl5-limit/1",
        "triangles": limit.triangles,
        "first_miss": limit.first_miss,
        "monotone": limit.monotone,
        "sizes_tried": limit.tried,
        "pipeline": query.program.pipeline().name(),
        "goal": query.goal,
        "scene": query.growing,
        "machine": query.config.preset,
        "n_gps": query.config.n_gps,
        "n_renderers": query.config.n_renderers,
        "fields": query.fields,
    });
    format!("{object:#}\n")
}

fn text(query: &LimitQuery, limit: Limit) -> String {
    let first_miss = limit.first_miss.map_or("none was missed".to_owned(), |n| format!("the first miss is {n}"));
    format!(
        "{} on {} GPs and {} renderers: at most {} triangles ({first_miss}; {} sizes were simulated for {} fields)\n",
        query.program.pipeline().name(),
        query.config.n_gps,
        query.config.n_renderers,
        limit.triangles,
        limit.tried,
        query.fields,
    )
}
