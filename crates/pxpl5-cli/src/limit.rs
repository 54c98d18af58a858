//! The command `pxpl5 limit`, which finds how many triangles a pipeline draws in time.

use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::estimate::Work;
use crate::numbers::{count_of, were, whole};
use crate::options::{PipelineOptions, option_of, registry};
use crate::scenes;
use crate::terminal::{print, warn};
use clap::Args;
use pxpl5::limit::{Limit, LimitQuery, Model};
use pxpl5::{ExperimentFile, Goal, Level, LimitCriterion, TestScene};
use serde_json::json;

/// Find the largest number of triangles that a pipeline draws in time.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 limit --pipeline slats                            140 triangles were published (TR94)
  pxpl5 limit --pipeline slats --copy whole               110 triangles were published
  pxpl5 limit --pipeline slats --machine slats-1995       100 triangles were published (I3D95)
  pxpl5 limit --pipeline slats --gps 4 --renderers 10 --binning touched
  pxpl5 limit --pipeline rendering-control --rate 30
  pxpl5 limit --pipeline slats --scene mig                the aircraft with a growing number of its triangles
  pxpl5 limit --pipeline rendering-control --latency 5    fields
  pxpl5 limit --pipeline slats --set gp.triangle_ns=20000

By default, the pipeline chooses the triangles and the condition of the limit.")]
pub(crate) struct LimitArgs {
    #[command(flatten)]
    pipeline: PipelineOptions,
    /// Number of graphics processors.
    #[arg(long, value_name = "N", value_parser = whole::<u64>(0, i64::MAX as u64))]
    gps: Option<u64>,
    /// Number of renderers.
    #[arg(long, value_name = "N", value_parser = whole::<u64>(0, i64::MAX as u64))]
    renderers: Option<u64>,
    /// Preset of the machine; default: the machine on which the papers measured the pipeline.
    #[arg(long, value_name = "PRESET")]
    machine: Option<String>,
    /// Display of the pipeline's pictures: ntsc or hires.
    #[arg(long)]
    display: Option<String>,
    /// Triangles: full-screen, typical (small ones that touch 1.3 regions on average), or a built-in scene or model
    /// file that is thinned out evenly; default: full-screen for pipelines that send all triangles to every region,
    /// typical otherwise.
    #[arg(long, value_name = "full-screen|typical|NAME|FILE")]
    scene: Option<String>,
    /// Minimum updates per second.
    #[arg(long, value_name = "HZ", conflicts_with = "latency")]
    rate: Option<f64>,
    /// Maximum mean latency in fields.
    #[arg(long, value_name = "FIELDS")]
    latency: Option<f64>,
    /// Fields simulated for each number of triangles; default: enough for a steady state of the pipeline.
    #[arg(long, value_name = "N", value_parser = whole::<u64>(0, 10_000_000))]
    fields: Option<u64>,
    /// Level of modelling: analytic, transaction or cycle; default transaction.
    #[arg(long)]
    level: Option<String>,
    /// Set any key of an experiment file, such as machine.gp.triangle_ns=30000; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
    #[command(flatten)]
    budget: BudgetArgs,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: LimitArgs) -> Result<(), CliError> {
    let query = args.query()?;
    let limit = query.search()?;
    print(&if args.json { json_text(&query, limit) } else { text(&query, limit) })
}

/// Maximum number of sizes that a search simulates: twice the number of halvings of the whole range.
const SIZES: usize = 40;

/// Minimum number of simulated fields. Shorter runs end within the warm-up of every pipeline.
const LEAST_FIELDS: u64 = 10;

impl LimitArgs {
    fn query(&self) -> Result<LimitQuery, CliError> {
        let plan = self.file()?.resolve()?;
        // An option replaces one part of the pipeline's own criterion.
        warn(&plan.warnings(), false);
        let query = LimitQuery::of_plan(&plan);
        let fields = self.fields.unwrap_or(query.criterion.fields);
        if fields < LEAST_FIELDS {
            return Err(CliError::usage(format!("--fields: expected at least {LEAST_FIELDS}, found {fields}")));
        }
        let scene = self.test_scene().unwrap_or(query.criterion.scene);
        let goal = self.goal()?.unwrap_or(query.criterion.goal);
        // Any other scene name is a model that is thinned out to every size.
        let model = if self.scene.is_some() && self.test_scene().is_none() {
            Some(Model::load(plan.scene.clone())?)
        } else {
            None
        };
        // Closed forms cost almost nothing, so only levels with events are checked against the budget.
        if query.level != Level::Analytic {
            let size = Work { fields, ..Work::of(&plan, &*scenes::load(&plan, false)?, false) };
            self.budget.admit_all([size; SIZES], 1)?;
        }
        Ok(LimitQuery { criterion: LimitCriterion { goal, scene, fields }, model, ..query })
    }

    /// Returns the test scene of the papers that `--scene` names, if any.
    fn test_scene(&self) -> Option<TestScene> {
        TestScene::ALL.into_iter().find(|scene| self.scene.as_deref() == Some(scene.name()))
    }

    /// Returns the settings shared by all sizes. Their scene is a placeholder with one triangle unless `--scene`
    /// names a model.
    fn file(&self) -> Result<ExperimentFile, CliError> {
        let mut file = ExperimentFile::with(registry());
        file.set("pipeline", "slats", "--pipeline")?;
        // A test scene depends on the size, so a placeholder with one triangle stands for it.
        let model = self.scene.as_deref().filter(|_| self.test_scene().is_none());
        file.set("scene", model.unwrap_or("full-screen:1"), "--scene")?;
        // Options override the pipeline's defaults, and `--set` overrides options.
        for (key, value) in &self.pipeline.given {
            file.set_text(&format!("{key}={value}"), &format!("--{}", option_of(key)))?;
        }
        let texts = [
            ("machine.preset", "--machine", &self.machine),
            ("display", "--display", &self.display),
            ("level", "--level", &self.level),
        ];
        for (key, option, value) in texts {
            value.clone().map(|value| file.set(key, value, option)).transpose()?;
        }
        let numbers = [("machine.n_gps", "--gps", self.gps), ("machine.n_renderers", "--renderers", self.renderers)];
        for (key, option, value) in numbers {
            value.map(|value| file.set(key, i64::try_from(value).unwrap_or(i64::MAX), option)).transpose()?;
        }
        for assignment in &self.sets {
            file.set_text(assignment, "--set")?;
        }
        Ok(file)
    }

    fn goal(&self) -> Result<Option<Goal>, CliError> {
        match (self.rate, self.latency) {
            (None, None) => Ok(None),
            (Some(hz), _) if hz > 0.0 => Ok(Some(Goal::RateHz(hz))),
            (_, Some(fields)) if fields > 0.0 => Ok(Some(Goal::LatencyFields(fields))),
            _ => Err(CliError::usage("--rate and --latency must be greater than 0")),
        }
    }
}

fn json_text(query: &LimitQuery, limit: Limit) -> String {
    let object = json!({
        "schema": "pxpl5-limit/2",
        "triangles": limit.triangles,
        "first_miss": limit.first_miss,
        "island": limit.island,
        "unbroken_from": limit.unbroken_from,
        "sizes_tried": limit.tried,
        "pipeline": query.pipeline.name(),
        "goal": query.criterion.goal,
        "scene": scene(query),
        "settings": settings(query),
        "machine": query.config.preset,
        "n_gps": query.config.n_gps,
        "n_renderers": query.config.n_renderers,
        "fields": query.criterion.fields,
        "level": query.level.name(),
    });
    format!("{object:#}\n")
}

/// Returns the name of the scene drawn at every size.
fn scene(query: &LimitQuery) -> String {
    query.model.as_ref().map_or_else(|| query.criterion.scene.name().to_owned(), |model| model.whole.name().to_owned())
}

fn text(query: &LimitQuery, limit: Limit) -> String {
    let first_miss = limit.first_miss.map_or("none was missed".to_owned(), |n| format!("the first miss is {n}"));
    let island = limit.island.map_or(String::new(), |n| {
        format!("An island above the first miss: {n} triangles reach the goal all the same.\n")
    });
    // Explain the search only if its result is not trivial.
    let row = if limit.unbroken_from < limit.triangles {
        format!("All sizes from {} to {} were tried, smaller ones in part.\n", limit.unbroken_from, limit.triangles)
    } else {
        String::new()
    };
    format!(
        "{} on {} and {}: at most {} of {} ({first_miss}; {} simulated for {})\n{row}{island}",
        query.pipeline.name(),
        count_of(query.config.n_gps, "GP"),
        count_of(query.config.n_renderers, "renderer"),
        count_of(limit.triangles, "triangle"),
        scene(query),
        were(limit.tried as u64, "size"),
        count_of(query.criterion.fields, "field"),
    )
}

/// Returns the pipeline's keys and their effective values.
fn settings(query: &LimitQuery) -> serde_json::Value {
    query.pipeline.settings().into_iter().map(|(key, value)| (key, value.to_string())).collect()
}
