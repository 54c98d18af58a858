//! Execution in the graphics unit: integer arithmetic, merging of pixels and depths, and comparison of depths.

use crate::cpu::Cpu;
use crate::instruction::{Flags, Instruction, Op};
use crate::operands::Operands;
use crate::state::PipeStage;

/// Mask and shift of the instruction faddp, for each pixel size psr.PS. The instruction first shifts the register MERGE
/// right by the shift. Then it copies the bits of the sum that the mask selects into MERGE.
const PIXEL_MERGE: [(u64, u32); 3] =
    [(0xFF00_FF00_FF00_FF00, 8), (0xFC00_FC00_FC00_FC00, 6), (0xFF00_0000_FF00_0000, 8)];

/// Compares unsigned depths of `width` bits in `a` and `b`. Returns the smaller depth of each pair, and one bit for
/// each pair. The bit is set if the depth in `b` is not greater than the depth in `a`.
fn z_check(a: u64, b: u64, width: u32) -> (u64, u32) {
    let field = (1u64 << width) - 1;
    let mut result = (0, 0);
    for index in 0..64 / width {
        let x = a >> (index * width) & field;
        let y = b >> (index * width) & field;
        result.0 |= x.min(y) << (index * width);
        result.1 |= u32::from(y <= x) << index;
    }
    result
}

impl Cpu {
    pub(crate) fn graphics(&mut self, i: &Instruction, Operands { a, b }: Operands) {
        let bits = match i.op {
            Op::Fxfr => return self.state.set_r(i.dest, a as u32),
            Op::Fiadd => a.wrapping_add(b),
            Op::Fisub => a.wrapping_sub(b),
            Op::Faddp => self.add_pixels(a, b),
            Op::Faddz => self.add_z(a, b),
            Op::Fzchkl => self.check_z(a, b, 32),
            Op::Fzchks => self.check_z(a, b, 16),
            _ => std::mem::take(&mut self.state.merge) | a,
        };
        // All results are doubles, except the results of fiadd.ss and fisub.ss.
        let double = !matches!(i.op, Op::Fiadd | Op::Fisub) || i.has(Flags::RESULT_DOUBLE);
        self.graphics_result(i, PipeStage { bits, double });
    }

    fn graphics_result(&mut self, i: &Instruction, result: PipeStage) {
        if i.has(Flags::PIPELINED) {
            let leaving = std::mem::replace(&mut self.state.graphics, result);
            self.state.set_f(i.dest, leaving);
        } else {
            self.state.set_f(i.dest, result);
        }
    }

    fn add_pixels(&mut self, a: u64, b: u64) -> u64 {
        let sum = a.wrapping_add(b);
        let (taken, shift) = PIXEL_MERGE[self.state.pixel_size() as usize];
        self.state.merge = self.state.merge >> shift & !taken | sum & taken;
        sum
    }

    fn add_z(&mut self, a: u64, b: u64) -> u64 {
        const TAKEN: u64 = 0xFFFF_0000_FFFF_0000;
        let sum = a.wrapping_add(b);
        self.state.merge = self.state.merge >> 16 & !TAKEN | sum & TAKEN;
        sum
    }

    fn check_z(&mut self, a: u64, b: u64, width: u32) -> u64 {
        let fields = 64 / width;
        let (smaller, passed) = z_check(a, b, width);
        // The new bits enter psr.PM at the upper end, so that PM can collect the bits of several checks.
        let mask = self.state.pixel_mask() >> fields | passed << (8 - fields);
        self.state.set_pixel_mask(mask);
        self.state.merge = 0;
        smaller
    }
}
