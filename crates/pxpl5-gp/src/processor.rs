//! The board's i860 with its memory, where programs run and clocks are counted.

use crate::window;
use i860::{Bus, Cpu, Program, Ram, RunEnd, State, Trap, Unmapped};
use pxpl5_sim::Span;
use pxpl5_wire::{NodeId, Word};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt;
use std::ops::Range;
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
            programs: Vec::new(),
            outputs: [None, None],
            breakpoints: BTreeSet::new(),
            hits: Vec::new(),
        }
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
        self.memory.0.load_words(address, words).map_err(|_| self.unmapped(address, words.len()))
    }

    /// Reads words of memory as code has left them.
    ///
    /// # Errors
    ///
    /// [`ProcessorFault::Unmapped`] when they are not all there.
    pub fn read(&self, address: u32, words: usize) -> Result<Vec<Word>, ProcessorFault> {
        self.memory.0.words(address, words).map_err(|_| self.unmapped(address, words))
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
        let end = if self.breakpoints.is_empty() {
            self.cpu.run(&mut self.memory, Some(RETURN), budget)
        } else {
            self.run_watched(begin, budget)
        };
        match end {
            RunEnd::Stopped => Ok(Self::CLOCK * (self.cpu.clocks() - begin)),
            RunEnd::Trapped(trap) => Err(ProcessorFault::Trap { gp, trap }),
            RunEnd::Exhausted => Err(ProcessorFault::Endless { gp, address: self.cpu.state.pc, budget }),
        }
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
        let previous = self.loaded.take().filter(|previous| self.holds(previous));
        let previous = previous.map(|previous| (self.number(&previous), extent(&previous)));
        let unmapped = self.unmapped(program.base, program.bytes.len() / 4);
        self.memory.0.load(program.base, &program.bytes).map_err(|_| unmapped)?;
        let next = self.number(program);
        self.cpu.exchange_code(previous, next);
        self.loaded = Some(Arc::clone(program));
        Ok(())
    }

    /// Whether memory holds a program as it was loaded.
    fn holds(&self, program: &Program) -> bool {
        let Range { start, end } = extent(program);
        self.memory.0.bytes().get(start as usize..end as usize) == Some(program.bytes.as_slice())
    }

    /// The number by which the core knows a program.
    fn number(&mut self, program: &Arc<Program>) -> usize {
        let known = self.programs.iter().position(|known| Arc::ptr_eq(known, program));
        known.unwrap_or_else(|| {
            self.programs.push(Arc::clone(program));
            self.programs.len() - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn processor() -> Processor {
        Processor::new(NodeId(3), 1 << 16, CodeVersion::Scheduled, i860::Config::cycle())
    }

    fn program(source: &str) -> Arc<Program> {
        Arc::new(i860::assemble("test", 0x1000, source).expect("it assembles"))
    }

    #[test]
    fn a_call_returns_with_its_result_and_takes_its_clocks() {
        let mut processor = processor();
        let double = program("start: adds r16, r16, r17\n bri r1\n nop");
        let cold = processor.call(&double, "start", &[(16, 21)], 10).expect("it returns");
        assert_eq!(processor.register(17), 42);
        let warm = processor.call(&double, "start", &[(16, 5)], 10).expect("it returns");
        assert_eq!(processor.register(17), 10);
        // Three instructions and the clock of an indirect branch.
        assert_eq!(warm, Processor::CLOCK * 4);
        assert!(cold > warm, "the first call fills the instruction cache");
    }

    #[test]
    fn a_trap_names_the_board_and_the_address() {
        let wild = program("start: nop\n ld.l 0(r16), r17\n bri r1\n nop");
        let error = processor().call(&wild, "start", &[(16, 0x2002)], 10).expect_err("unaligned");
        assert_eq!(
            error.to_string(),
            "graphics processor at node 3: trap at 0x00001004: 0x00002002 is not a multiple of 4"
        );
    }

    #[test]
    fn an_endless_loop_ends_with_its_budget() {
        let forever = program("start: br start\n nop");
        let error = processor().call(&forever, "start", &[], 1_000).expect_err("endless");
        assert!(matches!(error, ProcessorFault::Endless { gp: NodeId(3), budget: 1_000, .. }), "{error}");
    }

    #[test]
    fn a_program_that_changed_itself_is_as_new_when_it_is_loaded_again() {
        let mut processor = processor();
        // Stores the word of `other` over that of `here`, which it executes afterwards.
        let changing = program(
            "start: orh 0, r0, r18\n or 0x1018, r18, r18\n ld.l 0(r18), r19\n bri r1\n adds 1, r17, r17\n nop\n\
             other: adds 5, r17, r17\n change: orh 0, r0, r18\n or 0x1010, r18, r18\n st.l r19, 0(r18)\n bri r1\n nop",
        );
        let other = program("start: adds r16, r16, r17\n bri r1\n nop");
        for _ in 0..3 {
            processor.call(&changing, "start", &[(17, 10)], 20).expect("it returns");
            assert_eq!(processor.register(17), 11, "as it was loaded");
            processor.call(&changing, "change", &[], 20).expect("it returns");
            processor.call(&changing, "start", &[(17, 10)], 20).expect("it returns");
            assert_eq!(processor.register(17), 15, "as it changed itself");
            processor.call(&other, "start", &[(16, 21)], 10).expect("it returns");
            assert_eq!(processor.register(17), 42);
        }
    }

    #[test]
    fn what_memory_does_not_hold_is_refused() {
        let mut processor = processor();
        assert!(processor.write(0xFFFC, &[1]).is_ok());
        let error = processor.write(0xFFFC, &[1, 2]).expect_err("one word too many");
        assert_eq!(error.to_string(), "graphics processor at node 3: no memory for 2 words at 0x0000fffc");
    }
}
