//! Execution in the floating-point half: adder, multiplier, their pipes, and the dual operations.

use crate::arithmetic::{Operation, convert, multiply_low, narrow, operate, round, to_integer, widen};
use crate::cpu::Cpu;
use crate::decoded::Decoded;
use crate::instruction::{Flags, Instruction, Op};
use crate::state::{Stage, State, fsr, psr};

/// Source registers as read before either half of a pair writes, with the value leaving the pipe put through.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Operands {
    pub(crate) a: u64,
    pub(crate) b: u64,
}

/// Where a dual operation takes an operand from. M and A are the last stages of multiplier and adder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum Source {
    Kr,
    Ki,
    T,
    S1,
    S2,
    M,
    A,
}

/// One row of the data-path control table of the dual operations.
#[derive(Clone, Copy, Debug)]
struct Route {
    multiplier: [Source; 2],
    adder: [Source; 2],
    loads_t: bool,
    loads_k: bool,
}

const fn route(multiplier: [Source; 2], adder: [Source; 2], loads_t: bool, loads_k: bool) -> Route {
    Route { multiplier, adder, loads_t, loads_k }
}

/// The sixteen data paths by DPC, written for pfam/pfsm; for pfmam/pfmsm every `A` reads `M`.
const ROUTES: [Route; 16] = {
    use Source::{A, Ki, Kr, M, S1, S2, T};
    [
        route([Kr, S2], [S1, M], false, false),
        route([Kr, S2], [T, M], false, true),
        route([Kr, S2], [S1, A], true, false),
        route([Kr, S2], [T, A], true, true),
        route([Ki, S2], [S1, M], false, false),
        route([Ki, S2], [T, M], false, true),
        route([Ki, S2], [S1, A], true, false),
        route([Ki, S2], [T, A], true, true),
        route([Kr, A], [S1, S2], true, false),
        route([S1, S2], [A, M], false, false),
        route([Kr, A], [S1, S2], false, false),
        route([S1, S2], [T, A], true, false),
        route([Ki, A], [S1, S2], true, false),
        route([S1, S2], [T, M], false, false),
        route([Ki, A], [S1, S2], false, false),
        route([S1, S2], [T, A], false, false),
    ]
};

/// The same with every `A` reading `M`.
const MULTIPLIER_ROUTES: [Route; 16] = {
    let mut routes = ROUTES;
    let mut n = 0;
    while n < 16 {
        routes[n].multiplier[1] = multiplier_for_adder(routes[n].multiplier[1]);
        routes[n].adder[0] = multiplier_for_adder(routes[n].adder[0]);
        routes[n].adder[1] = multiplier_for_adder(routes[n].adder[1]);
        n += 1;
    }
    routes
};

const fn multiplier_for_adder(source: Source) -> Source {
    match source {
        Source::A => Source::M,
        other => other,
    }
}

/// The last stage of the multiplier for a source precision: two stages for double, three for single.
fn last_product(state: &State, source_double: bool) -> Stage {
    state.multiplier[if source_double { 1 } else { 2 }]
}

/// What a pipelined instruction sends to its destination; `None` for a scalar one.
fn leaving(state: &State, i: &Instruction) -> Option<Stage> {
    if i.op == Op::DualOp {
        let product = last_product(state, i.has(Flags::SOURCE_DOUBLE));
        return Some(if i.has(Flags::PIPELINED) { state.adder[2] } else { product });
    }
    if !i.has(Flags::PIPELINED) {
        return None;
    }
    Some(match () {
        () if i.uses_adder() => state.adder[2],
        () if i.uses_multiplier() => last_product(state, i.has(Flags::SOURCE_DOUBLE)),
        () => state.graphics,
    })
}

/// Register `n` as if the leaving value had already reached `dest`.
fn read_bypassed(state: &State, n: u8, double: bool, dest: u8, leaving: Stage) -> u64 {
    if dest & 30 != n & 30 || dest < 2 {
        return state.f_bits(n, double);
    }
    let low = usize::from(dest & 30);
    let mut pair = [state.f[low], state.f[low + 1]];
    if leaving.double {
        pair = [leaving.bits as u32, (leaving.bits >> 32) as u32];
    } else {
        pair[usize::from(dest & 1)] = leaving.bits as u32;
    }
    match double {
        true => u64::from(pair[1]) << 32 | u64::from(pair[0]),
        false => u64::from(pair[usize::from(n & 1)]),
    }
}

/// Whether the first and the second source are read as pairs of registers.
pub(crate) fn source_widths(i: &Instruction) -> (bool, bool) {
    let s = i.has(Flags::SOURCE_DOUBLE);
    let r = i.has(Flags::RESULT_DOUBLE);
    match i.op {
        Op::Fxfr => (false, false),
        Op::DualOp => {
            let route = &ROUTES[(i.imm & 15) as usize];
            let to_adder = [route.adder[0] == Source::S1, route.adder[1] == Source::S2];
            let [first, second] = to_adder.map(|adder| if adder { r } else { s });
            (first, second)
        }
        Op::Faddp | Op::Faddz | Op::Fzchkl | Op::Fzchks | Op::Form => (true, true),
        _ => (s, s),
    }
}

/// Whether the first source goes to the adder or the graphics unit, which have the bypass.
fn first_has_bypass(i: &Instruction) -> bool {
    match i.op {
        Op::DualOp => ROUTES[(i.imm & 15) as usize].adder[0] == Source::S1,
        _ => !i.uses_multiplier(),
    }
}

/// Reads the sources of a floating-point or graphics instruction.
#[inline(always)]
pub(crate) fn read_operands(state: &State, d: &Decoded) -> Operands {
    let i = &d.instruction;
    let (first, second) = d.source_widths();
    if d.may_bypass() {
        return read_through(state, i, first, second);
    }
    Operands { a: state.f_bits(i.src1, first), b: state.f_bits(i.src2, second) }
}

fn read_through(state: &State, i: &Instruction, first: bool, second: bool) -> Operands {
    let Some(out) = leaving(state, i) else {
        return Operands { a: state.f_bits(i.src1, first), b: state.f_bits(i.src2, second) };
    };
    let b = read_bypassed(state, i.src2, second, i.dest, out);
    let a = match first_has_bypass(i) {
        true => read_bypassed(state, i.src1, first, i.dest, out),
        false => state.f_bits(i.src1, first),
    };
    Operands { a, b }
}

impl Cpu {
    /// Executes a floating-point or graphics instruction with its operands already read.
    #[inline(always)]
    pub(crate) fn floating(&mut self, i: &Instruction, from: Operands) {
        match i.op {
            Op::Fnop => {}
            Op::DualOp => self.dual_operation(i, from),
            Op::Fmul => self.multiply(i, from),
            Op::Fadd => self.add(i, Operation::Add, from),
            Op::Fsub => self.add(i, Operation::Subtract, from),
            Op::Pfgt | Op::Pfle | Op::Pfeq => self.compare(i, from),
            Op::Fmlow => self.state.set_f64(i.dest, multiply_low(from.a, from.b)),
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
            self.state.set_f(i.dest, product);
        }
    }

    #[inline]
    fn push_product(&mut self, product: Stage) {
        let pipe = &mut self.state.multiplier;
        *pipe = [product, pipe[0], pipe[1]];
    }

    #[inline]
    fn push_sum(&mut self, sum: Stage) {
        let pipe = &mut self.state.adder;
        *pipe = [sum, pipe[0], pipe[1]];
    }

    /// A result of the adder goes to its register, or into the pipe while the oldest one leaves.
    #[inline]
    fn adder_result(&mut self, i: &Instruction, result: Stage) {
        if i.has(Flags::PIPELINED) {
            self.state.set_f(i.dest, self.state.adder[2]);
            self.push_sum(result);
        } else {
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

    /// Compares set CC and send an undefined value into the pipe; this model sends zero.
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
        self.adder_result(i, Stage { bits: 0, double });
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
        self.state.set_f(i.dest, Stage { bits, double: r });
    }

    /// The high word of the result is undefined on the part: `fix` clears it here, scalar `ftrunc` leaves it.
    fn integer_part(&mut self, i: &Instruction, x: u64) {
        let wide = if i.has(Flags::SOURCE_DOUBLE) { x } else { widen(x as u32) };
        let mode = if i.op == Op::Fix { self.state.fsr >> fsr::RM_SHIFT & 3 } else { 3 };
        let bits = u64::from(to_integer(round(f64::from_bits(wide), mode)));
        let whole_pair = i.op == Op::Fix || i.has(Flags::PIPELINED);
        self.adder_result(i, Stage { bits, double: whole_pair && i.has(Flags::RESULT_DOUBLE) });
    }

    fn adder_move(&mut self, i: &Instruction, x: u64) {
        let s = i.has(Flags::SOURCE_DOUBLE);
        let r = i.has(Flags::RESULT_DOUBLE);
        let bits = convert(Stage { bits: x, double: s }, r, self.flush_to_zero());
        self.adder_result(i, Stage { bits, double: r });
    }

    /// pfam, pfsm, pfmam, pfmsm. K and T are read before they are reloaded.
    fn dual_operation(&mut self, i: &Instruction, from: Operands) {
        let s = i.has(Flags::SOURCE_DOUBLE);
        let r = i.has(Flags::RESULT_DOUBLE);
        let pipelined = i.has(Flags::PIPELINED);
        let route = &(if pipelined { &ROUTES } else { &MULTIPLIER_ROUTES })[(i.imm & 15) as usize];
        let leaving_product = last_product(&self.state, s);
        let leaving_sum = self.state.adder[2];
        let flush = self.flush_to_zero();
        let for_adder = self.sources(from, leaving_product, leaving_sum, r);
        let for_multiplier = if s == r { for_adder } else { self.sources(from, leaving_product, leaving_sum, s) };
        let [m1, m2] = route.multiplier.map(|source| for_multiplier[source as usize]);
        let [a1, a2] = route.adder.map(|source| for_adder[source as usize]);
        let product = operate(Operation::Multiply, m1, m2, s, r, flush);
        let operation = if i.imm & 16 != 0 { Operation::Subtract } else { Operation::Add };
        let sum = operate(operation, a1, a2, r, r, flush);
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

    /// The values of all [`Source`]s in the precision of one unit, in the order of the enumeration.
    #[inline(always)]
    fn sources(&self, from: Operands, product: Stage, sum: Stage, double: bool) -> [u64; 7] {
        let product = self.in_precision(product, double);
        let sum = self.in_precision(sum, double);
        [self.state.kr, self.state.ki, self.state.t, from.a, from.b, product, sum]
    }

    #[inline(always)]
    fn in_precision(&self, stage: Stage, double: bool) -> u64 {
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

/// The number that bits of a precision stand for.
fn number(bits: u64, double: bool) -> f64 {
    f64::from_bits(if double { bits } else { widen(bits as u32) })
}
