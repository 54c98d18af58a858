//! The processor: fetch, pairing, delay slots, traps, and the run loop.

use crate::bus::Bus;
use crate::clock::Clock;
use crate::control::Flow;
use crate::decode::decode;
use crate::decoded::{Decoded, EMPTY};
use crate::floating::read_operands;
use crate::profile::{AddressProfile, Profile};
use crate::seed::SeedTable;
use crate::state::{Mode, State, TRAP_VECTOR, psr};
use crate::timing::Config;
use std::fmt;

/// Why the processor trapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TrapCause {
    /// A word that is no XR instruction.
    Illegal {
        /// The word.
        word: u32,
    },
    /// A pair whose halves are not one floating-point and one core instruction, in this order.
    IllegalPair,
    /// A branch in a delay slot (undefined on the part).
    BranchInSlot,
    /// A jump in dual-instruction mode to an address that is not a multiple of 8 (undefined on the part).
    PairAlignment,
    /// The instruction `trap`.
    Instruction,
    /// `intovr` with OF set.
    Overflow,
    /// Nothing answers the instruction fetch.
    InstructionAccess,
    /// Nothing answers a load or store.
    DataAccess {
        /// Its address.
        address: u32,
    },
    /// An address that is not a multiple of the access size.
    Unaligned {
        /// The address.
        address: u32,
        /// The size in bytes.
        size: u32,
    },
    /// The interrupt pin, while psr.IM is set.
    Interrupt,
}

impl fmt::Display for TrapCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TrapCause::Illegal { word } => write!(f, "{word:08x} is not an i860 XR instruction"),
            TrapCause::IllegalPair => write!(f, "a pair must be one floating-point and one core instruction"),
            TrapCause::BranchInSlot => write!(f, "branch in a delay slot"),
            TrapCause::PairAlignment => write!(f, "dual-instruction mode needs a multiple of 8"),
            TrapCause::Instruction => write!(f, "trap instruction"),
            TrapCause::Overflow => write!(f, "intovr with OF set"),
            TrapCause::InstructionAccess => write!(f, "no memory to fetch an instruction from"),
            TrapCause::DataAccess { address } => write!(f, "no memory at {address:#010x}"),
            TrapCause::Unaligned { address, size } => write!(f, "{address:#010x} is not a multiple of {size}"),
            TrapCause::Interrupt => write!(f, "interrupt"),
        }
    }
}

/// A trap that was taken. The state is that of the part at the first instruction of its handler: fir holds `pc`,
/// psr the trap bit, PU, PIM, DIM and DS, and the next pc is [`TRAP_VECTOR`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trap {
    /// Why.
    pub cause: TrapCause,
    /// Address of the instruction or pair, which had no effect. In a delay slot the branch before it had its
    /// effect on r1, LCC and its counter, as on the part.
    pub pc: u32,
}

impl fmt::Display for Trap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "trap at {:#010x}: {}", self.pc, self.cause)
    }
}

impl std::error::Error for Trap {}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The stop address was reached in single-instruction mode; its instruction was not executed.
    Stopped,
    /// A trap was taken.
    Trapped(Trap),
    /// The number of instructions was used up.
    Exhausted,
}

/// Entries of the cache of decoded instructions (a host matter, not the part's instruction cache).
const DECODED: usize = 1 << 14;

/// An i860 XR.
pub struct Cpu {
    /// What a program can see.
    pub state: State,
    pub(crate) time: Clock,
    pub(crate) seeds: SeedTable,
    /// Mode of the unit after the one in execution.
    pub(crate) next_mode: Mode,
    /// Set by a return from a trap.
    pub(crate) mode_after_slot: Option<Mode>,
    in_slot: bool,
    decoded: Box<[Decoded; DECODED]>,
    /// Lowest and highest address that was ever decoded.
    code: (u32, u32),
    config: Config,
}

impl fmt::Debug for Cpu {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Cpu").field("state", &self.state).field("clocks", &self.clocks()).finish_non_exhaustive()
    }
}

fn empty_decoded() -> Box<[Decoded; DECODED]> {
    let entries = vec![Decoded::empty(); DECODED].into_boxed_slice();
    entries.try_into().unwrap_or_else(|_| unreachable!("the length is that of the array"))
}

impl Cpu {
    /// A processor after reset, at [`TRAP_VECTOR`], with empty caches.
    #[must_use]
    pub fn new(config: Config) -> Cpu {
        Cpu {
            state: State::reset(),
            time: Clock::new(&config),
            seeds: config.seeds,
            next_mode: Mode::Single,
            mode_after_slot: None,
            in_slot: false,
            decoded: empty_decoded(),
            code: (u32::MAX, 0),
            config,
        }
    }

    /// A processor about to execute at `pc`.
    #[must_use]
    pub fn at(config: Config, pc: u32) -> Cpu {
        let mut cpu = Cpu::new(config);
        cpu.state.pc = pc;
        cpu
    }

    /// Back to the state after reset; clocks start from 0 and the caches are empty.
    pub fn reset(&mut self) {
        self.state = State::reset();
        self.time = Clock::new(&self.config);
        (self.next_mode, self.mode_after_slot, self.in_slot) = (Mode::Single, None, false);
        self.invalidate_code();
    }

    /// Clocks since reset (0 without timing).
    #[must_use]
    pub fn clocks(&self) -> u64 {
        self.time.now
    }

    /// Instructions since reset or the last [`Cpu::clear_profile`].
    #[must_use]
    pub fn instructions(&self) -> u64 {
        self.time.profile.instructions
    }

    /// Where the clocks went.
    #[must_use]
    pub fn profile(&self) -> Profile {
        self.time.profile()
    }

    /// Starts a new profile; caches, queues and the clock go on.
    pub fn clear_profile(&mut self) {
        self.time.clear_profile();
    }

    /// Empties the caches and the TLB without writing back, and waits for nothing: a cold start for measurements.
    pub fn empty_caches(&mut self) {
        self.time.empty_caches();
    }

    /// Watches clocks by address from now on (or stops to).
    pub fn watch(&mut self, addresses: Option<AddressProfile>) {
        self.time.sampler = addresses;
    }

    /// What [`Cpu::watch`] has gathered.
    #[must_use]
    pub fn watched(&self) -> Option<&AddressProfile> {
        self.time.sampler.as_ref()
    }

    /// Forgets all decoded instructions. Needed after something other than this processor wrote to code; its own
    /// stores are seen at once (the part would need a flush and dirbase.ITI).
    pub fn invalidate_code(&mut self) {
        self.decoded.fill(Decoded::empty());
        self.code = (u32::MAX, 0);
    }

    #[inline]
    pub(crate) fn forget_code(&mut self, address: u32, size: u32) {
        if address.wrapping_add(size) > self.code.0 && address <= self.code.1 {
            for word in [address & !3, address.wrapping_add(size - 1) & !3] {
                let entry = &mut self.decoded[(word >> 2) as usize % DECODED];
                if entry.tag == word {
                    entry.tag = EMPTY;
                }
            }
        }
    }

    #[inline(always)]
    fn locate<B: Bus>(&mut self, pc: u32, bus: &mut B) -> Result<usize, TrapCause> {
        let at = (pc >> 2) as usize % DECODED;
        if self.decoded[at].tag != pc {
            self.decode_at(pc, bus)?;
        }
        Ok(at)
    }

    #[cold]
    #[inline(never)]
    fn decode_at<B: Bus>(&mut self, pc: u32, bus: &mut B) -> Result<(), TrapCause> {
        let word = bus.read(pc, 4).map_err(|_| TrapCause::InstructionAccess)? as u32;
        let instruction = decode(word).map_err(|e| TrapCause::Illegal { word: e.0 })?;
        let entry = Decoded::new(instruction, pc);
        self.decoded[(pc >> 2) as usize % DECODED] = entry;
        self.code = (self.code.0.min(pc), self.code.1.max(pc | 3));
        Ok(())
    }

    /// Runs until `stop` is reached in single-instruction mode, a trap is taken, or `budget` more instructions have
    /// been executed (a branch and its slot are not parted, so it can be passed by three).
    pub fn run<B: Bus>(&mut self, bus: &mut B, stop: Option<u32>, budget: u64) -> Outcome {
        let end = self.instructions().saturating_add(budget);
        let stop = stop.map_or(u64::MAX, u64::from);
        loop {
            if u64::from(self.state.pc) == stop && self.state.mode == Mode::Single {
                return Outcome::Stopped;
            }
            if self.instructions() >= end {
                return Outcome::Exhausted;
            }
            if let Err(trap) = self.step(bus) {
                return Outcome::Trapped(trap);
            }
        }
    }

    /// Executes one instruction or pair; a delayed branch together with its slot.
    ///
    /// # Errors
    /// The trap that was taken. The next step executes the first instruction of its handler.
    #[inline(always)]
    pub fn step<B: Bus>(&mut self, bus: &mut B) -> Result<(), Trap> {
        match self.unit(bus) {
            Ok(Flow::Next) => Ok(()),
            Ok(Flow::Jump(target)) => {
                self.state.pc = target;
                Ok(())
            }
            Ok(Flow::Skip) => {
                let skipped = if self.state.mode.is_dual() { 8 } else { 4 };
                self.state.pc = self.state.pc.wrapping_add(skipped);
                Ok(())
            }
            Ok(Flow::Delayed(target)) => self.slot(target, bus),
            Err(cause) => Err(self.take_trap(cause)),
        }
    }

    #[inline(never)]
    fn slot<B: Bus>(&mut self, target: u32, bus: &mut B) -> Result<(), Trap> {
        self.in_slot = true;
        let done = self.unit(bus);
        self.in_slot = false;
        done.map_err(|cause| self.take_trap(cause))?;
        self.state.pc = target;
        if let Some(mode) = self.mode_after_slot.take() {
            self.state.mode = mode;
        }
        Ok(())
    }

    #[inline(always)]
    fn unit<B: Bus>(&mut self, bus: &mut B) -> Result<Flow, TrapCause> {
        let (pc, before) = (self.state.pc, self.time.now);
        let flow = if self.state.mode.is_dual() { self.pair(pc, bus)? } else { self.single(pc, bus)? };
        if let Some(sampler) = &mut self.time.sampler {
            sampler.add(pc, self.time.now - before);
        }
        Ok(flow)
    }

    #[inline(always)]
    fn single<B: Bus>(&mut self, pc: u32, bus: &mut B) -> Result<Flow, TrapCause> {
        let d = self.decoded[self.locate(pc, bus)? % DECODED];
        if self.in_slot && d.is_branch() {
            return Err(TrapCause::BranchInSlot);
        }
        self.time.fetch(pc, bus);
        self.time.issue(&d);
        self.next_mode = match (pc & 4 != 0, self.state.mode) {
            (true, Mode::Entering) => Mode::DualOnce,
            (false, _) if d.dual() => Mode::Entering,
            _ => Mode::Single,
        };
        let flow = if d.is_floating() {
            let operands = read_operands(&self.state, &d);
            self.floating(&d.instruction, operands);
            Flow::Next
        } else {
            self.core(&d, pc, bus)?
        };
        self.time.retire(&d);
        self.state.mode = self.next_mode;
        self.state.pc = pc.wrapping_add(4);
        Ok(flow)
    }

    /// A pair: both halves read before either writes, and the core half goes first so that its trap leaves no trace.
    #[inline(always)]
    fn pair<B: Bus>(&mut self, pc: u32, bus: &mut B) -> Result<Flow, TrapCause> {
        if pc & 4 != 0 {
            return Err(TrapCause::PairAlignment);
        }
        let low = self.decoded[self.locate(pc, bus)? % DECODED];
        let high = self.decoded[self.locate(pc.wrapping_add(4), bus)? % DECODED];
        if !low.is_floating() || high.is_floating() && high.instruction.op != crate::Op::Fnop {
            return Err(TrapCause::IllegalPair);
        }
        if self.in_slot && high.is_branch() {
            return Err(TrapCause::BranchInSlot);
        }
        self.time.fetch(pc, bus);
        self.time.issue_pair(&low, &high);
        self.next_mode = self.state.mode.after_pair(low.dual());
        let operands = read_operands(&self.state, &low);
        let flow = if high.is_floating() { Flow::Next } else { self.core(&high, pc.wrapping_add(4), bus)? };
        self.floating(&low.instruction, operands);
        self.time.retire(&low);
        self.time.retire(&high);
        self.state.mode = self.next_mode;
        self.state.pc = pc.wrapping_add(8);
        Ok(flow)
    }

    /// Raises the interrupt pin for one moment; false when psr.IM holds it off.
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
