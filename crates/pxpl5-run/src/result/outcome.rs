use crate::build::assembled::Assembled;
use crate::experiment::Experiment;
use crate::head_views::HeadViews;
use crate::observe::observers::FinalResults;
use crate::observe::window::{Closed, Window, field_ms};
use crate::pipeline::{PictureTimes, Pipeline};
use crate::result::due::{DuePictures, MIN_UPDATES};
use crate::result::latency::{LatencyParts, parts_of_pictures};
use crate::result::result_window::{ResultWindow, WINDOW_DEFINITION};
use crate::result::summary::Summary;
use crate::result::tally::Tally;
use pxpl5_machine::{Observation, ObservedEvent, Record, StageSpan};
use pxpl5_sim::Statistics;
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use std::fmt;
use std::sync::Arc;

/// Result of an experiment: the machine's [`Record`] and the pictures that were shown.
///
/// `Debug` prints one line only. Errors contain an outcome, and a panic message must not list every vertex of the
/// scene.
pub struct Outcome {
    experiment: Experiment,
    record: Record,
    head: Option<Arc<HeadViews>>,
    closed: Closed,
    reached: PeriodNumber,
    host_seconds: Option<f64>,
}

impl fmt::Debug for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Outcome")
            .field("pipeline", &self.experiment.pipeline().name())
            .field("scene", &self.experiment.scene().name())
            .field("reached", &self.reached)
            .field("shown", &self.tally().shown)
            .field("trace_hash", &self.record.trace_hash())
            .finish_non_exhaustive()
    }
}

impl Outcome {
    pub(crate) fn new(
        experiment: Experiment,
        run: Assembled,
        window: Window,
        reached: PeriodNumber,
        host_seconds: Option<f64>,
    ) -> Self {
        let Assembled { machine, head } = run;
        let record = machine.into_record();
        let closed = window.close(&experiment, &record, head.as_ref(), reached);
        Self { experiment, record, head, closed, reached, host_seconds }
    }

    /// Returns the results of the run for evaluation, as far as the records are in memory.
    pub fn final_results(&self) -> FinalResults<'_> {
        let all = self.experiment.final_results(&self.record, self.head.as_ref());
        FinalResults { pictures: self.pictures(), window: self.closed.window, ..all }
    }

    /// Returns the result of the streaming observer ([`Experiment::observed_by`]) if it has the type `T`.
    pub fn observed<T: 'static>(&self) -> Option<&T> {
        self.closed.observed.as_deref()?.downcast_ref()
    }

    /// Returns true if the run discarded old records ([`KeptRecords`](crate::KeptRecords)). Most results are then
    /// available only for the last periods.
    pub fn has_discarded_records(&self) -> bool {
        self.observation().discarded.before > Time::ZERO
    }

    /// Returns the statistics that the run has accumulated.
    pub const fn tally(&self) -> &Tally {
        &self.closed.tally
    }

    /// Returns the experiment that was run.
    pub const fn experiment(&self) -> &Experiment {
        &self.experiment
    }

    /// Returns all pictures that were begun and evaluated, complete or not.
    ///
    /// [`Tally::pictures`] counts these pictures. A run that keeps only statistics
    /// ([`KeptRecords`](crate::KeptRecords)) returns only the last pictures.
    pub fn pictures(&self) -> &[PictureTimes] {
        &self.closed.pictures
    }

    /// Returns the display periods over which latencies, due pictures, errors and rates are computed. Returns `None` if
    /// the run ended before these periods began.
    pub const fn window(&self) -> Option<ResultWindow> {
        self.closed.window
    }

    /// Returns the pictures in the result window.
    pub fn steady_pictures(&self) -> &[PictureTimes] {
        self.final_results().steady_pictures()
    }

    /// Returns the pictures in the result window that were complete in time. Other pictures have no latency.
    pub fn complete_pictures(&self) -> impl Iterator<Item = &PictureTimes> {
        self.steady_pictures().iter().filter(|times| times.is_shown())
    }

    /// Returns the number of complete pictures in the whole run, including the warm-up.
    pub const fn shown(&self) -> u64 {
        self.closed.tally.shown
    }

    /// Returns the number of due pictures, counted by result (shown, late, incomplete or missed). Returns `None` if the
    /// pipeline has no due pictures, or if the run ended before the first due picture or in its warm-up.
    pub fn due(&self) -> Option<DuePictures> {
        let every = self.pipeline().periods_a_picture(&self.record)?;
        DuePictures::of_ends(&self.closed.tally.ends, every, &self.closed.window?)
    }

    /// Returns a text that defines for this pipeline when a picture is due, and when it is in time.
    pub fn due_definition(&self) -> String {
        format!("{}; {WINDOW_DEFINITION}", self.pipeline().properties().due_definition)
    }

    /// Returns the number of complete new pictures per second, over the result window.
    ///
    /// At most one picture per display period counts, because a viewer cannot see more. Returns `None` if fewer than
    /// two pictures were shown, or if all shown pictures belong to the warm-up.
    pub fn updates_hz(&self) -> Option<f64> {
        let complete = self.closed.tally.complete;
        // A single picture has no rate.
        if complete < MIN_UPDATES {
            return None;
        }
        // Pipelines with due pictures have the rate of the pictures that were shown in time.
        if self.pipeline().periods_a_picture(&self.record).is_some() {
            return self.due()?.updates_hz(self.field_ms());
        }
        let window = self.closed.window?;
        // Otherwise several updates make up a picture, and each period counts at most once.
        let pictures = complete as f64 / self.pipeline().updates_per_picture(&self.record);
        let seen = pictures.min(self.closed.tally.ends.periods_shown([window.first_period, window.last_period]) as f64);
        Some(seen * 1e3 / (window.periods() as f64 * self.field_ms()))
    }

    /// Returns true if the viewer sees a complete screen at the end. With interlaced fields, a screen shows the
    /// pictures of two fields, and both pictures must have been in time.
    pub fn ends_complete(&self) -> bool {
        let (_, fields_of_a_screen) = self.record.display().rows_lit(PeriodNumber::FIRST);
        let of_a_pass = self.pipeline().updates_per_picture(&self.record).ceil() as usize;
        let needed = of_a_pass.max(fields_of_a_screen as usize);
        self.closed.tally.shown_in_a_row >= needed as u64
    }

    /// Returns the state of the machine's boards at the end of the run, and all observations of the run.
    pub const fn record(&self) -> &Record {
        &self.record
    }

    /// Returns the views of the tracked head, or `None` if no head is tracked.
    pub const fn head(&self) -> Option<&Arc<HeadViews>> {
        self.head.as_ref()
    }

    /// Returns the real time that the run took on the host computer, in seconds. Returns `None` on a host without a
    /// clock.
    pub const fn host_seconds(&self) -> Option<f64> {
        self.host_seconds
    }

    /// Returns the time stamps of stages, the arrivals at displays and the swaps, each in order of time.
    pub const fn observation(&self) -> &Observation {
        self.record.observation()
    }

    /// Returns the observed events of the run in the order of time, each with the name of its board.
    ///
    /// A run that keeps only statistics ([`KeptRecords`](crate::KeptRecords)) returns only the events of its last
    /// periods.
    pub fn events(&self) -> impl Iterator<Item = ObservedEvent> {
        self.record.observed_events().into_iter()
    }

    /// Returns the start and end of every stage of every picture. The times of COPY are measured at the displays.
    pub fn stages(&self) -> Vec<StageSpan> {
        self.record.stages()
    }

    /// Returns the pipeline that was run.
    pub fn pipeline(&self) -> &dyn Pipeline {
        self.experiment.pipeline.as_ref()
    }

    /// Returns the requested number of periods of the first display. For NTSC, a period is a field.
    pub const fn fields(&self) -> u64 {
        self.experiment.fields
    }

    /// Returns the simulated time at which the run ended.
    pub fn end(&self) -> Time {
        self.record.tick(self.experiment.end())
    }

    /// Returns the statistics of the latencies in milliseconds, over the complete pictures in the result window. The
    /// pipeline defines its latency.
    pub fn latency_ms(&self) -> Statistics {
        self.closed.tally.latency_ms.statistics()
    }

    /// Returns the statistics of the latencies in milliseconds. Returns `None` if the result window has no complete
    /// picture.
    pub fn latency(&self) -> Option<Statistics> {
        Some(self.latency_ms()).filter(|statistics| statistics.n > 0)
    }

    /// Returns the statistics of the latencies in periods of the first display. For NTSC, a period is a field of
    /// 1001/60000 s.
    pub fn latency_fields(&self) -> Statistics {
        self.closed.tally.latency_ms.statistics_in(self.field_ms())
    }

    /// Returns the parts of the latencies of the complete pictures in the result window. Pictures without records in
    /// memory are left out.
    pub fn latency_parts(&self) -> Vec<LatencyParts> {
        parts_of_pictures(&self.record, self.complete_pictures())
    }

    /// Returns the results that are available at every level of detail, over the pictures in the result window.
    pub fn summary(&self) -> Summary {
        let tally = self.tally();
        let [first_copy_ms, last_copy_ms] = tally.copy_ms.each_ref().map(|samples| samples.statistics().mean);
        // A pipeline without a second copy spends no time on a second copy. Without any copy, the time is unknown.
        let last_copy_ms = if last_copy_ms.is_nan() && !first_copy_ms.is_nan() { 0.0 } else { last_copy_ms };
        Summary {
            latencies_ms: tally.latency_ms.clone(),
            field_ms: self.field_ms(),
            updates_hz: self.updates_hz(),
            due: self.due(),
            eye_latencies_ms: tally.eye_ms.clone(),
            eye_swap_latencies_ms: tally.eye_swap_ms.clone(),
            eye_retraces: tally.eye_retraces.clone(),
            region_copy_us: tally.region_copy_us(),
            first_copy_ms,
            last_copy_ms,
            copy_begins_ms: tally.copy_begins_ms.statistics().mean,
        }
    }

    /// Returns the mean duration of a period of the first display over 60,000 periods, in milliseconds.
    pub fn field_ms(&self) -> f64 {
        field_ms(&self.record)
    }
}
