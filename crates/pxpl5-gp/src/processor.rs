//! The board's i860 with its memory, where programs run and clocks are counted.

use crate::window;
use i860::{Bus, Cpu, Program, Ram, RunEnd, Shelf, State, Trap, Unmapped};
use pxpl5_sim::Span;
use pxpl5_wire::{NodeId, Word};
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fmt;
use std::ops::Range;
use std::rc::Rc;
use std::sync::Arc;

/// Which code a board runs, where the time of its work comes from code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CodeVersion {
    /// As a compiler without optimisation would give it, nearly twice as large as the instruction cache.
    Unoptimised,
    /// As a good compiler of about 1990 would give it: the Slats of 1994 and 1995, whose code did not fit the instruction cache (I3D95).
    Compiled,
    /// Scheduled by hand in dual-instruction mode, in cache: optimised PPHIGS (TR94), and what Slats would have been with
    /// code that fits, faster by a factor of about 3 (I3D95).
    Scheduled,
}

impl CodeVersion {
    /// As experiment files name it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unoptimised => "unoptimised",
            Self::Compiled => "compiled",
            Self::Scheduled => "scheduled",
        }
    }
}

/// Why a program on the processor did not come to its end.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ProcessorFault {
    /// It took a trap.
    #[error("graphics processor at node {}: {trap}", gp.0)]
    Trap {
        /// The port of the board.
        gp: NodeId,
        /// What, and at which address.
        trap: Trap,
    },
    /// It did not return within its budget.
    #[error("graphics processor at node {}: no return within {budget} instructions, at {address:#010x}", gp.0)]
    Endless {
        /// The port of the board.
        gp: NodeId,
        /// Where it was when they were used up.
        address: u32,
        /// Instructions that it was given.
        budget: u64,
    },
    /// Data that its memory does not hold were asked for.
    #[error("graphics processor at node {}: no memory for {words} words at {address:#010x}", gp.0)]
    Unmapped {
        /// The port of the board.
        gp: NodeId,
        /// Address of the first word.
        address: u32,
        /// How many words were asked for.
        words: usize,
    },
    /// Two bin contexts would meet in memory.
    #[error("graphics processor at node {}: output of bin context {context} needs {needed_bytes} bytes, {available_bytes} are available", gp.0)]
    NoRoom {
        /// The port of the board.
        gp: NodeId,
        /// The bin context that asked for a place.
        context: u8,
        /// Bytes that it needs.
        needed_bytes: u32,
        /// Bytes between the data before it and the other context, or the end of memory.
        available_bytes: u32,
    },
    /// A program without the label at which it is called.
    #[error("graphics processor at node {}: the program has no label `{label}`", gp.0)]
    NoEntry {
        /// The port of the board.
        gp: NodeId,
        /// The label that it lacks.
        label: String,
    },
}

/// Where a called program returns to; nothing is there.
const RETURN: u32 = 0x0800;

/// The addresses that a program takes.
fn extent(program: &Program) -> Range<u32> {
    program.base..program.base.saturating_add(program.bytes.len() as u32)
}

/// Memory as the core sees it: the part that the ring's interface shares is not for its caches.
struct Memory(Ram);

impl Bus for Memory {
    #[inline]
    fn read(&mut self, address: u32, size: u32) -> Result<u64, Unmapped> {
        self.0.read(address, size)
    }

    #[inline]
    fn write(&mut self, address: u32, size: u32, value: u64) -> Result<(), Unmapped> {
        self.0.write(address, size, value)
    }

    #[inline]
    fn is_cacheable(&self, address: u32) -> bool {
        window::is_cacheable(address)
    }
}

/// Bytes of a line of the data cache, to which the output of a bin context is aligned.
const LINE: u32 = i860::timing::ChipSizes::PAPERS.line_bytes as u32;

/// Register of the return address.
const LINK: usize = 1;

/// An i860 with the memory of a board.
///
/// Its clock stands still between calls; caches, queues and the open row of the memory are as the last call left them.
/// What is written from outside counts as put there by code before the call: it takes no time and changes no cache.
///
/// No call is remembered for a later one, because none repeats. Of those of a still head 96 % have the code, arguments and
/// parameters of an earlier one (188 of Slats with 110 triangles, 2,800 of Rendering Control with the aircraft, 48 fields
/// each), of those of a moving head none; but not one finds the same lines in the caches, whose replacement is
/// pseudo-random, to say nothing of the phase of the memory's refresh. Runs of instructions do repeat: see
/// [`i860::Config::memoise`].
pub struct Processor {
    gp: NodeId,
    version: CodeVersion,
    /// What its core is built with, again at every reset.
    core: i860::Config,
    cpu: Cpu,
    memory: Memory,
    loaded: Option<Arc<Program>>,
    /// Whether memory holds that one as it was loaded.
    is_as_loaded: bool,
    /// What is known of programs, by other boards as well.
    shelf: Rc<RefCell<Shelf>>,
    /// All that were ever loaded.
    programs: Vec<Arc<Program>>,
    /// Places of the output of both bin contexts.
    outputs: [Option<Range<u32>>; 2],
    /// Addresses whose execution somebody wants to see, and what was seen since he last looked.
    breakpoints: BTreeSet<u32>,
    hits: Vec<BreakpointHit>,
}

/// An instruction at a breakpoint, about to be executed.
///
/// A call runs from its begin to its end at one instant of the board, which spends its clocks afterwards; so what a hit shows is kept,
/// and the call goes on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BreakpointHit {
    /// The port of the board.
    pub gp: NodeId,
    /// Address of the instruction.
    pub address: u32,
    /// Time since the begin of the call.
    pub into_call: Span,
    /// Registers, control registers and pipes.
    pub state: Box<State>,
}

/// Hits that are kept until somebody looks; further ones of the same calls are not.
pub const KEPT_HITS: usize = 64;

impl fmt::Debug for Processor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Processor").field("version", &self.version).field("cpu", &self.cpu).finish_non_exhaustive()
    }
}

impl Processor {
    /// Time of a clock: 40 MHz (TR94).
    pub const CLOCK: Span = Span(25_000);

    /// A processor after reset, its memory all zero; `core` gives the clocks of its instructions and of the memory.
    #[must_use]
    pub fn new(gp: NodeId, memory_bytes: u64, version: CodeVersion, core: i860::Config) -> Self {
        let memory = Memory(Ram::new(0, memory_bytes as usize));
        Self {
            gp,
            version,
            core,
            cpu: Cpu::new(core),
            memory,
            loaded: None,
            is_as_loaded: false,
            shelf: Rc::default(),
            programs: Vec::new(),
            outputs: [None, None],
            breakpoints: BTreeSet::new(),
            hits: Vec::new(),
        }
    }

    /// Shares what it knows of programs with others of the same core from now on, which changes no time.
    pub fn share(&mut self, shelf: &Rc<RefCell<Shelf>>) {
        self.shelf = Rc::clone(shelf);
    }

    /// Resets it to a processor that memoises nothing; every time stays the same.
    pub fn count_every_clock(&mut self) {
        self.core.memoise = false;
        self.cpu = Cpu::new(self.core);
    }

    /// Which version of the code the board runs.
    #[must_use]
    pub const fn version(&self) -> CodeVersion {
        self.version
    }

    /// The port of the board.
    #[must_use]
    pub const fn node(&self) -> NodeId {
        self.gp
    }

    /// Size of the memory in bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> u32 {
        self.memory.0.bytes().len() as u32
    }

    /// Puts words into memory, beside all caches.
    ///
    /// # Errors
    ///
    /// [`ProcessorFault::Unmapped`] when they do not fit; nothing is written then.
    pub fn write(&mut self, address: u32, words: &[Word]) -> Result<(), ProcessorFault> {
        self.memory.0.load_words(address, words).map_err(|_| self.unmapped(address, words.len()))?;
        let end = address.saturating_add(4 * words.len() as u32);
        self.is_as_loaded &= self.loaded.as_ref().is_none_or(|loaded| {
            let taken = extent(loaded);
            end <= taken.start || taken.end <= address
        });
        Ok(())
    }

    /// Reads words of memory as code has left them.
    ///
    /// # Errors
    ///
    /// [`ProcessorFault::Unmapped`] when they are not all there.
    pub fn read(&self, address: u32, words: usize) -> Result<Vec<Word>, ProcessorFault> {
        self.memory.0.words(address, words).map_err(|_| self.unmapped(address, words))
    }

    /// Reads one of them.
    pub(crate) fn word(&self, address: u32) -> Result<Word, ProcessorFault> {
        let bytes = self.memory.0.bytes().get(address as usize..).and_then(<[u8]>::first_chunk);
        bytes.map(|bytes| Word::from_le_bytes(*bytes)).ok_or_else(|| self.unmapped(address, 1))
    }

    fn unmapped(&self, address: u32, words: usize) -> ProcessorFault {
        ProcessorFault::Unmapped { gp: self.gp, address, words }
    }

    /// Takes a place for the output of a bin context, 0 or 1, instead of the one that it had, and gives its address.
    /// Context 0 lies behind what ends at `end_of_data`, context 1 at the end of memory.
    ///
    /// # Errors
    ///
    /// [`ProcessorFault::NoRoom`] when it does not fit beside the other context; nothing changes then.
    pub fn place_output(&mut self, context: u8, end_of_data: u32, bytes: u32) -> Result<u32, ProcessorFault> {
        let [lower, upper] = &self.outputs;
        let (first, last) = match context {
            0 => (end_of_data, upper.as_ref().map_or(self.memory_bytes(), |upper| upper.start)),
            _ => (lower.as_ref().map_or(end_of_data, |lower| lower.end), self.memory_bytes()),
        };
        let first = first.next_multiple_of(LINE);
        let available_bytes = last.saturating_sub(first);
        let highest = last.checked_sub(bytes).map(|begin| begin / LINE * LINE).filter(|begin| *begin >= first);
        let no_room = ProcessorFault::NoRoom { gp: self.gp, context, needed_bytes: bytes, available_bytes };
        let highest = highest.ok_or(no_room)?;
        let begin = if context == 0 { first } else { highest };
        self.outputs[usize::from(context % 2)] = Some(begin..begin + bytes);
        Ok(begin)
    }

    /// What an integer register holds, 0 to 31.
    #[must_use]
    pub const fn register(&self, number: usize) -> Word {
        self.cpu.state.r[number]
    }

    /// Calls a program at its label `entry` with some registers set, and gives the time until it returns.
    ///
    /// The program is loaded first where another one was called before; that takes no time.
    ///
    /// # Errors
    ///
    /// [`ProcessorFault`] when it traps, or does not return within `budget` instructions.
    pub fn call(
        &mut self,
        program: &Arc<Program>,
        entry: &str,
        registers: &[(usize, Word)],
        budget: u64,
    ) -> Result<Span, ProcessorFault> {
        let gp = self.gp;
        self.load(program)?;
        let start = program.symbol(entry).ok_or_else(|| ProcessorFault::NoEntry { gp, label: entry.to_owned() })?;
        let begin = self.cpu.clocks();
        let state = &mut self.cpu.state;
        state.pc = start;
        state.r[LINK] = RETURN;
        for (number, value) in registers {
            state.r[*number] = *value;
        }
        let end = self.run(program, begin, budget);
        match end {
            RunEnd::Stopped => Ok(Self::CLOCK * (self.cpu.clocks() - begin)),
            RunEnd::Trapped(trap) => Err(ProcessorFault::Trap { gp, trap }),
            RunEnd::Exhausted => Err(ProcessorFault::Endless { gp, address: self.cpu.state.pc, budget }),
        }
    }

    /// Runs what was loaded with what is known of it, until it returns.
    fn run(&mut self, program: &Arc<Program>, begin: u64, budget: u64) -> RunEnd {
        let shelf = Rc::clone(&self.shelf);
        let shelf = &mut *shelf.borrow_mut();
        let known = self.is_as_loaded.then_some(program);
        self.cpu.open(shelf, known);
        let end = if self.breakpoints.is_empty() {
            self.cpu.run(&mut self.memory, Some(RETURN), budget)
        } else {
            self.run_watched(begin, budget)
        };
        self.is_as_loaded = self.cpu.close(shelf, known);
        end
    }

    /// Runs one instruction (or pair, or branch with its slot) after the other, and keeps what it finds at breakpoints.
    fn run_watched(&mut self, begin: u64, budget: u64) -> RunEnd {
        let last = self.cpu.instructions().saturating_add(budget);
        loop {
            let address = self.cpu.state.pc;
            if self.breakpoints.contains(&address) && self.hits.len() < KEPT_HITS {
                let into_call = Self::CLOCK * (self.cpu.clocks() - begin);
                let state = Box::new(self.cpu.state.clone());
                self.hits.push(BreakpointHit { gp: self.gp, address, into_call, state });
            }
            match self.cpu.run(&mut self.memory, Some(RETURN), 1.min(last.saturating_sub(self.cpu.instructions()))) {
                RunEnd::Exhausted if self.cpu.instructions() < last => {}
                end => return end,
            }
        }
    }

    /// Has calls keep what they find at some addresses, instead of those given before. No clock changes.
    pub fn break_at(&mut self, addresses: BTreeSet<u32>) {
        self.breakpoints = addresses;
    }

    /// Hits since the last call of this, at most [`KEPT_HITS`].
    pub fn take_hits(&mut self) -> Vec<BreakpointHit> {
        std::mem::take(&mut self.hits)
    }

    /// What the last call left in the registers; its program counter stands behind the return.
    #[must_use]
    pub const fn state(&self) -> &State {
        &self.cpu.state
    }

    /// Clocks of all calls so far.
    #[must_use]
    pub fn clocks(&self) -> u64 {
        self.cpu.clocks()
    }

    /// The program that was called last.
    #[must_use]
    pub const fn program(&self) -> Option<&Arc<Program>> {
        self.loaded.as_ref()
    }

    /// The programs that were called and lie in memory as they were loaded: the one called last, then in the order of their first calls.
    pub fn programs(&self) -> impl Iterator<Item = &Arc<Program>> {
        let is_last = |program: &&Arc<Program>| self.loaded.as_ref().is_some_and(|last| Arc::ptr_eq(last, program));
        let others = self.programs.iter().filter(move |program| !is_last(program));
        self.loaded.iter().chain(others.filter(|program| self.holds(program)))
    }

    fn load(&mut self, program: &Arc<Program>) -> Result<(), ProcessorFault> {
        if self.loaded.as_ref().is_some_and(|loaded| Arc::ptr_eq(loaded, program)) {
            return Ok(());
        }
        if !self.holds(program) {
            let unmapped = self.unmapped(program.base, program.bytes.len() / 4);
            self.memory.0.load(program.base, &program.bytes).map_err(|_| unmapped)?;
        }
        if !self.programs.iter().any(|known| Arc::ptr_eq(known, program)) {
            self.programs.push(Arc::clone(program));
        }
        self.loaded = Some(Arc::clone(program));
        self.is_as_loaded = true;
        Ok(())
    }

    /// Whether memory holds a program as it was loaded.
    fn holds(&self, program: &Program) -> bool {
        let Range { start, end } = extent(program);
        self.memory.0.bytes().get(start as usize..end as usize) == Some(program.bytes.as_slice())
    }
}

#[cfg(test)]
mod tests;
