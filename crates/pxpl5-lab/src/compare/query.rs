//! Definition and execution of a comparison of pipelines.

use super::compared::{ComparedPipeline, RowChoice};
use super::interval::CONFIDENCE;
use super::precision::UntilPrecise;
use super::predictors::predictor_means;
use super::row::{ComparisonRow, Sampling, difference};
use super::store::CompareStore;
use super::trial::{Trial, common_window_from};
use crate::Workstation;
use crate::error::StudyError;
use crate::estimate::{Estimate, RunWork};
use crate::experiment_file::{ExperimentFile, Origin, Plan, Settings, plain};
use crate::limit::{CEILING, LimitQuery};
use crate::parallel;
use crate::study::{Study, check};
use pxpl5_measure::{Showing, program};
use pxpl5_run::{Experiment, Goal, Head, Pixels, Tunings, WARM_UP_PERIODS};
use pxpl5_scene::{HmdConfig, Scene};
use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{SharedWatcher, Watcher};
use pxpl5_wire::PeriodNumber;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Maximum number of fields of a compared run: a little over an hour. A comparison keeps all observations of a run in
/// memory, because it evaluates the errors of the run in several ways.
const MAX_FIELDS: u64 = 250_000;

/// Delay in display periods from which on the evaluation of a row counts as late. Smaller delays are normal, because
/// due pictures can be several periods apart.
const MAX_PERIODS_APART: u64 = 4;

/// Minimum number of seeds for meaningful confidence intervals.
pub const MIN_SEEDS: usize = 5;

/// A comparison to run, with the settings that all rows share. Each row adds its pipeline and a few settings.
#[derive(Clone, Debug)]
pub struct CompareQuery {
    /// Machine, scene, head and number of fields, without a pipeline. The compared pipelines come from the registry of
    /// the experiment file. If `head.motion` is `synthetic`, each seed has a different motion.
    pub shared: ExperimentFile,
    /// The rows to run, which are pipelines with settings.
    pub only: RowChoice,
    /// Seeds of the random numbers of tracker, host and motion. Each row runs once for each seed.
    pub seeds: Vec<u64>,
    /// True if the comparison also searches for the largest number of triangles that each row can draw.
    pub limits: bool,
    /// True if the error of each row is split by its causes ([`ComparisonRow::causes`]). Each run is then evaluated
    /// once for each cause.
    pub causes: bool,
    /// True if each row also runs with all other predictors ([`ComparisonRow::predictors`]).
    pub predictors: bool,
    /// True if the runs of the first seed compute pixels, for [`ComparisonRow::picture`].
    pub pictures: bool,
    /// Confidence of all intervals, between 0 and 1; usually [`CONFIDENCE`](super::CONFIDENCE).
    pub confidence: f64,
    /// Precision of the mean error, for which seeds are added to rows. `None` runs only the seeds in
    /// [`CompareQuery::seeds`].
    pub until: Option<UntilPrecise>,
    /// Folder of finished rows, from [`CompareQuery::open_store`]. Rows in the folder are not run, and each finished row
    /// is stored after its last run.
    pub store: Option<Arc<CompareStore>>,
}

/// Result of a comparison: the shared settings, and one row for each method.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Name and version of the JSON layout.
    pub schema: &'static str,
    /// Version of the program that made the comparison.
    pub version: &'static str,
    /// Commit from which the program was built, if it is known.
    pub commit: Option<&'static str>,
    /// Hash of everything that affects the first row with the first seed.
    pub config_hash: String,
    /// Every key that was set, options of the comparison, and hashes of the scene and of the files that are named.
    pub settings: BTreeMap<String, String>,
    /// Warnings about settings whose values no source supports.
    pub warnings: Vec<String>,
    /// Name of the machine's preset.
    pub machine: String,
    /// Number of graphics processors and number of renderers.
    pub boards: [u64; 2],
    /// Name of the scene that all rows draw.
    pub scene: String,
    /// Number of triangles in the scene.
    pub triangles: usize,
    /// Keys of the head's settings with their values.
    pub head: Vec<(String, String)>,
    /// Parameters of the head-mounted display.
    pub hmd: HmdConfig,
    /// Number of fields simulated for each seed.
    pub fields: u64,
    /// Seeds of the runs. Each row ran with all these seeds, and may have run with more ([`ComparisonRow::seeds`]).
    pub seeds: Vec<u64>,
    /// Confidence of all intervals, between 0 and 1.
    pub confidence: f64,
    /// Required width of the confidence intervals, such as `10%`. `None` if no width was required.
    pub until_precision: Option<String>,
    /// Maximum number of seeds of a row. `None` if no width of the intervals was required.
    pub max_seeds: Option<usize>,
    /// Earliest display period in which any row is evaluated. The evaluation of a row can begin later, because the
    /// row's warm-up is longer or because its pictures are due only every few periods ([`ComparisonRow::window`]).
    pub evaluated_from: PeriodNumber,
    /// One row for each compared pipeline, in the order of the registry.
    pub pipelines: Vec<ComparisonRow>,
}

struct Common<'a> {
    scene: Arc<Scene>,
    tunings: Arc<Tunings>,
    /// Counts the runs. Their number grows when seeds are added.
    watcher: SharedWatcher<'a>,
}

impl Common<'_> {
    /// Returns the experiment for checked settings. All rows share the tuning of predictors. Another thread can stop
    /// the run.
    fn experiment(&self, plan: &Plan) -> Experiment {
        let experiment =
            plan.experiment(Arc::clone(&self.scene)).host(Workstation::new()).stopped_by(self.watcher.stop());
        let head = experiment.head.as_ref().map(|head| Head::clone(head).sharing_tunings(Arc::clone(&self.tunings)));
        match head {
            Some(head) => experiment.head(head),
            None => experiment,
        }
    }
}

impl Study for CompareQuery {
    type Report = Comparison;

    fn estimate(&self, threads: usize) -> Estimate {
        // Seeds may be added up to the maximum, so the estimate covers the maximum.
        let seeds = self.until.map_or(0, |until| until.max_seeds).max(self.seeds.len());
        let plans = self.plans().unwrap_or_default();
        let Some(scene) = plans.first().and_then(|plan| plan.load_scene().ok()) else { return Estimate::NOTHING };
        let works = plans.iter().map(|plan| RunWork::of(&plan.experiment(Arc::clone(&scene)), true));
        Estimate::of_all(works.flat_map(|work| std::iter::repeat_n(work.estimate(), seeds)), threads)
    }

    /// Runs each row with each seed. Runs in progress end soon after a stop, and their rows are neither stored nor in the
    /// result.
    ///
    /// The result has a row for each pipeline. A pipeline may be unable to run on the machine, or show no picture of
    /// the scene. Its row then holds the reason, and the number of triangles that the pipeline could draw.
    fn run(&self, watcher: &mut dyn Watcher) -> Result<Comparison, StudyError> {
        let compared_pipelines = self.compared_pipelines()?;
        // The first row serves to check the settings that all rows share.
        let any = self.any_plan()?;
        let scene = any.load_scene()?;
        let held =
            |compared: &ComparedPipeline| self.store.as_deref().and_then(|store| store.row(compared.name)).cloned();
        let missing = compared_pipelines.iter().filter(|compared| held(compared).is_none()).count();
        let runs_of_a_row = self.seeds.len() + usize::from(self.limits);
        let watcher = SharedWatcher::new(watcher, (missing * runs_of_a_row) as u64);
        // After a row could not be stored, no further row starts.
        let is_failed = AtomicBool::new(false);
        // Rows with the same head and prediction interval share the tuning of the predictor.
        let common = Common { scene, tunings: Arc::default(), watcher };
        // Rows and the seeds of each row execute in parallel. So each row is known as soon as its own runs have ended.
        let pipelines = parallel::map(&compared_pipelines, |compared| {
            if let Some(row) = held(compared) {
                return Ok(Some(row));
            }
            if is_failed.load(Ordering::Relaxed) {
                return Ok(None);
            }
            let stop = common.watcher.stop();
            if stop.is_stopped() {
                return Ok(None);
            }
            let row = self.row(compared, &common);
            // A row whose runs were stopped is not a result.
            if stop.is_stopped() {
                return Ok(None);
            }
            let row = row?;
            if self.limits {
                common.watcher.step();
            }
            let row = match &self.store {
                Some(store) => store.append(row).inspect_err(|_| is_failed.store(true, Ordering::Relaxed))?,
                None => row,
            };
            common.watcher.row("rows", &row);
            Ok::<_, StudyError>(Some(row))
        });
        let sampling = self.sampling(&any)?;
        // Settings of the first row alone do not belong to the head of all rows.
        let shared = ComparedPipeline { settings: &[], ..compared_pipelines[0] }.plan(&self.shared, any.seed)?;
        let mut comparison = Comparison {
            schema: "pxpl5-comparison/5",
            version: program::VERSION,
            commit: program::commit(),
            config_hash: any.experiment(Arc::clone(&common.scene)).config_hash().to_string(),
            settings: self.header()?.settings,
            // All rows draw the scene, so its import warnings apply to all.
            warnings: any
                .warnings()
                .into_iter()
                .chain(common.scene.warnings().iter().map(ToString::to_string))
                .collect(),
            machine: any.machine.preset.clone(),
            boards: any.machine.boards(),
            scene: common.scene.name().to_owned(),
            triangles: common.scene.triangles().len(),
            head: shared
                .head
                .iter()
                .flat_map(|head| head.settings())
                .map(|(key, value)| (key, plain(&value)))
                .collect(),
            hmd: *any.hmd.config(),
            fields: any.fields,
            seeds: self.seeds.clone(),
            confidence: self.confidence,
            until_precision: self.until.map(|until| until.width.to_string()),
            max_seeds: self.until.map(|until| until.max_seeds),
            evaluated_from: common_window_from(any.fields),
            pipelines: pipelines.into_iter().filter_map(Result::transpose).collect::<Result<_, _>>()?,
        };
        comparison.compare_with_best(sampling);
        if comparison.pipelines.is_empty() {
            check(&common.watcher.stop())?;
        }
        Ok(comparison)
    }
}

impl CompareQuery {
    /// Creates a comparison of the usual rows with [`MIN_SEEDS`] seeds. All rows share the settings in `shared`.
    pub fn new(shared: ExperimentFile) -> Self {
        Self {
            shared,
            only: RowChoice::Usual,
            seeds: (1..=MIN_SEEDS as u64).collect(),
            limits: false,
            causes: false,
            predictors: false,
            pictures: false,
            confidence: CONFIDENCE,
            until: None,
            store: None,
        }
    }

    /// Returns the names of the rows that the query runs.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Study::run`].
    pub fn rows(&self) -> Result<Vec<String>, StudyError> {
        Ok(self.identity()?.1)
    }

    /// Returns the checked settings of the first row with the first seed, and the names of all rows.
    pub(super) fn identity(&self) -> Result<(Plan, Vec<String>), StudyError> {
        let rows = self.compared_pipelines()?.iter().map(|row| row.name.to_owned()).collect();
        Ok((self.any_plan()?, rows))
    }

    /// Returns the checked settings of each row with the first seed, for an estimate of the cost of the comparison.
    /// Rows that cannot run are left out.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Study::run`].
    pub fn plans(&self) -> Result<Vec<Plan>, StudyError> {
        let seed = self.any_plan()?.seed;
        Ok(self.compared_pipelines()?.iter().filter_map(|compared| compared.plan(&self.shared, seed).ok()).collect())
    }

    /// Returns a warning if the shared settings come from the folder of another comparison, and its results will differ.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Study::run`].
    pub fn changes(&self) -> Result<Option<String>, StudyError> {
        let (plan, _) = self.identity()?;
        Ok(plan.origin.changes(&Origin::of(&plan.experiment(plan.load_scene()?))))
    }

    /// Returns an experiment file in `folder` with the shared settings, their origin, and the command that makes the
    /// comparison again.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Study::run`].
    pub fn file_in(&self, folder: &Path) -> Result<String, StudyError> {
        let (plan, rows) = self.identity()?;
        let mut settings = Settings::of(&self.shared);
        settings.make_relative(folder);
        settings.originate(&Origin::of(&plan.experiment(plan.load_scene()?)));
        let mut options =
            format!("--only {} --seeds {} --confidence {}", rows.join(","), self.seeds.len(), self.confidence);
        if let Some(until) = self.until {
            options += &format!(" --until-precision {} --max-seeds {}", until.width, until.max_seeds);
        }
        for (option, _) in [("limits", self.limits), ("causes", self.causes), ("predictors", self.predictors)]
            .iter()
            .filter(|(_, is_on)| *is_on)
        {
            options += &format!(" --{option}");
        }
        let first = self.seeds.first().copied().unwrap_or_default();
        Ok(format!("# pxpl5 compare experiment.toml --seed {first} {options}\n{settings}"))
    }

    fn compared_pipelines(&self) -> Result<Vec<ComparedPipeline>, StudyError> {
        Ok(self.only.of(self.shared.registry())?)
    }

    /// Returns the checked settings of the first row with the first seed. The number of fields is not checked.
    pub(super) fn first_plan(&self) -> Result<Plan, StudyError> {
        let seed = *self.seeds.first().ok_or_else(|| SettingError::value("seeds", "at least one", "none"))?;
        let rows = self.compared_pipelines()?;
        let none = || SettingError::value("", "a registry with a pipeline that is compared", "none");
        Ok(rows.first().ok_or_else(none)?.plan(&self.shared, seed)?)
    }

    /// Checks the settings that all rows share: the head, the seeds and the number of fields. Returns the checked
    /// settings of the first row with the first seed.
    fn any_plan(&self) -> Result<Plan, StudyError> {
        let plan = self.first_plan()?;
        if plan.head.is_none() {
            let found = "none: without a head there is no error to compare";
            return Err(SettingError::value("", "a head.motion", found).into());
        }
        if self.until.is_some() && !self.shared.has_motion_for_each_seed()? {
            return Err(SettingError::combination(
                "this motion is the same for all seeds: its interval also shows how the motion varies, which more seeds do not make narrower; \
                 use head.motion = synthetic or a longer recording, or compare without a precision",
            )
            .into());
        }
        self.check_seeds()?;
        // The run must be longer than the warm-up of every pipeline.
        let expected = (WARM_UP_PERIODS + 1, MAX_FIELDS);
        let holds = (expected.0..=expected.1).contains(&plan.fields);
        SettingError::require(holds, "fields", format_args!("{} to {}", expected.0, expected.1), plan.fields)?;
        Ok(plan)
    }

    /// Checks three conditions: all seeds differ, experiment files can hold all seeds, and the maximum number of seeds
    /// is not below the number of seeds.
    fn check_seeds(&self) -> Result<(), SettingError> {
        let mut sorted = self.seeds.clone();
        sorted.sort_unstable();
        let twice = sorted.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0]);
        let max_seeds = self.until.map_or(0, |until| until.max_seeds);
        let greatest = i64::MAX as u64 - max_seeds as u64;
        match (twice, sorted.last()) {
            (Some(seed), _) => Err(SettingError::value("seeds", "different seeds", seed)),
            (None, Some(seed)) if *seed > greatest => {
                Err(SettingError::value("seeds", format_args!("seeds of at most {greatest}"), seed))
            }
            _ if self.until.is_some() && max_seeds < self.seeds.len() => {
                let expected = format_args!("a maximum of at least {} seeds", self.seeds.len());
                Err(SettingError::value("seeds", expected, max_seeds))
            }
            _ => Ok(()),
        }
    }

    /// Returns `more` new seeds for a row that has already run with `ran` seeds. The new seeds are greater than all
    /// seeds of the row.
    fn seeds_after(&self, ran: usize, more: usize) -> Vec<u64> {
        let greatest = self.seeds.iter().copied().max().unwrap_or_default();
        let added = (ran - self.seeds.len()) as u64;
        (1..=more as u64).map(|n| greatest.saturating_add(added + n)).collect()
    }

    fn trials(&self, compared: &ComparedPipeline, seeds: &[u64], common: &Common<'_>) -> Vec<Result<Trial, String>> {
        parallel::map(seeds, |seed| {
            let trial = self.trial(compared, *seed, common);
            common.watcher.step();
            trial
        })
    }

    fn trial(&self, compared: &ComparedPipeline, seed: u64, common: &Common<'_>) -> Result<Trial, String> {
        // Pixels are needed only for the picture of the first seed.
        let is_seen = self.pictures && self.seeds.first() == Some(&seed) && !compared.is_reference();
        let pixels = if is_seen { Pixels::Lazy } else { Pixels::Off };
        let plan = compared.plan(&self.shared, seed).map_err(|error| error.to_string())?;
        compared.trial(common.experiment(&plan).pixels(pixels), self.causes)
    }

    fn sampling(&self, plan: &Plan) -> Result<Sampling, StudyError> {
        let is_one_motion = !self.shared.has_motion_for_each_seed()?;
        let is_noisy = plan.head.as_ref().is_some_and(|head| head.head().tracker().config().is_random());
        Ok(Sampling { seeds: self.seeds.len(), is_one_motion, is_noisy, confidence: self.confidence })
    }

    /// Runs a row with all seeds. Then adds seeds while the confidence interval of the mean error is too wide.
    fn row(&self, compared: &ComparedPipeline, common: &Common<'_>) -> Result<ComparisonRow, StudyError> {
        let plan = match compared.plan(&self.shared, self.seeds[0]) {
            Ok(plan) => plan,
            // A row whose pictures the device of the settings cannot move states the reason.
            Err(error) => {
                let mut plain = self.shared.clone();
                plain.settings.retain(|key, _| key != "head.raster" && !key.starts_with("head.reprojection."));
                let Ok(plan) = compared.plan(&plain, self.seeds[0]) else { return Err(error.into()) };
                let none = Sampling { seeds: 0, ..self.sampling(&plan)? };
                let row = ComparisonRow::of(compared, plan.pipeline.as_ref(), &[], none);
                return Ok(ComparisonRow { failure: Some(error.to_string()), ..row });
            }
        };
        let mut trials = self.trials(compared, &self.seeds, common);
        let (mut row, shown) = loop {
            // Failed runs are left out, and their first error is reported below.
            let ran: Vec<&Trial> = trials.iter().flatten().collect();
            let sampling = Sampling { seeds: trials.len(), ..self.sampling(&plan)? };
            let mut row = ComparisonRow::of(compared, plan.pipeline.as_ref(), &ran, sampling);
            row.is_precise = self.until.map(|until| until.is_reached(&row.error.mean_px));
            // More seeds do not help a row with failed runs or without an evaluation.
            let helps = ran.len() == trials.len() && row.was_evaluated();
            let until = self.until.filter(|_| helps);
            check(&common.watcher.stop())?;
            let more = until.map_or(0, |until| until.seeds_to_add(&row.error.mean_px, trials.len()));
            if more == 0 {
                let shown: usize = ran.iter().map(|trial| trial.shown).sum();
                break (row, shown);
            }
            common.watcher.add(more as u64);
            let seeds = self.seeds_after(trials.len(), more);
            trials.extend(self.trials(compared, &seeds, common));
        };
        if let Some(Ok(first)) = trials.first()
            && self.predictors
            && !compared.is_reference()
        {
            // All predictors are evaluated over the periods of the row.
            let mut experiment = common.experiment(&plan).results_from(common_window_from(plan.fields));
            // The dry run of the first trial is reused for every predictor.
            experiment.dry_run = first.dry_run.clone();
            row.predictors = predictor_means(&experiment, compared.showing, first.errors.pixels.mean);
        }
        if self.limits && !compared.is_reference() {
            row.triangles_definition = definition(&plan);
            // The limit is that of the pipeline and the machine, so a search without the head is enough.
            let query = LimitQuery { looks_above: false, head: None, ..LimitQuery::of_plan(&plan) };
            let triangles = query.run(&mut common.watcher.stop()).ok().map(|limit| limit.triangles);
            row.has_no_limit = triangles == Some(CEILING);
            row.triangles_possible = triangles.filter(|triangles| *triangles < CEILING);
        }
        let error = trials.iter().find_map(|trial| trial.as_ref().err().cloned());
        // If a row showed no picture, its failure states the reason.
        row.failure = error.or_else(|| (shown == 0 && !row.was_evaluated()).then(|| nothing_shown(&row, plan.fields)));
        Ok(row)
    }
}

impl ComparedPipeline {
    fn is_reference(&self) -> bool {
        self.showing == Showing::Ideal
    }
}

fn nothing_shown(row: &ComparisonRow, fields: u64) -> String {
    let could = row
        .triangles_possible
        .map_or_else(String::new, |n| format!("; it could draw {n} {}", row.triangles_definition));
    match row.pictures_due.filter(|due| *due > 0) {
        Some(due) => format!(
            "cannot draw the scene: of {due} pictures due none was complete in time, so the scene is too heavy{could}"
        ),
        None => format!("no picture was shown after the warm-up in {fields} fields: simulate more fields{could}"),
    }
}

/// Returns, in words, the criterion for drawing a number of triangles in time.
fn definition(plan: &Plan) -> String {
    let goal = match plan.limit.goal {
        Goal::NoMissedRetrace => "with no retrace missed".to_owned(),
        Goal::RateHz(hz) => format!("at {hz} Hz"),
        Goal::LatencyFields(fields) => format!("at a mean latency of {fields} fields"),
    };
    format!("{} triangles {goal}", plan.limit.scene.name())
}

impl Comparison {
    /// Returns the row with the least mean error.
    ///
    /// Four kinds of rows are never the best:
    ///
    /// - rows with due pictures that were not shown
    /// - the row `ideal`, which shows ideal pictures for comparison
    /// - rows whose evaluation begins later than that of most rows
    /// - the row with delayed video, because its error leaves out the delay of the real world
    pub fn best(&self) -> Option<&ComparisonRow> {
        let ranked = self.pipelines.iter().filter(|row| self.is_ranked(row));
        ranked.min_by(|one, other| one.error.mean_px.mean.total_cmp(&other.error.mean_px.mean))
    }

    /// Returns the rows with the least mean error: the best row, and all rows that cannot be told apart from it, because
    /// the interval of the difference contains 0 ([`ComparisonRow::above_best_px`]). Without intervals, the best row alone.
    pub fn least(&self) -> Vec<&ComparisonRow> {
        let is_least = |row: &&ComparisonRow| {
            row.above_best_px.is_some_and(|above| above.mean <= 0.0 || above.width().is_some() && above.may_be_zero())
        };
        let mut rows: Vec<&ComparisonRow> = self.pipelines.iter().filter(is_least).collect();
        rows.sort_by(|one, other| one.error.mean_px.mean.total_cmp(&other.error.mean_px.mean));
        rows
    }

    fn compare_with_best(&mut self, sampling: Sampling) {
        let Some(best) = self.best().cloned() else { return };
        let ranked: Vec<bool> = self.pipelines.iter().map(|row| self.is_ranked(row)).collect();
        for (row, is_ranked) in self.pipelines.iter_mut().zip(ranked) {
            row.above_best_px = is_ranked.then(|| difference(row, &best, sampling));
        }
    }

    fn is_ranked(&self, row: &ComparisonRow) -> bool {
        row.was_evaluated()
            && row.failure.is_none()
            && row.shows_all()
            && row.is_ranked()
            && row.head_to_light_ms.mean.is_finite()
            && !self.starts_late(row)
    }

    /// Returns true if the evaluation of `row` begins four or more display periods after
    /// [`Comparison::evaluated_from`].
    pub fn starts_late(&self, row: &ComparisonRow) -> bool {
        row.window.is_some_and(|window| window.first_period.0 >= self.evaluated_from.0 + MAX_PERIODS_APART)
    }

    /// Returns the row with this name, if any.
    pub fn row(&self, pipeline: &str) -> Option<&ComparisonRow> {
        self.pipelines.iter().find(|row| row.pipeline == pipeline)
    }
}
