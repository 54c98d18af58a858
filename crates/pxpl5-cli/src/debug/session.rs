//! A debugger session, which applies commands to a run and returns their output.

use super::command::{Command, HELP, Pane, StepOf, parse};
use super::condition::{Before, Condition};
use super::pixels;
use super::views;
use i860::disassemble;
use pxpl5::run::{in_ms as ms, in_us as us};
use pxpl5::snapshots::BreakpointHit;
use pxpl5::{Board, Pause, Span, Stepper, Time};
use std::collections::BTreeSet;
use std::fmt::Write as _;

pub(super) struct Session {
    stepper: Stepper,
    breakpoints: BTreeSet<u32>,
    /// Processors that hit a breakpoint at the most recent stop, with the addresses of the breakpoints.
    hits: Vec<BreakpointHit>,
    is_over: bool,
    is_interrupted: fn() -> bool,
}

/// Number of events between two checks for an interrupt by the user.
const EVENTS_BETWEEN: u64 = 10_000;

impl Session {
    pub(super) const fn new(stepper: Stepper) -> Self {
        Self { stepper, breakpoints: BTreeSet::new(), hits: Vec::new(), is_over: false, is_interrupted: || false }
    }

    /// Returns the session with an interrupt callback. The run stops when `is_interrupted` returns true. The session
    /// calls this function once per display field and every 10,000 events.
    #[cfg(feature = "screen")]
    pub(super) fn interrupted_by(self, is_interrupted: fn() -> bool) -> Self {
        Self { is_interrupted, ..self }
    }

    pub(super) const fn is_over(&self) -> bool {
        self.is_over
    }

    /// Executes a command line and returns its output as lines. An error states the expected syntax and the text found,
    /// and leaves the session unchanged.
    pub(super) fn execute_line(&mut self, line: &str) -> Result<String, String> {
        // Only `run`, `next` and `step` change the machine.
        match parse(line, self.stepper.now())? {
            Command::Nothing => Ok(String::new()),
            Command::RunToEnd => {
                // One picosecond beyond the last instant, so that the run also executes the events at its end.
                let behind = self.stepper.end() + Span(1);
                self.run_to(behind)
            }
            Command::RunTo(time) => self.run_to(time),
            Command::RunToField(field) => self.run_to(self.stepper.record().tick(field)),
            Command::RunUntil(condition) => self.run_until(&condition),
            Command::Next(board) => self.next(board),
            Command::Step(count, of) => Ok(self.step(count, of)),
            Command::Show(pane) => Ok(self.pane(pane)),
            Command::ShowBoard(board) => views::board(&self.stepper, board),
            Command::Break(place) => self.break_at(place.as_deref()),
            Command::Delete(place) => self.delete(&place),
            Command::Registers(board) => self.registers(board),
            Command::Disassemble(board, place, count) => self.disassemble(board, place.as_deref(), count),
            Command::Memory(board, place, words) => self.memory(board, &place, words),
            Command::Pixel(renderer, x, y) => pixels::pixel(&self.stepper, renderer, x, y),
            Command::Enabled(renderer) => pixels::enabled(&self.stepper, renderer),
            Command::Seen(surface, file) => pixels::seen(&self.stepper, &surface, file.as_deref()),
            Command::Ideal(surface, file) => pixels::ideal(&self.stepper, &surface, file.as_deref()),
            Command::Help => Ok(help()),
            Command::Quit => {
                self.is_over = true;
                Ok(String::new())
            }
        }
    }

    pub(super) fn pane(&self, pane: Pane) -> String {
        match pane {
            Pane::Time => views::time(&self.stepper),
            Pane::Boards => views::boards(&self.stepper),
            Pane::Waits => views::waits(&self.stepper),
            Pane::Ring => views::ring(&self.stepper),
            Pane::Timeline => views::timeline(&self.stepper),
        }
    }

    fn run_to(&mut self, time: Time) -> Result<String, String> {
        let now = self.stepper.now();
        // A run cannot go back in time.
        if time < now {
            return Err(format!("expected an instant not before now, {}, found {}", ms(now), ms(time)));
        }
        let is_interrupted = self.is_interrupted;
        // Run field by field, so that the user can interrupt a long run.
        Ok(self.go(|stepper| {
            loop {
                let next = stepper.record().tick(stepper.period().next());
                let pause = stepper.run_to(time.min(next));
                if pause != Pause::Reached || next >= time || is_interrupted() {
                    return pause;
                }
            }
        }))
    }

    fn run_until(&mut self, condition: &Condition) -> Result<String, String> {
        condition.check(&self.stepper)?;
        let before = Before::of(&self.stepper);
        let is_interrupted = self.is_interrupted;
        Ok(self.go(|stepper| {
            stepper.run_until(stepper.end(), |stepper, _| {
                let asks = stepper.machine().events().is_multiple_of(EVENTS_BETWEEN);
                condition.holds(stepper, before) || asks && is_interrupted()
            })
        }))
    }

    fn next(&mut self, board: Board) -> Result<String, String> {
        views::check(&self.stepper, board)?;
        Ok(self.go(|stepper| stepper.step_board(board)))
    }

    fn step(&mut self, count: u64, of: StepOf) -> String {
        self.go(|stepper| {
            let mut pause = Pause::Reached;
            for _ in 0..count {
                pause = match of {
                    StepOf::Event => stepper.step_event(),
                    StepOf::Line => stepper.step_line(),
                    StepOf::Field => stepper.step_period(),
                };
                // A breakpoint or the end stops the remaining steps.
                if pause != Pause::Reached {
                    break;
                }
            }
            pause
        })
    }

    /// Resumes the run with `piece`, which simulates up to the next stop. Returns the reason for this stop and its
    /// simulated time as text.
    fn go(&mut self, piece: impl FnOnce(&mut Stepper) -> Pause) -> String {
        let mut text = match piece(&mut self.stepper) {
            Pause::Reached => String::new(),
            Pause::End => "the run is over: all fields have been simulated\n".to_owned(),
            Pause::Failed(error) => format!("the machine cannot go on: {error}\n"),
            Pause::Breakpoints(hits) => {
                self.hits = hits;
                self.met()
            }
        };
        text.push_str(&views::place(&self.stepper));
        text
    }

    fn met(&self) -> String {
        let mut text = String::new();
        for hit in &self.hits {
            let board = self.stepper.record().ports().board(hit.gp);
            let _ = writeln!(text, "breakpoint: {board} at {:#010x}, {} into the call", hit.address, us(hit.into_call));
        }
        text
    }

    fn break_at(&mut self, place: Option<&str>) -> Result<String, String> {
        let Some(place) = place else { return Ok(self.list()) };
        let at = views::place_in_code(&self.stepper, None, place)?;
        self.breakpoints.insert(at);
        self.stepper.break_at(self.breakpoints.clone());
        Ok(self.list())
    }

    fn delete(&mut self, place: &str) -> Result<String, String> {
        let at = views::place_in_code(&self.stepper, None, place)?;
        if !self.breakpoints.remove(&at) {
            return Err(format!("expected one of the breakpoints ({}), found {at:#010x}", self.list().trim()));
        }
        self.stepper.break_at(self.breakpoints.clone());
        Ok(self.list())
    }

    fn list(&self) -> String {
        if self.breakpoints.is_empty() {
            return "no breakpoints\n".to_owned();
        }
        self.breakpoints.iter().map(|at| format!("{at:#010x}\n")).collect()
    }

    fn registers(&self, board: Board) -> Result<String, String> {
        let processor = views::with_code(&self.stepper, board)?;
        // A processor at a breakpoint has the registers of that instant. Other processors show the end of their last
        // call.
        let hit = self.hits.iter().rev().find(|hit| self.stepper.record().ports().board(hit.gp) == board);
        let of_call = processor.with_processor(|processor| processor.state().clone());
        let state = hit.map(|hit| (*hit.state).clone()).or(of_call).ok_or("no processor")?;
        let origin_of_registers = if hit.is_some() { "at the breakpoint" } else { "after the last call" };
        let mut text = format!("{board}, {origin_of_registers}: pc {:#010x}, psr {:#010x}\n", state.pc, state.psr);
        for (name, registers) in [("r", &state.r), ("f", &state.f)] {
            for (row, four) in registers.chunks(8).enumerate() {
                let words: Vec<String> = four.iter().map(|word| format!("{word:08x}")).collect();
                let _ = writeln!(text, "{:>4} {}", format!("{name}{}", 8 * row), words.join(" "));
            }
        }
        Ok(text)
    }

    fn disassemble(&self, board: Board, place: Option<&str>, count: u64) -> Result<String, String> {
        let processor = views::with_code(&self.stepper, board)?;
        let hit = self.hits.iter().rev().find(|hit| self.stepper.record().ports().board(hit.gp) == board);
        // The listing starts at the given place, at the breakpoint, or at the base of the code.
        let begin = match (place, hit) {
            (Some(place), _) => views::place_in_code(&self.stepper, Some(board), place)?,
            (None, Some(hit)) => hit.address,
            (None, None) => views::base_of_code(&self.stepper, board)?,
        };
        let words = views::words(processor, begin, count)?;
        let mut text = String::new();
        for (at, word) in (begin..).step_by(4).zip(words) {
            views::labels(processor, at).iter().for_each(|label| {
                let _ = writeln!(text, "{label}:");
            });
            let mark = if self.breakpoints.contains(&at) { '*' } else { ' ' };
            let _ = writeln!(text, "{mark} {at:#010x}  {word:08x}  {}", disassemble(word, at));
        }
        Ok(text)
    }

    fn memory(&self, board: Board, place: &str, count: u64) -> Result<String, String> {
        let processor = views::with_code(&self.stepper, board)?;
        let begin = views::place_in_code(&self.stepper, Some(board), place)?;
        let words = views::words(processor, begin, count)?;
        let mut text = String::new();
        for (row, four) in words.chunks(4).enumerate() {
            let row_words: Vec<String> = four.iter().map(|word| format!("{word:08x}")).collect();
            let _ = writeln!(text, "{:#010x}  {}", begin + 16 * row as u32, row_words.join(" "));
        }
        Ok(text)
    }
}

fn help() -> String {
    let widest = HELP.iter().map(|(form, _)| form.len()).max().unwrap_or_default();
    HELP.iter().map(|(form, what)| format!("{form:widest$}  {what}\n")).collect()
}
