//! Execution of floating-point instructions: adder, multiplier, their pipes, and the dual operations.

use crate::action::{Floating, FloatingAction};
use crate::arithmetic::{Operation, convert, double, multiply_low, narrow, operate, round, single, to_integer, widen};
use crate::block::Unit;
use crate::cpu::Cpu;
use crate::dual_operation::{MULTIPLIER_ROUTES, ROUTES, Route, Source};
use crate::instruction::{Flags, Instruction, Op};
use crate::operands::{Operands, last_product};
use crate::state::{PipeStage, State, fsr, psr};

impl Cpu {
    /// Executes a floating-point instruction, alone or in a pair. `from` holds the values of the operands.
    #[inline(always)]
    pub(crate) fn floating<'a>(&mut self, action: &FloatingAction, unit: impl Fn() -> &'a Unit, from: Operands) {
        use Operation::{Add, Multiply, Subtract};
        match action.does {
            Floating::PipelinedMultiply => self.pipelined_single(Multiply, action, from),
            Floating::PipelinedAdd => self.pipelined_single(Add, action, from),
            Floating::PipelinedSubtract => self.pipelined_single(Subtract, action, from),
            Floating::PipelinedMultiplyDoubles => self.pipelined_double(Multiply, action, from),
            Floating::PipelinedAddDoubles => self.pipelined_double(Add, action, from),
            Floating::PipelinedSubtractDoubles => self.pipelined_double(Subtract, action, from),
            Floating::MultiplyDoubles => self.scalar_double(Multiply, action, from),
            Floating::AddDoubles => self.scalar_double(Add, action, from),
            Floating::SubtractDoubles => self.scalar_double(Subtract, action, from),
            Floating::Multiply => self.scalar_single(Multiply, action, from),
            Floating::Add => self.scalar_single(Add, action, from),
            Floating::Subtract => self.scalar_single(Subtract, action, from),
            Floating::Nothing => {}
            Floating::Singles | Floating::Doubles | Floating::Any => {
                // The remaining kinds read their operation from the instruction.
                self.by_instruction(&unit().first.instruction, from);
            }
        }
    }

    #[inline(always)]
    fn pipelined_single(&mut self, operation: Operation, action: &FloatingAction, from: Operands) {
        let result = PipeStage { bits: u64::from(self.single(operation, from)), double: false };
        // The destination receives the oldest result, and the new result enters the pipe.
        let leaving = push(self.pipe_of(operation), 2, result);
        self.state.set_f(action.dest, leaving);
    }

    #[inline(always)]
    fn pipelined_double(&mut self, operation: Operation, action: &FloatingAction, from: Operands) {
        let bits = self.double(operation, from);
        // For doubles, the multiplier has two stages and the adder has three stages.
        let last = if operation == Operation::Multiply { 1 } else { 2 };
        let leaving = push(self.pipe_of(operation), last, PipeStage { bits, double: true });
        self.state.set_f(action.dest, leaving);
    }

    #[inline(always)]
    fn scalar_double(&mut self, operation: Operation, action: &FloatingAction, from: Operands) {
        let bits = self.double(operation, from);
        lose(self.pipe_of(operation));
        self.state.set_f64(action.dest, bits);
    }

    #[inline(always)]
    fn double(&self, operation: Operation, Operands { a, b }: Operands) -> u64 {
        double(operation, f64::from_bits(a), f64::from_bits(b), self.flush_to_zero())
    }

    #[inline(always)]
    fn scalar_single(&mut self, operation: Operation, action: &FloatingAction, from: Operands) {
        let bits = self.single(operation, from);
        lose(self.pipe_of(operation));
        self.state.set_f32(action.dest, bits);
    }

    #[inline(always)]
    fn single(&self, operation: Operation, Operands { a, b }: Operands) -> u32 {
        single(operation, f32::from_bits(a as u32), f32::from_bits(b as u32), self.flush_to_zero())
    }

    #[inline(always)]
    fn pipe_of(&mut self, operation: Operation) -> &mut [PipeStage; 3] {
        let State { multiplier, adder, .. } = &mut self.state;
        if operation == Operation::Multiply { multiplier } else { adder }
    }

    fn by_instruction(&mut self, i: &Instruction, from: Operands) {
        match i.op {
            Op::Fnop => {}
            Op::DualOp => self.dual_operation(i, from),
            Op::Fmul => self.multiply(i, from),
            Op::Fmul3 => self.multiply_three_stages(i, from),
            Op::Fadd => self.add(i, Operation::Add, from),
            Op::Fsub => self.add(i, Operation::Subtract, from),
            Op::Pfgt | Op::Pfle | Op::Pfeq => self.compare(i, from),
            Op::Fmlow => self.multiply_low(i, from),
            Op::Frcp | Op::Frsqr => self.seed(i, from.b),
            Op::Fix | Op::Ftrunc => self.integer_part(i, from.a),
            Op::Famov => self.adder_move(i, from.a),
            _ => self.graphics(i, from),
        }
    }

    #[inline]
    fn flush_to_zero(&self) -> bool {
        self.state.fsr & fsr::FZ != 0
    }

    #[inline]
    fn multiply(&mut self, i: &Instruction, Operands { a, b }: Operands) {
        let s = i.has(Flags::SOURCE_DOUBLE);
        let r = i.has(Flags::RESULT_DOUBLE);
        let product = operate(Operation::Multiply, a, b, s, r, self.flush_to_zero());
        if i.has(Flags::PIPELINED) {
            self.state.set_f(i.dest, last_product(&self.state, s));
            self.push_product(product);
        } else {
            lose(&mut self.state.multiplier);
            self.state.set_f(i.dest, product);
        }
    }

    fn multiply_three_stages(&mut self, i: &Instruction, from: Operands) {
        let bits = self.double(Operation::Multiply, from);
        let leaving = push(&mut self.state.multiplier, 2, PipeStage { bits, double: true });
        self.state.set_f(i.dest, leaving);
    }

    fn multiply_low(&mut self, i: &Instruction, Operands { a, b }: Operands) {
        lose(&mut self.state.multiplier);
        self.state.set_f64(i.dest, multiply_low(a, b));
    }

    #[inline]
    fn push_product(&mut self, product: PipeStage) {
        push(&mut self.state.multiplier, 2, product);
    }

    #[inline]
    fn push_sum(&mut self, sum: PipeStage) {
        push(&mut self.state.adder, 2, sum);
    }

    /// Writes a scalar result of the adder to its register, or pushes a pipelined result into the adder's pipe.
    #[inline]
    fn adder_result(&mut self, i: &Instruction, result: PipeStage) {
        if i.has(Flags::PIPELINED) {
            self.state.set_f(i.dest, self.state.adder[2]);
            self.push_sum(result);
        } else {
            lose(&mut self.state.adder);
            self.state.set_f(i.dest, result);
        }
    }

    #[inline]
    fn add(&mut self, i: &Instruction, operation: Operation, Operands { a, b }: Operands) {
        let s = i.has(Flags::SOURCE_DOUBLE);
        let r = i.has(Flags::RESULT_DOUBLE);
        let sum = operate(operation, a, b, s, r, self.flush_to_zero());
        self.adder_result(i, sum);
    }

    /// Compares two operands and sets the condition code CC. The real chip also pushes an undefined value into the
    /// adder's pipe. This model pushes zero.
    fn compare(&mut self, i: &Instruction, Operands { a, b }: Operands) {
        let double = i.has(Flags::SOURCE_DOUBLE);
        let x = number(a, double);
        let y = number(b, double);
        let condition = match i.op {
            Op::Pfgt => x > y,
            Op::Pfeq => x == y,
            _ => x.partial_cmp(&y).is_none_or(std::cmp::Ordering::is_gt),
        };
        self.state.set_psr_bit(psr::CC, condition);
        self.adder_result(i, PipeStage { bits: 0, double });
    }

    fn seed(&mut self, i: &Instruction, x: u64) {
        let s = i.has(Flags::SOURCE_DOUBLE);
        let r = i.has(Flags::RESULT_DOUBLE);
        let x = if s { x } else { widen(x as u32) };
        let y = match i.op {
            Op::Frcp => self.seeds.reciprocal(x),
            _ => self.seeds.reciprocal_root(x),
        };
        let bits = if r { y } else { u64::from(narrow(y, self.flush_to_zero())) };
        // A seed (first approximation) goes through the multiplier and destroys its results.
        lose(&mut self.state.multiplier);
        self.state.set_f(i.dest, PipeStage { bits, double: r });
    }

    /// Converts a floating-point value to an integer. The high word of the result is undefined on the real chip. In
    /// this model, `fix` clears it, and scalar `ftrunc` leaves the old high word.
    fn integer_part(&mut self, i: &Instruction, x: u64) {
        let wide = if i.has(Flags::SOURCE_DOUBLE) { x } else { widen(x as u32) };
        let mode = if i.op == Op::Fix { self.state.fsr >> fsr::RM_SHIFT & 3 } else { 3 };
        let bits = u64::from(to_integer(round(f64::from_bits(wide), mode)));
        let whole_pair = i.op == Op::Fix || i.has(Flags::PIPELINED);
        self.adder_result(i, PipeStage { bits, double: whole_pair && i.has(Flags::RESULT_DOUBLE) });
    }

    fn adder_move(&mut self, i: &Instruction, x: u64) {
        let s = i.has(Flags::SOURCE_DOUBLE);
        let r = i.has(Flags::RESULT_DOUBLE);
        let bits = convert(PipeStage { bits: x, double: s }, r, self.flush_to_zero());
        self.adder_result(i, PipeStage { bits, double: r });
    }

    /// Executes pfam, pfsm, pfmam or pfmsm. The registers K and T are read before they receive new values.
    fn dual_operation(&mut self, i: &Instruction, from: Operands) {
        let s = i.has(Flags::SOURCE_DOUBLE);
        let r = i.has(Flags::RESULT_DOUBLE);
        let pipelined = i.has(Flags::PIPELINED);
        let route = &(if pipelined { &ROUTES } else { &MULTIPLIER_ROUTES })[(i.imm & 15) as usize];
        let leaving_product = last_product(&self.state, s);
        let leaving_sum = self.state.adder[2];
        let flush = self.flush_to_zero();
        // If all values are in single precision, use the fast path.
        if !(s || r || leaving_product.double || leaving_sum.double) {
            return self.single_dual_operation(i, route, from, [leaving_product, leaving_sum]);
        }
        // Select the sources of adder and multiplier by the bit field DPC.
        let for_adder = self.sources(from, leaving_product, leaving_sum, r);
        let for_multiplier = if s == r { for_adder } else { self.sources(from, leaving_product, leaving_sum, s) };
        let [m1, m2] = route.multiplier.map(|source| for_multiplier[source as usize]);
        let [a1, a2] = route.adder.map(|source| for_adder[source as usize]);
        let product = operate(Operation::Multiply, m1, m2, s, r, flush);
        let operation = if i.imm & 16 != 0 { Operation::Subtract } else { Operation::Add };
        let sum = operate(operation, a1, a2, r, r, flush);
        // The destination receives the result that leaves a pipe. T and K receive new values only after their use.
        self.state.set_f(i.dest, if pipelined { leaving_sum } else { leaving_product });
        if route.loads_t {
            self.state.t = convert(leaving_product, r, flush);
        }
        if route.loads_k {
            self.load_constant(i.imm & 4 != 0, from.a);
        }
        self.push_product(product);
        self.push_sum(sum);
    }

    #[inline]
    fn single_dual_operation(&mut self, i: &Instruction, route: &Route, from: Operands, leaving: [PipeStage; 2]) {
        let flush = self.flush_to_zero();
        let [product, sum] = leaving;
        // Select the four operands by the bit field DPC.
        let State { kr, ki, t, .. } = self.state;
        let sources = [kr, ki, t, from.a, from.b, product.bits, sum.bits].map(|bits| f32::from_bits(bits as u32));
        let of = |source: Source| sources[source as usize];
        let [m1, m2, a1, a2] = [route.multiplier[0], route.multiplier[1], route.adder[0], route.adder[1]].map(of);
        let new_product = single(Operation::Multiply, m1, m2, flush);
        let operation = if i.imm & 16 != 0 { Operation::Subtract } else { Operation::Add };
        let new_sum = single(operation, a1, a2, flush);
        // The destination receives the result that leaves a pipe.
        self.state.set_f32(i.dest, (if i.has(Flags::PIPELINED) { sum } else { product }).bits as u32);
        if route.loads_t {
            self.state.t = product.bits;
        }
        if route.loads_k {
            self.load_constant(i.imm & 4 != 0, from.a);
        }
        self.push_product(PipeStage { bits: u64::from(new_product), double: false });
        self.push_sum(PipeStage { bits: u64::from(new_sum), double: false });
    }

    /// Returns the bit patterns of all [`Source`]s in the order of the enumeration, in double precision if `double` is
    /// true.
    #[inline(always)]
    fn sources(&self, from: Operands, product: PipeStage, sum: PipeStage, double: bool) -> [u64; 7] {
        let product = self.in_precision(product, double);
        let sum = self.in_precision(sum, double);
        [self.state.kr, self.state.ki, self.state.t, from.a, from.b, product, sum]
    }

    #[inline(always)]
    fn in_precision(&self, stage: PipeStage, double: bool) -> u64 {
        match stage.double == double {
            true => stage.bits,
            false => convert(stage, double, self.flush_to_zero()),
        }
    }

    fn load_constant(&mut self, imaginary: bool, value: u64) {
        let register = if imaginary { &mut self.state.ki } else { &mut self.state.kr };
        *register = value;
    }
}

/// A bit pattern that is NaN in both precisions. The model uses it for undefined values, so that their use is visible
/// in results.
const LOST: u64 = 0x7FF8_0000_7FC0_0000;

/// Pushes a result into a pipe, and returns the value that leaves the pipe at stage `last`, the last used stage.
#[inline(always)]
fn push(pipe: &mut [PipeStage; 3], last: usize, result: PipeStage) -> PipeStage {
    let [first, second, _] = *pipe;
    let leaving = pipe[last];
    *pipe = [result, first, second];
    leaving
}

/// Replaces all results in a pipe by NaN, because a scalar operation destroys the results in the pipe of its unit.
#[inline(always)]
fn lose(pipe: &mut [PipeStage; 3]) {
    for stage in pipe {
        stage.bits = LOST;
    }
}

/// Converts the bits of a single-precision number (or of a double-precision number if `double` is true) to an `f64`.
fn number(bits: u64, double: bool) -> f64 {
    f64::from_bits(if double { bits } else { widen(bits as u32) })
}
