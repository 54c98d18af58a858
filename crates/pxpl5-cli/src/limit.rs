//! The command `pxpl5 limit`, which finds how many triangles a pipeline draws in time.

use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::numbers::{count_of, were};
use crate::progress::Progress;
use crate::scenes;
use crate::settings::SettingArgs;
use crate::terminal::{print, print_error, warn};
use clap::Args;
use pxpl5::limit::{CEILING, Limit, LimitQuery, OverLimit, OverQuery};
use pxpl5::tracking::time::PS_PER_S;
use pxpl5::{ExperimentFile, Goal, Level, LimitCriterion, Plan, TestScene};
use pxpl5_sim::Time;
use serde_json::json;

/// Find the largest number of triangles that a pipeline draws in time, or the values of a setting that reach a goal.
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
  pxpl5 limit --pipeline rendering-control --scene head --machine large --over machine.n_gps --rate 15
  pxpl5 limit --pipeline rendering-control --scene mig --over machine.n_renderers --latency 6

By default, the pipeline chooses the triangles, the condition of the limit and the length of the runs. The scenes full-screen and
typical are the triangles of the papers; any other scene is decimated evenly. With --over KEY, the goal may hold above a value, below
a value, or in a part of the range. The search first tries the ends of the range and three values between them.")]
pub(crate) struct LimitArgs {
    #[command(flatten)]
    settings: SettingArgs,
    /// Setting to vary: triangles, or any numeric key of an experiment file, such as machine.n_gps; default triangles.
    /// The default pipeline is slats for triangles, and rendering-control for other settings.
    #[arg(long, value_name = "KEY")]
    over: Option<String>,
    /// Smallest value of --over to try; default: 1 for numbers of boards, otherwise the smallest value of the range
    /// that the papers support.
    #[arg(long, value_name = "VALUE", requires = "over")]
    from: Option<f64>,
    /// Greatest value of --over to try. Default: for numbers of boards the number in the largest preset, otherwise the
    /// greatest value of the range that the papers support.
    #[arg(long, value_name = "VALUE", requires = "over")]
    to: Option<f64>,
    /// Goal: at least this many updates per second.
    #[arg(long, value_name = "HZ", conflicts_with = "latency")]
    rate: Option<f64>,
    /// Goal: at most this mean latency, in fields.
    #[arg(long, value_name = "FIELDS")]
    latency: Option<f64>,
    #[command(flatten)]
    budget: BudgetArgs,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Show no progress.
    #[arg(long, short)]
    quiet: bool,
}

pub(crate) fn run(args: LimitArgs) -> Result<(), CliError> {
    if let Some(key) = args.key() {
        return over(&args, key);
    }
    if args.from.or(args.to).is_some() {
        return Err(CliError::usage("--from and --to: expected a key with --over that is not triangles"));
    }
    let query = args.query()?;
    query.model.iter().for_each(|model| scenes::print_warnings(&model.whole, args.quiet));
    let limit = Progress::new("sizes", args.quiet).run_within(args.budget, FEWER, &query)?;
    if limit.has_limit() && limit.triangles > 1 {
        warn(query.near_edge(limit.triangles)?.as_slice(), args.quiet);
    }
    let choice = query.level_choice(limit.triangles.max(1))?;
    if let Some(choice) = choice.as_ref().filter(|_| !args.quiet) {
        print_error(&format!("pxpl5: with {} triangles, {choice}\n", limit.triangles));
    }
    let level = choice.map_or(query.level, |choice| choice.level);
    print(&if args.json { json_text(&query, limit, level) } else { text(&query, limit) })
}

const FEWER: &str = "simulate fewer fields";

fn over(args: &LimitArgs, key: &str) -> Result<(), CliError> {
    let (query, plan) = args.over_query(key)?;
    let limit = Progress::new("values", args.quiet).run_within(args.budget, FEWER, &query)?;
    print(&if args.json { over_json(&query, &plan, &limit)? } else { over_text(&query, &plan, &limit) })
}

/// Minimum number of simulated fields. Shorter runs end during the warm-up of every pipeline.
const MIN_FIELDS: u64 = 10;

impl LimitArgs {
    fn query(&self) -> Result<LimitQuery, CliError> {
        let (file, has_scene) = self.file()?;
        let plan = file.resolve()?;
        self.check_rate(&plan)?;
        warn(&plan.warnings(), self.quiet);
        let fields = length(&file, &plan);
        if fields < MIN_FIELDS {
            return Err(CliError::usage(format!("--fields: expected at least {MIN_FIELDS}, found {fields}")));
        }
        // Without a scene, the pipeline chooses the triangles.
        let of = if has_scene { LimitQuery::of_scene(&plan)? } else { LimitQuery::of_plan(&plan) };
        Ok(LimitQuery { criterion: LimitCriterion { fields, ..of.criterion }, ..of })
    }

    /// Returns an error for a rate that the display cannot show.
    fn check_rate(&self, plan: &Plan) -> Result<(), CliError> {
        let periods = plan.display_periods(Time(1_000 * PS_PER_S));
        let Some((asked, shown)) = self.rate.zip(periods.map(|periods| periods as f64 / 1e3)) else { return Ok(()) };
        // As in goals, 60 stand for the 59.94 Hz of NTSC.
        if asked * 0.999 <= shown + 1e-3 {
            return Ok(());
        }
        let display = plan.display();
        Err(CliError::usage(format!(
            "--rate: expected at most {shown:.2}, the rate of the display {display}, found {asked}"
        )))
    }

    /// Returns the setting that the search varies, or `None` if the search varies the number of triangles.
    fn key(&self) -> Option<&str> {
        self.over.as_deref().filter(|key| *key != "triangles")
    }

    /// Returns the search over the values of the setting `key`, and the plan of the experiment at the greatest value.
    fn over_query(&self, key: &str) -> Result<(OverQuery, Plan), CliError> {
        let (mut file, _) = self.file()?;
        // The experiment without --over gives the defaults of length, range and goal.
        let first = file.resolve()?;
        if let Some(scene) = TestScene::ALL.into_iter().find(|scene| scene.name() == first.scene.name) {
            return Err(CliError::usage(format!(
                "--scene: expected a number of triangles with --over {key}, such as {}:1000, found {}",
                scene.name(),
                scene.name()
            )));
        }
        let fields = length(&file, &first).max(MIN_FIELDS);
        file.set("fields", i64::try_from(fields).unwrap_or(i64::MAX), "--fields")?;
        // An unknown key is named as such, before its range is looked up.
        file.clone().set_text(&format!("{key}=1"), "--over")?;
        self.check_rate(&first)?;
        // A missing end of the range comes from the sources of the parameter.
        let values = OverQuery::values(&first, key, self.from, self.to).map_err(|e| e.at("--from and --to"))?;
        // The largest experiment must be valid and within the budget before the search starts.
        let mut last = file.clone();
        last.set_text(&format!("{key}={}", values.text(values.last())), "--over")?;
        let plan = last.resolve()?;
        warn(&first.warnings(), self.quiet);
        Ok((OverQuery { file, key: key.to_owned(), values, goal: first.limit.goal }, plan))
    }

    /// Returns the settings that all scene sizes share, and true if they name a scene. Without a scene, they have a
    /// placeholder of one triangle.
    fn file(&self) -> Result<(ExperimentFile, bool), CliError> {
        let mut file = self.settings.gather()?;
        let has_scene = file.place_of("scene").is_some();
        // A search over triangles starts with the pipeline whose limit was published.
        let pipeline = if self.key().is_some() { "rendering-control" } else { "slats" };
        for (key, value) in [("pipeline", pipeline), ("scene", "full-screen:1")] {
            if file.place_of(key).is_none() {
                file.set(key, value, "limit")?;
            }
        }
        let goals = [("limit.rate_hz", "--rate", self.rate), ("limit.latency_fields", "--latency", self.latency)];
        for (key, option, value) in goals {
            value.map(|value| file.set(key, value, option)).transpose()?;
        }
        Ok((file, has_scene))
    }
}

/// Returns the number of fields of each run. Without a number in the settings, it is enough to reach a steady state of
/// the pipeline.
fn length(file: &ExperimentFile, plan: &Plan) -> u64 {
    if file.place_of("fields").is_some() { plan.fields } else { plan.limit.fields }
}

fn goal_text(goal: Goal) -> String {
    match goal {
        Goal::NoMissedRetrace => "every picture that is due is shown in time".to_owned(),
        Goal::RateHz(hz) => format!("at least {hz} updates a second (as the papers count: 60 stand for 59.94)"),
        Goal::LatencyFields(fields) => format!("a mean latency of at most {fields} fields"),
    }
}

fn over_text(query: &OverQuery, plan: &Plan, limit: &OverLimit) -> String {
    let values = &query.values;
    let text = |value: f64| values.text(value);
    let key = &query.key;
    let answer = match (limit.reached, limit.least, limit.most) {
        (false, ..) => format!("none up to {}", text(values.last())),
        (true, None, None) => format!("all from {} to {}", text(values.from), text(values.last())),
        (true, Some(least), None) => format!("at least {}", text(least)),
        (true, None, Some(most)) => format!("at most {}", text(most)),
        (true, Some(least), Some(most)) => format!("from {} to {}", text(least), text(most)),
    };
    // The cause is known only for a value that missed the goal.
    let because = match (&limit.because, limit.missed_at) {
        (Some(because), Some(at)) => format!(": with {}, {because}", text(at)),
        _ => String::new(),
    };
    let islands: Vec<String> = limit.islands.iter().map(|value| text(*value)).collect();
    let again = match &islands[..] {
        [] => String::new(),
        all => format!("Beyond values that miss, these reach the goal again: {}.\n", all.join(", ")),
    };
    let tried: Vec<String> = limit
        .tried
        .iter()
        .map(|(value, hit)| format!("{}{}", text(*value), if *hit { " reached" } else { "" }))
        .collect();
    format!(
        "{} with {}: {key} {answer}{because}\n{again}Goal: {}.\n{} simulated for {}: {}.\n",
        plan.pipeline.name(),
        plan.scene.name,
        goal_text(query.goal),
        were(limit.tried.len() as u64, "value"),
        count_of(plan.fields, "field"),
        tried.join(", ")
    )
}

fn over_json(query: &OverQuery, plan: &Plan, limit: &OverLimit) -> Result<String, CliError> {
    let mut object = json!({
        "schema": "pxpl5-limit-over/1",
        "over": query.key,
        "goal": query.goal,
        "values": query.values,
        "pipeline": plan.pipeline.name(),
        "scene": plan.scene.name,
        "machine": plan.machine.preset,
        "n_gps": plan.machine.n_gps,
        "n_renderers": plan.machine.n_renderers,
        "fields": plan.fields,
        "level": plan.level_name(),
    });
    object["limit"] = serde_json::to_value(limit).map_err(CliError::failure)?;
    Ok(format!("{object:#}\n"))
}

fn json_text(query: &LimitQuery, limit: Limit, level: Level) -> String {
    let object = json!({
        "schema": "pxpl5-limit/2",
        "triangles": limit.has_limit().then_some(limit.triangles),
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
        "level": level.name(),
    });
    format!("{object:#}\n")
}

fn scene(query: &LimitQuery) -> String {
    query.model.as_ref().map_or_else(|| query.criterion.scene.name().to_owned(), |model| model.whole.name().to_owned())
}

fn text(query: &LimitQuery, limit: Limit) -> String {
    let goal = goal_text(query.criterion.goal);
    if !limit.has_limit() {
        return format!(
            "{} on {} and {} has no limit: {CEILING} triangles of {} reach the goal as well\nGoal: {goal}.\n",
            query.pipeline.name(),
            count_of(query.config.n_gps, "GP"),
            count_of(query.config.n_renderers, "renderer"),
            scene(query),
        );
    }
    let first_miss =
        limit.first_miss.map_or("no size missed the goal".to_owned(), |n| format!("the first size that missed is {n}"));
    let island =
        limit.island.map_or(String::new(), |n| format!("Above the first miss, {n} triangles reach the goal again.\n"));
    // Explain the search only if its result is not trivial.
    let row = if limit.unbroken_from < limit.triangles {
        format!("All sizes from {} to {} were tried, smaller ones in part.\n", limit.unbroken_from, limit.triangles)
    } else {
        String::new()
    };
    format!(
        "{} on {} and {}: at most {} of {} ({first_miss}; {} simulated for {})\nGoal: {goal}.\n{row}{island}",
        query.pipeline.name(),
        count_of(query.config.n_gps, "GP"),
        count_of(query.config.n_renderers, "renderer"),
        count_of(limit.triangles, "triangle"),
        scene(query),
        were(limit.tried as u64, "size"),
        count_of(query.criterion.fields, "field"),
    )
}

fn settings(query: &LimitQuery) -> serde_json::Value {
    query.pipeline.settings().into_iter().map(|(key, value)| (key, value.to_string())).collect()
}
