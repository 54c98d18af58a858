//! Execution of integer instructions: arithmetic, logical operations, shifts, and writes of control registers.

use crate::action::CoreAction;
use crate::cpu::Cpu;
use crate::instruction::Op;
use crate::state::{dirbase, epsr, psr};

impl Cpu {
    #[inline(always)]
    pub(crate) fn integer(&mut self, action: &CoreAction) {
        let a = action.immediate.wrapping_add(self.state.r(action.first));
        let b = self.state.r(action.second);
        let result = match action.op {
            Op::Addu => self.add_unsigned(a, b),
            Op::Subu => self.subtract_unsigned(a, b),
            Op::Adds => self.add_signed(a, b),
            Op::Subs => self.subtract_signed(a, b),
            Op::Shl => b << (a & 31),
            Op::Shr => self.shift_right(a, b),
            Op::Shrd => ((u64::from(a) << 32 | u64::from(b)) >> self.shift_count()) as u32,
            Op::Shra => (b as i32 >> (a & 31)) as u32,
            _ => self.logical(action.op, a, b),
        };
        self.state.set_r(action.dest, result);
    }

    #[inline]
    fn logical(&mut self, op: Op, a: u32, b: u32) -> u32 {
        let result = match op {
            Op::And => a & b,
            Op::Andh => a << 16 & b,
            Op::Andnot => !a & b,
            Op::Andnoth => !(a << 16) & b,
            Op::Or => a | b,
            Op::Orh => a << 16 | b,
            Op::Xor => a ^ b,
            _ => a << 16 ^ b,
        };
        self.state.set_psr_bit(psr::CC, result == 0);
        result
    }

    #[inline]
    fn add_unsigned(&mut self, a: u32, b: u32) -> u32 {
        let (sum, carry) = a.overflowing_add(b);
        self.state.set_psr_bit(psr::CC, carry);
        self.state.set_overflow(carry);
        sum
    }

    #[inline]
    fn subtract_unsigned(&mut self, a: u32, b: u32) -> u32 {
        let no_borrow = b <= a;
        self.state.set_psr_bit(psr::CC, no_borrow);
        self.state.set_overflow(!no_borrow);
        a.wrapping_sub(b)
    }

    #[inline]
    fn add_signed(&mut self, a: u32, b: u32) -> u32 {
        let (sum, overflow) = (a as i32).overflowing_add(b as i32);
        let negative = i64::from(a as i32) + i64::from(b as i32) < 0;
        self.state.set_psr_bit(psr::CC, negative);
        self.state.set_overflow(overflow);
        sum as u32
    }

    #[inline]
    fn subtract_signed(&mut self, a: u32, b: u32) -> u32 {
        let (difference, overflow) = (a as i32).overflowing_sub(b as i32);
        self.state.set_psr_bit(psr::CC, b as i32 > a as i32);
        self.state.set_overflow(overflow);
        difference as u32
    }

    fn shift_count(&self) -> u32 {
        (self.state.psr & psr::SC) >> psr::SC_SHIFT
    }

    #[inline]
    fn shift_right(&mut self, a: u32, b: u32) -> u32 {
        self.state.psr = self.state.psr & !psr::SC | (a & 31) << psr::SC_SHIFT;
        b >> (a & 31)
    }

    pub(crate) fn read_control(&self, register: u8) -> u32 {
        match register {
            0 => self.state.fir,
            1 => self.state.psr,
            2 => self.state.dirbase,
            3 => self.state.db,
            4 => self.state.fsr,
            _ => self.state.epsr,
        }
    }

    /// Writes a control register. In user mode, only fsr, epsr.OF and the user bits of psr can change.
    pub(crate) fn write_control(&mut self, register: u8, value: u32) {
        // In user mode, a program can change only a part of the bits.
        let user = self.state.psr & psr::U != 0;
        match register {
            1 => self.state.psr = merge(self.state.psr, value, if user { psr::USER } else { !0 }),
            4 => self.state.fsr = value,
            5 => self.state.epsr = merge(self.state.epsr, value, if user { epsr::OF } else { epsr::WRITABLE }),
            _ if user => {}
            0 => self.state.fir = value,
            2 => self.write_directory_base(value),
            _ => self.state.db = value,
        }
    }

    fn write_directory_base(&mut self, value: u32) {
        self.state.dirbase = value & !dirbase::ITI;
        self.directory_base = Some(value);
    }

    /// Applies a new value of the directory-base register to the caches and to address translation. The caller has
    /// already counted the clocks of the instruction.
    #[cold]
    pub(crate) fn apply_directory_base(&mut self, value: u32) {
        if value & dirbase::ITI != 0 {
            self.code_changed = true;
            self.time.invalidate_instruction_cache();
        }
        let directory = value & dirbase::DTB;
        self.time.set_translation((value & dirbase::ATE != 0).then_some(directory));
    }

    pub(crate) fn set_lock(&mut self, on: bool) {
        let il = if on { epsr::IL } else { 0 };
        let bl = if on { dirbase::BL } else { 0 };
        self.state.epsr = self.state.epsr & !epsr::IL | il;
        self.state.dirbase = self.state.dirbase & !dirbase::BL | bl;
    }
}

/// Returns the bits of `new` where `mask` is set, and the bits of `old` elsewhere.
fn merge(old: u32, new: u32, mask: u32) -> u32 {
    old & !mask | new & mask
}
