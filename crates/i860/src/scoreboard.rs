//! Scoreboard: registers that are not ready and units that are busy. The end of each wait is computed at its start.

use crate::decoded::{Decoded, arm, float_mask, hazard};
use crate::freeze::Costs;
use crate::instruction::{Flags, Instruction, Op};
use crate::timing::{Config, FREEZES, Freeze};

/// Value of `last_result` while no result can delay a multiplication. It is not the number of a register, and differs
/// from `NONE`, the number of an absent operand.
const NO_RESULT: u8 = 0xFE;

/// The clock at which a delay ends, and the row of the freeze table that causes the delay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Wait {
    pub(crate) until: u64,
    pub(crate) why: Freeze,
}

pub(crate) const NO_WAIT: Wait = Wait { until: 0, why: Freeze::LoadUse };

/// First value of [`Left::place`] that stands for a hazard instead of a register. The highest value stands for the last
/// floating-point result.
const HAZARDS: u8 = 64;
const LAST_RESULT: u8 = HAZARDS + hazard::COUNT as u8;

/// A remaining wait, packed into 16 bits. The upper seven bits contain the number of the register or hazard that is not
/// ready. The next four bits contain the remaining clocks, and the lower five bits the row of the freeze table.
struct Left {
    place: u8,
    clocks: u8,
    why: Freeze,
}

impl Left {
    const BITS: u32 = 16;
    const CAUSE_BITS: u32 = 5;
    const CLOCK_BITS: u32 = 4;

    fn packed(&self) -> u128 {
        let place = u128::from(self.place) << (Left::CLOCK_BITS + Left::CAUSE_BITS);
        place | u128::from(self.clocks) << Left::CAUSE_BITS | self.why as u128
    }

    fn unpacked(bits: u128) -> Left {
        let low = |bits: u128, n: u32| (bits & ((1 << n) - 1)) as u8;
        Left {
            place: low(bits >> (Left::CLOCK_BITS + Left::CAUSE_BITS), 7),
            clocks: low(bits >> Left::CAUSE_BITS, Left::CLOCK_BITS),
            why: FREEZES[usize::from(low(bits, Left::CAUSE_BITS))].id,
        }
    }
}

const MAX_WAITS: u32 = u128::BITS / Left::BITS;

/// A compact copy of the scoreboard at one clock: all waits that have not ended.
///
/// Two scoreboards with equal pending waits delay all later instructions equally.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct PendingWaits {
    /// Packed waits, sorted by [`Left::place`], with the first wait in the lowest bits. The bits above the last wait
    /// are zero.
    waits: u128,
    graphics_result: u64,
    stored: u64,
    last_result: u8,
    scalar_double: bool,
    /// The instruction-cache line that is still arriving: the number of remaining clocks, and the index of the 8-byte
    /// transfer that arrived first.
    beside: [u8; 2],
}

#[derive(Clone, Debug)]
pub(crate) struct Scoreboard {
    costs: Costs,
    /// Mask of the hazard classes for which at least one row of the freeze table is enabled.
    arms_seen: u16,
    /// Mask of the registers whose value may be unavailable: integer registers in the low word, floating-point
    /// registers in the high word.
    pending: u64,
    ready: [Wait; 64],
    armed: u16,
    hazards: [Wait; hazard::COUNT],
    /// Destination register of the last floating-point instruction. Row 9 of the freeze table delays a multiplication
    /// whose first source is this register.
    last_result: u8,
    last_result_until: u64,
    scalar_double: bool,
    graphics_result: u64,
    stored: u64,
    /// A clock at which all waits in the scoreboard have ended.
    latest: u64,
}

/// Iterates over the indices of the set bits, the lowest first.
fn bits(mut set: u64) -> impl Iterator<Item = u8> {
    std::iter::from_fn(move || {
        let lowest = (set != 0).then(|| set.trailing_zeros() as u8);
        set &= set.wrapping_sub(1);
        lowest
    })
}

impl Scoreboard {
    pub(crate) fn new(config: &Config) -> Scoreboard {
        Scoreboard {
            costs: Costs::new(&config.freezes),
            arms_seen: if config.freezes.logicals_delay_branches { !0 } else { !arm::LOGICAL },
            pending: 0,
            ready: [NO_WAIT; 64],
            armed: 0,
            hazards: [NO_WAIT; hazard::COUNT],
            last_result: NO_RESULT,
            last_result_until: 0,
            scalar_double: false,
            graphics_result: 0,
            stored: 0,
            latest: 0,
        }
    }

    /// Returns the waits that remain at clock `now`. `beside` describes the arriving instruction-cache line. Returns
    /// `None` if there are too many waits, or if a wait lasts longer than `most` clocks.
    pub(crate) fn leftover(&self, now: u64, most: u8, beside: [u8; 2]) -> Option<PendingWaits> {
        if self.latest > now + u64::from(most) {
            return None;
        }
        let mut left = PendingWaits {
            waits: 0,
            last_result: NO_RESULT,
            scalar_double: false,
            graphics_result: 0,
            stored: 0,
            beside,
        };
        let mut count = 0;
        // Pack each wait that has not ended.
        let mut add = |place: u8, wait: Wait| {
            let is_left = wait.until > now;
            if is_left && count < MAX_WAITS {
                let wait = Left { place, clocks: (wait.until - now) as u8, why: wait.why };
                left.waits |= wait.packed() << (count * Left::BITS);
            }
            count += u32::from(is_left);
            is_left
        };
        // Collect registers, hazards and the last result in the order of [`Left::place`].
        for n in bits(self.pending) {
            add(n, self.ready[usize::from(n)]);
        }
        for n in bits(u64::from(self.armed)) {
            let is_left = add(HAZARDS + n, self.hazards[usize::from(n)]);
            match 1u16 << n {
                hazard::SCALAR if is_left => left.scalar_double = self.scalar_double,
                hazard::GRAPHICS if is_left => left.graphics_result = self.graphics_result,
                hazard::STORED if is_left => left.stored = self.stored,
                _ => {}
            }
        }
        if add(LAST_RESULT, Wait { until: self.last_result_until, why: Freeze::MultiplierFirstSource }) {
            left.last_result = self.last_result;
        }
        (count <= MAX_WAITS).then_some(left)
    }

    pub(crate) fn restore(&mut self, left: &PendingWaits, now: u64) {
        self.pending = 0;
        self.armed = 0;
        self.latest = 0;
        self.last_result_until = 0;
        self.last_result = left.last_result;
        self.scalar_double = left.scalar_double;
        self.graphics_result = left.graphics_result;
        self.stored = left.stored;
        // Unpack the waits and store each one as a register, a hazard or the last result.
        let mut waits = left.waits;
        while waits != 0 {
            let Left { place, clocks, why } = Left::unpacked(waits);
            waits >>= Left::BITS;
            let wait = Wait { until: now + u64::from(clocks), why };
            self.latest = self.latest.max(wait.until);
            match place {
                LAST_RESULT => self.last_result_until = wait.until,
                n if n < HAZARDS => {
                    self.pending |= 1 << n;
                    self.ready[usize::from(n)] = wait;
                }
                n => {
                    self.armed |= 1 << (n - HAZARDS);
                    self.hazards[usize::from(n - HAZARDS)] = wait;
                }
            }
        }
    }

    /// Removes the wait for an integer register, because a new load overwrites the register.
    #[inline]
    pub(crate) fn release(&mut self, dest: u8) {
        self.pending &= !(1 << dest);
    }

    /// Returns true if a wait can delay the instruction `d`. The caller must then call [`Scoreboard::wait`] for the
    /// length of the wait.
    #[inline]
    pub(crate) fn may_wait(&self, d: &Decoded) -> bool {
        d.reads & self.pending != 0 || d.sensitive & self.armed != 0 || d.multiplier_source == self.last_result
    }

    /// Returns the longest wait that delays the instruction `d`, and removes hazards that have ended.
    pub(crate) fn wait(&mut self, d: &Decoded, now: u64) -> Wait {
        let mut longest = self.wait_for_registers(d.reads, now);
        let mut bits = d.sensitive & self.armed;
        // Find the longest wait among the hazards that can delay the instruction.
        while bits != 0 {
            let n = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let wait = self.wait_for_hazard(n, d, now);
            if wait.until > longest.until {
                longest = wait;
            }
        }
        if d.multiplier_source == self.last_result && self.last_result_until > longest.until {
            longest = Wait { until: self.last_result_until, why: Freeze::MultiplierFirstSource };
        }
        longest
    }

    fn wait_for_registers(&mut self, reads: u64, now: u64) -> Wait {
        let mut longest = NO_WAIT;
        let mut bits = reads & self.pending;
        while bits != 0 {
            let wait = self.ready[bits.trailing_zeros() as usize];
            if wait.until <= now {
                self.pending &= !(bits & bits.wrapping_neg());
            } else if wait.until > longest.until {
                longest = wait;
            }
            bits &= bits - 1;
        }
        longest
    }

    fn wait_for_hazard(&mut self, n: usize, d: &Decoded, now: u64) -> Wait {
        let wait = self.hazards[n];
        if wait.until <= now {
            self.armed &= !(1 << n);
            return NO_WAIT;
        }
        match 1u16 << n {
            hazard::SCALAR => self.wait_after_scalar(wait, &d.instruction),
            hazard::GRAPHICS => self.wait_after_graphics(wait, d),
            hazard::STORED => self.wait_after_store(wait, &d.instruction),
            _ => wait,
        }
    }

    fn wait_after_scalar(&self, mut wait: Wait, i: &Instruction) -> Wait {
        let floating = i.is_floating() && i.op != Op::Fxfr;
        if floating && i.has(Flags::SOURCE_DOUBLE) != self.scalar_double {
            wait.until += self.costs.clocks(Freeze::ScalarPrecisionChange);
        }
        let pipelined = i.op == Op::DualOp || i.is_floating() && i.has(Flags::PIPELINED);
        if pipelined && i.dest >= 2 {
            wait.until += self.costs.clocks(Freeze::ScalarThenPipelined);
        }
        wait
    }

    fn wait_after_graphics(&self, wait: Wait, d: &Decoded) -> Wait {
        let why = if d.instruction.uses_graphics() { Freeze::GraphicsToGraphics } else { Freeze::GraphicsToFloating };
        if d.reads & self.graphics_result == 0 {
            return NO_WAIT;
        }
        Wait { until: wait.until - 1 + self.costs.clocks(why), why }
    }

    fn wait_after_store(&self, wait: Wait, i: &Instruction) -> Wait {
        let bytes = if i.has(Flags::RESULT_DOUBLE) { 8 } else { 4 };
        if float_mask(i.dest, bytes) & self.stored == 0 || i.dest < 2 { NO_WAIT } else { wait }
    }

    // ---- hazards that an instruction leaves

    #[inline]
    pub(crate) fn retire(&mut self, d: &Decoded, now: u64) {
        match d.arms & self.arms_seen {
            0 => {}
            arm::CONDITION => self.set_hazard(hazard::CONDITION, Freeze::ConditionUse, now),
            arm::FLOATING_RESULT => self.note_result(&d.instruction, now),
            _ => self.arm(d, now),
        }
    }

    #[inline]
    fn note_result(&mut self, i: &Instruction, now: u64) {
        self.last_result = if i.has(Flags::RESULT_DOUBLE) { i.dest & 30 } else { i.dest };
        self.last_result_until = now + self.costs.clocks(Freeze::MultiplierFirstSource);
        self.latest = self.latest.max(self.last_result_until);
    }

    fn arm(&mut self, d: &Decoded, now: u64) {
        let i = &d.instruction;
        // Row 9 needs only the result of the last floating-point instruction.
        if d.arms & arm::FLOATING_RESULT != 0 {
            self.note_result(i, now);
        } else if d.is_floating() && i.op != Op::Fnop {
            self.last_result = NO_RESULT;
        }
        if d.arms & (arm::LOAD | arm::LONG_LOAD | arm::SEED) != 0 {
            self.arm_destination(d, now);
        }
        if d.arms & (arm::SCALAR | arm::SCALAR_DOUBLE_MULTIPLY) != 0 {
            self.arm_scalar(d, now);
        }
        self.arm_short(d, now);
    }

    #[inline]
    pub(crate) fn set_hazard(&mut self, bit: u16, why: Freeze, now: u64) {
        self.set_hazard_until(bit, now + self.costs.clocks(why), why);
    }

    #[inline]
    pub(crate) fn set_hazard_until(&mut self, bit: u16, until: u64, why: Freeze) {
        self.armed |= bit;
        self.latest = self.latest.max(until);
        // A new hazard of a kind replaces the old one.
        self.hazards[bit.trailing_zeros() as usize] = Wait { until, why };
    }

    pub(crate) fn set_ready(&mut self, mask: u64, until: u64, why: Freeze) {
        let mut bits = mask & !(1 | 3 << 32);
        self.pending |= bits;
        self.latest = self.latest.max(until);
        while bits != 0 {
            self.ready[bits.trailing_zeros() as usize] = Wait { until, why };
            bits &= bits - 1;
        }
    }

    // Marks the destination of a load or seed as not ready. A longer wait because of a cache miss remains.
    fn arm_destination(&mut self, d: &Decoded, now: u64) {
        let i = &d.instruction;
        // The row depends on the kind of the result.
        let (mask, why) = match i.op {
            Op::Call | Op::Calli => (1 << 1, Freeze::LoadUse),
            Op::LdB | Op::LdS | Op::LdL | Op::LdC | Op::Fxfr => (1 << i.dest, Freeze::LoadUse),
            Op::Frcp | Op::Frsqr => {
                let bytes = if i.has(Flags::RESULT_DOUBLE) { 8 } else { 4 };
                (float_mask(i.dest, bytes), Freeze::SeedUse)
            }
            _ => (float_mask(i.dest, i.size.max(4)), Freeze::FloatingLoadUse),
        };
        let until = now + self.costs.clocks(why);
        // The data of a load that missed the cache are ready later than row 6 requires.
        let missed = mask & self.pending != 0 && self.ready[mask.trailing_zeros() as usize].until > until;
        if !(missed && why == Freeze::LoadUse) {
            self.set_ready(mask, until, why);
        }
    }

    fn arm_scalar(&mut self, d: &Decoded, now: u64) {
        let long = d.arms & arm::SCALAR_DOUBLE_MULTIPLY != 0;
        let why = if long { Freeze::ScalarDoubleMultiplyBusy } else { Freeze::ScalarBusy };
        self.scalar_double = d.instruction.has(Flags::RESULT_DOUBLE);
        self.set_hazard(hazard::SCALAR, why, now);
    }

    fn arm_short(&mut self, d: &Decoded, now: u64) {
        let logical = d.arms & arm::LOGICAL != 0 && self.costs.logicals_delay_branches;
        if d.arms & arm::CONDITION != 0 || logical {
            self.set_hazard(hazard::CONDITION, Freeze::ConditionUse, now);
        }
        if d.arms & arm::DOUBLE_MULTIPLY != 0 {
            self.set_hazard(hazard::DOUBLE_MULTIPLY, Freeze::DoubleMultiply, now);
        }
        // Floating-point units cannot use a result of the graphics unit in the next clock. Registers f0 and f1 hold no
        // results.
        if d.arms & arm::GRAPHICS != 0 {
            self.graphics_result = float_mask(d.instruction.dest, 8) & !(3 << 32);
            self.set_hazard_until(hazard::GRAPHICS, now + 1, Freeze::GraphicsToFloating);
        }
        if d.arms & arm::FLUSH != 0 {
            self.set_hazard(hazard::FLUSH, Freeze::FlushAfterFlush, now);
        }
        if d.arms & arm::STORED != 0 {
            self.stored = float_mask(d.instruction.dest, d.instruction.size);
            self.set_hazard(hazard::STORED, Freeze::StoreThenOverwrite, now);
        }
    }
}
