//! The experiment behind each published figure.

use super::applications::{Applications, key_of};
use super::heads::{self, PHOTODIODE_LINE, RigLines};
use super::interpretation::{Interpretation, LatencySamples};
use super::measured::{FigureValue, Result, detail, scene_named};
use crate::StopFlag;
use crate::levels::summarise;
use crate::limit::LimitQuery;
use crate::parallel;
use pphigs::{BIN_ENTRY_BYTES, Picture, RegionBinning, Shading, Share, TransformCost};
use pxpl5_analytic::{StereoModel, stereo_loads};
use pxpl5_geometry::Viewport;
use pxpl5_gp::CodeUse;
use pxpl5_machine::{MachineConfig, PRESETS, Preset};
use pxpl5_renderer::{CommandKind, Layout};
use pxpl5_run::{
    Experiment, ExperimentError, Level, Pipeline, Pixels, Slats, Statistics, Summary, WARM_UP_PICTURES, display_list,
    views,
};
use pxpl5_scene::{Hmd, Scene};
use pxpl5_sim::Time;
use pxpl5_sim::parameters::{ParameterTable, SettingError, Value};
use std::sync::Arc;
use tracking::rig::Measurement as RigMeasurement;

/// Settings of all measurements of figures: the level of detail, and changes of machine parameters.
#[derive(Clone, Debug)]
pub struct Bench {
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
    /// True if the figures' intervals are computed too. The intervals take half of the time of all measurements.
    pub intervals: bool,
    /// Flag with which another thread stops the measurements.
    pub stop: StopFlag,
    pub(crate) applications: Arc<Applications>,
}

/// Milliseconds of TRANSFORM, and also of RENDER, for one eye in row 6 of ACCURACY.md. Both stages take longer than
/// COPY. The results for several times are averaged, because the swap waits for a retrace.
const LONG_STAGES_MS: [u64; 7] = [22, 23, 24, 25, 26, 27, 28];

/// Number of display fields in the runs with full bins (rows 16b and 16c of ACCURACY.md). In these runs, a frame takes
/// about 30 fields.
const FIELDS_OF_FULL_BINS: u64 = 600;

const PPHIGS_CODE: [&str; 3] = ["gp.triangle_ns", "gp.sphere_ns", "gp.bin_entry_ns"];

/// Number of head poses for each scene when the regions under triangles are counted (row 8 of ACCURACY.md).
const VIEWS: u64 = 40;
/// Picoseconds between two head poses for row 8 of ACCURACY.md.
const VIEW_PERIOD_PS: u64 = 500_000_000_000;

impl Bench {
    /// Returns settings with unchanged presets. The fly-through of the scene "mig" has 10 seeds of 150 frames.
    #[must_use]
    pub fn new(level: Level) -> Self {
        Self {
            level,
            changes: Vec::new(),
            seeds: 10,
            frames: 150,
            interpretation: Interpretation::USUAL,
            intervals: true,
            stop: StopFlag::default(),
            applications: Arc::default(),
        }
    }

    /// Returns the same settings with `seeds` seeds and `frames` frames for the fly-through of the scene "mig".
    #[must_use]
    pub fn with_mig(self, seeds: u64, frames: u64) -> Self {
        Self { seeds, frames, ..self }
    }

    /// Returns the same settings without intervals of the figures.
    #[must_use]
    pub fn without_intervals(self) -> Self {
        Self { intervals: false, ..self }
    }

    /// Returns the same settings with the flag `stop`, with which another thread stops the measurements.
    #[must_use]
    pub fn with_stop(self, stop: StopFlag) -> Self {
        Self { stop, ..self }
    }

    /// Returns the same settings, but with times per triangle and sphere from executed code. Each preset gets the times
    /// of its own code.
    #[must_use]
    pub fn with_times_of_code(mut self) -> Self {
        // Each preset runs its own code, so each has its own times.
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

    /// Measures the figure with the number `id`.
    ///
    /// # Errors
    ///
    /// Returns [`ExperimentError`] if the experiment fails, [`ExperimentError::Scene`] for an unknown figure, and
    /// [`ExperimentError::Stopped`] if another thread sets the flag.
    pub fn measure(&self, id: &str) -> Result<FigureValue> {
        self.stop.check()?;
        // Experiments that several figures need are cached.
        match id {
            "1" => Ok(self.trivial()?.region_copy_us.into()),
            "2" => self.trivial().map(|s| (s.first_copy_ms + s.last_copy_ms).into()),
            "3" => self.with(Interpretation::THEORY).copy_alone(),
            "4" => {
                let summary = self.trivial()?;
                Ok(spread_ms(Statistics::of(self.interpretation.latencies_ms(&summary).iter().copied())))
            }
            "4b" => self.trivial().map(|summary| rate_hz(&summary).into()),
            "5" => self.with(Interpretation::THEORY).equal_stages(),
            "6" => self.long_stages(),
            "7" => self.application("mig", 1),
            "7b" => self.application("molecules", 3),
            "7c" => self.application("head", 5),
            "8" => self.applications.value("8".to_owned(), || self.regions_touched()),
            "16" => self.most_in_bins(),
            "16b" => self.full_bins().map(|summary| rate_hz(&summary).into()),
            "16c" => Ok(spread_ms(Statistics::of(self.full_bins()?.eye_latencies_ms.iter().copied()))),
            "9" => self.slats_latency(),
            "9b" => self.slats(100, Slats::split()).map(|summary| rate_hz(&summary).into()),
            "10" => self.slats(60, Slats::whole()).map(|s| (s.first_copy_ms * 1e3 / s.region_copy_us).into()),
            "11" => Ok(self.slats(100, Slats::split())?.last_copy_ms.into()),
            "12" => self.limit("slats", Slats::whole()),
            "13" => self.limit("slats", Slats::split()),
            "14" => self.limit("slats-1995", Slats::split()),
            "15" => self.time_before_copy(),
            "17" => self.rig(),
            "18" => Ok(heads::ratio_of_errors()),
            "19" => {
                let machine = self.interpretation.on(self.machine("small-hmd")?)?;
                self.tracker_and_rendering(machine, self.interpretation.pipeline())
            }
            "19b" => self.tracker_and_rendering(self.machine("slats")?, Slats::split()),
            _ => Err(ExperimentError::Scene(format!("there is no figure {id}"))),
        }
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

    /// Runs an experiment with a built-in scene and without pixels. The result is cached, because several figures and
    /// interpretations share experiments.
    fn run(&self, machine: MachineConfig, pipeline: impl Pipeline, scene: &str, fields: u64) -> Result<Arc<Summary>> {
        // The key of the cache needs an experiment, but the scene is loaded only if the result is not cached.
        let empty = self.applications.scene("full-screen:1", false)?;
        let experiment = Experiment::new(machine, pipeline, empty).fields(fields).level(self.level);
        let make = || self.summarise(&experiment.clone().with_scene(scene_named(scene)?));
        self.applications.summary(key_of(&experiment, scene), make)
    }

    /// Runs an experiment and returns its summary. The boolean is true if a backing store may have been full.
    fn summarise(&self, experiment: &Experiment) -> Result<(Summary, bool)> {
        self.stop.check()?;
        let experiment = experiment.clone().pixels(Pixels::Off).level(self.level).host(self.stop.clone());
        if self.level == Level::Analytic {
            return Ok((summarise(&crate::registry(), &experiment)?, true));
        }
        let outcome = experiment.run()?;
        Ok((outcome.summary(), outcome.record().met_full_store()))
    }

    fn stereo(&self, machine: MachineConfig) -> Result<Arc<Summary>> {
        self.run(self.interpretation.on(machine)?, self.interpretation.pipeline(), "full-screen:12", 80)
    }

    /// Runs the experiment of rows 1, 2 and 4 of ACCURACY.md: twelve triangles that cover the screen.
    fn trivial(&self) -> Result<Arc<Summary>> {
        self.stereo(self.machine("small-hmd")?)
    }

    /// Runs the experiment of rows 16b and 16c of ACCURACY.md. The scene has as many screen-filling triangles as fit
    /// into the bins according to the papers.
    fn full_bins(&self) -> Result<Arc<Summary>> {
        let machine = self.interpretation.on(self.machine("small-hmd")?)?;
        self.run(machine, self.interpretation.pipeline(), "full-screen:7700", FIELDS_OF_FULL_BINS)
    }

    /// Measures row 3 of ACCURACY.md: the latency if all work except COPY takes no time.
    fn copy_alone(&self) -> Result<FigureValue> {
        let mut machine = self.machine("small-hmd")?;
        let gp = ["message", "triangle", "guard", "bin_entry", "token_entry", "edit", "pass", "structure"];
        let gp = gp.map(|name| format!("gp.{name}_ns"));
        machine.code = None;
        let array = ["triangle", "phong_triangle", "select", "clear", "shade"];
        let array = array.map(|name| format!("renderer.{name}_clocks"));
        for path in gp.iter().chain(&array) {
            machine.set(path, 0)?;
        }
        Ok(spread_ms(Statistics::of(self.stereo(machine)?.eye_latencies_ms.iter().copied())))
    }

    /// Computes row 16 of ACCURACY.md: the number of screen-filling triangles whose entries fit into the slaves' bins,
    /// for one eye or for both eyes.
    fn most_in_bins(&self) -> Result<FigureValue> {
        let machine = self.interpretation.on(self.machine("small-hmd")?)?;
        let slaves = machine.n_gps as u64 - 1;
        let regions = u64::from(Viewport::FRAME.grid().regions());
        let of_slave = machine.gp.bin_bytes / (regions * BIN_ENTRY_BYTES) / self.interpretation.bins;
        Ok(((of_slave * slaves) as f64).into())
    }

    /// Measures the latency with the pendulum rig (row 17 of ACCURACY.md) for three lines of the photodiode, unless the
    /// settings choose one line.
    fn rig(&self) -> Result<FigureValue> {
        match self.photodiode_line() {
            Some(_) => self.rig_measurement().map(|measured| heads::rendering(&measured)),
            None => Ok(self.rig_lines()?.figure()),
        }
    }

    /// Returns the measurement of the pendulum rig with the photodiode under the chosen line, or under the assumed line
    /// if no line is chosen.
    pub(super) fn rig_measurement(&self) -> Result<Arc<RigMeasurement>> {
        let lines = self.rig_lines()?;
        let Some(line) = self.photodiode_line() else { return Ok(lines.assumed()) };
        if let Some(measured) = lines.under(line) {
            return Ok(measured);
        }
        let machine = self.interpretation.on(self.machine("small-hmd")?)?;
        heads::under_line(&machine, (&self.interpretation, &self.stop), line).map(Arc::new)
    }

    fn photodiode_line(&self) -> Option<u64> {
        self.changes.iter().rev().find(|(path, _)| path == PHOTODIODE_LINE).map(|(_, line)| *line)
    }

    /// Returns the measurements of the pendulum rig in one run. The measurements depend neither on the level of detail
    /// nor on the definition of latency samples.
    fn rig_lines(&self) -> Result<Arc<RigLines>> {
        let machine = self.interpretation.on(self.machine("small-hmd")?)?;
        // The line of the photodiode does not change the run, so it is no part of the cache's key.
        let changes = self.changes.iter().filter(|(path, _)| path != PHOTODIODE_LINE).cloned().collect();
        let key = (self.interpretation.finished, changes);
        self.applications
            .rig(key, self.interpretation.kept, || RigLines::measure(&machine, &self.interpretation, &self.stop))
    }

    /// Returns a machine and a scene for which TRANSFORM and RENDER of one eye each take `ms` milliseconds.
    ///
    /// RENDER takes this time because enough triangles cover the screen. Slower renderers would distort the result.
    /// Commands behind a full input FIFO, such as a copy command, would then wait longer by the same factor. TRANSFORM
    /// takes this time because its code is slow. Slow code of TRANSFORM delays no other stage.
    fn stages_of(&self, ms: f64) -> Result<(MachineConfig, String)> {
        let mut machine = self.machine("small-hmd")?;
        let slaves = machine.n_gps as u64 - 1;
        let regions = u64::from(Viewport::FRAME.grid().regions());
        let of_renderer = regions.div_ceil(machine.n_renderers as u64) as f64;
        // Time of a region on a renderer: its triangles, and a constant part.
        let ns = |kind| machine.renderer.span(kind).unwrap_or_default().as_ms() * 1e6;
        let besides_ns =
            ns(CommandKind::Clear) + ns(CommandKind::Shade) + machine.renderer.backing_block().as_ms() * 1e6;
        let triangles = (ms * 1e6 / of_renderer - besides_ns) / ns(CommandKind::PhongTriangle);
        // All slaves get the same number of triangles.
        let of_slave = ((triangles / slaves as f64).round() as u64).max(1);
        let rest = TransformCost { structures: 1, entries: regions * of_slave, ..TransformCost::PASS };
        machine.set("gp.triangle_ns", ((ms * 1e6) as u64).saturating_sub(rest.ns(&machine.gp)) / of_slave)?;
        machine.code = None;
        Ok((machine, format!("full-screen:{}", of_slave * slaves)))
    }

    fn equal_stages(&self) -> Result<FigureValue> {
        let (machine, scene) = self.stages_of(15.6)?;
        let summary = self.run(self.interpretation.on(machine)?, self.interpretation.pipeline(), &scene, 160)?;
        let latency = Statistics::of(summary.latencies_ms.iter().copied());
        let details = vec![detail("mean", latency.mean, "ms"), detail("frames a second", rate_hz(&summary), "Hz")];
        Ok(FigureValue::with(latency.max, details))
    }

    fn long_stages(&self) -> Result<FigureValue> {
        let mut means = Vec::new();
        for ms in LONG_STAGES_MS {
            let (machine, scene) = self.stages_of(ms as f64)?;
            let summary = self.run(self.interpretation.on(machine)?, self.interpretation.pipeline(), &scene, 160)?;
            // The latency is three times TRANSFORM: TRANSFORM of the first eye and RENDER of both eyes.
            means.push(Statistics::of(summary.latencies_ms.iter().copied()).mean);
        }
        Ok(spread_ms(Statistics::of(means.into_iter())))
    }

    /// Measures rows 7, 7b and 7c of ACCURACY.md: a fly-through of an application scene. The number of seeds is divided
    /// by `seeds_of_one`, because larger scenes get fewer fly-throughs.
    fn application(&self, scene: &'static str, seeds_of_one: u64) -> Result<FigureValue> {
        let samples_a_frame = if self.interpretation.samples == LatencySamples::EachEye { 2 } else { 1 };
        let seeds: Vec<u64> = (1..=self.seeds.div_ceil(seeds_of_one)).collect();
        // One seed gives one fly-through.
        let latencies = parallel::map(&seeds, |seed| {
            let summary = self.fly_through(scene, *seed, seeds.len() as u64)?;
            let samples =
                self.interpretation.latencies_ms(&summary).iter().take(samples_a_frame * self.frames as usize);
            Ok(samples.map(|ms| self.interpretation.fields_of(*ms, summary.field_ms)).collect())
        });
        let latencies = latencies.into_iter().collect::<Result<Vec<Vec<f64>>>>()?.concat();
        let samples = latencies.len() as f64;
        let all = Statistics::of(latencies.into_iter());
        // The ranking of interpretations also uses the deviation.
        let details = vec![
            detail("standard deviation", all.sd, "fields"),
            detail("least", all.min, "fields"),
            detail("greatest", all.max, "fields"),
            detail("samples", samples, ""),
        ];
        Ok(FigureValue::with(all.mean, details))
    }

    fn fly_through(&self, scene: &'static str, seed: u64, seeds: u64) -> Result<Arc<Summary>> {
        let experiment = self.application_experiment(scene, seed)?;
        let drawn = format!("{scene} {} {seeds}", self.interpretation.culled);
        let key = key_of(&experiment.clone().level(self.level), &drawn);
        self.applications.summary(key, || self.fly_through_once(&experiment, scene, seed, seeds))
    }

    fn fly_through_once(
        &self,
        experiment: &Experiment,
        scene: &'static str,
        seed: u64,
        seeds: u64,
    ) -> Result<(Summary, bool)> {
        // At the analytic level the loads of all views are computed once for all seeds.
        if self.level != Level::Analytic {
            return self.summarise(experiment);
        }
        let of_seeds = || (1..=seeds).map(|seed| stereo_loads(&self.application_experiment(scene, seed)?)).collect();
        let loads = self.applications.loads((scene, self.interpretation.culled, seeds, self.frames), of_seeds)?;
        let model = StereoModel::new(experiment.config(), self.interpretation.pipeline())?;
        Ok((model.summary(&model.frames(&loads[seed as usize - 1]), experiment.length()), true))
    }

    /// Returns the experiment of a fly-through, with two display fields for each frame (30 Hz). If frames take longer,
    /// the run has fewer frames.
    fn application_experiment(&self, scene: &'static str, seed: u64) -> Result<Experiment> {
        let fields = 2 * (self.frames + WARM_UP_PICTURES as u64) + 8;
        let machine = self.interpretation.on(self.machine(self.interpretation.machine)?)?;
        let drawn = self.applications.scene(scene, self.interpretation.culled)?;
        Ok(Experiment::with(machine, Arc::new(self.interpretation.pipeline()), drawn).fields(fields).seed(seed))
    }

    fn slats(&self, triangles: u32, pipeline: Slats) -> Result<Arc<Summary>> {
        self.run(self.machine("slats")?, pipeline, &format!("full-screen:{triangles}"), 40)
    }

    fn slats_latency(&self) -> Result<FigureValue> {
        let fields = self.slats(100, Slats::split())?.latency_fields();
        let details = vec![detail("least", fields.min, "fields"), detail("greatest", fields.max, "fields")];
        Ok(FigureValue::with(fields.mean, details))
    }

    fn limit(&self, preset: &str, pipeline: Slats) -> Result<FigureValue> {
        let triangles = f64::from(self.most(preset, pipeline)?);
        let details = vec![detail("both eyes, 60 fields a second", triangles * 120.0, "triangles/s")];
        Ok(FigureValue::with(triangles, details))
    }

    fn limit_query(&self, preset: &str, pipeline: Slats) -> Result<LimitQuery> {
        let (level, stop) = (self.level, self.stop.clone());
        Ok(LimitQuery { level, stop, ..LimitQuery::of_papers(self.machine(preset)?, pipeline)? })
    }

    /// Returns the largest number of triangles that Slats draws in time. The result is cached, because two figures need
    /// the same search.
    fn most(&self, preset: &str, pipeline: Slats) -> Result<u32> {
        let query = self.limit_query(preset, pipeline)?;
        let key = format!("{:?} {pipeline:?} {:?}", query.level, query.config);
        self.applications.limit(key, || query.search_triangles())
    }

    /// Measures row 8 of ACCURACY.md: the number of regions under a triangle, which is the number of bin entries per
    /// visible triangle. Each scene is seen from poses along its own head motion. The figure is the mean over three
    /// scenes.
    fn regions_touched(&self) -> Result<FigureValue> {
        let mut details = Vec::new();
        for name in ["mig", "molecules", "head"] {
            details.push(detail(name, touched(&self.applications.scene(name, false)?, VIEWS)?, "regions"));
        }
        let value = details.iter().map(|d| d.value).sum::<f64>() / details.len() as f64;
        Ok(FigureValue::with(value, details))
    }

    /// Measures rows 19 and 19b of ACCURACY.md. Rendering is always simulated with events, even at the analytic level.
    fn tracker_and_rendering(&self, machine: MachineConfig, pipeline: impl Pipeline) -> Result<FigureValue> {
        let key = format!("{pipeline:?} {machine:?} {:?}", self.interpretation);
        let make = || heads::tracker_and_rendering(machine, pipeline, (&self.interpretation, &self.stop));
        self.applications.value(key, make)
    }

    fn time_before_copy(&self) -> Result<FigureValue> {
        let most = self.most("slats", Slats::split())?;
        let summary = self.slats(most, Slats::split())?;
        Ok(FigureValue::with(summary.copy_begins_ms, vec![detail("triangles", most.into(), "triangles")]))
    }
}

/// Returns the number of bin entries per visible triangle, over both eyes and `n_views` head poses.
fn touched(scene: &Arc<Scene>, n_views: u64) -> Result<f64> {
    let list = Arc::new(display_list(scene)?);
    let (views, _) = views(scene, 1, Hmd::unc(), 2);
    let share = Share::new(list, 0, 1);
    let layout = Layout::rendering_control_phong();
    let picture = Picture {
        viewport: Viewport::FRAME,
        shading: Shading::Phong,
        binning: RegionBinning::Touched,
        layout,
        pixels: false,
    };
    let mut entries = 0u64;
    let mut triangles = 0u64;
    for number in 0..n_views {
        let view = views(pxpl5_wire::ViewNumber(number), Time(number * VIEW_PERIOD_PS));
        for eye in 0..2 {
            // Both eyes of every view count.
            let pass = share.transform(&view, eye, picture);
            let regions = (0..picture.viewport.grid().regions() as u16).map(pxpl5_wire::RegionId);
            entries += regions.map(|region| u64::from(pass.counts(region).triangles)).sum::<u64>();
            triangles += u64::from(pass.screen_counts().triangles);
        }
    }
    Ok(entries as f64 / triangles.max(1) as f64)
}

/// Returns the number of complete pictures per second, or 0 if no picture was shown.
fn rate_hz(summary: &Summary) -> f64 {
    summary.updates_hz.unwrap_or_default()
}

/// Returns the mean as the value of a figure, with standard deviation, minimum and maximum as details.
fn spread_ms(statistics: Statistics) -> FigureValue {
    let Statistics { mean, sd, min, max, .. } = statistics;
    let details =
        vec![detail("standard deviation", sd, "ms"), detail("least", min, "ms"), detail("greatest", max, "ms")];
    FigureValue::with(mean, details)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limit::test_scene;
    use pxpl5_run::TestScene;
    use pxpl5_scene::config::{TYPICAL_LEG_PX, TYPICAL_SPREAD_PX};

    /// Returns the mean number of regions that a right-angled triangle touches. Its two short sides are parallel to the
    /// region borders and `leg` pixels long. Its position is random within `TYPICAL_SPREAD_PX`.
    ///
    /// The triangle touches the regions of those pixels whose centres it covers. A short side crosses a border at
    /// `leg - 1` of its possible positions. Four borders separate the columns of regions, which gives the factor
    /// `1 + 4 (leg - 1) / width`. Three borders separate the rows, which gives `1 + 3 (leg - 1) / height`.
    ///
    /// The product of both factors is the mean for the triangle's bounding box. In some positions, the box contains a
    /// point where four regions meet. In half of these positions, the triangle misses one of the four regions.
    fn expected(leg: f64) -> f64 {
        let [width, height] = TYPICAL_SPREAD_PX;
        let columns = 4.0 * (leg - 1.0) / width;
        let rows = 3.0 * (leg - 1.0) / height;
        (1.0 + columns) * (1.0 + rows) - columns * rows / 2.0
    }

    /// Tests which changes of parameters require new machines. A change to the preset's own value requires none.
    #[test]
    fn only_changes_of_the_machine_or_the_photodiode_need_another_run() {
        let bench = Bench::new(Level::Transaction);
        let with = |path: &str, value| Bench { changes: vec![(path.to_owned(), value)], ..bench.clone() };
        let words = MachineConfig::small_hmd().renderer.fifo_words;
        assert!(bench.has_machines_of(&with("renderer.fifo_words", words)));
        for (path, value) in [
            ("renderer.fifo_words", words + 1),
            ("slats:renderer.fifo_words", words + 1),
            (PHOTODIODE_LINE, 3),
            ("no.such_parameter", 1),
        ] {
            assert!(!bench.has_machines_of(&with(path, value)), "{path}");
        }
    }

    #[test]
    fn triangles_of_18_pixels_touch_as_many_regions_as_their_formula() {
        let found = touched(&Arc::new(test_scene(TestScene::Typical, 4_000)), 1).expect("it has triangles");
        let expected = expected(TYPICAL_LEG_PX);
        // The 4,000 positions sample the average to a few thousandths.
        assert!((found - expected).abs() < 0.005, "{found}, expected {expected}");
    }
}
