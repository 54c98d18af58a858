//! Exact formulas for the effect of prediction on a sinusoidal motion.
//!
//! The motion is x = e^(j w t) with the angular frequency w. A prediction by p seconds with exact derivatives
//! multiplies x by a gain G(w p). A perfect prediction multiplies x by e^(j w p). The arguments of the functions are w
//! p in radians: 2 pi x frequency x prediction time.

/// The complex factor by which a prediction multiplies a sinusoidal motion e^(j w t), without unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gain {
    /// Real part of the factor: the component in phase with the motion.
    pub re: f64,
    /// Imaginary part of the factor: the component that is a quarter of a period ahead of the motion.
    pub im: f64,
}

impl Gain {
    /// Returns the ratio of the predicted amplitude to the true amplitude.
    pub fn magnitude(self) -> f64 {
        libm::hypot(self.re, self.im)
    }

    /// Returns the phase of the predicted motion relative to the present motion, radians, -pi to pi. A positive phase
    /// is ahead.
    pub fn phase(self) -> f64 {
        libm::atan2(self.im, self.re)
    }
}

/// Returns the gain of a perfect prediction, e^(j w p).
pub fn perfect(wp: f64) -> Gain {
    let (im, re) = libm::sincos(wp);
    Gain { re, im }
}

/// Returns the gain without prediction. This gain is 1, because the last reported pose is shown unchanged.
pub fn none(_wp: f64) -> Gain {
    Gain { re: 1.0, im: 0.0 }
}

/// Returns the gain of a prediction with constant velocity, x + v p. The gain is 1 + j w p.
pub fn constant_velocity(wp: f64) -> Gain {
    Gain { re: 1.0, im: wp }
}

/// Returns the gain of a prediction with constant acceleration, x + v p + a p^2 / 2. The gain is 1 + j w p - (w p)^2 /
/// 2, with a magnitude of sqrt(1 + (w p)^4 / 4).
pub fn constant_acceleration(wp: f64) -> Gain {
    Gain { re: 1.0 - wp * wp / 2.0, im: wp }
}

/// Returns the prediction error relative to the motion's amplitude, |e^(j w p) - G|. Without prediction the error is 2
/// sin(w p / 2). The first order gives about (w p)^2 / 2, and the second order about (w p)^3 / 6.
pub fn relative_error(gain: fn(f64) -> Gain, wp: f64) -> f64 {
    let wanted = perfect(wp);
    let got = gain(wp);
    Gain { re: wanted.re - got.re, im: wanted.im - got.im }.magnitude()
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;

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

    #[test]
    fn the_gain_of_second_order_prediction_has_the_magnitude_sqrt_of_1_plus_wp_to_the_4_over_4() {
        for wp in [1e-3, 0.3, 1.0, 2.5, 10.0f64] {
            let expected = (1.0 + wp.powi(4) / 4.0).sqrt();
            assert!((constant_acceleration(wp).magnitude() / expected - 1.0).abs() < 4.0 * f64::EPSILON);
        }
    }

    #[test]
    fn without_prediction_the_relative_error_of_a_sinusoid_is_a_chord() {
        for wp in [0.1, 1.0, 2.5f64] {
            assert!((relative_error(none, wp) - 2.0 * (wp / 2.0).sin()).abs() < 4.0 * f64::EPSILON);
        }
    }

    #[test]
    fn small_prediction_errors_follow_the_first_power_that_the_order_omits() {
        let wp = 1e-2f64;
        assert!((relative_error(constant_velocity, wp) / (wp.powi(2) / 2.0) - 1.0).abs() < 1e-4);
        assert!((relative_error(constant_acceleration, wp) / (wp.powi(3) / 6.0) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn the_gain_equals_extrapolating_a_sinusoid_to_second_order() {
        let w = TAU * 1.3;
        let p = 0.07;
        let gain = constant_acceleration(w * p);
        for i in 0..50 {
            let (sin, cos) = (w * f64::from(i) * 0.013).sin_cos();
            let extrapolated = sin + w * cos * p - w * w * sin * p * p / 2.0;
            assert!((extrapolated - (gain.re * sin + gain.im * cos)).abs() < 1e-14);
        }
    }
}
