//! What is known before a run: when views are seen, and the numbers of a predictor that is tuned for it.

use crate::error::ExperimentError;
use crate::experiment::{Experiment, Pixels};
use crate::head::Head;
use crate::keep::Keep;
use crate::outcome::Outcome;
use crate::rehearsal::{Rehearsal, Rehearsed};
use crate::rehearsal_sum::RehearsalSum;
use crate::sums::{Summing, Sums};
use std::sync::Arc;

/// Fields of the run that tells how far ahead firmware predicts that knows itself when its views are seen. As many as its
/// statistics need; of all fields where no picture is complete in so few.
const INTERVAL_FIELDS: u64 = 60;

/// What a run is begun with.
#[derive(Clone, Debug, Default)]
pub(crate) struct Preparation {
    /// When each view is seen; `None` where nobody predicts, or the firmware knows.
    pub(crate) rehearsal: Option<Rehearsal>,
    /// The head with its predictor tuned; `None` where there is nothing to tune.
    pub(crate) head: Option<Arc<Head>>,
}

impl Experiment {
    /// With what a run without prediction tells, as far as its predictor needs it: what is run with another predictor afterwards
    /// need not run without one again. Nothing else may be changed after this.
    ///
    /// # Errors
    ///
    /// As [`Experiment::run`].
    pub fn rehearsed(self) -> Result<Self, ExperimentError> {
        let Some(head) = self.rehearsing_head() else { return Ok(self) };
        let rehearsed = Some(self.rehearse(head)?);
        Ok(Self { rehearsed, ..self })
    }

    /// What it was given by [`Experiment::rehearsed`].
    #[must_use]
    pub const fn rehearsal(&self) -> Option<&Arc<Rehearsed>> {
        self.rehearsed.as_ref()
    }

    /// With what the same experiment with another predictor was given by [`Experiment::rehearsed`].
    #[must_use]
    pub fn rehearsed_as(self, rehearsed: Option<Arc<Rehearsed>>) -> Self {
        Self { rehearsed, ..self }
    }

    /// Runs without prediction, as far as somebody predicts who does not know what that run tells.
    pub(crate) fn prepare(&self) -> Result<Preparation, ExperimentError> {
        let Some(head) = self.rehearsing_head() else { return Ok(Preparation::default()) };
        let known = self.rehearsed.clone().map_or_else(|| self.rehearse(head), Ok)?;
        let tuned = head.is_to_be_tuned().then(|| known.tuned(head)).flatten();
        let rehearsal = (!self.pipeline.knows_when_seen()).then(|| known.rehearsal.clone());
        Ok(Preparation { rehearsal, head: tuned.map(Arc::new) })
    }

    /// The head, where somebody predicts who does not know what a run without prediction tells.
    fn rehearsing_head(&self) -> Option<&Arc<Head>> {
        let needs = |head: &&Arc<Head>| !self.pipeline.knows_when_seen() || head.is_to_be_tuned();
        self.head.as_ref().filter(|head| head.predicts()).filter(needs)
    }

    fn rehearse(&self, head: &Head) -> Result<Arc<Rehearsed>, ExperimentError> {
        let rehearsed = if self.pipeline.knows_when_seen() {
            self.short_rehearsal(head)?
        } else {
            self.without_prediction(head, self.fields)?
        };
        Ok(Arc::new(rehearsed))
    }

    /// Sums up while it runs: however long that is, it keeps two or three bytes a view.
    fn without_prediction(&self, head: &Head, fields: u64) -> Result<Rehearsed, ExperimentError> {
        let plain = Some(Arc::new(head.without_prediction()));
        let (keep, sums): (Keep, Sums) = (Keep::Statistics, || Box::<RehearsalSum>::default());
        let plain =
            Self { head: plain, pixels: Pixels::Off, traffic: false, keep, sums: Some(sums), fields, ..self.clone() };
        // A run of few pictures is rehearsed by as few.
        let outcome = match plain.perform(Preparation::default(), &[], |_, _| Ok(())) {
            Err(ExperimentError::TooShort { partial, .. }) => *partial,
            run => run?,
        };
        Ok(outcome.said().cloned().unwrap_or_else(|| rehearsed(&outcome)))
    }

    fn short_rehearsal(&self, head: &Head) -> Result<Rehearsed, ExperimentError> {
        match self.without_prediction(head, self.fields.min(INTERVAL_FIELDS)) {
            Ok(rehearsed) if rehearsed.interval_ps.is_some() => Ok(rehearsed),
            Ok(_) => self.without_prediction(head, self.fields),
            Err(error) => Err(error),
        }
    }
}

/// What a run tells that kept everything.
fn rehearsed(outcome: &Outcome) -> Rehearsed {
    let mut sum = RehearsalSum::default();
    sum.take(&outcome.settled());
    sum.rehearsed()
}
