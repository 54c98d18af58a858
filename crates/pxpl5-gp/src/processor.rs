//! The i860 of a board with its memory. It runs code for the work of the board's programs, and counts the clocks of
//! this code.

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

/// Version of the i860 code that a board runs for its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CodeVersion {
    /// Code like the output of a compiler without optimization. It is nearly twice as large as the instruction cache.
    Unoptimised,
    /// Code like the output of a good compiler of about 1990. The code of Slats in 1994 and 1995 was not
    /// optimized for the instruction cache (I3D95), and is assumed to be of this kind.
    Compiled,
    /// Code that `i860::linear` schedules for dual-instruction mode, and that fits in the instruction cache. Optimized
    /// PPHIGS fitted in the cache too, which made it about 3 times faster (I3D95).
    Scheduled,
}

impl CodeVersion {
    /// All versions, the slowest first.
    pub const ALL: [Self; 3] = [Self::Unoptimised, Self::Compiled, Self::Scheduled];

    /// Returns the name with which experiment files choose this version of the code.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unoptimised => "unoptimised",
            Self::Compiled => "compiled",
            Self::Scheduled => "scheduled",
        }
    }
}

pxpl5_sim::parameters::named!(
    CodeVersion,
    "version of the code",
    CodeVersion::ALL.map(|version| (version.name(), version))
);

/// The reason why a call of i860 code failed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ProcessorFault {
    #[error("graphics processor at node {}: {trap}", gp.0)]
    Trap { gp: NodeId, trap: Trap },
    /// The code used up its instruction budget before it returned.
    #[error("graphics processor at node {}: no return within {budget} instructions, at {address:#010x}", gp.0)]
    Endless {
        gp: NodeId,
        /// Address of the instruction that would have been executed next.
        address: u32,
        budget: u64,
    },
    /// An access from outside the i860 to addresses without memory.
    #[error("graphics processor at node {}: no memory for {words} words at {address:#010x}", gp.0)]
    Unmapped { gp: NodeId, address: u32, words: usize },
    /// The memory is too small for the outputs of the two bin contexts (sets of bins).
    #[error("graphics processor at node {}: output of bin context {context} needs {needed_bytes} bytes, {available_bytes} are available", gp.0)]
    NoRoom {
        gp: NodeId,
        /// Bin context (set of bins, 0 or 1) that requested memory.
        context: u8,
        needed_bytes: u32,
        /// Number of bytes that are free for the context. The free range of context 0 ends at context 1 or at the end
        /// of memory. The free range of context 1 begins after context 0 or after the program's data.
        available_bytes: u32,
    },
    /// The program has no label with the requested name.
    #[error("graphics processor at node {}: the program has no label `{label}`", gp.0)]
    NoEntry { gp: NodeId, label: String },
}

/// Return address of every call. There is no code at this address, and the i860 stops when its program counter reaches
/// it.
const RETURN: u32 = 0x0800;

fn extent(program: &Program) -> Range<u32> {
    program.base..program.base.saturating_add(program.bytes.len() as u32)
}

/// The memory of the board, with the bus interface for the i860. The caches never hold data of the range that the i860
/// shares with the ring interface.
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

/// Size of a data-cache line in bytes. The memory for each of the two sets of bins begins at a multiple of this size.
const LINE: u32 = i860::timing::ChipSizes::PAPERS.line_bytes as u32;

/// Integer register that holds the return address of a call.
const LINK: usize = 1;

/// An i860 with the memory of a board.
///
/// Its clock stops between calls, while caches, queues and the open DRAM row keep their state. A write by Rust code
/// takes no time and changes no cache, because it stands for an earlier write by i860 code.
///
/// Clocks of whole calls are not memoized, because no call repeats exactly. While the head is still, 96 % of the calls
/// have the same code and inputs as an earlier one; while it moves, none has. Even calls with equal inputs differ in
/// the content of the caches, whose lines are replaced pseudo-randomly, and in the time to the next memory refresh. The
/// numbers are from 188 calls of Slats with 110 triangles and 2,800 of Rendering Control with the aircraft scene, 48
/// fields each. What can be memoized are the clocks of short sequences of instructions ([`i860::Config::memoise`]).
pub struct Processor {
    gp: NodeId,
    version: CodeVersion,
    core: i860::Config,
    cpu: Cpu,
    memory: Memory,
    loaded: Option<Arc<Program>>,
    is_as_loaded: bool,
    /// Decoded programs with their memoized clocks. Several boards share this store.
    decoded: Rc<RefCell<DecodedPrograms>>,
    /// All programs loaded so far, in the order of their first calls.
    programs: Vec<Arc<Program>>,
    /// Address range that is reserved for the output of each bin context (set of bins).
    outputs: [Option<Range<u32>>; 2],
    breakpoints: BTreeSet<u32>,
    hits: Vec<BreakpointHit>,
}

/// The state of the i860 at a breakpoint, before the execution of the instruction.
///
/// A call does not stop at a breakpoint: it runs completely at one instant of simulated time, and the board spends its
/// clocks afterwards.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BreakpointHit {
    pub gp: NodeId,
    pub address: u32,
    /// Time on the i860's clock from the start of the call to the breakpoint.
    pub into_call: Span,
    /// Registers, control registers and pipes of the i860.
    pub state: Box<State>,
}

/// Greatest number of breakpoint hits that are kept until [`Processor::take_hits`]. Later hits are not recorded.
pub const KEPT_HITS: usize = 64;

impl fmt::Debug for Processor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Processor").field("version", &self.version).field("cpu", &self.cpu).finish_non_exhaustive()
    }
}

impl Processor {
    /// Period of the i860's clock: 25 ns at 40 MHz (TR94).
    pub const CLOCK: Span = Span(25_000);

    /// Makes an i860 in the state after reset. All bytes of its memory are zero. `core` configures the timing of
    /// instructions and memory.
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
            decoded: Rc::default(),
            programs: Vec::new(),
            outputs: [None, None],
            breakpoints: BTreeSet::new(),
            hits: Vec::new(),
        }
    }

    /// Shares decoded programs and their memoized clocks with other boards, whose i860s must have the same
    /// configuration. Simulated times do not depend on this call.
    pub fn share(&mut self, decoded: &Rc<RefCell<DecodedPrograms>>) {
        self.decoded = Rc::clone(decoded);
    }

    /// Resets the i860, and turns off memoization. Simulated times do not depend on this call.
    pub fn disable_memoization(&mut self) {
        self.core.memoise = false;
        self.cpu = Cpu::new(self.core);
    }

    pub const fn version(&self) -> CodeVersion {
        self.version
    }

    pub const fn node(&self) -> NodeId {
        self.gp
    }

    /// Returns the size of the board's memory in bytes.
    pub fn memory_bytes(&self) -> u32 {
        self.memory.0.bytes().len() as u32
    }

    /// Writes words to memory. The caches stay unchanged.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault::Unmapped`] if the words do not fit. In this case, nothing is written.
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

    /// Reads words of memory, including all stores of i860 code.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault::Unmapped`] if a word lies outside the memory.
    pub fn read(&self, address: u32, words: usize) -> Result<Vec<Word>, ProcessorFault> {
        self.memory.0.words(address, words).map_err(|_| self.unmapped(address, words))
    }

    pub(crate) fn word(&self, address: u32) -> Result<Word, ProcessorFault> {
        let bytes = self.memory.0.bytes().get(address as usize..).and_then(<[u8]>::first_chunk);
        bytes.map(|bytes| Word::from_le_bytes(*bytes)).ok_or_else(|| self.unmapped(address, 1))
    }

    fn unmapped(&self, address: u32, words: usize) -> ProcessorFault {
        ProcessorFault::Unmapped { gp: self.gp, address, words }
    }

    /// Reserves memory for the output of bin context 0 or 1 (one of two sets of bins), and returns its address. The
    /// range replaces an earlier range of the same context. Context 0 begins after the program's data, at address
    /// `end_of_data` or above. Context 1 is at the end of memory.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault::NoRoom`] if the free memory beside the other context is too small. In this case,
    /// nothing changes.
    pub fn place_output(&mut self, context: u8, end_of_data: u32, bytes: u32) -> Result<u32, ProcessorFault> {
        // Find the free range beside the other context.
        let [lower, upper] = &self.outputs;
        let (first, last) = match context {
            0 => (end_of_data, upper.as_ref().map_or(self.memory_bytes(), |upper| upper.start)),
            _ => (lower.as_ref().map_or(end_of_data, |lower| lower.end), self.memory_bytes()),
        };
        let first = first.next_multiple_of(LINE);
        // Context 0 begins at the lowest cache line of the range, and context 1 at the highest line at which it fits.
        let available_bytes = last.saturating_sub(first);
        let highest = last.checked_sub(bytes).map(|begin| begin / LINE * LINE).filter(|begin| *begin >= first);
        let no_room = ProcessorFault::NoRoom { gp: self.gp, context, needed_bytes: bytes, available_bytes };
        let highest = highest.ok_or(no_room)?;
        let begin = if context == 0 { first } else { highest };
        self.outputs[usize::from(context % 2)] = Some(begin..begin + bytes);
        Ok(begin)
    }

    pub const fn register(&self, number: usize) -> Word {
        self.cpu.state.r[number]
    }

    /// Calls a program at its label `entry`, with the values of `registers` in integer registers. Returns the time from
    /// the call to the return.
    ///
    /// If memory does not hold the program, the function first loads it. Loading takes no simulated time.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault`] if the program traps, or does not return within `budget` instructions.
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
        // The run ends when the program returns to this address.
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

    /// Runs the loaded program until it returns. Its decoded code comes from the shared store `decoded`.
    fn run(&mut self, program: &Arc<Program>, begin: u64, budget: u64) -> RunEnd {
        let decoded = Rc::clone(&self.decoded);
        let decoded = &mut *decoded.borrow_mut();
        // Code that has changed in memory must be decoded again.
        let known = self.is_as_loaded.then_some(program);
        self.cpu.open(decoded, known);
        let end = if self.breakpoints.is_empty() {
            self.cpu.run(&mut self.memory, Some(RETURN), budget)
        } else {
            self.run_with_breakpoints(begin, budget)
        };
        self.is_as_loaded = self.cpu.close(decoded, known);
        end
    }

    /// Runs the loaded program step by step, and records a hit at each breakpoint. A step is an instruction, a pair in
    /// dual-instruction mode, or a branch with its delay slot.
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

    /// Replaces all breakpoints. Breakpoints do not change the number of clocks of a call.
    pub fn break_at(&mut self, addresses: BTreeSet<u32>) {
        self.breakpoints = addresses;
    }

    /// Removes and returns the recorded breakpoint hits, at most [`KEPT_HITS`].
    pub fn take_hits(&mut self) -> Vec<BreakpointHit> {
        std::mem::take(&mut self.hits)
    }

    /// Returns the state of the i860 after the last call. The program counter contains the return address of this call.
    pub const fn state(&self) -> &State {
        &self.cpu.state
    }

    /// Returns the sum of the clocks of all calls so far.
    pub fn clocks(&self) -> u64 {
        self.cpu.clocks()
    }

    pub const fn program(&self) -> Option<&Arc<Program>> {
        self.loaded.as_ref()
    }

    /// Returns the programs that memory still holds unchanged: the most recently called program, then the others in the
    /// order of their first calls.
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

    fn holds(&self, program: &Program) -> bool {
        let Range { start, end } = extent(program);
        self.memory.0.bytes().get(start as usize..end as usize) == Some(program.bytes.as_slice())
    }
}

#[cfg(test)]
mod tests;
