//! The programmer's model: registers, control registers, pipes, dual-instruction mode.

/// Bits of the processor status register.
pub mod psr {
    /// Break on data read.
    pub const BR: u32 = 1 << 0;
    /// Break on data write.
    pub const BW: u32 = 1 << 1;
    /// CC, the condition code that compares, sums and logicals set.
    pub const CC: u32 = 1 << 2;
    /// Loop condition code, tested by `bla`.
    pub const LCC: u32 = 1 << 3;
    /// Interrupt mode: interrupts enabled.
    pub const IM: u32 = 1 << 4;
    /// IM before the trap.
    pub const PIM: u32 = 1 << 5;
    /// U, set in user mode.
    pub const U: u32 = 1 << 6;
    /// U before the trap.
    pub const PU: u32 = 1 << 7;
    /// IT, set by an instruction trap.
    pub const IT: u32 = 1 << 8;
    /// IN, set by an interrupt.
    pub const IN: u32 = 1 << 9;
    /// IAT, set by an instruction access trap.
    pub const IAT: u32 = 1 << 10;
    /// DAT, set by a data access trap.
    pub const DAT: u32 = 1 << 11;
    /// FT, set by a floating-point trap.
    pub const FT: u32 = 1 << 12;
    /// Delayed switch: the trap came while the mode was about to change.
    pub const DS: u32 = 1 << 13;
    /// The trap came in dual-instruction mode.
    pub const DIM: u32 = 1 << 14;
    /// Kill the next floating-point instruction.
    pub const KNF: u32 = 1 << 15;
    /// Lowest bit of the shift count.
    pub const SC_SHIFT: u32 = 17;
    /// Shift count, five bits.
    pub const SC: u32 = 31 << SC_SHIFT;
    /// Lowest bit of the pixel size.
    pub const PS_SHIFT: u32 = 22;
    /// Pixel size: 0, 1, 2 for 8, 16, 32 bits.
    pub const PS: u32 = 3 << PS_SHIFT;
    /// Lowest bit of the pixel mask.
    pub const PM_SHIFT: u32 = 24;
    /// Pixel mask, eight bits.
    pub const PM: u32 = 0xFF << PM_SHIFT;
    /// The five trap bits.
    pub const TRAPS: u32 = IT | IN | IAT | DAT | FT;
    /// What a program in user mode can write.
    pub const USER: u32 = CC | LCC | SC | PS | PM;
}

/// Bits of the extended processor status register.
pub mod epsr {
    /// IL, set between `lock` and `unlock`.
    pub const IL: u32 = 1 << 13;
    /// OF, set by integer overflow and tested by `intovr`.
    pub const OF: u32 = 1 << 24;
    /// What software can write: WP, PBM, BE, OF. BE is stored but has no effect in this model.
    pub const WRITABLE: u32 = 1 << 14 | 1 << 22 | 1 << 23 | OF;
    /// Type 1 (XR), step 7 (D0), data cache of 2^(12+1) bytes.
    pub const RESET: u32 = 1 | 7 << 8 | 1 << 18;
}

/// Bits of the floating-point status register.
pub mod fsr {
    /// Flush results that underflow to zero.
    pub const FZ: u32 = 1;
    /// Lowest bit of the rounding mode (obeyed by `fix` only).
    pub const RM_SHIFT: u32 = 2;
}

/// Bits of the directory-base register.
pub mod dirbase {
    /// ATE, which turns address translation on.
    pub const ATE: u32 = 1;
    /// BL, which locks the bus.
    pub const BL: u32 = 1 << 4;
    /// Invalidate the TLB and the instruction cache.
    pub const ITI: u32 = 1 << 5;
    /// DTB, address of the page directory.
    pub const DTB: u32 = 0xFFFF_F000;
}

/// A value in a pipe with the precision that it was made with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PipeStage {
    /// Bit pattern; a single occupies the low word.
    pub bits: u64,
    /// Whether it is a double (two registers).
    pub double: bool,
}

/// How instructions are paired at present.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Mode {
    /// One instruction at a time.
    #[default]
    Single,
    /// The second half of a word whose first half had its D bit set.
    Entering,
    /// This pair is dual; the next one only if this one has its D bit set.
    DualOnce,
    /// This pair and the next one are dual.
    Dual,
}

impl Mode {
    /// Whether the next unit of execution is a pair.
    #[must_use]
    pub fn is_dual(self) -> bool {
        matches!(self, Mode::DualOnce | Mode::Dual)
    }

    /// The mode after a pair with this D bit.
    pub(crate) fn after_pair(self, d: bool) -> Mode {
        match (self, d) {
            (Mode::DualOnce, false) => Mode::Single,
            (Mode::Dual, false) => Mode::DualOnce,
            _ => Mode::Dual,
        }
    }
}

/// Everything that a program can see.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    /// Address of the next instruction, or of the next pair.
    pub pc: u32,
    /// Integer registers; `r[0]` stays 0.
    pub r: [u32; 32],
    /// Floating-point registers; `f[0]` and `f[1]` stay 0.
    pub f: [u32; 32],
    /// psr, processor status: the bits of [`psr`].
    pub psr: u32,
    /// epsr, extended processor status: the bits of [`epsr`].
    pub epsr: u32,
    /// fsr, floating-point status: the bits of [`fsr`].
    pub fsr: u32,
    /// dirbase, directory base and cache control: the bits of [`dirbase`].
    pub dirbase: u32,
    /// db, data breakpoint; kept, never compared.
    pub db: u32,
    /// fir, address of the instruction that trapped.
    pub fir: u32,
    /// Constant register KR of the dual operations.
    pub kr: u64,
    /// KI, the second constant of dual operations.
    pub ki: u64,
    /// T, which holds a product for a later addition.
    pub t: u64,
    /// The graphics unit's MERGE.
    pub merge: u64,
    /// Adder pipe, last stage at the end.
    pub adder: [PipeStage; 3],
    /// Multiplier pipe; double-precision operations use the first two stages.
    pub multiplier: [PipeStage; 3],
    /// Load pipe of three stages.
    pub load: [PipeStage; 3],
    /// Graphics pipe, of one stage.
    pub graphics: PipeStage,
    /// Whether instructions issue singly or in pairs.
    pub mode: Mode,
}

/// Where the processor starts, and where every trap goes.
pub const TRAP_VECTOR: u32 = 0xFFFF_FF00;

impl State {
    /// The state after reset: all registers zero, supervisor mode, at [`TRAP_VECTOR`].
    #[must_use]
    pub fn reset() -> State {
        State {
            pc: TRAP_VECTOR,
            r: [0; 32],
            f: [0; 32],
            psr: 0,
            epsr: epsr::RESET,
            fsr: 0,
            dirbase: 0,
            db: 0,
            fir: 0,
            kr: 0,
            ki: 0,
            t: 0,
            merge: 0,
            adder: [PipeStage::default(); 3],
            multiplier: [PipeStage::default(); 3],
            load: [PipeStage::default(); 3],
            graphics: PipeStage::default(),
            mode: Mode::Single,
        }
    }

    #[inline]
    pub(crate) fn set_r(&mut self, n: u8, value: u32) {
        self.r[usize::from(n & 31)] = value;
        self.r[0] = 0;
    }

    #[inline]
    pub(crate) fn r(&self, n: u8) -> u32 {
        self.r[usize::from(n & 31)]
    }

    #[inline]
    pub(crate) fn f32_bits(&self, n: u8) -> u32 {
        self.f[usize::from(n & 31)]
    }

    /// The pair of an even register; an odd number names the pair that it lies in.
    #[inline]
    pub(crate) fn f64_bits(&self, n: u8) -> u64 {
        let low = usize::from(n & 30);
        u64::from(self.f[low + 1]) << 32 | u64::from(self.f[low])
    }

    #[inline]
    pub(crate) fn f_bits(&self, n: u8, double: bool) -> u64 {
        if double { self.f64_bits(n) } else { u64::from(self.f32_bits(n)) }
    }

    #[inline]
    pub(crate) fn set_f32(&mut self, n: u8, value: u32) {
        self.f[usize::from(n & 31)] = value;
        self.f[0] = 0;
        self.f[1] = 0;
    }

    #[inline]
    pub(crate) fn set_f64(&mut self, n: u8, value: u64) {
        let low = usize::from(n & 30);
        self.f[low] = value as u32;
        self.f[low + 1] = (value >> 32) as u32;
        self.f[0] = 0;
        self.f[1] = 0;
    }

    #[inline]
    pub(crate) fn set_f(&mut self, n: u8, value: PipeStage) {
        if value.double { self.set_f64(n, value.bits) } else { self.set_f32(n, value.bits as u32) }
    }

    #[inline]
    pub(crate) fn set_psr_bit(&mut self, bit: u32, on: bool) {
        self.psr = self.psr & !bit | if on { bit } else { 0 };
    }

    #[inline]
    pub(crate) fn set_overflow(&mut self, on: bool) {
        self.epsr = self.epsr & !epsr::OF | if on { epsr::OF } else { 0 };
    }

    pub(crate) fn pixel_mask(&self) -> u32 {
        (self.psr & psr::PM) >> psr::PM_SHIFT
    }

    pub(crate) fn set_pixel_mask(&mut self, mask: u32) {
        self.psr = self.psr & !psr::PM | mask << psr::PM_SHIFT;
    }

    /// psr.PS: 0, 1, 2 for 8, 16, 32 bits; the reserved 3 behaves as 2.
    pub(crate) fn pixel_size(&self) -> u32 {
        ((self.psr & psr::PS) >> psr::PS_SHIFT).min(2)
    }
}
