//! The board's i860 with its memory, which runs code and counts clocks.

use crate::window;
use i860::{Bus, Cpu, DecodedPrograms, Program, Ram, RunEnd, State, Trap, Unmapped};
use pxpl5_sim::Span;
use pxpl5_wire::{NodeId, Word};
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fmt;
use std::ops::Range;
use std::rc::Rc;
use std::sync::Arc;

/// Version of the i860 code that a board runs when the time of its work comes from code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CodeVersion {
    /// Code as from a compiler without optimization, nearly twice as large as the instruction cache.
    Unoptimised,
    /// Code as from a good compiler of about 1990. Slats of 1994 and 1995 had such code, which did not fit the
    /// instruction cache (I3D95).
    Compiled,
    /// Code scheduled by hand in dual-instruction mode, which fits the cache: optimized PPHIGS (TR94). Slats with code
    /// that fits would have been faster by a factor of about 3 (I3D95).
    Scheduled,
}

impl CodeVersion {
    /// Returns the name in experiment files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unoptimised => "unoptimised",
            Self::Compiled => "compiled",
            Self::Scheduled => "scheduled",
        }
    }
}

/// The reason why a program on the processor did not reach its end.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ProcessorFault {
    /// The program took a trap.
    #[error("graphics processor at node {}: {trap}", gp.0)]
    Trap {
        /// Port of the board.
        gp: NodeId,
        /// Cause and address of the trap.
        trap: Trap,
    },
    /// The program did not return within its instruction budget.
    #[error("graphics processor at node {}: no return within {budget} instructions, at {address:#010x}", gp.0)]
    Endless {
        /// Port of the board.
        gp: NodeId,
        /// Address of the next instruction at the end of the budget.
        address: u32,
        /// Instruction budget of the call.
        budget: u64,
    },
    /// An access to data outside the memory.
    #[error("graphics processor at node {}: no memory for {words} words at {address:#010x}", gp.0)]
    Unmapped {
        /// Port of the board.
        gp: NodeId,
        /// Address of the first word.
        address: u32,
        /// Number of requested words.
        words: usize,
    },
    /// Two bin contexts would overlap in memory.
    #[error("graphics processor at node {}: output of bin context {context} needs {needed_bytes} bytes, {available_bytes} are available", gp.0)]
    NoRoom {
        /// Port of the board.
        gp: NodeId,
        /// Bin context that requested memory.
        context: u8,
        /// Bytes that the context needs.
        needed_bytes: u32,
        /// Bytes between the data before the context and the other context or the end of memory.
        available_bytes: u32,
    },
    /// The program lacks the label of its entry.
    #[error("graphics processor at node {}: the program has no label `{label}`", gp.0)]
    NoEntry {
        /// Port of the board.
        gp: NodeId,
        /// Name of the missing label.
        label: String,
    },
}

/// Return address of called programs. No code is there; the run stops at this address.
const RETURN: u32 = 0x0800;

/// Returns the range of addresses of a program.
fn extent(program: &Program) -> Range<u32> {
    program.base..program.base.saturating_add(program.bytes.len() as u32)
}

/// Memory as the core sees it. The part shared with the ring interface is not cacheable.
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

/// Bytes of a data-cache line, to which the output of a bin context is aligned.
const LINE: u32 = i860::timing::ChipSizes::PAPERS.line_bytes as u32;

/// Number of the register with the return address.
const LINK: usize = 1;

/// An i860 with the memory of a board.
///
/// The clock stands still between calls. Caches, queues and the open DRAM row stay as the last call left them. A write
/// from outside counts as a write by code before the call: it takes no time and changes no cache.
///
/// Calls are not memoized as a whole, because no call repeats exactly. For a still head, 96 % of the calls have the
/// code, arguments and parameters of an earlier call (188 calls of Slats with 110 triangles, 2,800 of Rendering Control
/// with the aircraft, 48 fields each). For a moving head none have. But no call finds the same lines in the caches,
/// whose replacement is pseudo-random, or the same phase of the memory's refresh. Runs of instructions do repeat: see
/// [`i860::Config::memoise`].
pub struct Processor {
    gp: NodeId,
    version: CodeVersion,
    /// Configuration of the core, used again at every reset.
    core: i860::Config,
    cpu: Cpu,
    memory: Memory,
    loaded: Option<Arc<Program>>,
    /// True if the memory holds the loaded program unchanged.
    is_as_loaded: bool,
    /// Decoded programs and their clocks, shared with other boards.
    shelf: Rc<RefCell<DecodedPrograms>>,
    /// All programs that were ever loaded.
    programs: Vec<Arc<Program>>,
    /// Address ranges of the output of both bin contexts.
    outputs: [Option<Range<u32>>; 2],
    /// Addresses of breakpoints, and the hits since the last [`Processor::take_hits`].
    breakpoints: BTreeSet<u32>,
    hits: Vec<BreakpointHit>,
}

/// The state of the processor at a breakpoint, before the instruction executes.
///
/// A call runs from begin to end at one instant of the board, which spends its clocks afterwards. The call therefore
/// does not stop at a breakpoint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BreakpointHit {
    /// Port of the board.
    pub gp: NodeId,
    /// Address of the instruction.
    pub address: u32,
    /// Time since the begin of the call.
    pub into_call: Span,
    /// Registers, control registers and pipes.
    pub state: Box<State>,
}

/// Most hits that are kept until [`Processor::take_hits`]. Later hits are dropped.
pub const KEPT_HITS: usize = 64;

impl fmt::Debug for Processor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Processor").field("version", &self.version).field("cpu", &self.cpu).finish_non_exhaustive()
    }
}

impl Processor {
    /// Period of the clock: 40 MHz (TR94).
    pub const CLOCK: Span = Span(25_000);

    /// Makes a processor after reset with zeroed memory. `core` gives the timing of its instructions and of the memory.
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

    /// Shares decoded programs and their clocks with other processors of the same core configuration. No simulated time
    /// changes.
    pub fn share(&mut self, shelf: &Rc<RefCell<DecodedPrograms>>) {
        self.shelf = Rc::clone(shelf);
    }

    /// Resets the processor and turns memoization off. No simulated time changes.
    pub fn disable_memoization(&mut self) {
        self.core.memoise = false;
        self.cpu = Cpu::new(self.core);
    }

    /// Returns the version of the code that the board runs.
    #[must_use]
    pub const fn version(&self) -> CodeVersion {
        self.version
    }

    /// Returns the port of the board.
    #[must_use]
    pub const fn node(&self) -> NodeId {
        self.gp
    }

    /// Returns the size of the memory in bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> u32 {
        self.memory.0.bytes().len() as u32
    }

    /// Writes words to memory without any effect on caches.
    ///
    /// # Errors
    ///
    /// [`ProcessorFault::Unmapped`] if the words do not fit. Nothing is written then.
    pub fn write(&mut self, address: u32, words: &[Word]) -> Result<(), ProcessorFault> {
        self.memory.0.load_words(address, words).map_err(|_| self.unmapped(address, words.len()))?;
        let end = address.saturating_add(4 * words.len() as u32);
        // A write over the loaded program changes it.
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
    /// [`ProcessorFault::Unmapped`] if a word lies outside the memory.
    pub fn read(&self, address: u32, words: usize) -> Result<Vec<Word>, ProcessorFault> {
        self.memory.0.words(address, words).map_err(|_| self.unmapped(address, words))
    }

    /// Reads one word of memory.
    pub(crate) fn word(&self, address: u32) -> Result<Word, ProcessorFault> {
        let bytes = self.memory.0.bytes().get(address as usize..).and_then(<[u8]>::first_chunk);
        bytes.map(|bytes| Word::from_le_bytes(*bytes)).ok_or_else(|| self.unmapped(address, 1))
    }

    fn unmapped(&self, address: u32, words: usize) -> ProcessorFault {
        ProcessorFault::Unmapped { gp: self.gp, address, words }
    }

    /// Reserves memory for the output of bin context 0 or 1, instead of its previous reservation. Returns the address.
    /// Context 0 begins after the data, which end at `end_of_data`. Context 1 lies at the end of memory.
    ///
    /// # Errors
    ///
    /// [`ProcessorFault::NoRoom`] if the output does not fit beside the other context. Nothing changes then.
    pub fn place_output(&mut self, context: u8, end_of_data: u32, bytes: u32) -> Result<u32, ProcessorFault> {
        // Find the free range beside the other context.
        let [lower, upper] = &self.outputs;
        let (first, last) = match context {
            0 => (end_of_data, upper.as_ref().map_or(self.memory_bytes(), |upper| upper.start)),
            _ => (lower.as_ref().map_or(end_of_data, |lower| lower.end), self.memory_bytes()),
        };
        let first = first.next_multiple_of(LINE);
        // Context 0 begins at the lowest line of the range, context 1 at the highest that fits.
        let available_bytes = last.saturating_sub(first);
        let highest = last.checked_sub(bytes).map(|begin| begin / LINE * LINE).filter(|begin| *begin >= first);
        let no_room = ProcessorFault::NoRoom { gp: self.gp, context, needed_bytes: bytes, available_bytes };
        let highest = highest.ok_or(no_room)?;
        let begin = if context == 0 { first } else { highest };
        self.outputs[usize::from(context % 2)] = Some(begin..begin + bytes);
        Ok(begin)
    }

    /// Returns the value of integer register `number`, 0 to 31.
    #[must_use]
    pub const fn register(&self, number: usize) -> Word {
        self.cpu.state.r[number]
    }

    /// Calls a program at its label `entry` with some registers set. Returns the time until the program returns.
    ///
    /// If another program was called before, this one is loaded first, which takes no time.
    ///
    /// # Errors
    ///
    /// [`ProcessorFault`] if the program traps, or does not return within `budget` instructions.
    pub fn call(
        &mut self,
        program: &Arc<Program>,
        entry: &str,
        registers: &[(usize, Word)],
        budget: u64,
    ) -> Result<Span, ProcessorFault> {
        let gp = self.gp;
        self.load(program)?;
        // The program must be in memory before its label is called.
        let start = program.symbol(entry).ok_or_else(|| ProcessorFault::NoEntry { gp, label: entry.to_owned() })?;
        let begin = self.cpu.clocks();
        let state = &mut self.cpu.state;
        state.pc = start;
        // A return to this address ends the run.
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

    /// Runs the loaded program until it returns, with its decoded code from the shelf.
    fn run(&mut self, program: &Arc<Program>, begin: u64, budget: u64) -> RunEnd {
        let shelf = Rc::clone(&self.shelf);
        let shelf = &mut *shelf.borrow_mut();
        // Code that has changed in memory must be decoded anew.
        let known = self.is_as_loaded.then_some(program);
        self.cpu.open(shelf, known);
        let end = if self.breakpoints.is_empty() {
            self.cpu.run(&mut self.memory, Some(RETURN), budget)
        } else {
            self.run_with_breakpoints(begin, budget)
        };
        self.is_as_loaded = self.cpu.close(shelf, known);
        end
    }

    /// Runs step by step (an instruction, a pair, or a branch with its slot) and records a hit at each breakpoint.
    fn run_with_breakpoints(&mut self, begin: u64, budget: u64) -> RunEnd {
        let last = self.cpu.instructions().saturating_add(budget);
        loop {
            let address = self.cpu.state.pc;
            // Record the state before the instruction executes.
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

    /// Sets the addresses at which calls record hits, instead of earlier ones. No clock changes.
    pub fn break_at(&mut self, addresses: BTreeSet<u32>) {
        self.breakpoints = addresses;
    }

    /// Returns and removes the hits since the last call of this function, at most [`KEPT_HITS`].
    pub fn take_hits(&mut self) -> Vec<BreakpointHit> {
        std::mem::take(&mut self.hits)
    }

    /// Returns the state that the last call left. Its program counter is the return address of the call.
    #[must_use]
    pub const fn state(&self) -> &State {
        &self.cpu.state
    }

    /// Returns the clocks of all calls so far.
    #[must_use]
    pub fn clocks(&self) -> u64 {
        self.cpu.clocks()
    }

    /// Returns the program that was called last.
    #[must_use]
    pub const fn program(&self) -> Option<&Arc<Program>> {
        self.loaded.as_ref()
    }

    /// Returns the programs that memory still holds as loaded: the last called one first, then the others in the order
    /// of their first calls.
    pub fn programs(&self) -> impl Iterator<Item = &Arc<Program>> {
        let is_last = |program: &&Arc<Program>| self.loaded.as_ref().is_some_and(|last| Arc::ptr_eq(last, program));
        let others = self.programs.iter().filter(move |program| !is_last(program));
        self.loaded.iter().chain(others.filter(|program| self.holds(program)))
    }

    fn load(&mut self, program: &Arc<Program>) -> Result<(), ProcessorFault> {
        if self.loaded.as_ref().is_some_and(|loaded| Arc::ptr_eq(loaded, program)) {
            return Ok(());
        }
        // The memory may still hold the program from an earlier call.
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

    /// Returns true if memory holds a program as it was loaded.
    fn holds(&self, program: &Program) -> bool {
        let Range { start, end } = extent(program);
        self.memory.0.bytes().get(start as usize..end as usize) == Some(program.bytes.as_slice())
    }
}

#[cfg(test)]
mod tests;
