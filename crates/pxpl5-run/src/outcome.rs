//! What came of an experiment, as data.

use crate::assembled::Assembled;
use crate::due::{DuePictures, LEAST_UPDATES};
use crate::experiment::Experiment;
use crate::face_notes::FaceNotes;
use crate::head_views::HeadViews;
use crate::latency::{LatencyParts, parts};
use crate::pipeline::{PictureTimes, Pipeline};
use crate::result_window::{ResultWindow, WINDOW_DEFINITION};
use crate::statistics::Statistics;
use crate::summary::Summary;
use crate::sums::Settled;
use crate::tally::{Tally, of_picture};
use crate::window::{Closed, Window, field_ms};
use pxpl5_machine::{Observation, Record, StageSpan};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::PeriodNumber;
use std::fmt;
use std::sync::Arc;

/// What came of an experiment: the machine's [`Record`] and the pictures that were shown. It may be sent to another thread.
///
/// It prints as a line: errors carry one, and whoever unwraps a result shall not be shown every vertex of the scene.
pub struct Outcome {
    experiment: Experiment,
    record: Record,
    head: Option<Arc<HeadViews>>,
    notes: FaceNotes,
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
        let Assembled { machine, head, notes } = run;
        let record = machine.into_record();
        let closed = window.close(&experiment, &record, (head.as_ref(), &notes), reached);
        Self { experiment, record, head, notes, closed, reached, host_seconds }
    }

    /// All of the run, as far as it is kept, for whoever sums it up afterwards.
    #[must_use]
    pub fn settled(&self) -> Settled<'_> {
        let all = self.experiment.settled(&self.record, self.head.as_ref(), &self.notes);
        Settled { pictures: self.pictures(), window: self.closed.window, ..all }
    }

    /// What came of the sum that was taken while the run went on ([`Experiment::summed_by`]), if that is of this kind.
    #[must_use]
    pub fn said<T: 'static>(&self) -> Option<&T> {
        self.closed.said.as_deref()?.downcast_ref()
    }

    /// Whether records of the run were given up ([`Keep`](crate::Keep)): what is asked now and was not summed up is of its last periods alone.
    #[must_use]
    pub fn has_forgotten(&self) -> bool {
        self.observation().forgotten.before > Time::ZERO
    }

    /// What was summed up over the whole run.
    #[must_use]
    pub const fn tally(&self) -> &Tally {
        &self.closed.tally
    }

    /// The experiment that was run, as it was asked for.
    #[must_use]
    pub const fn experiment(&self) -> &Experiment {
        &self.experiment
    }

    /// All pictures that were begun and judged, complete or not; of a run that keeps statistics only ([`Keep`](crate::Keep)) the last
    /// of [`Tally::pictures`].
    #[must_use]
    pub fn pictures(&self) -> &[PictureTimes] {
        &self.closed.pictures
    }

    /// The window over which latencies, pictures due, errors and rates are computed; `None` of a run that was over before it began.
    #[must_use]
    pub const fn window(&self) -> Option<ResultWindow> {
        self.closed.window
    }

    /// Those of them in the window.
    #[must_use]
    pub fn steady_pictures(&self) -> &[PictureTimes] {
        let Some(window) = self.closed.window else { return &[] };
        let display = self.record.display();
        // They are in the order in which they are shown.
        let is_in = |times: &PictureTimes| window.holds_picture(display.period_at(times.shown_at));
        let pictures = self.pictures();
        let first = pictures.iter().position(is_in).unwrap_or(pictures.len());
        let end = pictures.iter().rposition(is_in).map_or(first, |last| last + 1);
        &pictures[first..end]
    }

    /// Those of the steady ones that were complete in time: the others have no latency.
    pub fn complete_pictures(&self) -> impl Iterator<Item = &PictureTimes> {
        self.steady_pictures().iter().filter(|times| times.is_shown())
    }

    /// Complete pictures that were shown in the whole run, the warm-up included.
    #[must_use]
    pub const fn shown(&self) -> u64 {
        self.closed.tally.shown
    }

    /// The pictures that were due, and what became of them; `None` of a pipeline whose pictures never are, and of a run that
    /// was over before any was.
    #[must_use]
    pub fn due(&self) -> Option<DuePictures> {
        let every = self.pipeline().periods_a_picture(&self.record)?;
        Some(DuePictures::of_ends(self.closed.tally.ends(), every, &self.closed.window?))
    }

    /// When a picture is due here, what it takes to be in time, and which are counted.
    #[must_use]
    pub fn due_definition(&self) -> String {
        format!("{}; {WINDOW_DEFINITION}", self.pipeline().due_definition())
    }

    /// Whole new pictures a second, over the window: at most one a period of the display, since no more can be seen. `None` where
    /// fewer than two were shown, since a single one has no rate, and where all that were shown belong to start-up.
    #[must_use]
    pub fn updates_hz(&self) -> Option<f64> {
        let complete = self.closed.tally.complete;
        if complete < LEAST_UPDATES {
            return None;
        }
        if self.pipeline().periods_a_picture(&self.record).is_some() {
            return self.due()?.updates_hz(self.field_ms());
        }
        let window = self.closed.window?;
        let pictures = complete as f64 / self.pipeline().updates_per_picture(&self.record);
        let seen =
            pictures.min(self.closed.tally.ends().periods_shown([window.first_period, window.last_period]) as f64);
        Some(seen * 1e3 / (window.periods() as f64 * self.field_ms()))
    }

    /// Whether what a viewer sees at the end is complete: made of as many pictures as a whole screen takes (two fields,
    /// where lines are interlaced), all of them in time.
    #[must_use]
    pub fn ends_complete(&self) -> bool {
        let (_, fields_of_a_screen) = self.record.display().rows_lit(PeriodNumber::FIRST);
        let of_a_pass = self.pipeline().updates_per_picture(&self.record).ceil() as usize;
        let needed = of_a_pass.max(fields_of_a_screen as usize);
        self.closed.tally.shown_in_a_row >= needed as u64
    }

    /// The machine's boards as they stand at the end, and everything observed.
    #[must_use]
    pub const fn record(&self) -> &Record {
        &self.record
    }

    /// The views that the head's tracker gave, if there was one.
    #[must_use]
    pub const fn head(&self) -> Option<&Arc<HeadViews>> {
        self.head.as_ref()
    }

    /// The updates of display memories that were asked for, in order; none of a pipeline that draws no faces.
    #[must_use]
    pub const fn face_notes(&self) -> &FaceNotes {
        &self.notes
    }

    /// Time that the run took on this host, in seconds; `None` on a host without a clock.
    #[must_use]
    pub const fn host_seconds(&self) -> Option<f64> {
        self.host_seconds
    }

    /// Marks of firmware, arrivals at displays and swaps, in the order of time.
    #[must_use]
    pub const fn observation(&self) -> &Observation {
        self.record.observation()
    }

    /// All stages of all pictures, COPY as the displays saw it.
    #[must_use]
    pub fn stages(&self) -> Vec<StageSpan> {
        self.record.stages()
    }

    /// The software time of a message that a GP receives.
    #[must_use]
    pub const fn receive_span(&self) -> Span {
        Span::from_ns(self.experiment.config.gp.message_ns)
    }

    /// The pipeline that ran.
    #[must_use]
    pub fn pipeline(&self) -> &dyn Pipeline {
        self.experiment.pipeline.as_ref()
    }

    /// Periods of the first display that were asked for: NTSC fields.
    #[must_use]
    pub const fn fields(&self) -> u64 {
        self.experiment.fields
    }

    /// The end of the run.
    #[must_use]
    pub fn end(&self) -> Time {
        self.record.tick(self.experiment.end())
    }

    /// Latency in milliseconds over the complete pictures in the window, as the pipeline defines it.
    #[must_use]
    pub fn latency_ms(&self) -> Statistics {
        self.closed.tally.latency_ms.statistics()
    }

    /// The same in periods of the first display: for NTSC, fields of 1001/60000 s.
    #[must_use]
    pub fn latency_fields(&self) -> Statistics {
        self.closed.tally.latency_ms.statistics_in(self.field_ms())
    }

    /// The parts of the latency of the complete pictures in the window, as far as they are kept.
    #[must_use]
    pub fn latency_parts(&self) -> Vec<LatencyParts> {
        let stages = self.stages();
        let parts =
            self.complete_pictures().map(|times| parts(&self.record, times, of_picture(&stages, times.picture)));
        parts.collect()
    }

    /// The few numbers that every level of modelling gives, over the pictures in the window.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let tally = self.tally();
        let [first_copy_ms, last_copy_ms] = tally.copy_ms.each_ref().map(|samples| samples.statistics().mean);
        // A pipeline without a second copy spends no time on it; where nothing was copied nothing is known.
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

    /// A period of the first display in milliseconds, from 60,000 of them.
    #[must_use]
    pub fn field_ms(&self) -> f64 {
        field_ms(&self.record)
    }
}
