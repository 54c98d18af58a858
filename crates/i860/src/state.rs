//! State that is visible to a program: registers, control registers, pipes and dual-instruction mode.

/// Bits of the processor status register, psr.
pub mod psr {
    /// BR: break on data read.
    pub const BR: u32 = 1 << 0;
    /// BW: break on data write.
    pub const BW: u32 = 1 << 1;
    /// CC: condition code, set by compares, additions, subtractions and logical operations.
    pub const CC: u32 = 1 << 2;
    /// LCC: loop condition code, tested by `bla`.
    pub const LCC: u32 = 1 << 3;
    /// IM: interrupt mode. Interrupts are enabled while this bit is set.
    pub const IM: u32 = 1 << 4;
    /// PIM: value of IM before the trap.
    pub const PIM: u32 = 1 << 5;
    /// U: set in user mode, clear in supervisor mode.
    pub const U: u32 = 1 << 6;
    /// PU: value of U before the trap.
    pub const PU: u32 = 1 << 7;
    /// IT: set by an instruction trap.
    pub const IT: u32 = 1 << 8;
    /// IN: set by an interrupt.
    pub const IN: u32 = 1 << 9;
    /// IAT: set by an instruction access trap.
    pub const IAT: u32 = 1 << 10;
    /// DAT: set by a data access trap.
    pub const DAT: u32 = 1 << 11;
    /// FT: set by a floating-point trap.
    pub const FT: u32 = 1 << 12;
    /// DS, delayed switch: the trap occurred when dual-instruction mode was about to begin or end.
    pub const DS: u32 = 1 << 13;
    /// DIM: the trap occurred in dual-instruction mode.
    pub const DIM: u32 = 1 << 14;
    /// KNF (kill next): skip the next floating-point instruction. The model ignores this bit.
    pub const KNF: u32 = 1 << 15;
    /// Index, in psr, of the lowest bit of SC, the shift count.
    pub const SC_SHIFT: u32 = 17;
    /// SC: shift count of `shrd`, five bits.
    pub const SC: u32 = 31 << SC_SHIFT;
    /// Index, in psr, of the lowest bit of PS, the pixel size.
    pub const PS_SHIFT: u32 = 22;
    /// PS: pixel size. The values 0, 1, 2 stand for 8, 16, 32 bits.
    pub const PS: u32 = 3 << PS_SHIFT;
    /// Index, in psr, of the lowest bit of PM, the pixel mask.
    pub const PM_SHIFT: u32 = 24;
    /// PM: pixel mask, eight bits. `pst` stores only pixels whose bits are set.
    pub const PM: u32 = 0xFF << PM_SHIFT;
    /// All bits that give the cause of a trap.
    pub const TRAPS: u32 = IT | IN | IAT | DAT | FT;
    /// Bits that a program can write in user mode.
    pub const USER: u32 = CC | LCC | SC | PS | PM;
}

/// Bits of the extended processor status register, epsr.
pub mod epsr {
    /// IL: set between `lock` and `unlock`.
    pub const IL: u32 = 1 << 13;
    /// OF: set by integer overflow and tested by `intovr`.
    pub const OF: u32 = 1 << 24;
    /// Bits that a program can write: WP, PBM, BE, OF. BE is stored but has no effect in this model.
    pub const WRITABLE: u32 = 1 << 14 | 1 << 22 | 1 << 23 | OF;
    /// Value after reset: type 1 (XR), step 7 (D0), data cache of 2^(12+1) bytes.
    pub const RESET: u32 = 1 | 7 << 8 | 1 << 18;
}

/// Bits of the floating-point status register, fsr.
pub mod fsr {
    /// FZ: flush to zero. Results that underflow become zero.
    pub const FZ: u32 = 1;
    /// Index, in fsr, of the lowest bit of RM, the rounding mode. In this model, only `fix` uses RM.
    pub const RM_SHIFT: u32 = 2;
}

/// Bits of the directory-base register, dirbase.
pub mod dirbase {
    /// ATE: turns address translation on.
    pub const ATE: u32 = 1;
    /// BL: locks the bus while the bit is set.
    pub const BL: u32 = 1 << 4;
    /// ITI: writing 1 invalidates the TLB and the instruction cache.
    pub const ITI: u32 = 1 << 5;
    /// DTB: the upper 20 bits of the address of the page directory.
    pub const DTB: u32 = 0xFFFF_F000;
}

/// A value in one stage of a pipe, with its precision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PipeStage {
    /// Bit pattern of the value. A single-precision value is in the low word.
    pub bits: u64,
    /// True if the value is in double precision and occupies two registers.
    pub double: bool,
}

/// Pairing mode: decides if the next instructions execute alone or as pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Mode {
    /// Instructions execute one at a time.
    #[default]
    Single,
    /// The next instruction executes alone, and pairs begin after it. This mode follows an instruction in the lower
    /// half of 8 aligned bytes whose D bit is set.
    Entering,
    /// The next two instructions form a pair. Another pair follows only if this pair has its D bit set. This mode
    /// belongs to the first and the last pair of dual-instruction mode.
    DualOnce,
    /// The next two instructions form a pair, and another pair follows.
    Dual,
}

impl Mode {
    /// Returns true if the next two instructions form a pair.
    pub fn is_dual(self) -> bool {
        matches!(self, Mode::DualOnce | Mode::Dual)
    }

    pub(crate) fn after_pair(self, d: bool) -> Mode {
        match (self, d) {
            (Mode::DualOnce, false) => Mode::Single,
            (Mode::Dual, false) => Mode::DualOnce,
            _ => Mode::Dual,
        }
    }
}

/// The complete state that is visible to a program: registers, pipes and pairing mode.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    /// Address of the next instruction or pair.
    pub pc: u32,
    /// Integer registers. `r[0]` stays 0.
    pub r: [u32; 32],
    /// Floating-point registers. `f[0]` and `f[1]` stay 0.
    pub f: [u32; 32],
    /// psr, the processor status, with the bits in [`psr`].
    pub psr: u32,
    /// epsr, the extended processor status, with the bits in [`epsr`].
    pub epsr: u32,
    /// fsr, the floating-point status, with the bits in [`fsr`].
    pub fsr: u32,
    /// dirbase, the directory base and cache control, with the bits in [`dirbase`].
    pub dirbase: u32,
    /// db, the data breakpoint. The model stores it, but never compares it with addresses.
    pub db: u32,
    /// fir, the address of the instruction that trapped.
    pub fir: u32,
    /// KR, the first constant register of dual operations.
    pub kr: u64,
    /// KI, the second constant register of dual operations.
    pub ki: u64,
    /// T, the register that holds a product until a later dual operation adds it.
    pub t: u64,
    /// MERGE, the register in which the graphics unit collects pixels or depths.
    pub merge: u64,
    /// Pipe of the adder. The value in the last stage leaves the pipe at the next push.
    pub adder: [PipeStage; 3],
    /// Pipe of the multiplier. Double-precision operations use only the first two stages.
    pub multiplier: [PipeStage; 3],
    /// Pipe of the pipelined loads (`pfld`).
    pub load: [PipeStage; 3],
    pub graphics: PipeStage,
    pub mode: Mode,
}

/// Address of the first instruction after reset, and of the trap handler.
pub const TRAP_VECTOR: u32 = 0xFFFF_FF00;

impl State {
    /// Returns the state after reset: all registers are zero, the processor is in supervisor mode, and the next
    /// instruction is at [`TRAP_VECTOR`].
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

    /// Returns the bits of the register pair that contains floating-point register `n`.
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

    pub(crate) fn pixel_size(&self) -> u32 {
        ((self.psr & psr::PS) >> psr::PS_SHIFT).min(2)
    }
}
