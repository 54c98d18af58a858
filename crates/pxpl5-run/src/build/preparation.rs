//! Preparation of a run: a dry run, and the tuning of the predictor.

use crate::dry_run::{DryRun, SeenTimes};
use crate::dry_run_observer::DryRunObserver;
use crate::error::ExperimentError;
use crate::experiment::{Experiment, Pixels};
use crate::head::Head;
use crate::kept_records::KeptRecords;
use crate::observe::observers::{ObserverFactory, StreamingObserver};
use crate::result::outcome::Outcome;
use std::sync::Arc;

/// Number of fields of a dry run if the firmware computes the display times of its views.
///
/// The dry run then needs only the mean prediction interval. If no picture is complete within these fields, a second
/// dry run takes all fields.
const INTERVAL_FIELDS: u64 = 60;

#[derive(Clone, Debug, Default)]
pub(crate) struct Preparation {
    /// Time at which each view is seen. `None` without prediction, or if the firmware computes these times itself.
    pub(crate) seen_times: Option<SeenTimes>,
    pub(crate) head: Option<Arc<Head>>,
}

impl Experiment {
    /// Performs the dry run now and stores its result in the experiment.
    ///
    /// A later run with another predictor reuses the stored result. All other settings must stay the same after this
    /// call.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Experiment::run`].
    pub fn after_dry_run(self) -> Result<Self, ExperimentError> {
        let Some(head) = self.predicting_head() else { return Ok(self) };
        let dry_run = Some(self.make_dry_run(head)?);
        Ok(Self { dry_run, ..self })
    }

    pub(crate) fn prepare(&self) -> Result<Preparation, ExperimentError> {
        let Some(head) = self.predicting_head() else { return Ok(Preparation::default()) };
        let dry_run = self.dry_run.clone().map_or_else(|| self.make_dry_run(head), Ok)?;
        let tuned = head.is_to_be_tuned().then(|| dry_run.tuned(head)).flatten();
        let seen_times = (!self.pipeline.properties().knows_when_seen).then(|| dry_run.seen_times.clone());
        Ok(Preparation { seen_times, head: tuned.map(Arc::new) })
    }

    /// Returns the head if a run needs a dry run, because the firmware does not compute display times, or because the
    /// predictor is not tuned.
    fn predicting_head(&self) -> Option<&Arc<Head>> {
        let needs = |head: &&Arc<Head>| !self.pipeline.properties().knows_when_seen || head.is_to_be_tuned();
        self.head.as_ref().filter(|head| head.predicts()).filter(needs)
    }

    fn make_dry_run(&self, head: &Head) -> Result<Arc<DryRun>, ExperimentError> {
        let dry_run = if self.pipeline.properties().knows_when_seen {
            self.short_dry_run(head)?
        } else {
            self.without_prediction(head, self.fields)?
        };
        Ok(Arc::new(dry_run))
    }

    fn without_prediction(&self, head: &Head, fields: u64) -> Result<DryRun, ExperimentError> {
        let plain = Some(Arc::new(head.without_prediction()));
        let (keep, observer): (KeptRecords, ObserverFactory) =
            (KeptRecords::Statistics, || Box::<DryRunObserver>::default());
        let plain = Self {
            head: plain,
            pixels: Pixels::Off,
            traffic: false,
            keep,
            observer: Some(observer),
            fields,
            ..self.clone()
        };
        // If the run has few pictures, the dry run before it has few pictures too.
        let outcome = match plain.perform(Preparation::default(), &[], |_, _| Ok(())) {
            Err(ExperimentError::TooShort { partial, .. }) => *partial,
            run => run?,
        };
        Ok(outcome.observed().cloned().unwrap_or_else(|| dry_run_of(&outcome)))
    }

    fn short_dry_run(&self, head: &Head) -> Result<DryRun, ExperimentError> {
        match self.without_prediction(head, self.fields.min(INTERVAL_FIELDS)) {
            Ok(dry_run) if dry_run.interval_ps.is_some() => Ok(dry_run),
            Ok(_) => self.without_prediction(head, self.fields),
            Err(error) => Err(error),
        }
    }
}

fn dry_run_of(outcome: &Outcome) -> DryRun {
    let mut sum = DryRunObserver::default();
    sum.take(&outcome.final_results());
    sum.into_dry_run()
}
