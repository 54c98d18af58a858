//! Saves and restores a run at the boundary between two display fields.
//!
//! A [`Snapshot`] is a checkpoint: a saved run that can be continued. The checkpoint does not hold the state of the
//! boards, because their programs are suspended `async` functions, whose state cannot be serialized. Instead, the
//! checkpoint holds the data that determine this state: the experiment, the identity of the scene, and the field. The
//! checkpoint also holds the trace hash and the number of events, which identify the state.
//!
//! To restore a checkpoint, the program repeats the run up to the saved field without computing pixels. The program
//! then compares the hash and the number of events with the saved values, and continues the run. A restored run is
//! therefore identical to the original run. Restoring takes as long as the original simulation up to that field
//! (thousands of fields a second for small scenes).
//!
//! The file is JSON with a version and a checksum. Damaged files and other files are refused with the reason.

use crate::experiment_file::{ExperimentFile, Plan};
use pxpl5_machine::Machine;
use pxpl5_run::{Experiment, Fingerprint, Registry, Stepper};
use pxpl5_scene::Scene;
use pxpl5_sim::Time;
use pxpl5_sim::parameters::{FileError, FileErrorKind, SettingError};
use pxpl5_wire::PeriodNumber;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fmt::Display;
use std::sync::Arc;

/// A checkpoint: the data that repeat a run up to a field, and the hashes that verify the repeated run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Snapshot {
    /// Name and version of the JSON layout.
    pub schema: String,
    /// Version of the program that wrote the checkpoint.
    pub version: String,
    /// Name of the machine's preset.
    pub machine: String,
    /// Hash of all settings on which the trace of the whole run depends.
    pub config_hash: String,
    /// Name of the level of detail: `transaction` or `cycle`.
    pub level: String,
    /// Seed of the head motion.
    pub seed: u64,
    /// Field that begins at the instant of the checkpoint. No event of this field has happened yet.
    pub field: PeriodNumber,
    /// Instant of the checkpoint in picoseconds.
    pub time_ps: u64,
    /// Trace hash of all events before the checkpoint.
    pub trace_hash: String,
    /// Number of events before the checkpoint.
    pub events: u64,
    /// Hash of the scene's contents.
    pub scene_hash: String,
    /// Text of the experiment file. `None` for an experiment that a program built without a file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub experiment: Option<String>,
}

impl Snapshot {
    /// Name and version of the JSON layout.
    pub const SCHEMA: &'static str = "pxpl5-snapshot/1";

    /// Creates a checkpoint of a machine that has just reached the retrace at the start of a field.
    #[must_use]
    pub fn of_machine(
        plan: &Plan,
        config_hash: Fingerprint,
        scene: &Scene,
        field: PeriodNumber,
        machine: &Machine,
    ) -> Self {
        Self {
            schema: Self::SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            machine: plan.machine.preset.clone(),
            config_hash: config_hash.to_string(),
            level: plan.level_name(),
            seed: plan.seed,
            field,
            time_ps: machine.record().tick(field).0,
            trace_hash: machine.record().trace_hash().to_string(),
            events: machine.events(),
            scene_hash: Fingerprint::of_scene(scene).to_string(),
            experiment: Some(plan.settings().to_string()),
        }
    }

    /// Creates a checkpoint of a run of an experiment that a program built without a file.
    ///
    /// The file of the checkpoint does not describe such an experiment, so [`Snapshot::resume`] needs the same
    /// experiment as its argument.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] unless the run has just reached the start of a period ([`Stepper::step_period`]).
    pub fn of_stepper(stepper: &Stepper) -> Result<Self, SettingError> {
        let (experiment, machine, field) = (stepper.experiment(), stepper.machine(), stepper.period());
        let start = machine.record().tick(field);
        // An event at the start of the period may have been handled already.
        if stepper.now() != start || stepper.last().is_some() {
            let found = format!("{}, {} after the start", stepper.now(), stepper.now().since(start));
            return Err(SettingError::value("", "a run at the start of a period of the first display", found));
        }
        Ok(Self {
            schema: Self::SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            machine: experiment.config().preset.clone(),
            config_hash: experiment.config_hash().to_string(),
            level: experiment.modelling_level().name().to_owned(),
            seed: experiment.motion_seed(),
            field,
            time_ps: start.0,
            trace_hash: machine.record().trace_hash().to_string(),
            events: machine.events(),
            scene_hash: Fingerprint::of_scene(experiment.scene()).to_string(),
            experiment: None,
        })
    }

    /// Repeats the run of an experiment up to the saved field, and returns the run at this point. `file` is the name of
    /// the checkpoint in error messages.
    ///
    /// # Errors
    ///
    /// Returns a [`FileError`] if the experiment, the scene or the repeated run differs from the saved data, or if the
    /// experiment cannot run.
    pub fn resume(&self, experiment: &Experiment, file: &str) -> Result<Stepper, FileError> {
        // A different experiment is refused before its run.
        self.check_scene(experiment.scene(), file)?;
        let found = experiment.config_hash().to_string();
        self.same("the fingerprint of the settings", &self.config_hash, found, file)?;
        let mut stepper = experiment.stepper().map_err(|error| foreign(file, error))?;
        // A run that ended early differs in its hash.
        stepper.run_to(Time(self.time_ps));
        self.check_machine(stepper.machine(), file)?;
        Ok(stepper)
    }

    /// Returns the text of the checkpoint's file.
    pub fn to_text(&self) -> String {
        let sealed = Sealed { snapshot: self.clone(), checksum: self.checksum() };
        let mut text = serde_json::to_string_pretty(&sealed).unwrap_or_default();
        text.push('\n');
        text
    }

    /// Reads the text of a checkpoint's file. `file` is its name in error messages.
    ///
    /// # Errors
    ///
    /// Returns [`FileError`] for any text that [`Self::to_text`] did not write.
    pub fn read(text: &str, file: &str) -> Result<Self, FileError> {
        let value: Value =
            serde_json::from_str(text).map_err(|error| no_snapshot(file, format!("not whole JSON: {error}")))?;
        let found = value.get("schema").and_then(Value::as_str).unwrap_or("none");
        // A file of another program and a file of another version get different errors.
        if !found.starts_with("pxpl5-snapshot/") {
            return Err(no_snapshot(file, format!("expected schema {}, found {found}", Self::SCHEMA)));
        }
        if found != Self::SCHEMA {
            let expected = format!("a checkpoint of layout {}", Self::SCHEMA);
            let found = format!("{found}; use the version of pxpl5 that wrote it");
            return Err(FileError::new(FileErrorKind::Foreign, expected, found).in_file(file));
        }
        let sealed: Sealed = serde_json::from_value(value).map_err(|error| no_snapshot(file, error.to_string()))?;
        // The checksum detects every later change.
        let expected = sealed.snapshot.checksum();
        if sealed.checksum != expected {
            let found = sealed.checksum;
            let reason = format!("the checkpoint is damaged: expected checksum {expected}, found {found}");
            return Err(FileError::because(FileErrorKind::Damaged, reason).in_file(file));
        }
        Ok(sealed.snapshot)
    }

    fn checksum(&self) -> String {
        Fingerprint::of(serde_json::to_string(self).unwrap_or_default().as_bytes()).to_string()
    }

    /// Returns the saved experiment.
    ///
    /// # Errors
    ///
    /// Returns a [`FileError`] if this version cannot read the experiment, or if the checkpoint holds no experiment.
    pub fn experiment(&self, file: &str) -> Result<ExperimentFile, FileError> {
        self.experiment_with(crate::registry(), file)
    }

    /// Returns the saved experiment, which may use pipelines and displays of `registry`.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Self::experiment`].
    pub fn experiment_with(&self, registry: Arc<Registry>, file: &str) -> Result<ExperimentFile, FileError> {
        let text = format!("{file}: experiment");
        let experiment = self.experiment.as_ref().ok_or_else(|| {
            foreign(file, "the experiment was built in code; build it again and call Snapshot::resume")
        })?;
        ExperimentFile::with(registry).and_parse(experiment, &text).map_err(|error| foreign(file, error))
    }

    /// Compares the hash of `scene` with the hash in the checkpoint.
    ///
    /// # Errors
    ///
    /// Returns a [`FileError`] if the scenes differ.
    pub fn check_scene(&self, scene: &Scene, file: &str) -> Result<(), FileError> {
        self.same("the scene's fingerprint", &self.scene_hash, Fingerprint::of_scene(scene).to_string(), file)
    }

    /// Compares the trace hash and the number of events of `machine` with the checkpoint. The machine must have
    /// repeated the run up to the saved field.
    ///
    /// # Errors
    ///
    /// Returns a [`FileError`] if a value differs.
    pub fn check_machine(&self, machine: &Machine, file: &str) -> Result<(), FileError> {
        self.same("the trace hash", &self.trace_hash, machine.record().trace_hash().to_string(), file)?;
        self.same("the number of events", &self.events.to_string(), machine.events().to_string(), file)
    }

    fn same(&self, what: &'static str, expected: &str, found: String, file: &str) -> Result<(), FileError> {
        if expected == found {
            return Ok(());
        }
        let version = &self.version;
        let part = format!("the repeated run differs from the saved run (version {version}): {what}");
        Err(FileError::new(FileErrorKind::Foreign, expected, found).at(part).in_file(file))
    }
}

fn no_snapshot(file: &str, reason: String) -> FileError {
    FileError::because(FileErrorKind::Syntax, format_args!("this is not a checkpoint: {reason}")).in_file(file)
}

fn foreign(file: &str, reason: impl Display) -> FileError {
    FileError::because(FileErrorKind::Foreign, reason).in_file(file)
}

#[derive(Serialize, Deserialize)]
struct Sealed {
    #[serde(flatten)]
    snapshot: Snapshot,
    checksum: String,
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};
    use pxpl5_machine::MachineConfig;
    use pxpl5_measure::Measured;
    use pxpl5_run::{Head, Pixels, RenderingControl};
    use tracking::Pose;
    use tracking::motion::from_fn;
    use tracking::predict::PredictorKind;
    use tracking::tracker::TrackerConfig;

    /// Runs an experiment. Returns its plan, its checkpoint at field 9, and its trace hash at the end.
    fn saved() -> (Plan, Snapshot, String) {
        let text = "pipeline = \"rendering-control\"\nscene = \"mig\"\ntriangles = 40\nfields = 24\nseed = 5\n";
        let plan = ExperimentFile::parse(text, "test").and_then(|file| file.resolve()).expect("an experiment");
        let scene = plan.load_scene().expect("built in");
        let experiment = plan.experiment(scene.clone()).pixels(Pixels::Off);
        let mut snapshot = None;
        let outcome = experiment.run_stopping(&[PeriodNumber(9)], |field, machine| {
            if field == PeriodNumber(9) {
                snapshot = Some(Snapshot::of_machine(&plan, experiment.config_hash(), &scene, field, machine));
            }
            Ok(())
        });
        let hash = outcome.expect("it runs").report().trace_hash;
        (plan, snapshot.expect("field 9 was passed"), hash)
    }

    #[test]
    fn a_run_repeated_from_its_checkpoint_is_equal_at_the_field_and_at_the_end() {
        let (plan, snapshot, end) = saved();
        let snapshot = Snapshot::read(&snapshot.to_text(), "s").expect("as written");
        let restored = snapshot.experiment("s").and_then(|file| file.resolve().map_err(|error| foreign("s", error)));
        let restored = restored.expect("as written");
        assert_eq!(restored, plan);
        let scene = restored.load_scene().expect("built in");
        snapshot.check_scene(&scene, "s").expect("the same");
        let mut compared = false;
        let outcome = restored.experiment(scene).run_stopping(&[PeriodNumber(9)], |field, machine| {
            if field == PeriodNumber(9) {
                snapshot.check_machine(machine, "s").expect("the same");
                compared = true;
            }
            Ok(())
        });
        assert!(compared);
        assert_eq!(outcome.expect("it runs").report().trace_hash, end);
    }

    /// Returns an experiment whose motion is a function, so no experiment file can describe it. The head turns at
    /// `rate` rad/s.
    fn built_in_code(rate: f64) -> Experiment {
        let turn = move |s: f64| Pose { position: DVec3::ZERO, orientation: DQuat::from_rotation_y(rate * s) };
        let head = Head::new(Arc::new(from_fn(turn)), TrackerConfig::fastrak(), PredictorKind::None, 1);
        let scene = pxpl5_scene::builtin("full-screen:12").expect("built in");
        let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene);
        experiment.fields(40).pixels(Pixels::Off).head(head.expect("a head"))
    }

    #[test]
    fn a_run_built_in_code_continues_from_its_snapshot_to_the_same_end() {
        let experiment = built_in_code(0.5);
        let mut stepper = experiment.stepper().expect("it begins");
        (0..9).for_each(|_| drop(stepper.step_period()));
        let snapshot = Snapshot::of_stepper(&stepper).expect("at a retrace");
        let snapshot = Snapshot::read(&snapshot.to_text(), "s").expect("as written");
        assert_eq!(snapshot.field, PeriodNumber(9));
        let end = stepper.finish().expect("it runs").record().trace_hash();
        let resumed = snapshot.resume(&experiment, "s").expect("the same");
        assert_eq!(resumed.period(), PeriodNumber(9));
        assert_eq!(resumed.finish().expect("it runs").record().trace_hash(), end);
        // There is no text from which the experiment could be made.
        let error = snapshot.experiment("s").expect_err("no file");
        assert!(error.to_string().starts_with("s: the experiment was built in code"), "{error}");
    }

    #[test]
    fn a_snapshot_of_another_experiment_or_within_a_period_is_refused() {
        let experiment = built_in_code(0.5);
        let mut stepper = experiment.stepper().expect("it begins");
        stepper.step_period();
        let snapshot = Snapshot::of_stepper(&stepper).expect("at a retrace");
        for other in [experiment.clone().fields(41), built_in_code(0.25)] {
            let error = snapshot.resume(&other, "s").expect_err("another experiment").to_string();
            assert!(error.contains("the repeated run differs from the saved run"), "{error}");
        }
        stepper.step_event();
        let error = Snapshot::of_stepper(&stepper).expect_err("after an event").to_string();
        assert!(error.starts_with("expected a run at the start of a period"), "{error}");
    }

    #[test]
    fn stops_during_a_run_do_not_change_the_trace() {
        let (plan, _, stopped) = saved();
        let whole = plan.experiment(plan.load_scene().expect("built in")).run().expect("it runs");
        assert_eq!(whole.report().trace_hash, stopped);
    }

    #[test]
    fn a_checkpoint_of_another_machine_is_refused() {
        let (plan, snapshot, _) = saved();
        let other = Plan { seed: 6, ..plan.clone() };
        let result = other.experiment(plan.load_scene().expect("built in")).run_stopping(
            &[PeriodNumber(9)],
            |field, machine| {
                if field == PeriodNumber(9) {
                    let error = snapshot.check_machine(machine, "s").expect_err("another seed").to_string();
                    assert!(error.contains("the repeated run differs from the saved run"), "{error}");
                }
                Ok(())
            },
        );
        result.expect("it runs");
        let cut = plan.load_scene().expect("built in").decimated(39).expect("it has 40");
        assert!(snapshot.check_scene(&cut, "s").is_err());
    }

    #[test]
    fn every_changed_byte_and_every_truncation_is_detected() {
        let (_, snapshot, _) = saved();
        let text = snapshot.to_text();
        for at in 0..text.len() - 2 {
            assert!(Snapshot::read(&text[..at], "s").is_err(), "cut at {at}");
            let mut bytes = text.clone().into_bytes();
            bytes[at] = if bytes[at] == b'7' { b'8' } else { b'7' };
            let same = String::from_utf8(bytes).ok().and_then(|text| Snapshot::read(&text, "s").ok());
            assert!(same.is_none_or(|other| other == snapshot), "changed at {at}");
        }
    }

    #[test]
    fn foreign_files_are_refused_with_the_reason() {
        let (_, snapshot, _) = saved();
        for (text, says) in [
            ("", "not whole JSON"),
            ("{}", "expected schema pxpl5-snapshot/1, found none"),
            ("{\"schema\": \"pxpl5-report/1\"}", "found pxpl5-report/1"),
            ("{\"schema\": \"pxpl5-snapshot/1\"}", "missing field"),
        ] {
            let error = Snapshot::read(text, "s").expect_err(text).to_string();
            assert!(error.contains(says), "{text}: {error}");
        }
        let newer = snapshot.to_text().replace("snapshot/1", "snapshot/2");
        assert_eq!(Snapshot::read(&newer, "s").expect_err("newer").kind, FileErrorKind::Foreign);
        let edited = snapshot.to_text().replace("\"seed\": 5", "\"seed\": 6");
        assert_eq!(Snapshot::read(&edited, "s").expect_err("edited").kind, FileErrorKind::Damaged);
    }
}
