//! Runs an experiment in steps. Between two steps, the state of the machine can be read.

use crate::build::assembled::Assembled;
use crate::build::preparation::Preparation;
use crate::error::ExperimentError;
use crate::experiment::{Experiment, Pixels};
use crate::head_views::HeadViews;
use crate::ideal::ideal_picture;
use crate::level::Level;
use crate::observe::observers::FinalResults;
use crate::observe::window::Window;
use crate::pipeline::PictureTimes;
use crate::result::latency::{LatencyParts, parts_of_pictures};
use crate::result::outcome::Outcome;
use crate::result::picture_ends::WARM_UP_PICTURES;
use crate::result::result_window::WARM_UP_PERIODS;
use image::RgbImage;
use pphigs::oracle::IdealPicture;
use pxpl5_gp::{BreakpointHit, GpSnapshot};
use pxpl5_machine::{Board, DEADLOCK_TICKS, EventDescription, Machine, Record, RunError};
use pxpl5_renderer::{Lanes, RendererSnapshot};
use pxpl5_ring::ChannelSnapshot;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{PeriodNumber, SurfaceId};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Reason why a step of a run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Pause {
    /// The step ended as requested: the requested instant was reached, or the awaited event happened.
    Reached,
    /// Executed code reached one or more breakpoints. The list has one entry for each breakpoint.
    Breakpoints(Vec<BreakpointHit>),
    /// All fields of the experiment have been simulated.
    End,
    /// The machine has failed and cannot continue.
    Failed(RunError),
}

/// A running experiment that advances on request, for example by a field, a line or an event, or until a condition is
/// met.
///
/// Steps change no result: trace, pictures and report equal the results of [`Experiment::run`].
#[derive(Debug)]
pub struct Stepper {
    experiment: Experiment,
    preparation: Preparation,
    run: Assembled,
    window: Window,
    begun_s: Option<f64>,
    now: Time,
    last: Option<EventDescription>,
    breakpoints: BTreeSet<u32>,
}

impl Stepper {
    pub(crate) fn begin(experiment: &Experiment, preparation: Preparation) -> Result<Self, ExperimentError> {
        // The real time on the host includes the time for building the machine.
        let begun_s = experiment.host.seconds();
        let run = experiment.assemble(preparation.clone())?;
        let window = Window::new(experiment, run.machine.record());
        Ok(Self {
            experiment: experiment.clone(),
            preparation,
            run,
            window,
            begun_s,
            now: Time::ZERO,
            last: None,
            breakpoints: BTreeSet::new(),
        })
    }

    /// Runs up to an instant. Events at exactly this instant stay pending. If the instant is in the past, nothing
    /// happens.
    pub fn run_to(&mut self, time: Time) -> Pause {
        let target = time.min(self.end());
        // Breakpoints must be checked after every event. Without any, the machine runs in chunks.
        if !self.breakpoints.is_empty() {
            let pause = self.run_until(target, |_, _| false);
            return if pause == Pause::End && time <= self.end() { Pause::Reached } else { pause };
        }
        // Final results are added to the sums after each chunk.
        while self.now < target {
            let chunk = self.record().tick(self.period().after(PROGRESS_FIELDS)).min(target);
            if let Err(error) = self.run.machine.run_until(chunk) {
                self.now = error.time();
                return Pause::Failed(error);
            }
            self.advance_to(chunk);
        }
        self.reached(time)
    }

    /// Handles events until `is_it` returns true for a handled event, or until the instant `limit`.
    pub fn run_until(&mut self, limit: Time, mut is_it: impl FnMut(&Self, &EventDescription) -> bool) -> Pause {
        let target = limit.min(self.end());
        loop {
            // The next event is read before it is handled, because a handled event cannot be read any more.
            let next = self.run.machine.next_event_description();
            match self.run.machine.step_before(target) {
                Err(error) => {
                    self.now = error.time();
                    self.last = next;
                    return Pause::Failed(error);
                }
                Ok(None) => {
                    self.advance_to(self.now.max(target));
                    return if target < self.end() { Pause::Reached } else { Pause::End };
                }
                Ok(Some(time)) => self.now = time,
            }
            self.last = next;
            // Breakpoints take precedence over the condition.
            if !self.breakpoints.is_empty() {
                let hits = self.run.machine.take_hits();
                if !hits.is_empty() {
                    return Pause::Breakpoints(hits);
                }
            }
            if next.is_some_and(|happening| is_it(self, &happening)) {
                return Pause::Reached;
            }
        }
    }

    /// Handles one event. [`Stepper::last`] then returns a description of this event.
    pub fn step_event(&mut self) -> Pause {
        self.run_until(self.end(), |_, _| true)
    }

    /// Handles events until an event of the board `board` has been handled.
    pub fn step_board(&mut self, board: Board) -> Pause {
        self.run_until(self.end(), |_, happening| happening.board == board)
    }

    /// Runs until the beam of the first display reaches the next line. After the last line of a period, runs to the
    /// next period.
    pub fn step_line(&mut self) -> Pause {
        self.run_to(self.next_line())
    }

    /// Runs to the beginning of the next period of the first display. For NTSC, a period is one field.
    pub fn step_period(&mut self) -> Pause {
        self.run_to(self.record().tick(self.period().next()))
    }

    /// Sets the code addresses at which the run stops, and removes all earlier addresses.
    ///
    /// Only a run at [`Level::Cycle`](crate::Level::Cycle) executes code and can stop at an address.
    pub fn break_at(&mut self, addresses: BTreeSet<u32>) {
        self.run.machine.break_at(&addresses);
        self.breakpoints = addresses;
    }

    /// Ends the run early: now, if a display period has just begun, and otherwise with the current period. The outcome
    /// equals that of a run of so many fields, except that predictors were tuned for the whole run.
    pub fn end_early(&mut self) {
        let period = self.period();
        let begun = period.since(PeriodNumber::FIRST) + u64::from(self.record().tick(period) < self.now);
        self.experiment.fields = begun.clamp(1, self.experiment.fields);
    }

    /// Runs to the end and returns the outcome.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Experiment::run`].
    pub fn finish(mut self) -> Result<Outcome, ExperimentError> {
        self.break_at(BTreeSet::new());
        while self.failure().is_none() && self.now < self.end() {
            self.experiment.check_stopped()?;
            self.run_to(self.record().tick(self.period().after(PROGRESS_FIELDS)));
        }
        self.run.machine.finish_pixels();
        // The search for a deadlock simulates time after the end of the run, so its host time is not counted.
        let host_seconds = self.begun_s.zip(self.experiment.host.seconds()).map(|(begin, end)| end - begin);
        let mut error = self.failure().cloned();
        // With frames on demand, a host that waits for a further report is not in a deadlock.
        if error.is_none() && !self.experiment.on_demand && self.may_be_deadlocked() {
            error = self.deadlock();
        }
        // The outcome ends at the end of the run, or in the period in which the machine failed.
        let Self { experiment, run, window, .. } = self;
        let display = run.machine.record().display();
        let stopped = error.as_ref().map(|error| display.period_at(error.time()));
        let reached = stopped.unwrap_or(experiment.end()).min(experiment.end());
        let outcome = Outcome::new(experiment.clone(), run, window, reached, host_seconds);
        match error {
            Some(error) => Err(ExperimentError::Run { error, partial: Box::new(outcome) }),
            None if shown_in(&outcome) <= WARM_UP_PICTURES as u64 => Err(too_short(&experiment, outcome)),
            None => Ok(outcome),
        }
    }

    /// Returns the simulated instant at which the last step ended.
    pub const fn now(&self) -> Time {
        self.now
    }

    /// Returns the instant at which the run ends.
    pub fn end(&self) -> Time {
        self.record().tick(self.experiment.end())
    }

    /// Returns the current period of the first display. For NTSC, a period is a field.
    pub fn period(&self) -> PeriodNumber {
        self.record().display().period_at(self.now)
    }

    /// Returns the instant at which the beam of the first display reaches its next line. After the last line, returns
    /// the start of the next period.
    pub fn next_line(&self) -> Time {
        let display = self.record().display();
        let period = self.period();
        let lines = display.surfaces().first().map_or(0, |surface| surface.height);
        let begins = (0..lines).filter_map(|line| display.lights(0, 0, line, period));
        begins.filter(|at| *at > self.now).min().unwrap_or_else(|| display.tick(period.next()))
    }

    /// Returns the last event, if the last step ended with an event.
    pub const fn last(&self) -> Option<EventDescription> {
        self.last
    }

    /// Returns the error with which the machine failed, or `None` if the machine has not failed.
    pub const fn failure(&self) -> Option<&RunError> {
        self.run.machine.failure()
    }

    /// Returns the machine with its boards and all observations so far.
    pub const fn machine(&self) -> &Machine {
        &self.run.machine
    }

    /// Returns the views of the tracked head, or `None` if no head is tracked.
    pub const fn head(&self) -> Option<&Arc<HeadViews>> {
        self.run.head.as_ref()
    }

    /// Returns the boards and all observations so far.
    pub const fn record(&self) -> &Record {
        self.run.machine.record()
    }

    /// Returns the experiment that is running.
    pub const fn experiment(&self) -> &Experiment {
        &self.experiment
    }

    /// Returns a snapshot of the host or of a graphics processor. Returns `None` for other boards and for boards that
    /// the machine does not have.
    pub fn processor(&self, board: Board) -> Option<GpSnapshot> {
        Some(self.run.machine.board(board)?.snapshot(self.now))
    }

    /// Returns a snapshot of a renderer, or `None` if the machine does not have that renderer.
    pub fn renderer(&self, number: usize) -> Option<RendererSnapshot> {
        Some(self.record().renderers().get(number)?.snapshot(self.now))
    }

    /// Returns the pixel memory of a renderer after all commands that have started.
    ///
    /// Returns `None` unless [messages are recorded](Experiment::record_traffic) and pixels are computed.
    pub fn array(&self, renderer: usize) -> Option<Lanes> {
        self.record().renderers().get(renderer)?.array_at(self.now)
    }

    /// Returns the messages that occupy channels of the ring now.
    pub fn channels(&self) -> Vec<ChannelSnapshot> {
        self.record().ring().channel_snapshots(self.now).collect()
    }

    /// Returns the pictures that were begun and evaluated up to now, in order, complete or not.
    pub fn pictures(&self) -> Vec<PictureTimes> {
        self.experiment.pipeline().pictures(self.record(), self.now)
    }

    /// Returns the observations up to now for evaluation, with the [`pictures`](Self::pictures) so far. The run so far
    /// has no result window.
    pub fn results<'a>(&'a self, pictures: &'a [PictureTimes]) -> FinalResults<'a> {
        FinalResults { pictures, now: self.now, ..self.experiment.final_results(self.record(), self.head()) }
    }

    /// Returns the latency parts of the newest complete pictures, at most `most`. The newest picture is the last entry.
    pub fn last_latencies(&self, most: usize) -> Vec<LatencyParts> {
        let pictures = self.pictures();
        let mut last: Vec<_> = pictures.iter().rev().filter(|times| times.is_shown()).take(most).collect();
        last.reverse();
        parts_of_pictures(self.record(), last)
    }

    /// Returns the picture on the screen of a surface now. Lines above the beam are new, and lines below the beam are
    /// from the preceding scan.
    pub fn seen(&self, surface: SurfaceId) -> Option<RgbImage> {
        let mut left = surface.index();
        for display in self.record().displays() {
            let surfaces = display.surfaces().len();
            if left < surfaces {
                return display.picture_so_far(left, self.now);
            }
            left -= surfaces;
        }
        None
    }

    /// Returns the ideal picture of a surface for the current state of the scene. See [`Outcome::ideal_picture`].
    pub fn ideal_picture(&self, surface: SurfaceId) -> Option<IdealPicture> {
        ideal_picture(&self.experiment, self.record(), self.run.head.as_deref(), surface, self.now)
    }

    fn advance_to(&mut self, now: Time) {
        self.now = now;
        self.last = None;
        self.window.update(&self.experiment, &mut self.run, now);
    }

    fn reached(&self, time: Time) -> Pause {
        if let Some(failure) = self.failure() {
            return Pause::Failed(failure.clone());
        }
        if time > self.end() { Pause::End } else { Pause::Reached }
    }

    /// Returns true if a machine at the end of the run may be in a deadlock.
    ///
    /// The machine itself detects a deadlock in a long run, unless its last periods were idle. A pipeline that only
    /// waits for the next swap has the same state, so this test alone is not sufficient.
    fn may_be_deadlocked(&self) -> bool {
        let is_long = self.experiment.fields > SHORT_RUN && self.run.machine.idle_ticks() < IDLE_TICKS;
        self.run.machine.is_at_rest() && !is_long
    }

    /// Returns a deadlock error if the pipeline would never continue after the end of the run.
    ///
    /// The method repeats the run with enough additional fields to detect a deadlock.
    fn deadlock(&self) -> Option<RunError> {
        let fields = self.experiment.fields + DEADLOCK_TICKS + 2;
        let longer = Experiment { fields, pixels: Pixels::Off, ..self.experiment.clone() };
        let mut run = longer.assemble(self.preparation.clone()).ok()?;
        for field in longer.stops(&[]) {
            let until = run.machine.record().tick(field);
            if let Err(error) = run.machine.run_until(until) {
                return Some(error).filter(|error| matches!(error, RunError::Deadlock { .. }));
            }
            run.discard_before(until, until);
        }
        None
    }
}

fn too_short(experiment: &Experiment, partial: Outcome) -> ExperimentError {
    let by_form = experiment.estimates.and_then(|estimates| (estimates.fields_needed)(experiment));
    let needed = by_form.filter(|fields| *fields > experiment.fields).or_else(|| needed_by_run(&partial));
    let pictures = partial.tally().pictures as usize;
    ExperimentError::TooShort { fields: experiment.fields, pictures, needed, partial: Box::new(partial) }
}

/// Estimates the number of fields until a picture after the warm-up is shown, from the mean interval between the
/// pictures so far. For a single picture, the interval is the time until this picture was shown.
fn needed_by_run(partial: &Outcome) -> Option<u64> {
    let pictures = partial.pictures();
    if !pictures.iter().any(PictureTimes::is_shown) {
        return None;
    }
    let shown = || pictures.iter().map(|times| times.shown_at);
    let (first, last) = (shown().min()?, shown().max()?);
    // Estimate the interval between pictures.
    let each = match pictures.len() {
        1 => first.since(Time::ZERO),
        more => Span(last.since(first).0 / (more as u64 - 1)),
    };
    // Extrapolate to the first picture after the warm-up.
    let missing = (WARM_UP_PICTURES + 1).saturating_sub(pictures.len()).max(1) as u64;
    let at = last + Span(each.0.saturating_mul(missing));
    let field = partial.record().display().period_at(at).since(PeriodNumber::FIRST);
    // The warm-up also takes a number of fields. The period that follows it must be complete.
    Some((field + 1).max(partial.fields() + 1).max(WARM_UP_PERIODS + 1))
}

/// Returns the number of pictures of a run. A period that shows old pictures in a new direction of the head also
/// counts.
fn shown_in(outcome: &Outcome) -> u64 {
    outcome.tally().pictures.max(outcome.turned_periods())
}

/// Number of fields below which the machine may not detect a deadlock itself.
const SHORT_RUN: u64 = 2 * DEADLOCK_TICKS;
const IDLE_TICKS: u64 = 2;

/// Number of fields between two progress reports. At each report, a long run also discards old records.
pub(crate) const PROGRESS_FIELDS: u64 = 60;

impl Experiment {
    pub(crate) fn stops(&self, asked: &[PeriodNumber]) -> impl Iterator<Item = PeriodNumber> {
        let end = self.end();
        let mut asked: BTreeSet<PeriodNumber> = asked.iter().copied().filter(|field| *field < end).collect();
        // A field of the cycle level takes as long as dozens of other levels.
        let step = if self.level == Level::Cycle { 1 } else { PROGRESS_FIELDS };
        let mut regular = PeriodNumber(step).until(end).step_by(step as usize).chain([end]).peekable();
        std::iter::from_fn(move || {
            let next = regular.peek().into_iter().chain(asked.first()).copied().min()?;
            regular.next_if_eq(&next);
            asked.remove(&next);
            Some(next)
        })
    }
}
