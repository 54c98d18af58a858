//! The processor: instruction fetch, pairs of instructions, delay slots, traps, and the main loop.

use crate::action::{Action, Floating};
use crate::assembler::Program;
use crate::block::{Block, Execution};
use crate::bus::Bus;
use crate::clock::{Accesses, Clock};
use crate::code::Code;
use crate::decoded_programs::DecodedPrograms;
use crate::profile::{AddressProfile, Profile};
use crate::seed::SeedTable;
use crate::state::{Mode, State, TRAP_VECTOR, psr};
use crate::timing::Config;
use crate::trap::{RunEnd, Trap, TrapCause};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flow {
    Next,
    /// Continue with the next instruction in memory, which a store may have changed.
    NextOfChangedCode,
    /// Jump to the target address immediately.
    Jump(u32),
    /// Jump to the target address after the delay slot.
    Delayed(u32),
    /// Skip one instruction or pair, which is the delay slot of a branch that is not taken.
    Skip,
    Trapped,
}

/// An i860 XR with its caches and its clock. The memory is not part of the processor: each call of [`Cpu::run`] or
/// [`Cpu::step`] takes a [`Bus`].
pub struct Cpu {
    /// Registers, pipes and pairing mode: the complete state that is visible to a program.
    pub state: State,
    pub(crate) time: Clock,
    pub(crate) seeds: SeedTable,
    /// Pairing mode (single instructions or pairs) after the delay slot. Set by a return from a trap.
    pub(crate) mode_after_slot: Option<Mode>,
    pub(crate) accesses: Accesses,
    cause: Option<TrapCause>,
    pub(crate) directory_base: Option<u32>,
    pub(crate) code_changed: bool,
    pub(crate) code: Code,
    config: Config,
}

impl fmt::Debug for Cpu {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Cpu").field("state", &self.state).field("clocks", &self.clocks()).finish_non_exhaustive()
    }
}

impl Cpu {
    /// Makes a processor in the state after reset: the next instruction is at [`TRAP_VECTOR`], and the caches are
    /// empty.
    pub fn new(config: Config) -> Cpu {
        Cpu {
            state: State::reset(),
            time: Clock::new(&config),
            seeds: config.seeds,
            mode_after_slot: None,
            accesses: Accesses::new(),
            cause: None,
            directory_base: None,
            code_changed: false,
            code: Code::new(),
            config,
        }
    }

    /// Makes a processor whose next instruction is at address `pc`.
    pub fn at(config: Config, pc: u32) -> Cpu {
        let mut cpu = Cpu::new(config);
        cpu.state.pc = pc;
        cpu
    }

    /// Puts the processor into its state after reset. The clock starts from 0 and the caches are empty.
    pub fn reset(&mut self) {
        self.state = State::reset();
        self.time = Clock::new(&self.config);
        self.mode_after_slot = None;
        self.invalidate_code();
    }

    /// Returns the number of clocks since reset, or 0 if timing is off.
    pub fn clocks(&self) -> u64 {
        self.time.now()
    }

    /// Returns the number of instructions since the last reset or [`Cpu::clear_profile`].
    pub fn instructions(&self) -> u64 {
        self.time.instructions()
    }

    /// Returns the number of instructions, since reset, whose clocks were reused from an earlier execution of the same
    /// code ([`Config::memoise`]).
    pub fn repeated_instructions(&self) -> u64 {
        self.time.repeated_instructions()
    }

    /// Returns the clocks by cause and the numbers of cache misses, since reset or [`Cpu::clear_profile`].
    pub fn profile(&self) -> Profile {
        self.time.profile()
    }

    /// Sets all counts of the profile to zero. The caches, queues and the clock keep their state.
    pub fn clear_profile(&mut self) {
        self.time.clear_profile();
    }

    /// Empties the caches and the TLB without write-backs and without simulated time, for example before a measurement.
    pub fn empty_caches(&mut self) {
        self.time.empty_caches();
    }

    /// Starts to count clocks for each code address in `addresses`. With `None`, stops this count.
    pub fn watch(&mut self, addresses: Option<AddressProfile>) {
        self.time.sampler = addresses;
    }

    /// Returns the clocks for each code address since [`Cpu::watch`] was called.
    pub fn watched(&self) -> Option<&AddressProfile> {
        self.time.sampler.as_ref()
    }

    /// Discards all decoded instructions. Call this after another device has written code into memory, because
    /// instructions are decoded ahead, up to the next branch. The processor's own stores into code take effect
    /// immediately (the real chip would need a flush and dirbase.ITI).
    pub fn invalidate_code(&mut self) {
        self.code.clear();
        self.code_changed = false;
    }

    /// Takes the decoded code of `program` from `programs`, a shared store, and uses it until [`Cpu::close`]. Memory
    /// must contain `program` as assembled. With `None`, all code is decoded again. Either way, simulated clocks stay
    /// the same.
    ///
    /// All processors that share the store must have the same [`Config::freezes`].
    pub fn open(&mut self, programs: &mut DecodedPrograms, program: Option<&Arc<Program>>) {
        self.code = program.map_or_else(Code::new, |program| programs.take(program));
        self.code_changed = false;
        self.time.exchange_numbers(&mut programs.numbers);
        self.time.fetch.number_states_from(programs.cache_states);
    }

    /// Returns the decoded program and its memoized clocks to `programs`, and returns true. If a store has changed the
    /// program in memory, discards the decoded code instead, and returns false.
    pub fn close(&mut self, programs: &mut DecodedPrograms, program: Option<&Arc<Program>>) -> bool {
        self.time.exchange_numbers(&mut programs.numbers);
        programs.cache_states = self.time.fetch.states();
        let code = std::mem::replace(&mut self.code, Code::new());
        let Some(program) = program.filter(|_| code.is_as_assembled()) else { return false };
        programs.put(program, code);
        true
    }

    /// Runs the program until it reaches address `stop` in single-instruction mode, takes a trap, or has executed
    /// `budget` instructions. A branch and its delay slot stay together, so a run can exceed the budget by up to three
    /// instructions.
    pub fn run<B: Bus>(&mut self, bus: &mut B, stop: Option<u32>, budget: u64) -> RunEnd {
        let end = self.instructions().saturating_add(budget);
        loop {
            if Some(self.state.pc) == stop && self.state.mode == Mode::Single {
                return RunEnd::Stopped;
            }
            if self.instructions() >= end {
                return RunEnd::Exhausted;
            }
            if let Err(trap) = self.advance(bus, stop, end - self.instructions()) {
                return RunEnd::Trapped(trap);
            }
        }
    }

    /// Executes one instruction, one pair, or one delayed branch together with its delay slot.
    ///
    /// # Errors
    /// Returns the trap that was taken. The next step executes the first instruction of the trap handler.
    pub fn step<B: Bus>(&mut self, bus: &mut B) -> Result<(), Trap> {
        self.advance(bus, None, 1)
    }

    /// Executes the block that begins at `pc`. If the block contains the address `stop` or has more than `most`
    /// instructions, executes only the first instruction or pair of the block.
    fn advance<B: Bus>(&mut self, bus: &mut B, stop: Option<u32>, most: u64) -> Result<(), Trap> {
        let pc = self.state.pc;
        // Take the decoded block out of the store, or decode it now.
        let mode = self.state.mode;
        let mut block = match self.code.take(pc, mode) {
            Some(block) => block,
            None => match Block::read(pc, mode, &mut self.code.words, bus) {
                Ok(block) => Box::new(block),
                Err(cause) => return Err(self.take_trap(cause)),
            },
        };
        // Execute the whole block if `stop` and the budget permit. Otherwise execute its first instruction or pair.
        let whole = block.instructions <= most && stop.is_none_or(|stop| !block.passes(stop));
        let units = if whole { block.count } else { 1 };
        self.execute(&mut block, units, bus);
        // Changes of dirbase take effect after the instruction that wrote the register.
        if let Some(value) = self.directory_base.take() {
            self.apply_directory_base(value);
        }
        self.code.put(pc, block);
        // After a store into decoded code, all blocks must be decoded again.
        if self.code_changed {
            self.invalidate_code();
        }
        match self.cause.take() {
            None => Ok(()),
            Some(cause) => Err(self.take_trap(cause)),
        }
    }

    /// Executes up to `most` instructions or pairs of a block, and the delay slot of its branch. Then counts the clocks
    /// of these instructions.
    #[inline]
    fn execute<B: Bus>(&mut self, block: &mut Block, most: usize, bus: &mut B) {
        self.accesses.begin(self.time.repeats());
        let (units, flow) = self.units(block, 0..most, bus);
        let mut execution = Execution { units, slot: false, taken: false, trapped: false };
        self.go_on(flow, block, &mut execution, bus);
        self.time.pass(block, execution, &self.accesses, bus);
    }

    /// Sets the address and pairing mode of the next block. If the current block has ended with a taken delayed branch,
    /// executes the branch's delay slot first.
    #[inline]
    fn go_on<B: Bus>(&mut self, flow: Flow, block: &Block, execution: &mut Execution, bus: &mut B) {
        // Begin with the address after the executed code. A jump or trap overrides this address below.
        let (next, after) = match execution.units == block.count {
            true => (block.next, block.after),
            false => {
                let last = block.unit(execution.units - 1);
                (last.next(), last.after)
            }
        };
        self.state.pc = next;
        self.state.mode = after;
        match flow {
            Flow::Next | Flow::NextOfChangedCode => {}
            Flow::Jump(target) => {
                self.state.pc = target;
                execution.taken = true;
            }
            Flow::Skip => self.state.pc = next.wrapping_add(if after.is_dual() { 8 } else { 4 }),
            Flow::Delayed(target) => {
                execution.taken = true;
                self.slot(block, target, execution, bus);
            }
            Flow::Trapped => {
                execution.trapped = true;
                let last = block.unit(execution.units - 1);
                self.state.pc = last.pc;
                self.state.mode = last.mode;
            }
        }
    }

    #[inline]
    fn slot<B: Bus>(&mut self, block: &Block, target: u32, execution: &mut Execution, bus: &mut B) {
        if block.wrong_slot.is_some() {
            self.cause = block.wrong_slot;
            return;
        }
        execution.slot = true;
        if self.units(block, block.count..block.count + 1, bus).1 == Flow::Trapped {
            execution.trapped = true;
        } else {
            self.state.pc = target;
            self.state.mode = self.mode_after_slot.take().unwrap_or(block.after_slot);
        }
    }

    /// Returns the control flow after an instruction, and records the cause if the instruction has trapped.
    #[inline(always)]
    pub(crate) fn flow(&mut self, done: Result<Flow, TrapCause>) -> Flow {
        done.unwrap_or_else(|cause| self.trapped(cause))
    }

    #[cold]
    fn trapped(&mut self, cause: TrapCause) -> Flow {
        self.cause = Some(cause);
        Flow::Trapped
    }

    /// Executes instructions and pairs of a block until one of them branches or traps. Returns the number of executed
    /// instructions or pairs, and the control flow after the last of them.
    fn units<B: Bus>(&mut self, block: &Block, range: Range<usize>, bus: &mut B) -> (usize, Flow) {
        let actions = &block.actions[range];
        for action in actions {
            let flow = self.unit(action, block, bus);
            if !matches!(flow, Flow::Next) {
                return (usize::from(action.number) + 1, flow);
            }
        }
        (actions.len(), Flow::Next)
    }

    /// Executes an instruction or pair. Both halves of a pair read their operands before either half writes its result.
    /// The core half executes first, so the floating-point half has no effect if the core half traps.
    #[inline(always)]
    fn unit<B: Bus>(&mut self, action: &Action, block: &Block, bus: &mut B) -> Flow {
        let unit = || block.unit(usize::from(action.number));
        let operands = self.read_operands(&action.floating, unit);
        let flow = self.core(&action.core, unit, bus);
        if action.floating.does != Floating::Nothing && !matches!(flow, Flow::Trapped) {
            self.floating(&action.floating, unit, operands);
        }
        flow
    }

    /// Sends a pulse to the interrupt pin. Returns false if interrupts are disabled because psr.IM is clear.
    pub fn interrupt(&mut self) -> bool {
        let enabled = self.state.psr & psr::IM != 0;
        if enabled {
            self.take_trap(TrapCause::Interrupt);
        }
        enabled
    }

    #[cold]
    fn take_trap(&mut self, cause: TrapCause) -> Trap {
        let pc = self.state.pc;
        let old = self.state.psr;
        // Record the cause and the previous mode in psr, and the address in fir, for the handler.
        let bit = match cause {
            TrapCause::InstructionAccess => psr::IAT,
            TrapCause::DataAccess { .. } | TrapCause::Unaligned { .. } => psr::DAT,
            TrapCause::Interrupt => psr::IN,
            _ => psr::IT,
        };
        self.state.set_psr_bit(psr::PU, old & psr::U != 0);
        self.state.set_psr_bit(psr::PIM, old & psr::IM != 0);
        self.state.set_psr_bit(psr::DIM, self.state.mode.is_dual());
        self.state.set_psr_bit(psr::DS, matches!(self.state.mode, Mode::DualOnce | Mode::Entering));
        self.state.psr = self.state.psr & !(psr::U | psr::IM) | bit;
        self.state.fir = pc;
        self.state.mode = Mode::Single;
        self.mode_after_slot = None;
        self.state.pc = TRAP_VECTOR;
        Trap { cause, pc }
    }
}
