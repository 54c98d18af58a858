//! The part of a run that has been simulated, as input for timelines and tables.

use crate::experiment::Experiment;
use crate::head_views::HeadViews;
use crate::observe::observers::FinalResults;
use crate::pipeline::{PictureTimes, Pipeline};
use crate::result::latency::{LatencyParts, parts};
use crate::result::outcome::Outcome;
use crate::result::tally::of_picture;
use crate::stepper::Stepper;
use pxpl5_machine::{Observation, Record, StageSpan};
use pxpl5_sim::{Span, Time};
use std::borrow::Cow;
use std::sync::Arc;

/// A run as observed up to an instant: all of an [`Outcome`], or the simulated part of a [`Stepper`].
#[derive(Clone, Debug)]
pub struct ObservedRun<'a> {
    experiment: &'a Experiment,
    record: &'a Record,
    head: Option<&'a Arc<HeadViews>>,
    pictures: Cow<'a, [PictureTimes]>,
    end: Time,
}

impl Outcome {
    /// Returns the observations of the whole run.
    pub fn observed_run(&self) -> ObservedRun<'_> {
        let pictures = Cow::Borrowed(self.pictures());
        ObservedRun {
            experiment: self.experiment(),
            record: self.record(),
            head: self.head(),
            pictures,
            end: self.end(),
        }
    }
}

impl Stepper {
    /// Returns the observations up to now, including the shown pictures in memory.
    pub fn observed_run(&self) -> ObservedRun<'_> {
        let pictures = self.experiment().pipeline().pictures(self.record(), self.now());
        ObservedRun {
            experiment: self.experiment(),
            record: self.record(),
            head: self.head(),
            pictures: Cow::Owned(pictures),
            end: self.now(),
        }
    }
}

impl ObservedRun<'_> {
    /// Returns the machine's boards and all observations.
    pub const fn record(&self) -> &Record {
        self.record
    }

    /// Returns the time stamps of stages, the arrivals at displays and the swaps, each in order of time.
    pub const fn observation(&self) -> &Observation {
        self.record.observation()
    }

    /// Returns the pictures that were begun and evaluated, in order.
    pub fn pictures(&self) -> &[PictureTimes] {
        &self.pictures
    }

    /// Returns the observations in the form for evaluations. The run so far has no result window.
    pub fn results(&self) -> FinalResults<'_> {
        FinalResults { pictures: &self.pictures, ..self.experiment.final_results(self.record, self.head) }
    }

    /// Returns the pipeline that runs.
    pub fn pipeline(&self) -> &dyn Pipeline {
        self.experiment.pipeline().as_ref()
    }

    /// Returns the start and end of every stage of every picture so far. The times of COPY are measured at the
    /// displays.
    pub fn stages(&self) -> Vec<StageSpan> {
        self.record.stages()
    }

    /// Returns the number of periods of the first display that the whole run takes.
    pub const fn fields(&self) -> u64 {
        self.experiment.fields
    }

    /// Returns the instant at which the observations end.
    pub const fn end(&self) -> Time {
        self.end
    }

    /// Returns the time that a graphics processor needs to receive one message.
    pub const fn receive_span(&self) -> Span {
        Span::from_ns(self.experiment.config().gp.message_ns)
    }

    /// Returns the latency parts of the newest complete pictures, at most `most`. The newest picture is the last entry.
    pub fn last_latencies(&self, most: usize) -> Vec<LatencyParts> {
        let stages = self.stages();
        let complete: Vec<&PictureTimes> = self.pictures.iter().filter(|times| times.is_shown()).collect();
        let last = &complete[complete.len().saturating_sub(most)..];
        last.iter().map(|times| parts(self.record, times, of_picture(&stages, times.picture))).collect()
    }
}
