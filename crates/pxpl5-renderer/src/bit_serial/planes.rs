//! Operations that the one-bit processors of a tile perform on all pixels at the same time.

use super::tile::{EMPTY, TilePlane};

#[inline(always)]
pub(super) fn invert(a: &mut TilePlane) {
    for a in a {
        *a = !*a;
    }
}

#[inline(always)]
pub(super) fn and(a: &mut TilePlane, b: &TilePlane) {
    for (a, b) in a.iter_mut().zip(b) {
        *a &= b;
    }
}

#[inline(always)]
pub(super) fn and_not(a: &mut TilePlane, b: &TilePlane) {
    for (a, b) in a.iter_mut().zip(b) {
        *a &= !b;
    }
}

#[inline(always)]
pub(super) fn or(a: &mut TilePlane, b: &TilePlane) {
    for (a, b) in a.iter_mut().zip(b) {
        *a |= b;
    }
}

#[inline(always)]
pub(super) fn store(old: &mut TilePlane, new: &TilePlane, enable: &TilePlane) {
    for ((old, new), enable) in old.iter_mut().zip(new).zip(enable) {
        *old = *old & !enable | new & enable;
    }
}

/// Sets `a` to the sum bit of a + b + carry, and `carry` to the carry that the addition produces.
#[inline(always)]
pub(super) fn add(a: &mut TilePlane, b: &TilePlane, carry: &mut TilePlane) {
    for ((a, b), c) in a.iter_mut().zip(b).zip(carry) {
        let half = *a ^ b;
        let next = *a & b | *c & half;
        *a = half ^ *c;
        *c = next;
    }
}

/// Sets `a` to the difference bit of a - b - borrow, and `borrow` to the borrow that the subtraction produces.
#[inline(always)]
pub(super) fn subtract(a: &mut TilePlane, b: &TilePlane, borrow: &mut TilePlane) {
    for ((a, b), c) in a.iter_mut().zip(b).zip(borrow) {
        let half = *a ^ b;
        let next = !*a & b | *c & !half;
        *a = half ^ *c;
        *c = next;
    }
}

/// Simulates one clock of a serial subtracter if `subtracts` is true, or of a serial adder otherwise.
#[inline(always)]
pub(super) fn step(subtracts: bool, a: &mut TilePlane, b: &TilePlane, carry: &mut TilePlane) {
    if subtracts { subtract(a, b, carry) } else { add(a, b, carry) }
}

/// Sets `borrow` to the borrow that the subtraction a - b - borrow produces, without computing the difference.
#[inline(always)]
pub(super) fn borrow(a: &TilePlane, b: &TilePlane, borrow: &mut TilePlane) {
    for ((a, b), c) in a.iter().zip(b).zip(borrow) {
        *c = !a & b | *c & !(a ^ b);
    }
}

#[inline(always)]
pub(super) fn combine(a: &TilePlane, b: &TilePlane, f: impl Fn(u64, u64) -> u64) -> TilePlane {
    let mut out = EMPTY;
    for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
        *out = f(*a, *b);
    }
    out
}
