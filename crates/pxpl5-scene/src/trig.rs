//! Trigonometric functions in software and double precision. Their results have the same bits on every computer.

use std::f64::consts::{PI, TAU};

pub(crate) fn sin_turns(turns: f64) -> f64 {
    libm::sin(TAU * (turns - libm::floor(turns)))
}

pub(crate) fn cos_turns(turns: f64) -> f64 {
    libm::cos(TAU * (turns - libm::floor(turns)))
}

pub(crate) fn sin_cos_deg(degrees: f64) -> (f64, f64) {
    (libm::sin(degrees * PI / 180.0), libm::cos(degrees * PI / 180.0))
}
