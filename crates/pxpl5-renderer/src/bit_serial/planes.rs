//! Operations of all one-bit processors at once, on whole planes.

use crate::array::{EMPTY_PLANE, Plane};

pub(super) const FULL_PLANE: Plane = [u64::MAX; 256];

/// a &= b.
#[inline(always)]
pub(super) fn and(a: &mut Plane, b: &Plane) {
    for (a, b) in a.iter_mut().zip(b) {
        *a &= b;
    }
}

/// a &= not b.
#[inline(always)]
pub(super) fn and_not(a: &mut Plane, b: &Plane) {
    for (a, b) in a.iter_mut().zip(b) {
        *a &= !b;
    }
}

/// a |= b.
#[inline(always)]
pub(super) fn or(a: &mut Plane, b: &Plane) {
    for (a, b) in a.iter_mut().zip(b) {
        *a |= b;
    }
}

/// old := new where enabled.
#[inline(always)]
pub(super) fn store(old: &mut Plane, new: &Plane, enable: &Plane) {
    for ((old, new), enable) in old.iter_mut().zip(new).zip(enable) {
        *old = *old & !enable | new & enable;
    }
}

/// a := sum bit of a + b + carry; carry := the next carry.
#[inline(always)]
pub(super) fn add(a: &mut Plane, b: &Plane, carry: &mut Plane) {
    for ((a, b), c) in a.iter_mut().zip(b).zip(carry) {
        let half = *a ^ b;
        let next = *a & b | *c & half;
        *a = half ^ *c;
        *c = next;
    }
}

/// a := difference bit of a - b - borrow; borrow := the next borrow.
#[inline(always)]
pub(super) fn subtract(a: &mut Plane, b: &Plane, borrow: &mut Plane) {
    for ((a, b), c) in a.iter_mut().zip(b).zip(borrow) {
        let half = *a ^ b;
        let next = !*a & b | *c & !half;
        *a = half ^ *c;
        *c = next;
    }
}

/// borrow := the next borrow of a - b.
#[inline(always)]
pub(super) fn borrow(a: &Plane, b: &Plane, borrow: &mut Plane) {
    for ((a, b), c) in a.iter().zip(b).zip(borrow) {
        *c = !a & b | *c & !(a ^ b);
    }
}

/// A combination of two planes, word by word.
#[inline(always)]
pub(super) fn combine(a: &Plane, b: &Plane, f: impl Fn(u64, u64) -> u64) -> Plane {
    let mut out = EMPTY_PLANE;
    for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
        *out = f(*a, *b);
    }
    out
}
