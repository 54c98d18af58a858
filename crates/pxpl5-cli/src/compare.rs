//! The command `pxpl5 compare`, which compares the low-latency methods of all pipelines.

mod drawings;
mod gallery;
mod table;

use crate::error::CliError;
use crate::interrupt;
use crate::numbers::{confidence, count_of, whole};
use crate::output::OutputFolder;
use crate::progress::Progress;
use crate::run::MIN_COVERED;
use crate::settings::SettingArgs;
use crate::terminal::{self, AnswerArgs, json_text};
use pxpl5::compare::{
    CONFIDENCE, CompareQuery, Comparison, ComparisonRow, MAX_SEEDS, MIN_SEEDS, Precision, ROWS_FOLDER, RecordedLength,
    RowChoice, UntilPrecise, edge_pictures,
};
use pxpl5::views::png_bytes;
use pxpl5::{ExperimentFile, MachineConfig};
use std::path::PathBuf;
use std::sync::Arc;

/// Arguments of `pxpl5 compare`.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 compare --head recorded:vive-tracked
  pxpl5 compare --head recorded:vive-dev --scene sphere:60 --model-size 1.5 --model-at 0,0,-2 --place content
  pxpl5 compare --head head.csv --predict none --out out/compare
  pxpl5 compare --machine design-maximum --gps 34 --set gp.triangle_ns=20000 --seeds 10 --json
  pxpl5 compare --fields 60 --seeds 1
  pxpl5 compare --all --limits --confidence 0.99
  pxpl5 compare --causes --predictors                               the causes of the error, and the best predictor
  pxpl5 compare --only slats,vdrt,jitp-scanline-racing --head pan:200
  pxpl5 compare --out out/compare --resume                          after an interruption
  pxpl5 compare --until-precision 10% --max-seeds 40

Defaults of a comparison: --scene room --machine small-hmd --head synthetic --tracker optical --fields 300.

Every pipeline has the same settings and one run for each seed. With the head `synthetic`, each seed gives another motion. The pipelines
have the values of their papers. A recording sets the length of the runs. The command `pxpl5 run --pipeline NAME` runs one pipeline alone, with its own keys and pictures.")]
pub(crate) struct CompareArgs {
    #[command(flatten)]
    settings: SettingArgs,
    /// Rows (pipelines) to run, separated by commas; default: one or two rows of each family of pipelines.
    #[arg(long, value_name = "ROW,...", value_delimiter = ',')]
    only: Vec<String>,
    /// Run all rows.
    #[arg(long, conflicts_with = "only")]
    all: bool,
    /// Number of seeds for the random parts of a run: tracker, host and synthetic motion. The first seed is --seed.
    /// Each pipeline runs once for each seed. The confidence interval of a mean needs at least two seeds.
    #[arg(long, default_value_t = MIN_SEEDS as u64, value_name = "N", value_parser = whole::<u64>(1, 1_000))]
    seeds: u64,
    /// Add seeds to each row until the confidence interval of its mean end-to-end error is narrower than this. The
    /// width is a share of the mean (10%) or pixels (0.2px). Only for the motion `synthetic`, which differs with the
    /// seed.
    #[arg(long, value_name = "WIDTH")]
    until_precision: Option<Precision>,
    /// Maximum number of seeds of a row with --until-precision.
    #[arg(long, value_name = "N", default_value_t = MAX_SEEDS as u64, value_parser = whole::<u64>(2, 1_000), requires = "until_precision")]
    max_seeds: u64,
    /// Also search for the largest number of triangles that each pipeline can draw in time. The search takes longer
    /// than all runs.
    #[arg(long)]
    limits: bool,
    /// Also split the error of each row by its causes. For each cause, every run is evaluated once more without this
    /// cause.
    #[arg(long)]
    causes: bool,
    /// Also run each row with every other predictor, to find the predictor with the least error.
    #[arg(long)]
    predictors: bool,
    /// Confidence of all intervals, between 0 and 1.
    #[arg(long, value_name = "SHARE", default_value_t = CONFIDENCE, value_parser = confidence)]
    confidence: f64,
    /// Write comparison.json, experiment.toml (which makes the comparison again), rows.csv, errors.csv, gallery.html with the picture of every pipeline, pictures of a
    /// vertical edge, and charts into this folder. The charts show the error over time, its distribution, and the error
    /// against latency and against prediction interval. DIR/rows/rows.jsonl has each row as soon as the runs of the row
    /// have ended.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Resume an interrupted comparison with the same settings: keep the finished rows in --out, and run only the
    /// others.
    #[arg(long, requires = "out")]
    resume: bool,
    /// Speed of the head's turn in the pictures of a vertical edge, in degrees per second.
    #[arg(long, default_value_t = 200.0, value_name = "DEG_PER_S", allow_negative_numbers = true, value_parser = pan)]
    edge_pan: f64,
    #[command(flatten)]
    answer: AnswerArgs,
}

const DEFAULTS: [(&str, &str); 4] =
    [("scene", "room"), ("machine.preset", "small-hmd"), ("head.motion", "synthetic"), ("head.tracker", "optical")];

/// Maximum speed in the option `--edge-pan`, in degrees per second.
const FASTEST: f64 = 10_000.0;

fn pan(text: &str) -> Result<f64, String> {
    let expected = format!("expected a number from -{FASTEST} to {FASTEST}, found {text}");
    text.parse().ok().filter(|rate: &f64| rate.abs() <= FASTEST).ok_or(expected)
}

pub(crate) fn run(args: CompareArgs) -> Result<(), CliError> {
    // Create the folder and resolve every setting first, so that mistakes are reported before hours of runs.
    let mut folder = args.out.as_deref().map(|out| OutputFolder::of_run(out, "compare")).transpose()?;
    let shared = with_defaults(args.settings.gather()?)?;
    let first = shared.seed()?;
    let seeds = (first..=first.saturating_add(args.seeds - 1)).collect();
    let only = if args.all { RowChoice::All } else { args.only.into() };
    let (limits, pictures) = (args.limits, folder.is_some());
    let until = args.until_precision.map(|width| UntilPrecise { width, max_seeds: args.max_seeds as usize });
    let CompareArgs { causes, predictors, confidence, .. } = args;
    let mut query =
        CompareQuery { shared, only, seeds, limits, causes, predictors, pictures, confidence, until, store: None };
    set_length(&mut query, args.answer.quiet)?;
    terminal::warn(query.changes()?.as_slice(), args.answer.quiet);
    args.answer.budget.admit_study(&query, "simulate fewer fields")?;
    // The store keeps finished rows, so that an interruption loses only the rows in progress.
    if let Some(out) = &args.out {
        query.store = Some(Arc::new(query.open_store(&out.join(ROWS_FOLDER), args.resume)?));
    }
    let found = query.store.as_ref().map_or(0, |store| store.found());
    let (mut done, rows) = (found, query.rows()?.len());
    let progress = Progress::new("runs", args.answer.quiet).on_row(|bar, _, row| {
        done += 1;
        bar.line(&format!("pxpl5: row {done} of {rows}, {row}; {}\n", bar.left()));
    });
    let progress = match query.store {
        Some(_) => progress.keeping("the finished rows are kept; the same command with --resume continues"),
        None => progress,
    };
    if found > 0 {
        progress.line(&format!("pxpl5: {found} of {rows} rows were finished before\n"));
    }
    let comparison = progress.run(&query)?;
    terminal::warn(&comparison.warnings, args.answer.quiet);
    terminal::warn(out_of_view(&comparison).as_slice(), args.answer.quiet);
    let near = comparison
        .pipelines
        .iter()
        .flat_map(|row| row.near_edges.iter().map(|edge| format!("{}: {edge}", row.pipeline)));
    terminal::warn(&near.collect::<Vec<_>>(), args.answer.quiet);
    // Write all files, then publish the folder in one step.
    let json = json_text(&comparison)?;
    if interrupt::flag().is_stopped() {
        return args.answer.print(&json, || table::text(&comparison));
    }
    if let Some(folder) = &mut folder {
        folder.put("comparison.json", json.as_bytes())?;
        folder.put("experiment.toml", query.file_in(folder.path())?.as_bytes())?;
        for (name, text) in drawings::files(&comparison) {
            folder.put(name, text.as_bytes())?;
        }
        gallery::put(folder, &comparison)?;
        edges(&query, args.edge_pan, folder)?;
    }
    folder.map(OutputFolder::commit).transpose()?;
    args.answer.print(&json, || table::text(&comparison))
}

/// Returns a warning that names the rows in whose pictures the scene hardly appears.
fn out_of_view(comparison: &Comparison) -> Option<String> {
    let is_out = |row: &&ComparisonRow| row.covered_share.is_some_and(|share| share < MIN_COVERED);
    let rows: Vec<&str> = comparison.pipelines.iter().filter(is_out).map(|row| row.pipeline.as_str()).collect();
    let names = rows.join(", ");
    (!rows.is_empty()).then(|| {
        format!(
            "the scene covers less than {} % of the picture in {names}: these errors are those of the background; --place content turns the head towards it",
            MIN_COVERED * 100.0
        )
    })
}

fn with_defaults(mut file: ExperimentFile) -> Result<ExperimentFile, CliError> {
    if let Some(place) = file.place_of("pipeline") {
        return Err(CliError::usage(format!(
            "{place}: compare runs every pipeline; to run one, use `pxpl5 run --pipeline`"
        )));
    }
    for (key, value) in DEFAULTS {
        if file.place_of(key).is_none() {
            file.set(key, value, "compare")?;
        }
    }
    Ok(file)
}

/// Sets the length of the runs. Prints a warning if a recording of the head's motion is shorter than the required
/// length.
fn set_length(query: &mut CompareQuery, quiet: bool) -> Result<(), CliError> {
    if let Some(RecordedLength { fields, asked: Some(asked) }) = query.set_length()? {
        let [asked, fields] = [asked, fields].map(|fields| count_of(fields, "field"));
        terminal::warn(&[format!("the recording of the head ends before {asked}: each run has {fields}")], quiet);
    }
    Ok(())
}

fn edges(query: &CompareQuery, deg_per_s: f64, folder: &mut OutputFolder) -> Result<(), CliError> {
    let plates = edge_pictures(&machine(query)?, deg_per_s)?;
    for (name, picture) in [
        ("edge-conventional-computed.png", &plates.conventional),
        ("edge-conventional-seen.png", &plates.conventional_seen),
        ("edge-just-in-time-computed.png", &plates.just_in_time),
        ("edge-just-in-time-seen.png", &plates.just_in_time_seen),
    ] {
        let texts = [("pan, degrees per second", deg_per_s.to_string())];
        folder.put(name, &png_bytes(picture, &texts).map_err(CliError::failure)?)?;
    }
    Ok(())
}

/// Returns the machine of the comparison, configured for the pipeline `jitp-field`. This machine draws the pictures of
/// a vertical edge.
fn machine(query: &CompareQuery) -> Result<MachineConfig, CliError> {
    let mut file = query.shared.clone();
    file.set("pipeline", "jitp-field", "compare")?;
    Ok(file.resolve_for(query.seeds.first().copied().unwrap_or(1))?.machine)
}
