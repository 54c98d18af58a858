//! A run as far as it has come: what timelines and tables of a run need, whether it is over or goes on.

use crate::experiment::Experiment;
use crate::latency::{LatencyParts, parts};
use crate::outcome::Outcome;
use crate::pipeline::{PictureTimes, Pipeline};
use crate::stepper::Stepper;
use crate::tally::of_picture;
use pxpl5_machine::{Observation, Record, StageSpan};
use pxpl5_sim::{Span, Time};
use std::borrow::Cow;

/// What was observed of a run up to an instant: of an [`Outcome`] all of it, of a [`Stepper`] what has happened.
#[derive(Clone, Debug)]
pub struct SoFar<'a> {
    experiment: &'a Experiment,
    record: &'a Record,
    pictures: Cow<'a, [PictureTimes]>,
    end: Time,
}

impl Outcome {
    /// All of the run.
    #[must_use]
    pub fn so_far(&self) -> SoFar<'_> {
        let pictures = Cow::Borrowed(self.pictures());
        SoFar { experiment: self.experiment(), record: self.record(), pictures, end: self.end() }
    }
}

impl Stepper {
    /// The run up to now, with its pictures that have been shown, as far as records of them are [kept](crate::Keep).
    #[must_use]
    pub fn so_far(&self) -> SoFar<'_> {
        let pictures = self.experiment().pipeline().pictures(self.record(), self.now());
        SoFar { experiment: self.experiment(), record: self.record(), pictures: Cow::Owned(pictures), end: self.now() }
    }
}

impl SoFar<'_> {
    /// The machine's boards and everything observed.
    #[must_use]
    pub const fn record(&self) -> &Record {
        self.record
    }

    /// Marks of firmware, arrivals at displays and swaps, in the order of time.
    #[must_use]
    pub const fn observation(&self) -> &Observation {
        self.record.observation()
    }

    /// The pictures that were begun and judged, in order.
    #[must_use]
    pub fn pictures(&self) -> &[PictureTimes] {
        &self.pictures
    }

    /// The pipeline that runs.
    #[must_use]
    pub fn pipeline(&self) -> &dyn Pipeline {
        self.experiment.pipeline().as_ref()
    }

    /// All stages of all pictures, COPY as the displays saw it.
    #[must_use]
    pub fn stages(&self) -> Vec<StageSpan> {
        self.record.stages()
    }

    /// Periods of the first display that the run takes in all.
    #[must_use]
    pub const fn fields(&self) -> u64 {
        self.experiment.length()
    }

    /// The instant up to which it is known.
    #[must_use]
    pub const fn end(&self) -> Time {
        self.end
    }

    /// The software time of a message that a GP receives.
    #[must_use]
    pub const fn receive_span(&self) -> Span {
        Span::from_ns(self.experiment.config().gp.message_ns)
    }

    /// Where the latency of the last complete pictures went, at most so many, the newest last.
    #[must_use]
    pub fn last_latencies(&self, most: usize) -> Vec<LatencyParts> {
        let stages = self.stages();
        let complete: Vec<&PictureTimes> = self.pictures.iter().filter(|times| times.is_shown()).collect();
        let last = &complete[complete.len().saturating_sub(most)..];
        last.iter().map(|times| parts(self.record, times, of_picture(&stages, times.picture))).collect()
    }
}
