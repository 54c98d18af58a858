//! Settings of all measurements of figures, and the cached runs that several figures share.

use super::applications::{Applications, key_of};
use super::interpretation::Interpretation;
use super::rig_lines::{self, PHOTODIODE_LINE, RigLines};
use super::value::{Result, scene_named};
use crate::levels::summarise;
use crate::study::check;
use pxpl5_gp::CodeUse;
use pxpl5_machine::{MachineConfig, PRESETS, Preset};
use pxpl5_run::{Experiment, Level, Pipeline, Pixels, Summary};
use pxpl5_sim::StopFlag;
use pxpl5_sim::parameters::{ParameterTable, SettingError, Value};
use std::sync::Arc;
use tracking::rig::Measurement as RigMeasurement;

/// Settings of all measurements of figures: the level of detail, and changes of machine parameters.
#[derive(Clone, Debug)]
pub struct FigureSettings {
    /// Level of detail at which each figure is measured.
    pub level: Level,
    /// Paths of parameters, with values that replace the values of the presets. A path that begins with a preset's name
    /// and a colon changes only that preset. For example, a time of Rendering Control's graphics library (PPHIGS) can
    /// change without effect on Slats. The path [`PHOTODIODE_LINE`] changes the pendulum rig instead of a machine.
    pub changes: Vec<(String, u64)>,
    /// Number of seeds of the head motion for the fly-through of the scene "mig" (row 7 of ACCURACY.md).
    pub seeds: u64,
    /// Number of evaluated frames for each seed of the fly-through of the scene "mig" (row 7 of ACCURACY.md).
    pub frames: u64,
    /// Answers to the questions that the papers leave open about Rendering Control.
    pub interpretation: Interpretation,
    /// True if the times of triangles come from executed code ([`Self::with_times_of_code`]), so that none is fitted.
    pub has_times_of_code: bool,
    /// Flag with which another thread stops the measurements.
    pub(crate) stop: StopFlag,
    pub(crate) applications: Arc<Applications>,
}

const PPHIGS_CODE: [&str; 3] = ["gp.triangle_ns", "gp.sphere_ns", "gp.bin_entry_ns"];

impl FigureSettings {
    /// Returns settings with unchanged presets. The fly-through of the scene "mig" has 10 seeds of 150 frames.
    pub fn new(level: Level) -> Self {
        Self {
            level,
            changes: Vec::new(),
            seeds: 10,
            frames: 150,
            interpretation: Interpretation::USUAL,
            has_times_of_code: false,
            stop: StopFlag::default(),
            applications: Arc::default(),
        }
    }

    /// Returns the same settings with `seeds` seeds and `frames` frames for the fly-through of the scene "mig".
    #[must_use]
    pub fn with_mig(self, seeds: u64, frames: u64) -> Self {
        Self { seeds, frames, ..self }
    }

    /// Returns the same settings with `changes` in addition to the changes of these settings.
    #[must_use]
    pub fn with_changes(&self, changes: impl IntoIterator<Item = (String, u64)>) -> Self {
        Self { changes: self.changes.iter().cloned().chain(changes).collect(), ..self.clone() }
    }

    /// Returns the same settings, but with times per triangle and sphere from executed code. Each preset gets the times
    /// of its own code.
    #[must_use]
    pub fn with_times_of_code(mut self) -> Self {
        self.has_times_of_code = true;
        // Each preset runs its own code, so each has its own times. Those of `slats` are the default.
        for preset in PRESETS {
            let Ok(machine) = MachineConfig::preset(preset.name) else { continue };
            let of = if preset.name.starts_with("slats") { CodeUse::Slats } else { CodeUse::Pphigs };
            let by_code = machine.clone().with_times_of_code(of).gp.entries();
            for (code, table) in by_code.iter().zip(machine.gp.entries()) {
                if let Value::Whole(ns) = code.value
                    && code.value != table.value
                {
                    self.changes.push((format!("{}:gp.{}", preset.name, code.info.name), ns));
                }
            }
        }
        self
    }

    /// Returns the machine of a preset with the changed parameters.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] for a preset or path that does not exist.
    pub fn machine(&self, preset: &str) -> std::result::Result<MachineConfig, SettingError> {
        let mut machine = MachineConfig::preset(preset)?;
        for (path, value) in &self.changes {
            // A path with a preset's name applies only to this preset.
            match path.split_once(':') {
                Some((only, path)) if only == preset => machine.set(path, *value)?,
                Some(_) => {}
                None if path == PHOTODIODE_LINE => {}
                None if preset.starts_with("slats") && PPHIGS_CODE.contains(&path.as_str()) => {}
                None => machine.set(path, *value)?,
            }
        }
        Ok(machine)
    }

    /// Returns true if `other` has the same machine for every preset, and the same line of the photodiode.
    pub(crate) fn has_machines_of(&self, other: &Self) -> bool {
        let is_same =
            |preset: &Preset| self.machine(preset.name).is_ok_and(|one| other.machine(preset.name) == Ok(one));
        self.photodiode_line() == other.photodiode_line() && PRESETS.iter().all(is_same)
    }

    /// Returns the same settings with `interpretation` as the interpretation of the papers.
    #[must_use]
    pub fn with(&self, interpretation: Interpretation) -> Self {
        Self { interpretation, ..self.clone() }
    }

    /// Returns the machine of a preset with the changed parameters, and with the answers of the interpretation that
    /// concern the machine.
    pub(super) fn interpreted(&self, preset: &str) -> Result<MachineConfig> {
        Ok(self.interpretation.on(self.machine(preset)?)?)
    }

    /// Runs an experiment with a built-in scene and without pixels. The result is cached, because several figures and
    /// interpretations share experiments.
    pub(super) fn run(
        &self,
        machine: MachineConfig,
        pipeline: impl Pipeline,
        scene: &str,
        fields: u64,
    ) -> Result<Arc<Summary>> {
        // The key of the cache needs an experiment, but the scene is loaded only if the result is not cached.
        let empty = self.applications.scene("full-screen:1", false)?;
        let experiment = Experiment::new(machine, pipeline, empty).fields(fields).level(self.level);
        let make = || self.summarise(&experiment.clone().with_scene(scene_named(scene)?));
        self.applications.summary(key_of(&experiment, scene), make)
    }

    /// Runs a scene under Rendering Control on a machine, with the answers of the interpretation.
    pub(super) fn controlled(&self, machine: MachineConfig, scene: &str, fields: u64) -> Result<Arc<Summary>> {
        self.run(self.interpretation.on(machine)?, self.interpretation.pipeline(), scene, fields)
    }

    /// Runs an experiment and returns its summary. The boolean is true if a backing store may have been full.
    pub(super) fn summarise(&self, experiment: &Experiment) -> Result<(Summary, bool)> {
        check(&self.stop)?;
        let experiment = experiment.clone().pixels(Pixels::Off).level(self.level).stopped_by(self.stop.clone());
        if self.level == Level::Analytic {
            return Ok((summarise(&crate::registry(), &experiment)?, true));
        }
        let outcome = experiment.run()?;
        Ok((outcome.summary(), outcome.record().met_full_store()))
    }

    /// Returns the measurement of the pendulum rig with the photodiode under the chosen line, or under the assumed line
    /// if no line is chosen.
    pub(super) fn rig_measurement(&self) -> Result<Arc<RigMeasurement>> {
        let lines = self.rig_lines()?;
        let Some(line) = self.photodiode_line() else { return Ok(lines.assumed()) };
        if let Some(measured) = lines.under(line) {
            return Ok(measured);
        }
        let machine = self.interpreted("small-hmd")?;
        rig_lines::under_line(&machine, (&self.interpretation, &self.stop), line).map(Arc::new)
    }

    pub(super) fn photodiode_line(&self) -> Option<u64> {
        self.changes.iter().rev().find(|(path, _)| path == PHOTODIODE_LINE).map(|(_, line)| *line)
    }

    /// Returns the measurements of the pendulum rig in one run. The measurements depend neither on the level of detail
    /// nor on the definition of latency samples.
    pub(super) fn rig_lines(&self) -> Result<Arc<RigLines>> {
        let machine = self.interpreted("small-hmd")?;
        // The line of the photodiode does not change the run, so it is no part of the cache's key.
        let changes = self.changes.iter().filter(|(path, _)| path != PHOTODIODE_LINE).cloned().collect();
        let key = (self.interpretation.finished, changes);
        self.applications
            .rig(key, self.interpretation.kept, || RigLines::measure(&machine, &self.interpretation, &self.stop))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests which changes of parameters require new machines. A change to the preset's own value requires none.
    #[test]
    fn only_changes_of_the_machine_or_the_photodiode_need_another_run() {
        let settings = FigureSettings::new(Level::Transaction);
        let with = |path: &str, value| settings.with_changes([(path.to_owned(), value)]);
        let words = MachineConfig::small_hmd().renderer.fifo_words;
        assert!(settings.has_machines_of(&with("renderer.fifo_words", words)));
        for (path, value) in [
            ("renderer.fifo_words", words + 1),
            ("slats:renderer.fifo_words", words + 1),
            (PHOTODIODE_LINE, 3),
            ("no.such_parameter", 1),
        ] {
            assert!(!settings.has_machines_of(&with(path, value)), "{path}");
        }
    }
}
