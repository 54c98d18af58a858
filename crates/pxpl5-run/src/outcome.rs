//! What came of an experiment, as data.

use crate::experiment::{Experiment, WARM_UP_PICTURES};
use crate::head_views::HeadViews;
use crate::pipeline::{PictureTimes, Pipeline};
use crate::statistics::Statistics;
use pxpl5_machine::{Observation, Record, StageSpan};
use pxpl5_sim::{Span, Time};
use std::sync::Arc;

/// What came of an experiment: the machine's [`Record`] and the pictures that were shown. It may be sent to another thread.
#[derive(Debug)]
pub struct Outcome {
    experiment: Experiment,
    record: Record,
    head: Option<Arc<HeadViews>>,
    pictures: Vec<PictureTimes>,
    host_seconds: Option<f64>,
}

impl Outcome {
    pub(crate) fn new(
        experiment: Experiment,
        record: Record,
        head: Option<Arc<HeadViews>>,
        host_seconds: Option<f64>,
    ) -> Self {
        let end = record.tick(experiment.fields);
        let pictures = experiment.pipeline.pictures(&record, end);
        Self { experiment, record, head, pictures, host_seconds }
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
        self.record.tick(self.experiment.fields)
    }

    /// Latency in milliseconds over the pictures after the warm-up, as the pipeline defines it.
    #[must_use]
    pub fn latency_ms(&self) -> Statistics {
        Statistics::of(self.steady_pictures().iter().map(|times| (times.shown_at - times.transform_at).as_ms()))
    }

    /// The same in periods of the first display: for NTSC, fields of 1001/60000 s.
    #[must_use]
    pub fn latency_fields(&self) -> Statistics {
        let field_ms = self.field_ms();
        let fields = |times: &PictureTimes| (times.shown_at - times.transform_at).as_ms() / field_ms;
        Statistics::of(self.steady_pictures().iter().map(fields))
    }

    /// A period of the first display in milliseconds, from 60,000 of them.
    #[must_use]
    pub fn field_ms(&self) -> f64 {
        self.record.tick(60_000).since(Time::ZERO).as_ms() / 60_000.0
    }
}
