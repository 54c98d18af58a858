//! What is known before a run: when views are seen, and the numbers of a predictor that is tuned for it.

use crate::error::ExperimentError;
use crate::experiment::{Experiment, Pixels};
use crate::head::Head;
use crate::latched_head::LatchedHead;
use crate::outcome::Outcome;
use crate::rehearsal::{Rehearsal, Rehearsed};
use crate::statistics::Statistics;
use pxpl5_display::{Aim, LightSpan};
use pxpl5_sim::Time;
use pxpl5_wire::{FieldParity, PeriodNumber, ViewNumber};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Fields of the run that tells how far ahead firmware predicts that knows itself when its views are seen. As many as its
/// statistics need; of all fields where no picture is complete in so few.
const INTERVAL_FIELDS: u64 = 60;

/// Least step of an interval for which a predictor is tuned, picoseconds: a millisecond. A finer one changes no number of a filter
/// by a per cent.
const INTERVAL_STEP_PS: u64 = 1_000_000_000;

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
        let knows_when_seen = self.pipeline.knows_when_seen();
        let outcome =
            if knows_when_seen { self.short_rehearsal(head)? } else { self.without_prediction(head, self.fields)? };
        Ok(Arc::new(Rehearsed {
            rehearsal: rehearsed(&outcome, head.aim()),
            interval_ps: interval_ps(&outcome, head.aim()),
            turn_interval_ps: turn_interval_ps(&outcome),
        }))
    }

    fn without_prediction(&self, head: &Head, fields: u64) -> Result<Outcome, ExperimentError> {
        let plain = Some(Arc::new(head.without_prediction()));
        let plain = Self { head: plain, pixels: Pixels::Off, fields, ..self.clone() };
        plain.perform(Preparation::default(), &[], |_, _| Ok(()))
    }

    fn short_rehearsal(&self, head: &Head) -> Result<Outcome, ExperimentError> {
        match self.without_prediction(head, self.fields.min(INTERVAL_FIELDS)) {
            Ok(outcome) if interval_ps(&outcome, head.aim()).is_some() => Ok(outcome),
            Ok(_) | Err(ExperimentError::TooShort { .. }) => self.without_prediction(head, self.fields),
            Err(error) => Err(error),
        }
    }
}

/// Mean time from the instant at which an orientation was true to the one that it is latched for, over the middle pixel of all fields,
/// to the nearest millisecond; `None` where the display latches none, and before the first report.
fn turn_interval_ps(outcome: &Outcome) -> Option<u64> {
    let latched = LatchedHead::of(outcome)?;
    let head = outcome.head()?;
    let surface = outcome.record().display().surfaces().first()?;
    let of_field = |field: PeriodNumber| {
        let y = surface.height / 2 + FieldParity::of_field(field).first_line();
        let (known, aimed) = latched.turned_by(head, surface.width / 2, y, field)?;
        let measured = head.measured_at(head.report_by(known)?)?;
        Some(aimed.since(measured).as_ms())
    };
    rounded(PeriodNumber::FIRST.until(PeriodNumber(outcome.fields())).filter_map(of_field))
}

/// Mean time from the instant at which the newest report of a view was true to the one that the view is drawn for, to the nearest
/// millisecond; `None` where no picture was complete whose view had a report.
fn interval_ps(outcome: &Outcome, aim: Aim) -> Option<u64> {
    let head = outcome.head()?;
    let measured: BTreeMap<ViewNumber, Time> =
        head.sampled().into_iter().filter_map(|sampled| Some((sampled.number, sampled.measured_at?))).collect();
    let complete: BTreeSet<ViewNumber> = outcome.complete_pictures().map(|times| times.view).collect();
    let shown = shown(outcome).into_iter().filter(|(view, _)| complete.contains(view));
    let each = shown.filter_map(|(view, shown)| Some(aim.instant(&shown).since(*measured.get(&view)?).as_ms()));
    rounded(each)
}

/// The mean of intervals, ms, in whole steps; `None` of none.
fn rounded(intervals: impl Iterator<Item = f64>) -> Option<u64> {
    let mean_ms = Statistics::of(intervals).mean;
    let steps = (mean_ms * 1e9 / INTERVAL_STEP_PS as f64).round();
    mean_ms.is_finite().then_some(steps as u64 * INTERVAL_STEP_PS)
}

/// What an aim makes of a run without prediction.
fn rehearsed(outcome: &Outcome, aim: Aim) -> Rehearsal {
    let Some(head) = outcome.head() else { return Rehearsal::default() };
    let aimed_at: BTreeMap<ViewNumber, Time> =
        shown(outcome).into_iter().map(|(view, shown)| (view, aim.instant(&shown))).collect();
    let leads = head.sampled().into_iter().filter_map(|s| Some(aimed_at.get(&s.number)?.since(s.known).as_ms()));
    let mean_lead_ps = (Statistics::of(leads).mean * 1e9) as u64;
    Rehearsal::new(aimed_at, mean_lead_ps)
}

/// When each view is shown, in as many pictures as are of it.
fn shown(outcome: &Outcome) -> BTreeMap<ViewNumber, LightSpan> {
    let mut all: BTreeMap<ViewNumber, LightSpan> = BTreeMap::new();
    let pictures = outcome.pictures();
    for (i, times) in pictures.iter().enumerate() {
        let shown = outcome.pipeline().shown(outcome.record(), times, pictures.get(i + 1));
        all.entry(times.view).and_modify(|known| known.last = known.last.max(shown.last)).or_insert(shown);
    }
    all
}
