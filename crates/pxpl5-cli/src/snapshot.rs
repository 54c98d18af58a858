//! Runs an experiment within its budget, and saves and restores checkpoints.

use crate::budget::{BudgetArgs, EARLY_CHECK_FIELDS};
use crate::error::CliError;
use crate::estimate::RunWork;
use crate::numbers::whole;
use crate::options::registry;
use crate::output::OutputFile;
use crate::scenes;
use crate::terminal::{progress, warn};
use crate::too_heavy::too_heavy;
use clap::Args;
use pxpl5::{
    ExperimentError, ExperimentFile, Host, KeptRecords, Machine, Optimization, Outcome, PeriodNumber, Pixels, Plan,
    Snapshot, Workstation,
};
use pxpl5_sim::parameters::text_of;
use std::path::{Path, PathBuf};

/// Options to save a checkpoint of a run, or to resume a run from a checkpoint.
#[derive(Args, Debug, Default)]
pub(crate) struct SnapshotArgs {
    /// Save a checkpoint at the first retrace of this field into the file of --save, and continue.
    #[arg(long, value_name = "FIELD", requires = "save", value_parser = whole::<u64>(0, 10_000_000))]
    save_at: Option<u64>,
    /// File into which the checkpoint is saved.
    #[arg(long, value_name = "FILE", requires = "save_at")]
    save: Option<PathBuf>,
    /// Resume a run from a checkpoint. The run is repeated without pixels up to the saved field, compared with the
    /// checkpoint, and continued.
    #[arg(long, value_name = "FILE")]
    restore: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct How<'a> {
    pub(crate) threads: Option<u64>,
    pub(crate) without: &'a [Optimization],
    pub(crate) keep: KeptRecords,
    pub(crate) budget: BudgetArgs,
    pub(crate) quiet: bool,
}

#[derive(Debug)]
pub(crate) struct Simulated {
    pub(crate) outcome: Outcome,
    pub(crate) too_short: Option<CliError>,
}

impl Simulated {
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

    /// Returns the outcome of the run. Fails if the run was too short for statistics.
    pub(crate) fn long_enough(self) -> Result<Outcome, CliError> {
        self.too_short.map_or(Ok(self.outcome), Err)
    }
}

/// Keys, or prefixes of keys, that the user may set together with `--restore`. The checkpoint determines all other
/// keys.
const KEYS_BESIDE_SNAPSHOT: [&str; 4] = ["fields", "pixels", "measure", "output."];

impl SnapshotArgs {
    /// Returns the experiment of the checkpoint, changed by the settings in `given`. Without a checkpoint, returns
    /// `given`. Fails if a setting contradicts the checkpoint.
    pub(crate) fn experiment(&self, given: ExperimentFile) -> Result<ExperimentFile, CliError> {
        let Some(path) = &self.restore else { return Ok(given) };
        // Most settings are part of the checkpoint, and changing them would change the run.
        if let Some(key) = given.keys().find(|key| !KEYS_BESIDE_SNAPSHOT.iter().any(|allowed| key.starts_with(allowed)))
        {
            let message = format!(
                "{key} comes from the checkpoint; with --restore, only fields, pixels, measure and output can be set"
            );
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

    /// Simulates an experiment. Depending on the options, saves a checkpoint at a field, or continues from a restored
    /// checkpoint. Fails if the restored run differs from its checkpoint.
    pub(crate) fn simulate(&self, plan: &Plan, how: How<'_>) -> Result<Simulated, CliError> {
        let saving = self.saving(plan)?;
        // The text is written after the run, so that an interrupted run leaves no file.
        let mut saved = None;
        let scene = scenes::load(plan, how.quiet)?;
        how.budget.admit(&RunWork::of(plan, &scene, how.keep == KeptRecords::Everything))?;
        warn(too_heavy(plan, &scene, plan.fields).as_slice(), how.quiet);
        let host = how.threads.map_or_else(Workstation::new, |threads| Workstation::with_threads(threads as usize));
        let experiment = plan.experiment(scene.clone()).host(host).keep(how.keep);
        let mut experiment = how.without.iter().fold(experiment, |experiment, saving| experiment.without(*saving));
        let hash = experiment.config_hash();
        let restored = self.restored(plan)?;
        if let Some((snapshot, name)) = &restored {
            snapshot.check_scene(&scene, name)?;
            // Pixels of pictures before the checkpoint are computed only if they are read.
            experiment = experiment.pixels(if plan.pixels == Pixels::All { Pixels::Lazy } else { plan.pixels });
        }
        // The run stops at these fields: to save, to compare, and to extrapolate its cost early.
        let save_at = self.save_at.map(PeriodNumber);
        let young = EARLY_CHECK_FIELDS.map(|field| PeriodNumber::FIRST.after(field));
        let stops = save_at.into_iter().chain(restored.iter().map(|(s, _)| s.field)).chain(young);
        let stops: Vec<PeriodNumber> = stops.collect();
        let bar = progress(plan.fields, "fields", how.quiet);
        let watch = how.budget.watch(plan.fields);
        let outcome = experiment.run_stopping(&stops, |field, machine| {
            let done = field.since(PeriodNumber::FIRST);
            bar.set_position(done);
            watch.check(done, 0.0).map_err(ExperimentError::Stopped)?;
            // The repeated part must match the checkpoint before the run continues.
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

    /// Opens the file of `--save`. Fails if the field of `--save-at` lies outside the run.
    fn saving(&self, plan: &Plan) -> Result<Option<OutputFile>, CliError> {
        let (Some(field), Some(path)) = (self.save_at, &self.save) else { return Ok(None) };
        if !(1..plan.fields).contains(&field) {
            let last = plan.fields.saturating_sub(1);
            return Err(CliError::usage(format!("--save-at: expected a field from 1 to {last}, found {field}")));
        }
        OutputFile::open(path, "--save").map(Some)
    }

    /// Returns the checkpoint in the file of `--restore`, with the file name. Fails if the field of the checkpoint lies
    /// outside the run.
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
