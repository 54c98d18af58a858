//! Exact formulas for the effect of prediction on a sinusoidal motion.
//!
//! The motion is x = e^(j w t) with the angular frequency w. A prediction by p seconds with exact derivatives
//! multiplies x by a gain G(w p). A perfect prediction multiplies x by e^(j w p). The arguments of the functions are w
//! p in radians: 2 pi x frequency x prediction time.

use std::f64::consts::TAU;

/// The complex factor by which a prediction multiplies a sinusoidal motion e^(j w t), without unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gain {
    /// Real part of the factor: the component in phase with the motion.
    pub(super) re: f64,
    /// Imaginary part of the factor: the component that is a quarter of a period ahead of the motion.
    pub(super) im: f64,
}

impl Gain {
    /// Returns the ratio of the predicted amplitude to the true amplitude.
    fn magnitude(self) -> f64 {
        libm::hypot(self.re, self.im)
    }
}

/// Returns the gain of a perfect prediction, e^(j w p).
fn perfect(wp: f64) -> Gain {
    let (im, re) = libm::sincos(wp);
    Gain { re, im }
}

/// Returns the gain without prediction. This gain is 1, because the last reported pose is shown unchanged.
pub(super) fn none(_wp: f64) -> Gain {
    Gain { re: 1.0, im: 0.0 }
}

/// Returns the gain of a prediction with constant velocity, x + v p. The gain is 1 + j w p.
pub(super) fn constant_velocity(wp: f64) -> Gain {
    Gain { re: 1.0, im: wp }
}

/// Returns the gain of a prediction with constant acceleration, x + v p + a p^2 / 2. The gain is 1 + j w p - (w p)^2 /
/// 2, with a magnitude of sqrt(1 + (w p)^4 / 4).
pub(super) fn constant_acceleration(wp: f64) -> Gain {
    Gain { re: 1.0 - wp * wp / 2.0, im: wp }
}

/// Returns the prediction error relative to the motion's amplitude, |e^(j w p) - G|. Without prediction the error is 2
/// sin(w p / 2). The first order gives about (w p)^2 / 2, and the second order about (w p)^3 / 6.
pub(super) fn relative_error(gain: fn(f64) -> Gain, wp: f64) -> f64 {
    let wanted = perfect(wp);
    let got = gain(wp);
    Gain { re: wanted.re - got.re, im: wanted.im - got.im }.magnitude()
}

/// Published relative errors without prediction, and with prediction of first and second order. Each row begins
/// with the frequency of the motion in Hz and the prediction interval in seconds.
const PUBLISHED: [(f64, f64, [f64; 3]); 4] = [
    (1.0, 0.05, [0.313, 0.049, 0.005]),
    (1.0, 0.10, [0.618, 0.195, 0.041]),
    (2.0, 0.10, [1.18, 0.76, 0.32]),
    (2.0, 0.20, [1.90, 2.64, 2.35]),
];

#[test]
fn relative_errors_equal_the_published_digits() {
    for (hz, p, published) in PUBLISHED {
        let digit = if published[0] < 1.0 { 5.1e-4 } else { 5.1e-3 };
        for (gain, expected) in [none, constant_velocity, constant_acceleration].into_iter().zip(published) {
            let error = relative_error(gain, TAU * hz * p);
            assert!((error - expected).abs() < digit, "{hz} Hz {p} s: {error} for {expected}");
        }
    }
}
