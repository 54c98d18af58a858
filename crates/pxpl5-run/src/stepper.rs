//! A run in pieces: the machine at work, to be looked at whenever it stands.

use crate::assembled::Assembled;
use crate::error::ExperimentError;
use crate::experiment::{Experiment, Pixels};
use crate::ideal::ideal_picture;
use crate::outcome::Outcome;
use crate::picture_ends::WARM_UP_PICTURES;
use crate::pipeline::PictureTimes;
use crate::preparation::Preparation;
use crate::stops::PROGRESS_FIELDS;
use crate::window::Window;
use image::RgbImage;
use pxpl5_gp::{BreakpointHit, GpLook};
use pxpl5_machine::{Board, DEADLOCK_TICKS, Happening, Machine, Record, RunError};
use pxpl5_oracle::IdealPicture;
use pxpl5_renderer::{Lanes, RendererLook};
use pxpl5_ring::OnChannel;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{PeriodNumber, SurfaceId};
use std::collections::BTreeSet;

/// Why a piece of a run is over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Pause {
    /// The instant has come, or what was waited for has happened.
    Reached,
    /// Code has met breakpoints: what was found there.
    Breakpoints(Vec<BreakpointHit>),
    /// All fields of the experiment have been simulated.
    End,
    /// The machine cannot go on.
    Failed(RunError),
}

/// A running experiment that goes on when it is told to: to an instant, by a field, a line or an event, to an event of a board, to a
/// condition. [`Experiment::run`] is a stepper that goes to the end.
///
/// How it is divided and how often somebody looks changes nothing of the run: the same trace, pictures and report come of it.
#[derive(Debug)]
pub struct Stepper {
    experiment: Experiment,
    preparation: Preparation,
    run: Assembled,
    window: Window,
    begun_s: Option<f64>,
    now: Time,
    last: Option<Happening>,
    breakpoints: BTreeSet<u32>,
}

impl Stepper {
    pub(crate) fn begin(experiment: &Experiment, preparation: Preparation) -> Result<Self, ExperimentError> {
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

    /// Runs up to, and not including, an instant; one that has passed is reached at once.
    pub fn run_to(&mut self, time: Time) -> Pause {
        let target = time.min(self.end());
        if !self.breakpoints.is_empty() {
            let pause = self.run_until(target, |_, _| false);
            return if pause == Pause::End && time <= self.end() { Pause::Reached } else { pause };
        }
        while self.now < target {
            let chunk = self.record().tick(self.period().after(PROGRESS_FIELDS)).min(target);
            if let Err(error) = self.run.machine.run_until(chunk) {
                self.now = error.time();
                return Pause::Failed(error);
            }
            self.stand_at(chunk);
        }
        self.reached(time)
    }

    /// Takes events one after the other until one has happened of which `is_it` says so, and not beyond `limit`.
    pub fn run_until(&mut self, limit: Time, mut is_it: impl FnMut(&Self, &Happening) -> bool) -> Pause {
        let target = limit.min(self.end());
        loop {
            let next = self.run.machine.next_happening();
            match self.run.machine.step_before(target) {
                Err(error) => {
                    self.now = error.time();
                    self.last = next;
                    return Pause::Failed(error);
                }
                Ok(None) => {
                    self.stand_at(self.now.max(target));
                    return if target < self.end() { Pause::Reached } else { Pause::End };
                }
                Ok(Some(time)) => self.now = time,
            }
            self.last = next;
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

    /// Takes one event: see [`Stepper::last`].
    pub fn step_event(&mut self) -> Pause {
        self.run_until(self.end(), |_, _| true)
    }

    /// Takes events until one of a board has happened.
    pub fn step_board(&mut self, board: Board) -> Pause {
        self.run_until(self.end(), |_, happening| happening.board == board)
    }

    /// Runs until the next line of the first display's first surface begins to light, or the next period where none is left.
    pub fn step_line(&mut self) -> Pause {
        self.run_to(self.next_line())
    }

    /// Runs to the next tick of the first display: the begin of a field.
    pub fn step_period(&mut self) -> Pause {
        self.run_to(self.record().tick(self.period().next()))
    }

    /// Has code that comes to some addresses stop the run, instead of the addresses given before; only where the time of work comes from
    /// code ([`Level::Cycle`](crate::Level::Cycle)) does any.
    pub fn break_at(&mut self, addresses: BTreeSet<u32>) {
        self.run.machine.break_at(&addresses);
        self.breakpoints = addresses;
    }

    /// Runs what is left, and gives what came of all.
    ///
    /// # Errors
    ///
    /// As [`Experiment::run`].
    pub fn finish(mut self) -> Result<Outcome, ExperimentError> {
        self.break_at(BTreeSet::new());
        while self.failure().is_none() && self.now < self.end() {
            self.experiment.go_on()?;
            self.run_to(self.record().tick(self.period().after(PROGRESS_FIELDS)));
        }
        self.run.machine.finish_pixels();
        // What a look for a deadlock takes, behind the end of the run, is no time of it.
        let host_seconds = self.begun_s.zip(self.experiment.host.seconds()).map(|(begin, end)| end - begin);
        let mut error = self.failure().cloned();
        // Where frames are begun on demand, a host without a further report is at rest for good reason.
        if error.is_none() && !self.experiment.on_demand && self.may_be_stuck() {
            error = self.deadlock();
        }
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

    /// The simulated instant: where the last piece of the run ended.
    #[must_use]
    pub const fn now(&self) -> Time {
        self.now
    }

    /// The instant at which the run ends.
    #[must_use]
    pub fn end(&self) -> Time {
        self.record().tick(self.experiment.end())
    }

    /// The period of the first display that goes on: its field.
    #[must_use]
    pub fn period(&self) -> PeriodNumber {
        self.record().display().period_at(self.now)
    }

    /// When the next line of the first surface begins to light, or the next period begins where none is left.
    #[must_use]
    pub fn next_line(&self) -> Time {
        let display = self.record().display();
        let period = self.period();
        let lines = display.surfaces().first().map_or(0, |surface| surface.height);
        let begins = (0..lines).filter_map(|line| display.lights(0, 0, line, period));
        begins.filter(|at| *at > self.now).min().unwrap_or_else(|| display.tick(period.next()))
    }

    /// What happened last, where the last piece of the run ended with an event.
    #[must_use]
    pub const fn last(&self) -> Option<Happening> {
        self.last
    }

    /// Why the machine goes on no more, if it does not.
    #[must_use]
    pub const fn failure(&self) -> Option<&RunError> {
        self.run.machine.failure()
    }

    /// The machine with its boards and all that was observed so far.
    #[must_use]
    pub const fn machine(&self) -> &Machine {
        &self.run.machine
    }

    pub(crate) const fn machine_mut(&mut self) -> &mut Machine {
        &mut self.run.machine
    }

    /// What was observed so far; its hash is that of the trace up to now.
    #[must_use]
    pub const fn record(&self) -> &Record {
        self.run.machine.record()
    }

    /// The experiment that is run.
    #[must_use]
    pub const fn experiment(&self) -> &Experiment {
        &self.experiment
    }

    /// What the host or a graphics processor does; `None` for other boards, and those that the machine does not have.
    #[must_use]
    pub fn processor(&self, board: Board) -> Option<GpLook> {
        Some(self.run.machine.board(board)?.look(self.now))
    }

    /// What a renderer does.
    #[must_use]
    pub fn renderer(&self, number: usize) -> Option<RendererLook> {
        Some(self.record().renderers().get(number)?.look(self.now))
    }

    /// The pixel array of a renderer, as far as its commands have started; `None` without
    /// [recorded traffic](Experiment::record_traffic), and where no pixels are wanted.
    #[must_use]
    pub fn array(&self, renderer: usize) -> Option<Lanes> {
        self.record().renderers().get(renderer)?.array_at(self.now)
    }

    /// The messages that are on channels of the ring.
    #[must_use]
    pub fn channels(&self) -> Vec<OnChannel> {
        self.record().ring().on_channels(self.now).collect()
    }

    /// What stands before a viewer of a surface: what the beam has drawn so far, and before it what still stands.
    #[must_use]
    pub fn seen(&self, surface: SurfaceId) -> Option<RgbImage> {
        let mut left = surface.index();
        for display in self.record().displays() {
            let surfaces = display.surfaces().len();
            if left < surfaces {
                return display.seen_so_far(left, self.now);
            }
            left -= surfaces;
        }
        None
    }

    /// What a viewer of a surface should see of the scene as it is now: see [`Outcome::ideal_picture`].
    #[must_use]
    pub fn ideal_picture(&self, surface: SurfaceId) -> Option<IdealPicture> {
        ideal_picture(&self.experiment, self.record(), self.run.head.as_deref(), surface, self.now)
    }

    /// The run has come to an instant: what nobody will change any more is summed up.
    fn stand_at(&mut self, now: Time) {
        self.now = now;
        self.last = None;
        self.window.look(&self.experiment, &mut self.run, now);
    }

    fn reached(&self, time: Time) -> Pause {
        if let Some(failure) = self.failure() {
            return Pause::Failed(failure.clone());
        }
        if time > self.end() { Pause::End } else { Pause::Reached }
    }

    /// Whether a machine at the end of the run may never go on. A pipeline that waits for a swap is at rest until the next tick; only
    /// a run that was over soon could have come to rest for ever in the last periods before its end, and not before.
    fn may_be_stuck(&self) -> bool {
        let is_long = self.experiment.fields > SHORT_RUN && self.run.machine.idle_ticks() < IDLE_TICKS;
        self.run.machine.is_at_rest() && !is_long
    }

    /// Whether a machine that is at rest at the end of the run, which may be too short to tell, would be so for ever: the run
    /// is repeated for as long as that takes, so that the record of this one ends where it was asked to.
    fn deadlock(&self) -> Option<RunError> {
        let fields = self.experiment.fields + DEADLOCK_TICKS + 2;
        let longer = Experiment { fields, pixels: Pixels::Off, ..self.experiment.clone() };
        let mut run = longer.assemble(self.preparation.clone()).ok()?;
        for field in longer.stops(&[]) {
            let until = run.machine.record().tick(field);
            if let Err(error) = run.machine.run_until(until) {
                return Some(error).filter(|error| matches!(error, RunError::Deadlock { .. }));
            }
            run.forget_before(until, until);
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

/// About how many fields it takes until a picture behind the warm-up is shown, if pictures go on coming as they came: by the time
/// from the first to the last of them, or of one alone by the time that it took.
fn needed_by_run(partial: &Outcome) -> Option<u64> {
    let pictures = partial.pictures();
    if !pictures.iter().any(PictureTimes::is_shown) {
        return None;
    }
    let shown = || pictures.iter().map(|times| times.shown_at);
    let (first, last) = (shown().min()?, shown().max()?);
    let each = match pictures.len() {
        1 => first.since(Time::ZERO),
        more => Span(last.since(first).0 / (more as u64 - 1)),
    };
    let missing = (WARM_UP_PICTURES + 1).saturating_sub(pictures.len()).max(1) as u64;
    let at = last + Span(each.0.saturating_mul(missing));
    let field = partial.record().display().period_at(at).since(PeriodNumber::FIRST);
    Some((field + 1).max(partial.fields() + 1))
}

/// Pictures of a run, those included for which nothing had to be drawn.
fn shown_in(outcome: &Outcome) -> u64 {
    outcome.tally().pictures.max(outcome.pipeline().turned_periods(outcome.record(), outcome.end()))
}

/// Fields of a run that may be over before a deadlock has been noticed, and ticks without work from which on a longer one may be in one
/// that it was too short to notice.
const SHORT_RUN: u64 = 2 * DEADLOCK_TICKS;
const IDLE_TICKS: u64 = 2;
