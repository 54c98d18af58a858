//! What came of an experiment, as data.

use crate::experiment::{Experiment, WARM_UP_PICTURES};
use crate::head_views::HeadViews;
use crate::pipeline::{PictureTimes, Pipeline};
use crate::statistics::Statistics;
use pxpl5_machine::{Observation, Record, StageSpan};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::PeriodNumber;
use std::sync::Arc;

/// What came of an experiment: the machine's [`Record`] and the pictures that were shown. It may be sent to another thread.
#[derive(Debug)]
pub struct Outcome {
    experiment: Experiment,
    record: Record,
    head: Option<Arc<HeadViews>>,
    pictures: Vec<PictureTimes>,
    reached: PeriodNumber,
    host_seconds: Option<f64>,
}

/// Which retraces are judged, behind what a pipeline calls missed.
const JUDGED: &str = "counted from the first picture after the warm-up to the end of the run; where no complete picture came \
                      after the warm-up, every retrace of the run at which none was shown";

impl Outcome {
    pub(crate) fn new(
        experiment: Experiment,
        record: Record,
        head: Option<Arc<HeadViews>>,
        reached: PeriodNumber,
        host_seconds: Option<f64>,
    ) -> Self {
        let end = record.tick(experiment.end());
        let pictures = experiment.pipeline.pictures(&record, end);
        Self { experiment, record, head, pictures, reached, host_seconds }
    }

    /// What was run.
    #[must_use]
    pub const fn experiment(&self) -> &Experiment {
        &self.experiment
    }

    /// All pictures that were shown.
    #[must_use]
    pub fn pictures(&self) -> &[PictureTimes] {
        &self.pictures
    }

    /// The pictures after the first [`WARM_UP_PICTURES`].
    #[must_use]
    pub fn steady_pictures(&self) -> &[PictureTimes] {
        self.pictures.get(WARM_UP_PICTURES..).unwrap_or_default()
    }

    /// Those of them that were complete in time: the others have no latency.
    pub fn complete_pictures(&self) -> impl Iterator<Item = &PictureTimes> {
        self.steady_pictures().iter().filter(|times| times.complete)
    }

    /// Complete pictures that were shown in the whole run, the warm-up included.
    #[must_use]
    pub fn shown(&self) -> u64 {
        self.pictures.iter().filter(|times| times.complete).count() as u64
    }

    /// Retraces that are judged: from the first picture after the warm-up to the end of the run, or to where it stopped;
    /// where no complete picture came after the warm-up, all; 0 of a pipeline whose pictures are never due.
    #[must_use]
    pub fn judged_retraces(&self) -> u64 {
        if self.pipeline().retraces_a_picture().is_none() {
            return 0;
        }
        let first = self.judged_pictures().first().map_or(PeriodNumber::FIRST, |times| self.period_of(times));
        self.reached.since(first)
    }

    /// Judged retraces at which no complete new picture could be shown though it was due: those between pictures, as the
    /// pipeline defines them, and those from the one at which the next picture was due to the end of the run. Where no
    /// complete picture came after the warm-up, all at which none was shown. Of a pipeline whose pictures are never due,
    /// what it counts itself.
    #[must_use]
    pub fn missed_retraces(&self) -> u64 {
        let Some(every) = self.pipeline().retraces_a_picture() else {
            return self.pipeline().missed_retraces(&self.record, self.steady_pictures());
        };
        let judged = self.judged_pictures();
        let Some(last) = judged.last() else {
            return self.reached.since(PeriodNumber::FIRST).saturating_sub(self.shown());
        };
        let after = self.reached.since(self.period_of(last)).saturating_sub(every);
        self.pipeline().missed_retraces(&self.record, judged) + after
    }

    /// What a missed retrace is here, and which retraces are judged.
    #[must_use]
    pub fn missed_definition(&self) -> String {
        let definition = self.pipeline().missed_definition();
        if self.pipeline().retraces_a_picture().is_none() {
            return definition.to_owned();
        }
        format!("{definition}; {JUDGED}")
    }

    /// The pictures after the warm-up, if any of them is complete.
    fn judged_pictures(&self) -> &[PictureTimes] {
        let steady = self.steady_pictures();
        if steady.iter().any(|times| times.complete) { steady } else { &[] }
    }

    /// The period of the first display in which a picture is shown.
    fn period_of(&self, times: &PictureTimes) -> PeriodNumber {
        self.record.display().period_at(times.shown_at)
    }

    /// The machine's boards as they stand at the end, and everything observed.
    #[must_use]
    pub const fn record(&self) -> &Record {
        &self.record
    }

    /// The views that the head's tracker gave, if there was one.
    #[must_use]
    pub fn head(&self) -> Option<&HeadViews> {
        self.head.as_deref()
    }

    /// Time that the run took on this host, in seconds; `None` on a host without a clock.
    #[must_use]
    pub const fn host_seconds(&self) -> Option<f64> {
        self.host_seconds
    }

    /// What was observed.
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

    /// Fields simulated.
    #[must_use]
    pub const fn fields(&self) -> u64 {
        self.experiment.fields
    }

    /// The end of the run.
    #[must_use]
    pub fn end(&self) -> Time {
        self.record.tick(self.experiment.end())
    }

    /// Latency in milliseconds over the complete pictures after the warm-up, as the pipeline defines it.
    #[must_use]
    pub fn latency_ms(&self) -> Statistics {
        Statistics::of(self.complete_pictures().map(|times| (times.shown_at - times.transform_at).as_ms()))
    }

    /// The same in periods of the first display: for NTSC, fields of 1001/60000 s.
    #[must_use]
    pub fn latency_fields(&self) -> Statistics {
        let field_ms = self.field_ms();
        let fields = |times: &PictureTimes| (times.shown_at - times.transform_at).as_ms() / field_ms;
        Statistics::of(self.complete_pictures().map(fields))
    }

    /// A period of the first display in milliseconds, from 60,000 of them.
    #[must_use]
    pub fn field_ms(&self) -> f64 {
        self.record.tick(PeriodNumber(60_000)).since(Time::ZERO).as_ms() / 60_000.0
    }
}
