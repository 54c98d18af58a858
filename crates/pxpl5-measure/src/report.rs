//! Results as numbers, with units in the names.

use crate::budget::Budget;
use crate::errors::PixelErrors;
use crate::faces_report::FacesReport;
use crate::latency::{NamedStatistics, SurfaceStatistics, latency_by_surface, latency_part_statistics};
use crate::of_outcome::{pixel_errors, untold};
use crate::too_heavy::TooHeavy;
use parameters::Value;
use pxpl5_display::Counter;
use pxpl5_machine::{LateRegion, Record};
use pxpl5_run::{Aim, DefinedStatistics, DuePictures, Head, Outcome, Raster, ResultWindow};
use pxpl5_sim::{Time, TraceHash, mix};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::{self, Write};
use tracking::predict::{PredictorConfig, Training};

/// The numbers of one experiment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Name and version of this record's layout.
    pub schema: String,
    /// Version of the program.
    pub version: String,
    /// Preset of the machine.
    pub machine: String,
    /// Name of everything on which the trace depends ([`pxpl5_run::Experiment::config_hash`]).
    pub config_hash: String,
    /// Level of modelling: `transaction` or `cycle`.
    pub level: String,
    /// Seed of the head motion.
    pub seed: u64,
    /// Name of the pipeline, as in experiment files.
    pub pipeline: String,
    /// Its keys and their values, as they take effect.
    pub variant: String,
    /// The display that it draws for.
    pub display: String,
    /// Parameters of the machine that differ from the preset's, by path.
    pub overrides: BTreeMap<String, Value>,
    /// What no source allows: each parameter outside its stated range, with range and source.
    pub warnings: Vec<String>,
    /// What displays could not use of what came to them, and the first reason of each: then less is shown than was drawn.
    pub display_faults: Vec<String>,
    /// Graphics processors of the machine, the master included.
    pub n_gps: usize,
    /// Renderer boards of the machine.
    pub n_renderers: usize,
    /// Name of the scene that was drawn.
    pub scene: String,
    /// Triangles in the scene.
    pub triangles: usize,
    /// Spheres in the scene.
    pub spheres: usize,
    /// Periods of the display that were simulated: NTSC fields.
    pub fields: u64,
    /// The periods of the display over which latencies, pictures due, errors and rates are computed; nothing of a run that was over
    /// before they began.
    pub window: Option<ResultWindow>,
    /// Complete pictures in the window, that the statistics are over.
    pub pictures: usize,
    /// Latency in periods of the display: for NTSC, fields of 1001/60000 s.
    pub latency_fields: DefinedStatistics,
    /// The same latency in milliseconds of simulated time.
    pub latency_ms: DefinedStatistics,
    /// Where the latency goes, in milliseconds: parts that add up to the way from the sample of the pose to light.
    pub latency_parts_ms: Vec<NamedStatistics>,
    /// Latency of each eye and of the pair to the end of COPY, to the swap and to light, in milliseconds; empty where the
    /// eyes have no TRANSFORM of their own.
    pub latency_by_eye_ms: Vec<SurfaceStatistics>,
    /// Complete pictures that were shown in the whole run, the warm-up included.
    pub shown: u64,
    /// Whole new pictures a second, over the window; nothing where fewer than two were shown.
    pub updates_hz: Option<f64>,
    /// The pictures that were due in the window, and what became of them; nothing where none was.
    pub due: Option<DuePictures>,
    /// When a picture is due here, what it takes to be in time, and which are counted.
    pub due_definition: String,
    /// Pictures that were due and not shown: late, incomplete or missed.
    pub missed_retraces: Option<u64>,
    /// That the load was too heavy, and what would do; nothing where it was not.
    pub too_heavy: Option<TooHeavy>,
    /// Whether the pictures that the viewer sees at the end are complete.
    pub ends_complete: bool,
    /// Regions that came after their deadline.
    pub late_regions: usize,
    /// The first of them; lateness in picoseconds.
    pub first_late_regions: Vec<LateRegion>,
    /// What the first display has counted since the start.
    pub display_counters: Vec<Counter>,
    /// From the head to light; nothing of a run without a tracker.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub head: Option<HeadReport>,
    /// Of a display with faces around the head; nothing of any other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arp: Option<FacesReport>,
    /// Hash of everything that happened, and of the statistics above.
    pub trace_hash: String,
    /// Events of the simulation that were handled.
    pub events: u64,
    /// Vertices that graphics processors transformed: each corner of a triangle and each centre of a sphere, once for each view.
    pub vertex_transforms: u64,
    /// Time that the run took on this host; nothing on a host without a clock.
    pub host_seconds: Option<f64>,
}

/// What a tracker, a predictor and a display make of a pipeline.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HeadReport {
    /// Name of the tracker that reported the head.
    pub tracker: String,
    /// Name of the predictor between tracker and pipeline.
    pub predictor: String,
    /// The instant of what is shown from it that a view is predicted for.
    pub aim: Aim,
    /// Its numbers, as it ran.
    pub prediction: PredictorConfig,
    /// On what they were tuned; nothing where they were given.
    pub training: Option<Training>,
    /// Name of the head with all that it is, the numbers of its predictor included.
    pub fingerprint: String,
    /// Distance at which errors are judged, metres; nothing where the scene's content lies.
    pub judged_at_m: Option<f64>,
    /// How the raster before the eyes shows the picture.
    pub display: Raster,
    /// From the head's pose to light, milliseconds.
    pub end_to_end: Budget,
    /// Where pixels are against where they should be.
    pub error: PixelErrors,
}

impl HeadReport {
    fn of_head(outcome: &Outcome, head: &Head) -> Option<Self> {
        Some(Self {
            tracker: head.tracker().config().name.clone(),
            predictor: format!("{:?}", head.predictor_kind()),
            aim: head.aim(),
            prediction: *head.predictor(),
            training: head.training().copied(),
            fingerprint: head.fingerprint().to_string(),
            judged_at_m: head.judge_at_m(),
            display: head.raster(),
            end_to_end: Budget::of(outcome),
            error: pixel_errors(outcome)?,
        })
    }
}

impl Report {
    /// Lines of regions that were overwritten before they had been shown; `None` where the display does not count them.
    #[must_use]
    pub fn lines_never_shown(&self) -> Option<u64> {
        let counter = self.display_counters.iter().find(|counter| counter.name == Counter::LINES_NEVER_SHOWN);
        counter.map(|counter| counter.count)
    }
}

fn faults(record: &Record) -> impl Iterator<Item = String> {
    record.displays().iter().filter_map(|display| {
        let (count, first) = display.faults();
        let first = first.map(|reason| format!("; the first: {reason}")).unwrap_or_default();
        (count > 0).then(|| format!("the display {} could not use {count} messages{first}", display.name()))
    })
}

impl Report {
    /// Name and version of the layout.
    pub const SCHEMA: &'static str = "pxpl5-report/2";

    /// Everything that an outcome says, as numbers.
    #[must_use]
    pub fn of(outcome: &Outcome) -> Self {
        let experiment = outcome.experiment();
        let config = experiment.config();
        let scene = experiment.scene();
        let pipeline = outcome.pipeline();
        let record = outcome.record();
        let due = outcome.due();
        let tally = outcome.tally();
        let mut report = Self {
            schema: Self::SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            machine: config.preset.clone(),
            config_hash: experiment.config_hash().to_string(),
            level: experiment.level_of_modelling().name().to_owned(),
            seed: experiment.seed_of_motion(),
            pipeline: pipeline.name().to_owned(),
            variant: pipeline
                .settings()
                .iter()
                .map(|(key, value)| format!("{key}={value}"))
                .collect::<Vec<_>>()
                .join(" "),
            display: record.display().name().to_owned(),
            overrides: config.overrides(),
            warnings: experiment.warnings().into_iter().chain(untold(outcome)).collect(),
            display_faults: faults(record).collect(),
            n_gps: config.n_gps,
            n_renderers: config.n_renderers,
            scene: scene.name().to_owned(),
            triangles: scene.triangles().len(),
            spheres: scene.spheres().len(),
            fields: outcome.fields(),
            window: outcome.window(),
            pictures: tally.complete as usize,
            latency_fields: outcome.latency_fields().defined(pipeline.latency_definition()),
            latency_ms: outcome.latency_ms().defined(pipeline.latency_definition()),
            latency_parts_ms: latency_part_statistics(outcome),
            latency_by_eye_ms: latency_by_surface(outcome),
            shown: outcome.shown(),
            updates_hz: outcome.updates_hz(),
            due,
            due_definition: outcome.due_definition(),
            missed_retraces: due.map(|due| due.not_shown()),
            too_heavy: due.and_then(|due| TooHeavy::of(experiment, &due)),
            ends_complete: outcome.ends_complete(),
            late_regions: tally.late_regions as usize,
            first_late_regions: tally.first_late_regions.clone(),
            display_counters: record.display().counters(),
            head: outcome.head().and_then(|views| HeadReport::of_head(outcome, views.head())),
            arp: FacesReport::of(outcome),
            trace_hash: String::new(),
            events: record.events(),
            vertex_transforms: record.vertex_transforms(),
            host_seconds: outcome.host_seconds(),
        };
        report.hash_statistics(record.trace_hash());
        report
    }

    /// Takes the statistics into the hash: what is reported follows from what happened, but in an order of its own, and a sum of
    /// floating-point numbers in another order is another one.
    fn hash_statistics(&mut self, mut hash: TraceHash) {
        let latencies = (&self.latency_fields, &self.latency_ms, &self.latency_parts_ms, &self.latency_by_eye_ms);
        let pictures =
            (self.pictures, self.shown, &self.updates_hz, &self.due, self.missed_retraces, self.ends_complete);
        let late = (self.late_regions, &self.first_late_regions, &self.display_counters);
        // The latency of a step is no part of it, since a run that has dropped records does not know it.
        let mut arp = self.arp.clone();
        for memory in arp.iter_mut().flat_map(|faces| &mut faces.memories) {
            memory.translation_latency_ms = None;
            memory.translation_latency_parts_ms.clear();
        }
        let mut text = HashedText::default();
        // Numbers print with as many digits as tell them apart.
        let _ = write!(text, "{latencies:?}{pictures:?}{late:?}{:?}{:?}", self.head, arp);
        hash.0 = hash.0.wrapping_add(text.0);
        self.trace_hash = hash.to_string();
    }
}

/// The hash of a record at time zero of the facts 9 and the bytes of a text, which nobody holds: that of a long run has many.
struct HashedText(u64);

impl Default for HashedText {
    fn default() -> Self {
        Self(mix(mix(Time::ZERO.0) ^ mix(9)))
    }
}

impl Write for HashedText {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0 = text.bytes().fold(self.0, |hash, byte| mix(hash ^ mix(u64::from(byte))));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_gp::Priority;
    use pxpl5_machine::{Machine, MachineConfig};
    use pxpl5_renderer::Layout;
    use pxpl5_wire::{Body, swap_request};

    /// A processor that asks a frame buffer for its buffer 2 of 2, so many times.
    #[test]
    fn displays_say_what_they_could_not_use_and_nothing_else() {
        for asks in [0, 1, 3] {
            let mut machine = Machine::new(&MachineConfig::small_hmd(), 1, Layout::slats()).expect("a preset");
            let (processor, display) = (machine.ports().gps[0], machine.ports().display()[0]);
            let gp = machine.processor(processor, Priority::Foreground);
            let program = async move {
                for _ in 0..asks {
                    gp.send(display, 2, Body::Words(swap_request(2))).await;
                }
                gp.until("nothing", || None).await
            };
            machine.load(processor, Priority::Foreground, Box::pin(program));
            machine.switch_on();
            machine.run_until(Time(1_000_000_000)).expect("it runs");
            let said: Vec<String> = faults(machine.record()).collect();
            let begin = format!("the display ntsc could not use {asks} messages; the first: ");
            let is_said = |said: &String| said.starts_with(&begin) && said.ends_with("expected buffer 0 or 1, found 2");
            assert!(said.iter().all(is_said) && said.len() == asks.min(1), "{asks}: {said:?}");
        }
    }

    #[test]
    fn a_text_in_pieces_is_hashed_as_one_record() {
        let text = "latency 33.4, pictures 12";
        let mut record = TraceHash::default();
        record.record(Time::ZERO, &[9].into_iter().chain(text.bytes().map(u64::from)).collect::<Vec<u64>>());
        let mut hashed = HashedText::default();
        let written = text.split_inclusive(' ').try_for_each(|piece| hashed.write_str(piece));
        assert_eq!((written, hashed.0), (Ok(()), record.0));
    }
}
