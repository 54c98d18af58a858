//! The pendulum rig in front of the emulated machine.
//!
//! The rig measures latency from outside, and compares the result with the system's own time stamps.
//!
//! As in I3D95, the host starts a frame when the host detects that the pendulum passes its lowest point. Frames
//! alternate between dark and light. The output of a D/A converter (the D/A line) changes when the program starts a
//! frame. Frames therefore come on demand, the pipeline is not full, and the latency contains no wait for an earlier
//! frame. Under Rendering Control, the host drives the D/A line when it detects the low point, so the application's time, SEND
//! and EDIT belong to the rendering part of the latency. Under Slats and other firmware that starts frames itself, the D/A line changes when the firmware samples
//! the pose of a frame.
//!
//! The traces of the simulated oscilloscope do not use the pipeline's own records of its pictures. The instants of the
//! lowest point come from the pendulum. The light comes from the pixels that the display scans at the photodiode. The
//! D/A line comes from the board that starts the frame. The pipeline's records give the system's own time stamps.

use crate::error::StudyError;
use crate::estimate::{Estimate, RunWork};
use crate::study::Study;
use core::f64::consts::FRAC_PI_2;
use glam::{DVec3, Vec3};
use pxpl5_gp::{Stage, StageEdge};
use pxpl5_machine::{Machine, MachineConfig, Record};
use pxpl5_run::{Coverage, Experiment, ExperimentError, Head, Outcome, PictureTimes, Pipeline, Pixels};
use pxpl5_scene::{HeadMotion, Lighting, Scene, SceneParts, Vertex};
use pxpl5_sim::parameters::{SettingError, Value};
use pxpl5_sim::{Time, Watcher};
use pxpl5_wire::display::Display;
use pxpl5_wire::{PeriodNumber, ViewNumber};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;
use tracking::motion::Still;
use tracking::predict::PredictorKind;
use tracking::rig::{InsidePass, LowPointReport, Measurement, Oscilloscope, PendulumRig, ScopeTrace, Side};
use tracking::time::nearest_ps;
use tracking::tracker::{TrackerConfig, TrackerModel, TrackerReport};
use tracking::{Pose, rotation};

/// A measurement of latency with the pendulum rig.
#[derive(Clone, Debug)]
pub struct Rig {
    /// Settings of the pendulum, of the detection of its lowest point, and of the photodiodes.
    pub rig: PendulumRig,
    /// Tracker on the bob of the pendulum.
    pub tracker: TrackerConfig,
    /// Seed of the tracker's noise.
    pub seed: u64,
    /// Number of measured passes of the pendulum through its lowest point, at least 2.
    pub passes: usize,
}

/// Default number of measured passes of the pendulum through its lowest point. A pass can fall at any time within a
/// field. With this number, the error of the mean wait for a retrace is about a fifth of a field.
pub const PASSES: usize = 24;

/// The measurement of the latency of a pipeline on a machine with a rig.
#[derive(Clone, Debug)]
pub struct RigQuery {
    /// The pendulum, its tracker, and the photodiodes.
    pub rig: Rig,
    /// Machine on which the pipeline runs.
    pub machine: MachineConfig,
    /// The measured pipeline.
    pub pipeline: Arc<dyn Pipeline>,
}

/// Latencies of a system, measured from outside and from inside.
#[derive(Clone, Debug, Serialize)]
pub struct RigReport {
    /// Name and version of the JSON layout.
    pub schema: &'static str,
    /// Name of the measured pipeline.
    pub pipeline: &'static str,
    /// Name of the machine's preset.
    pub machine: String,
    /// Parameters of the machine that differ from the preset.
    pub overrides: BTreeMap<String, Value>,
    /// Name of the tracker.
    pub tracker: String,
    /// Seed of the tracker's noise.
    pub seed: u64,
    /// Line of the screen under the photodiode.
    pub photodiode_line: u32,
    /// Number of measured passes of the pendulum.
    pub n: u64,
    /// Latencies measured with the oscilloscope, in milliseconds.
    pub outside_ms: Side,
    /// Latencies by the system's own time stamps, in milliseconds.
    pub inside_ms: Side,
    /// Mean total latency outside minus that inside, in milliseconds.
    pub outside_less_inside_ms: f64,
    /// Greatest amount by which tracking may take longer outside, in milliseconds.
    pub tracking_bound_ms: f64,
    /// Greatest amount by which rendering may be shorter outside, in milliseconds.
    pub rendering_early_bound_ms: f64,
    /// Greatest amount by which rendering may take longer outside, in milliseconds.
    pub rendering_bound_ms: f64,
    /// True if both sides agree.
    pub agrees: bool,
    /// The measurement of each pass.
    #[serde(skip)]
    pub measured: Measurement,
}

/// Greatest number of display fields between two passes of the pendulum through its lowest point: one second.
const FIELDS_OF_PASS: u64 = 60;

impl Study for RigQuery {
    type Report = RigReport;

    fn estimate(&self, _: usize) -> Estimate {
        let fields = self.rig.passes as u64 * FIELDS_OF_PASS;
        let experiment = Experiment::with(self.machine.clone(), Arc::clone(&self.pipeline), Arc::new(lamp()));
        RunWork { is_tracked: true, ..RunWork::of(&experiment.fields(fields), true) }.estimate()
    }

    /// Measures the latency. Fails if the pipeline does not show the requested frames.
    fn run(&self, watcher: &mut dyn Watcher) -> Result<RigReport, StudyError> {
        let line = self.rig.rig.photodiode_line;
        let ([measured], _) = self.rig.measure_lines(&self.machine, Arc::clone(&self.pipeline), [line], watcher)?;
        Ok(RigReport {
            schema: "pxpl5-rig/1",
            pipeline: self.pipeline.name(),
            machine: self.machine.preset.clone(),
            overrides: self.machine.overrides(),
            tracker: self.rig.tracker.name.clone(),
            seed: self.rig.seed,
            photodiode_line: line,
            n: measured.outside.total.n,
            outside_ms: measured.outside.in_ms(),
            inside_ms: measured.inside.in_ms(),
            outside_less_inside_ms: measured.outside_less_inside_s() * 1e3,
            tracking_bound_ms: measured.tracking_bound_ps as f64 * 1e-9,
            rendering_early_bound_ms: measured.rendering_early_ps as f64 * 1e-9,
            rendering_bound_ms: measured.rendering_bound_ps as f64 * 1e-9,
            agrees: measured.agrees(),
            measured,
        })
    }
}

impl Rig {
    /// Creates a rig with `tracker` on the pendulum, and with the assumed settings of pendulum, detection and
    /// photodiodes.
    pub fn assumed(tracker: TrackerConfig) -> Self {
        Self { rig: PendulumRig::assumed(), tracker, seed: 1, passes: PASSES }
    }

    /// Measures the latency under several lines of the screen in one run. Also returns the run. A photodiode does not
    /// affect the machine, so each measurement equals that of a run with only this photodiode.
    pub(crate) fn measure_lines<const N: usize>(
        &self,
        machine: &MachineConfig,
        pipeline: Arc<dyn Pipeline>,
        lines: [u32; N],
        watcher: &mut dyn Watcher,
    ) -> Result<([Measurement; N], Outcome), StudyError> {
        let tracker = TrackerModel::new(self.tracker.clone())?;
        check_frames(machine, pipeline.as_ref())?;
        // The pendulum determines when frames start.
        let sightings = self.rig.sightings(&tracker, self.seed, self.passes.max(2))?;
        let experiment = self.experiment(machine, pipeline, &sightings)?.stopped_by(watcher.stop());
        // Observe the screen during the run, then read the pipeline's records for the inside measurement.
        let mut photodiodes = lines.map(Photodiode::new);
        let outcome = observe(&mut photodiodes, &experiment, watcher)?;
        let measured = photodiodes.map(|photodiode| self.compared(&tracker, &outcome, &sightings, photodiode));
        // Report the error of the first line that has one.
        let mut errors = Vec::new();
        let measured = measured.map(|one| one.map_err(|error| errors.push(error)).ok());
        match errors.into_iter().next() {
            Some(error) => Err(error),
            None => Ok((measured.map(|one| one.expect("no line has an error")), outcome)),
        }
    }

    fn compared(
        &self,
        tracker: &TrackerModel,
        outcome: &Outcome,
        sightings: &[LowPointReport],
        photodiode: Photodiode,
    ) -> Result<Measurement, StudyError> {
        let rig = PendulumRig { photodiode_line: photodiode.line, ..self.rig };
        let frames = frames_asked_for(outcome, sightings)?;
        let begun = |(sighting, frame): (&LowPointReport, &PictureTimes)| started(outcome.record(), frame, sighting).0;
        let dac = ScopeTrace::toggling("D/A line", sightings.iter().zip(&frames).map(begun).collect());
        let screen = ScopeTrace::sampled("screen", photodiode.samples);
        let oscilloscope = Oscilloscope::of(&rig, dac, screen);
        let inside = sightings.iter().zip(&frames).map(|(sighting, frame)| InsidePass {
            sighting: *sighting,
            started_ps: started(outcome.record(), frame, sighting).0,
            shown_ps: frame.shown_at.0,
        });
        // Compare the oscilloscope's times with the pipeline's time stamps.
        let measured = rig.compare(tracker, photodiode.place_ps, &oscilloscope, inside.collect())?;
        let counted = frames.iter().map(|frame| behind_the_retrace(outcome.record(), frame.shown_at)).max();
        Ok(measured.with_frames_counted_in_scan(counted.unwrap_or_default()))
    }

    /// Returns the experiment of a measurement. Each report that the pendulum is at its lowest point has a head pose:
    /// alternately toward the lamp and away from the lamp. The experiment is long enough to show the last frame.
    fn experiment(
        &self,
        machine: &MachineConfig,
        pipeline: Arc<dyn Pipeline>,
        sightings: &[LowPointReport],
    ) -> Result<Experiment, StudyError> {
        // Sightings of the pendulum with even numbers make a light frame, and sightings with odd numbers a dark frame.
        let reports = (0..).zip(sightings).map(|(number, sighting)| TrackerReport {
            solution: number,
            measured_ps: sighting.measured_ps,
            position_measured_ps: sighting.measured_ps,
            arrives_ps: sighting.arrives_ps,
            pose: if number % 2 == 0 { Pose::IDENTITY } else { away() },
        });
        let head = Head::new(Arc::new(Still(away())), self.tracker.clone(), PredictorKind::None, self.seed)?;
        let head = head.reporting(reports.collect());
        let experiment =
            Experiment::with(machine.clone(), pipeline, Arc::new(lamp())).head(head).on_demand().pixels(Pixels::Lazy);
        let last_ps = sightings.last().map_or(0, |last| last.arrives_ps);
        // The run ends half a period of the pendulum after the last sighting.
        let end = Time(last_ps + nearest_ps(self.rig.pendulum.period_s() / 2.0));
        let fields = experiment.build()?.record().display().period_at(end).0 + 1;
        Ok(experiment.fields(fields))
    }
}

/// Returns an error for a pipeline in which a photodiode on the screen cannot detect a new frame.
fn check_frames(machine: &MachineConfig, pipeline: &dyn Pipeline) -> Result<(), StudyError> {
    let refused = |reason: &str| {
        let found = format_args!("{}: {reason}; {}", pipeline.name(), pipeline.properties().due_definition);
        Err(SettingError::value("", "a pipeline whose frames a photodiode can distinguish", found).into())
    };
    if pipeline.properties().coverage == Coverage::Surroundings {
        return refused("its display turns with the head, so the light changes before any frame is drawn");
    }
    let machine = Machine::new(&pipeline.adapt(machine.clone()), 1, pipeline.properties().layout)
        .map_err(ExperimentError::from)?;
    if pipeline.periods_a_picture(machine.record()).is_none() {
        return refused("parts of the screen change one by one, so the light under a photodiode is that of one part");
    }
    Ok(())
}

/// Returns the time in picoseconds from the retrace at the start of a period to an instant within this period.
fn behind_the_retrace(record: &Record, instant: Time) -> u64 {
    instant.since(record.tick(record.display().period_at(instant))).0
}

/// Returns the head pose of dark frames, in which the lamp is behind the viewer.
fn away() -> Pose {
    Pose { position: DVec3::ZERO, orientation: rotation::about_y(FRAC_PI_2) }
}

/// Returns a scene with a white wall (the lamp) straight ahead (along -z) that fills the view. The scene's own viewer
/// looks away from the wall. The wall has two triangles, the smallest number for a rectangle.
fn lamp() -> Scene {
    const CORNERS: [[f32; 2]; 4] = [[-1.6, -1.6], [1.6, -1.6], [1.6, 1.6], [-1.6, 1.6]];
    let vertex = |[x, y]: [f32; 2]| Vertex { position: Vec3::new(x, y, -2.0), normal: Vec3::Z, colour: [255; 3] };
    // Full ambient light makes the wall white from every direction, and the background stays black.
    let lighting = Lighting { background: [0; 3], ambient: 1.0, diffuse: 0.0, ..Lighting::over_the_shoulder() };
    let motion = HeadMotion::still(Vec3::ZERO, Vec3::NEG_X);
    Scene::new(SceneParts {
        lighting,
        motion: motion.expect("a still head is in range"),
        ..SceneParts::of("lamp", CORNERS.map(vertex).to_vec(), vec![[0, 1, 2], [0, 2, 3]])
    })
    .expect("a quadrangle is a scene")
}

/// A photodiode in the middle of a line of the screen, with a sample for each pass of the beam.
struct Photodiode {
    line: u32,
    /// Longest time in picoseconds from the start of a period to the beam's pass over the photodiode.
    place_ps: u64,
    /// Time in picoseconds of each pass of the beam over the photodiode. The boolean is true if the pixel was bright.
    samples: Vec<(u64, bool)>,
    /// Number of messages that the ring had carried at the end of each period. The boolean is true if no message was
    /// under way.
    ring: Vec<(u64, bool)>,
}

/// Minimum mean of red, green and blue of a bright pixel: half the value of a white wall.
const LIGHT: u32 = 128;

impl Photodiode {
    const fn new(line: u32) -> Self {
        Self { line, place_ps: 0, samples: Vec::new(), ring: Vec::new() }
    }

    fn check(&self, display: &dyn Display) -> Result<(), SettingError> {
        let lines =
            display.surfaces().first().map_or(0, |surface| surface.height / display.rows_lit(PeriodNumber::FIRST).1);
        let expected = format_args!("a line from 0 to {}", lines.saturating_sub(1));
        SettingError::require(self.line < lines, "line of the photodiode", expected, self.line)
    }

    fn sample(&mut self, period: PeriodNumber, record: &Record) {
        let display = record.display();
        let Some(surface) = display.surfaces().first() else { return };
        let (first_row, row_distance) = display.rows_lit(period);
        let x = surface.width / 2;
        let y = first_row + self.line * row_distance;
        let Some(at) = display.lights(0, x, y, period) else { return };
        self.place_ps = self.place_ps.max(at.since(display.tick(period)).0);
        self.ring.push((record.ring().stats().messages, record.ring().is_idle()));
        // A pixel is read only if it can have changed.
        let is_light = self
            .unchanged()
            .unwrap_or_else(|| brightness(display.seen_pixel(0, [x, y], period).unwrap_or_default()) >= LIGHT);
        self.samples.push((at.0, is_light));
    }

    /// Returns the sample of two periods ago if the ring has carried no message since then. Without messages the screen
    /// cannot have changed, so that the picture need not be read again. The display lights each line in every second
    /// period. The state of the ring is recorded one period later than the sample of the screen.
    fn unchanged(&self) -> Option<bool> {
        let [.., before, _, _, _, now] = self.ring[..] else { return None };
        let (_, was_light) = *self.samples.get(self.samples.len().checked_sub(2)?)?;
        (before == now).then_some(was_light)
    }
}

fn brightness(colour: [u8; 3]) -> u32 {
    colour.iter().map(|value| u32::from(*value)).sum::<u32>() / 3
}

/// Runs an experiment and samples the photodiodes. A run that is too short to fill the pipeline is not an error.
fn observe(
    photodiodes: &mut [Photodiode],
    experiment: &Experiment,
    watcher: &mut dyn Watcher,
) -> Result<Outcome, StudyError> {
    let machine = experiment.build()?;
    photodiodes.iter().try_for_each(|photodiode| photodiode.check(machine.record().display()))?;
    let every: Vec<PeriodNumber> = PeriodNumber(2).until(PeriodNumber(experiment.fields)).collect();
    let result = experiment.run_stopping(&every, |period, run| {
        watcher.progress(period.0, experiment.fields);
        // The stop comes before the retrace that ends the previous period.
        if let Some(over) = period.before(2) {
            photodiodes.iter_mut().for_each(|photodiode| photodiode.sample(over, run.record()));
        }
        Ok(())
    });
    match result {
        Err(ExperimentError::TooShort { partial, .. }) => Ok(*partial),
        other => Ok(other?),
    }
}

/// Returns one picture for each report that the pendulum is at its lowest point: the first complete picture with the
/// head pose of the report. The pictures come from the pipeline's records.
fn frames_asked_for(outcome: &Outcome, sightings: &[LowPointReport]) -> Result<Vec<PictureTimes>, SettingError> {
    let sampled = outcome.head().map(|head| head.sampled()).unwrap_or_default();
    let arrived_at: BTreeMap<ViewNumber, Time> =
        sampled.iter().filter_map(|s| Some((s.number, s.arrived_at?))).collect();
    let mut first: BTreeMap<u64, PictureTimes> = BTreeMap::new();
    // The first complete picture of a sighting counts.
    for times in outcome.pictures().iter().filter(|times| times.is_shown()) {
        if let Some(arrived) = arrived_at.get(&times.view) {
            first.entry(arrived.0).or_insert(*times);
        }
    }
    let found: Vec<_> = sightings.iter().filter_map(|sighting| first.get(&sighting.arrives_ps).copied()).collect();
    let expected = sightings.len();
    if found.len() == expected {
        return Ok(found);
    }
    let expected = format_args!("the time of complete display for {expected} frames that low points requested");
    Err(SettingError::value("", expected, format_args!("it for {}", found.len())))
}

/// Returns the time at which a program started a frame and changed the D/A line. Under Rendering Control, the host does so
/// when it detects the low point; its application then takes its time, and SEND begins. Under Slats, a graphics processor
/// does so when it begins a field.
fn started(record: &Record, frame: &PictureTimes, sighting: &LowPointReport) -> Time {
    let marks = record.observation().marks.iter();
    let begun = marks
        .filter(|mark| mark.stage == Stage::Sample && mark.edge == StageEdge::Begin && mark.picture == frame.picture);
    let Some(mark) = begun.min_by_key(|mark| mark.time) else { return frame.transform_at };
    if mark.node != record.ports().host {
        return mark.time;
    }
    // The application takes at most this time, and less only by its jitter.
    let host = &record.config().host;
    let application_ps = (host.application_ns + host.application_jitter_ns.min(host.application_ns)) * 1_000;
    Time(mark.time.0 - application_ps.min(mark.time.0.saturating_sub(sighting.arrives_ps)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_run::RenderingControl;

    #[test]
    fn one_run_with_three_photodiodes_measures_the_same_as_three_runs_with_one_photodiode() {
        let rig = Rig { passes: 4, ..Rig::assumed(TrackerConfig::optical_ceiling()) };
        let (machine, pipeline) = (MachineConfig::small_hmd(), Arc::new(RenderingControl::stereo()));
        let lines = [0, 100, 239];
        let (together, _) = rig.measure_lines(&machine, pipeline.clone(), lines, &mut ()).expect("it shows frames");
        for (line, together) in lines.into_iter().zip(together) {
            let rig = Rig { rig: PendulumRig { photodiode_line: line, ..rig.rig }, ..rig.clone() };
            let query = RigQuery { rig, machine: machine.clone(), pipeline: pipeline.clone() };
            let alone = query.run(&mut ()).expect("it shows frames").measured;
            assert_eq!(format!("{alone:?}"), format!("{together:?}"), "line {line}");
        }
        let refused = rig.measure_lines(&machine, pipeline, [0, 240], &mut ());
        let refused = refused.expect_err("there are 240 lines").to_string();
        assert_eq!(refused, "line of the photodiode: expected a line from 0 to 239, found 240");
    }
}
