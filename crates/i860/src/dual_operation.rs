//! The data paths of the dual operations, which use the adder and the multiplier at the same time.

use crate::instruction::{Flags, Instruction, Op};

/// A source of an operand of the adder or the multiplier in a dual operation. `M` and `A` are the results that leave
/// the multiplier and the adder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Source {
    Kr,
    Ki,
    T,
    S1,
    S2,
    M,
    A,
}

/// One row of the table of data paths. The bit field DPC (data-path control) of a dual operation selects the row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Route {
    pub(crate) multiplier: [Source; 2],
    pub(crate) adder: [Source; 2],
    pub(crate) loads_t: bool,
    pub(crate) loads_k: bool,
}

const fn route(multiplier: [Source; 2], adder: [Source; 2], loads_t: bool, loads_k: bool) -> Route {
    Route { multiplier, adder, loads_t, loads_k }
}

/// The sixteen data paths of pfam and pfsm, by the bit field DPC (data-path control).
pub(crate) const ROUTES: [Route; 16] = {
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

/// The sixteen data paths of pfmam and pfmsm. They equal [`ROUTES`], with `M` (the multiplier's result) in place of
/// `A`.
pub(crate) const MULTIPLIER_ROUTES: [Route; 16] = {
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

/// Returns, for the first and the second source, true if the source is a double-precision number in a pair of
/// registers.
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

/// Returns true if the first source goes to the adder or the graphics unit. Only these units can use a result in the
/// clock in which it leaves a pipe.
pub(crate) fn first_has_bypass(i: &Instruction) -> bool {
    match i.op {
        Op::DualOp => ROUTES[(i.imm & 15) as usize].adder[0] == Source::S1,
        _ => !i.uses_multiplier(),
    }
}
