//! Running an experiment, with a snapshot saved or restored on the way.

use crate::budget::{BudgetArgs, YOUNG};
use crate::error::CliError;
use crate::estimate::Work;
use crate::numbers::whole;
use crate::options::registry;
use crate::output::OutputFile;
use crate::scenes;
use crate::terminal::{progress, warn};
use crate::too_heavy::too_heavy;
use clap::Args;
use parameters::text_of;
use pxpl5::{
    ExperimentError, ExperimentFile, Host, Keep, Machine, Outcome, PeriodNumber, Pixels, Plan, Saving, Snapshot,
    Workstation,
};
use std::path::{Path, PathBuf};

/// A moment to be kept or to go on from.
#[derive(Args, Debug, Default)]
pub(crate) struct SnapshotArgs {
    /// Save a snapshot at the first retrace of this field (see --save), and go on.
    #[arg(long, value_name = "FIELD", requires = "save", value_parser = whole::<u64>(0, 10_000_000))]
    save_at: Option<u64>,
    /// Where the snapshot goes.
    #[arg(long, value_name = "FILE", requires = "save_at")]
    save: Option<PathBuf>,
    /// Go on from a snapshot: the run is repeated up to its field, without pixels, compared, and continued.
    #[arg(long, value_name = "FILE")]
    restore: Option<PathBuf>,
}

/// How a run is to be made, whatever comes of it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct How<'a> {
    /// Worker threads for all pixels; one a core where it is not said.
    pub(crate) threads: Option<u64>,
    /// Savings to do without.
    pub(crate) without: &'a [Saving],
    /// What of the observations is kept.
    pub(crate) keep: Keep,
    pub(crate) budget: BudgetArgs,
    pub(crate) quiet: bool,
}

/// What came of a run, and that it was too short to say much.
#[derive(Debug)]
pub(crate) struct Simulated {
    pub(crate) outcome: Outcome,
    pub(crate) too_short: Option<CliError>,
}

impl Simulated {
    /// A run that is too short has an outcome all the same.
    pub(crate) fn of(run: Result<Outcome, ExperimentError>) -> Result<Self, CliError> {
        match run {
            Ok(outcome) => Ok(Self { outcome, too_short: None }),
            Err(error) => {
                let too_short = CliError::failure(&error);
                match error {
                    ExperimentError::TooShort { partial, .. } => {
                        Ok(Self { outcome: *partial, too_short: Some(too_short) })
                    }
                    other => Err(other.into()),
                }
            }
        }
    }

    /// Of a run that is known to be long enough.
    ///
    /// # Errors
    ///
    /// When it was not.
    pub(crate) fn long_enough(self) -> Result<Outcome, CliError> {
        self.too_short.map_or(Ok(self.outcome), Err)
    }
}

/// What may be said beside a snapshot: the rest is in it.
const BESIDE: [&str; 4] = ["fields", "pixels", "measure", "output."];

impl SnapshotArgs {
    /// The experiment of the snapshot with the settings given beside it, or the experiment given.
    ///
    /// # Errors
    ///
    /// For an unusable snapshot, or settings that contradict it.
    pub(crate) fn experiment(&self, given: ExperimentFile) -> Result<ExperimentFile, CliError> {
        let Some(path) = &self.restore else { return Ok(given) };
        if let Some(key) = given.keys().find(|key| !BESIDE.iter().any(|allowed| key.starts_with(allowed))) {
            let message = format!("{key} is in the snapshot; beside --restore only fields, pixels, measure and output");
            return Err(CliError::usage(message));
        }
        let name = path.display().to_string();
        let mut file = self.read(path)?.experiment_with(registry(), &name)?;
        file.overlay(given);
        Ok(file)
    }

    fn read(&self, path: &Path) -> Result<Snapshot, CliError> {
        let name = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|error| CliError::failure(format!("{name}: {error}")))?;
        let text = text_of(&bytes).map_err(|error| CliError::failure(format!("{name}: {error}")))?;
        Ok(Snapshot::read(text, &name)?)
    }

    /// Runs it.
    ///
    /// # Errors
    ///
    /// When the run fails, is not the one of the snapshot, or the snapshot cannot be written.
    pub(crate) fn simulate(&self, plan: &Plan, how: How<'_>) -> Result<Simulated, CliError> {
        let saving = self.saving(plan)?;
        // Kept until the run has ended, so that a run that is ended in any way leaves nothing.
        let mut saved = None;
        let scene = scenes::load(plan, how.quiet)?;
        how.budget.admit(&Work::of(plan, &scene, how.keep == Keep::Everything))?;
        warn(too_heavy(plan, &scene, plan.fields).as_slice(), how.quiet);
        let host = how.threads.map_or_else(Workstation::new, |threads| Workstation::with_threads(threads as usize));
        let experiment = plan.experiment(scene.clone()).host(host).keep(how.keep);
        let mut experiment = how.without.iter().fold(experiment, |experiment, saving| experiment.without(*saving));
        let hash = experiment.config_hash();
        let restored = self.restored(plan)?;
        if let Some((snapshot, name)) = &restored {
            snapshot.check_scene(&scene, name)?;
            // Pixels of what was seen before the snapshot are computed only if somebody looks.
            experiment = experiment.pixels(if plan.pixels == Pixels::All { Pixels::Lazy } else { plan.pixels });
        }
        let save_at = self.save_at.map(PeriodNumber);
        let young = YOUNG.map(|field| PeriodNumber::FIRST.after(field));
        let stops = save_at.into_iter().chain(restored.iter().map(|(s, _)| s.field)).chain(young);
        let stops: Vec<PeriodNumber> = stops.collect();
        let bar = progress(plan.fields, "fields", how.quiet);
        let watch = how.budget.watch(plan.fields);
        let outcome = experiment.run_stopping(&stops, |field, machine| {
            let done = field.since(PeriodNumber::FIRST);
            bar.set_position(done);
            watch.check(done).map_err(ExperimentError::Stopped)?;
            if let Some((snapshot, name)) = restored.as_ref().filter(|(snapshot, _)| snapshot.field == field) {
                snapshot.check_machine(machine, name).map_err(|error| ExperimentError::Stopped(error.to_string()))?;
                continue_pixels(plan, machine, host);
            }
            if Some(field) == save_at {
                saved = Some(Snapshot::of_machine(plan, hash, &scene, field, machine).to_text());
            }
            Ok(())
        });
        bar.finish_and_clear();
        let simulated = Simulated::of(outcome)?;
        saving.zip(saved).map(|(file, text)| file.write(text.as_bytes())).transpose()?;
        Ok(simulated)
    }

    /// Where the snapshot goes.
    fn saving(&self, plan: &Plan) -> Result<Option<OutputFile>, CliError> {
        let (Some(field), Some(path)) = (self.save_at, &self.save) else { return Ok(None) };
        if !(1..plan.fields).contains(&field) {
            let last = plan.fields.saturating_sub(1);
            return Err(CliError::usage(format!("--save-at: expected a field from 1 to {last}, found {field}")));
        }
        OutputFile::open(path, "--save").map(Some)
    }

    /// The snapshot to go on from, and its name.
    fn restored(&self, plan: &Plan) -> Result<Option<(Snapshot, String)>, CliError> {
        let Some(path) = &self.restore else { return Ok(None) };
        let snapshot = self.read(path)?;
        let name = path.display().to_string();
        if snapshot.field >= PeriodNumber::FIRST.after(plan.fields) {
            let first = snapshot.field.next();
            let found = plan.fields;
            return Err(CliError::usage(format!(
                "--fields: {name} was saved at field {}: expected at least {first}, found {found}",
                snapshot.field
            )));
        }
        Ok(Some((snapshot, name)))
    }
}

fn continue_pixels(plan: &Plan, machine: &mut Machine, host: Workstation) {
    if plan.pixels == Pixels::All {
        machine.compute_all_pixels(host.pixel_worker());
    }
}
