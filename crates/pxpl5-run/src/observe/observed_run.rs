//! The part of a run that has been simulated, as input for timelines and tables.

use crate::experiment::Experiment;
use crate::head_views::HeadViews;
use crate::observe::observers::FinalResults;
use crate::pipeline::{PictureTimes, Pipeline};
use crate::result::latency::{LatencyParts, parts};
use crate::result::outcome::Outcome;
use crate::result::tally::of_picture;
use crate::stepper::Stepper;
use pxpl5_machine::Record;
use pxpl5_sim::Time;
use std::borrow::Cow;
use std::sync::Arc;

/// A run as observed up to an instant: all of an [`Outcome`], or the simulated part of a [`Stepper`].
#[derive(Clone, Debug)]
pub struct ObservedRun<'a> {
    /// The experiment that runs.
    pub experiment: &'a Experiment,
    /// The machine's boards and all observations.
    pub record: &'a Record,
    /// Views of the tracked head, or `None` if no head is tracked.
    pub head: Option<&'a Arc<HeadViews>>,
    /// Pictures that were begun and evaluated, in order.
    pub pictures: Cow<'a, [PictureTimes]>,
    /// Instant at which the observations end.
    pub end: Time,
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
    /// Returns the observations in the form for evaluations. The run so far has no result window.
    pub fn results(&self) -> FinalResults<'_> {
        FinalResults { pictures: &self.pictures, ..self.experiment.final_results(self.record, self.head) }
    }

    /// Returns the pipeline that runs.
    pub fn pipeline(&self) -> &dyn Pipeline {
        self.experiment.pipeline().as_ref()
    }

    /// Returns the latency parts of the newest complete pictures, at most `most`. The newest picture is the last entry.
    pub fn last_latencies(&self, most: usize) -> Vec<LatencyParts> {
        let stages = self.record.stages();
        let complete: Vec<&PictureTimes> = self.pictures.iter().filter(|times| times.is_shown()).collect();
        let last = &complete[complete.len().saturating_sub(most)..];
        last.iter().map(|times| parts(self.record, times, of_picture(&stages, times.picture))).collect()
    }
}
