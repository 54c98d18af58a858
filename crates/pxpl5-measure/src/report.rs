//! The report of an experiment. Names of its numbers include the unit.

use crate::budget::Budget;
use crate::critical_path::CriticalPath;
use crate::errors::PixelErrors;
use crate::eye_report::EyeReport;
use crate::faces_report::FacesReport;
use crate::head_results::{HeadResults, missing_results_warning};
use crate::latency::{
    LatencyPartStatistics, LatencyPercentiles, SurfaceStatistics, latency_by_surface, latency_part_statistics,
};
use crate::percentiles::Percentiles;
use crate::program;
use crate::too_heavy::TooHeavy;
use crate::utilisation::Utilisation;
use pxpl5_machine::{LateRegion, Record};
use pxpl5_run::{Aim, DefinedStatistics, DuePictures, Head, Outcome, Raster, ResultWindow, hmd_on};
use pxpl5_scene::HmdConfig;
use pxpl5_sim::parameters::Value;
use pxpl5_sim::{Time, TraceHash, mix};
use pxpl5_wire::display::Counter;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::{self, Write};
use tracking::predict::{PredictorConfig, Training};

/// All numbers of one experiment, as written to JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Name and version of the layout of this report.
    pub schema: String,
    /// Version of the program that wrote the report.
    pub version: String,
    /// Commit from which the program was built. `None` if the program did not state its commit.
    pub commit: Option<String>,
    /// Name of the machine's preset.
    pub machine: String,
    /// Hash of all settings that the trace depends on ([`pxpl5_run::Experiment::config_hash`]).
    pub config_hash: String,
    /// Level of modelling: `transaction` or `cycle`.
    pub level: String,
    /// Seed of the head motion.
    pub seed: u64,
    /// Name of the pipeline, as in experiment files.
    pub pipeline: String,
    /// Settings of the pipeline as `key=value`, including defaults.
    pub variant: String,
    /// Name of the display that the pipeline draws for.
    pub display: String,
    /// Machine parameters that differ from the preset, by path.
    pub overrides: BTreeMap<String, Value>,
    /// Warnings, such as parameters outside the range that the sources allow.
    pub warnings: Vec<String>,
    /// Messages that each display could not use, with the first reason. If the list is not empty, the displays show
    /// less than the pipeline drew.
    pub display_faults: Vec<String>,
    /// Number of graphics processors in the machine, including the master.
    pub n_gps: usize,
    /// Number of renderer boards in the machine.
    pub n_renderers: usize,
    /// Name of the scene that was drawn.
    pub scene: String,
    /// Number of triangles in the scene.
    pub triangles: usize,
    /// Number of spheres in the scene.
    pub spheres: usize,
    /// Number of simulated display periods. For NTSC, a period is one field.
    pub fields: u64,
    /// The display periods over which latencies, pictures due, errors and rates are computed.
    ///
    /// `None` if the run ended before the window of these periods began.
    pub window: Option<ResultWindow>,
    /// Number of complete pictures in the result window after the first four pictures of the run. The statistics are
    /// computed over these pictures.
    pub pictures: usize,
    /// Latency of the pictures in display periods. For NTSC, a period is one field of 1001/60000 s.
    pub latency_fields: DefinedStatistics,
    /// Latency of the pictures in milliseconds of simulated time.
    pub latency_ms: DefinedStatistics,
    /// Percentiles of the latency, of the time from head to light, and of the error of the prediction interval.
    pub percentiles_ms: LatencyPercentiles,
    /// Parts of the latency in milliseconds. The parts add up to the time from the sample of the pose until the picture
    /// is lit.
    pub latency_parts_ms: Vec<LatencyPartStatistics>,
    /// Latency of each eye and of the pair, in milliseconds: to the end of COPY, to the swap, and until the pixels are
    /// lit.
    ///
    /// The list is empty if the eyes share one TRANSFORM.
    pub latency_by_eye_ms: Vec<SurfaceStatistics>,
    /// Number of complete pictures shown in the whole run, including the warm-up.
    pub shown: u64,
    /// Number of complete new pictures per second within the result window. `None` if fewer than two pictures were
    /// shown.
    pub updates_hz: Option<f64>,
    /// Number of pictures that were due in the result window, counted by result (shown, late, incomplete or missed).
    /// `None` if no picture was due.
    pub due: Option<DuePictures>,
    /// Definition of the due pictures: the time at which a picture is due, the latest time for its display, and the
    /// pictures that are counted.
    pub due_definition: String,
    /// Number of pictures due that were not shown: late, incomplete or missed.
    pub missed_retraces: Option<u64>,
    /// Warning that the scene is too heavy for the pipeline, with advice. `None` if the load is acceptable.
    pub too_heavy: Option<TooHeavy>,
    /// True if each picture that the viewer sees at the end of the run is complete.
    pub ends_complete: bool,
    /// Number of regions that arrived after their deadline.
    pub late_regions: usize,
    /// The first late regions, with lateness in picoseconds.
    pub first_late_regions: Vec<LateRegion>,
    /// Counters of the first display since the start of the run.
    pub display_counters: Vec<Counter>,
    /// Results that concern the head: prediction, latency and pixel errors. `None` for a run without a tracker.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub head: Option<HeadReport>,
    /// Smear, and results of a device that moves pictures.
    ///
    /// `None` if pixels are lit for an instant only and no device moves pictures.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye: Option<EyeReport>,
    /// Results of an address recalculation display. `None` for any other display.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arp: Option<FacesReport>,
    /// Head-mounted display before the viewer's eyes. A display with cube faces around the head does not use this
    /// display, but has settings for its own optics.
    pub hmd: HmdConfig,
    /// Share of time in which each kind of board was busy. `None` if the machine has not run.
    pub utilisation: Option<Utilisation>,
    /// Chain of waits that make up the latency of the last complete pictures. `None` if no picture was complete.
    pub critical_path: Option<CriticalPath>,
    /// Hash of all events of the run, and of the statistics of this report up to the member `arp`.
    pub trace_hash: String,
    /// Number of events that the simulation handled.
    pub events: u64,
    /// Number of vertices that graphics processors transformed.
    ///
    /// Each corner of a triangle and each centre of a sphere counts once per view.
    pub vertex_transforms: u64,
    /// Real time that the run took on this computer, in seconds. `None` on a system without a clock.
    pub host_seconds: Option<f64>,
}

/// Results that concern the head: tracker, prediction, latency until pixels are lit, and pixel error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HeadReport {
    /// Name of the tracker that reported the head's pose.
    pub tracker: String,
    /// Name of the predictor between tracker and pipeline.
    pub predictor: String,
    /// The instant for which the predictor predicts the head's pose, relative to the time at which the picture is
    /// shown.
    pub aim: Aim,
    /// Parameters of the predictor in this run.
    pub prediction: PredictorConfig,
    /// Data from which the predictor's parameters were tuned. `None` if the user set the parameters.
    pub training: Option<Training>,
    /// Hash of all settings of the head, including the parameters of its predictor.
    pub fingerprint: String,
    /// Fixed distance at which errors are evaluated, in metres. `None` if errors are evaluated at the scene's content.
    pub evaluated_at_m: Option<f64>,
    /// Correction that the head-mounted display applies to pictures: none, the raster offset of VDRT, or a device that
    /// moves pictures.
    pub display: Raster,
    /// Latency from the measurement of the head's pose until the picture is lit, by stage, in milliseconds.
    pub end_to_end: Budget,
    /// Pixel error of the displayed pixels.
    pub error: PixelErrors,
}

impl HeadReport {
    fn of(head: &Head, results: &HeadResults) -> Self {
        Self {
            tracker: head.tracker().config().name.clone(),
            predictor: format!("{:?}", head.predictor().kind),
            aim: head.aim,
            prediction: *head.predictor(),
            training: head.training().copied(),
            fingerprint: head.fingerprint().to_string(),
            evaluated_at_m: head.evaluate_at_m,
            display: head.raster,
            end_to_end: results.end_to_end,
            error: results.error.clone(),
        }
    }
}

impl Report {
    /// Returns the number of lines that were overwritten before the display showed them. `None` if the display does not
    /// count such lines.
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
    /// Name and version of the layout of this report.
    pub const SCHEMA: &'static str = "pxpl5-report/3";

    /// Computes the report of an outcome.
    pub fn of(outcome: &Outcome) -> Self {
        let experiment = outcome.experiment();
        let config = experiment.config();
        let scene = experiment.scene();
        let pipeline = outcome.pipeline();
        let record = outcome.record();
        let due = outcome.due();
        let tally = outcome.tally();
        let results = HeadResults::of(outcome);
        let [head_to_light, prediction_interval_error] = results.percentiles;
        let latency = Percentiles::of(tally.latency_ms.iter().copied());
        let mut report = Self {
            // Identity of the run.
            schema: Self::SCHEMA.to_owned(),
            version: program::VERSION.to_owned(),
            commit: program::commit().map(str::to_owned),
            machine: config.preset.clone(),
            config_hash: experiment.config_hash().to_string(),
            level: experiment.level.name().to_owned(),
            seed: experiment.seed,
            pipeline: pipeline.name().to_owned(),
            variant: pipeline
                .settings()
                .iter()
                .map(|(key, value)| format!("{key}={value}"))
                .collect::<Vec<_>>()
                .join(" "),
            display: record.display().name().to_owned(),
            // Warnings and configuration.
            overrides: config.overrides(),
            warnings: experiment.warnings().into_iter().chain(missing_results_warning(outcome)).collect(),
            display_faults: faults(record).collect(),
            n_gps: config.n_gps,
            n_renderers: config.n_renderers,
            scene: scene.name().to_owned(),
            triangles: scene.triangles().len(),
            spheres: scene.spheres().len(),
            // Results over the window.
            fields: outcome.fields(),
            window: outcome.window(),
            pictures: tally.complete as usize,
            latency_fields: outcome.latency_fields().defined(pipeline.properties().latency_definition),
            latency_ms: outcome.latency_ms().defined(pipeline.properties().latency_definition),
            percentiles_ms: LatencyPercentiles { latency, head_to_light, prediction_interval_error },
            latency_parts_ms: latency_part_statistics(outcome),
            latency_by_eye_ms: latency_by_surface(outcome),
            // Results over the whole run.
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
            // Results that only some runs have.
            head: outcome.head().map(|views| HeadReport::of(views.head(), &results)),
            eye: results.eye.clone(),
            arp: FacesReport::of(outcome, &results),
            hmd: *hmd_on(outcome.record().display(), &outcome.experiment().hmd).config(),
            utilisation: Utilisation::of(record),
            critical_path: CriticalPath::of(outcome),
            trace_hash: String::new(),
            events: record.events(),
            vertex_transforms: record.vertex_transforms(),
            host_seconds: outcome.host_seconds(),
        };
        report.hash_statistics(record.trace_hash());
        report
    }

    /// Adds the statistics of this report to the trace hash. Otherwise the hash would not depend on the order of
    /// summation, which changes floating-point sums.
    fn hash_statistics(&mut self, mut hash: TraceHash) {
        let latencies = (&self.latency_fields, &self.latency_ms, &self.latency_parts_ms, &self.latency_by_eye_ms);
        let pictures =
            (self.pictures, self.shown, &self.updates_hz, &self.due, self.missed_retraces, self.ends_complete);
        let late = (self.late_regions, &self.first_late_regions, &self.display_counters);
        // Leave out the translation latency, as when hashes of reports were first published.
        let mut arp = self.arp.clone();
        for memory in arp.iter_mut().flat_map(|faces| &mut faces.memories) {
            memory.translation_latency_ms = None;
            memory.translation_latency_parts_ms.clear();
        }
        let mut text = HashedText::default();
        // The debug format prints enough digits to distinguish all numbers.
        let _ = write!(text, "{latencies:?}{pictures:?}{late:?}{:?}{:?}", self.head, arp);
        hash.0 = hash.0.wrapping_add(text.0);
        self.trace_hash = hash.to_string();
    }
}

/// Computes the hash of a text like the trace hash of one event. This event has time zero, kind 9 and the bytes of the
/// text.
///
/// The text is not stored, because the text of a long run would be large.
struct HashedText(u64);

impl Default for HashedText {
    fn default() -> Self {
        Self(mix(mix(Time::ZERO.0) ^ mix(9)))
    }
}

impl Write for HashedText {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        // These have the names that they had when hashes of reports were first published.
        let text = match text {
            "FieldMisregistration" => "FieldError",
            "LatencyPartStatistics" => "NamedStatistics",
            "evaluated" => "judged",
            "evaluated_at_m" => "judged_at_m",
            other => other,
        };
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

    /// Tests a program that asks a display with the buffers 0 and 1 for buffer 2, `asks` times.
    #[test]
    fn a_report_has_a_fault_of_the_display_only_if_a_program_causes_a_fault() {
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
            let found_faults: Vec<String> = faults(machine.record()).collect();
            let begin = format!("the display ntsc could not use {asks} messages; the first: ");
            let is_fault =
                |fault: &String| fault.starts_with(&begin) && fault.ends_with("expected buffer 0 or 1, found 2");
            assert!(found_faults.iter().all(is_fault) && found_faults.len() == asks.min(1), "{asks}: {found_faults:?}");
        }
    }

    #[test]
    fn a_text_written_in_parts_is_hashed_as_one_record() {
        let text = "latency 33.4, pictures 12";
        let mut record = TraceHash::default();
        record.record(Time::ZERO, &[9].into_iter().chain(text.bytes().map(u64::from)).collect::<Vec<u64>>());
        let mut hashed = HashedText::default();
        let written = text.split_inclusive(' ').try_for_each(|piece| hashed.write_str(piece));
        assert_eq!((written, hashed.0), (Ok(()), record.0));
    }
}
