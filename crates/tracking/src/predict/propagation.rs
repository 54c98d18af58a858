use glam::{DMat3, DVec3};

use serde::{Deserialize, Serialize};
use std::cell::RefCell;

/// Terms of the power series. With rates of at most [`LARGEST_DECAY`] in a step, the rest is below 1e-9 of the sum.
const TERMS: u32 = 10;
/// Greatest product of decay rate and time for which the power series is used.
const LARGEST_DECAY: f64 = 0.125;

/// Rates at which a Kalman filter lets velocity and acceleration decay, as in the model of Singer (1970).
///
/// With both rates 0 the acceleration stays constant. A great rate of acceleration leaves a constant velocity, and
/// great rates of both leave the last pose: the other prediction methods are limits of this one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Decay {
    /// Rate at which a velocity decays, 1/s.
    pub velocity: f64,
    /// Rate at which an acceleration decays, 1/s.
    pub acceleration: f64,
}

impl Decay {
    /// No decay: the acceleration stays constant.
    pub const NONE: Self = Self { velocity: 0.0, acceleration: 0.0 };
}

/// The change of value, velocity and acceleration over a time, and of their covariance.
///
/// Velocity and acceleration decay as in the model of Singer 1970, and jerk is white noise. With the rates of decay b
/// and c, x' = v, v' = a - b v, and a' = w - c a.
#[derive(Clone, Copy, Debug)]
pub(super) struct Propagation {
    /// Matrix that gives the new state from the old one.
    pub(super) step: DMat3,
    /// Covariance that white jerk of spectral density 1 adds.
    pub(super) growth: DMat3,
    /// Second term of the Magnus series of a turn, as a factor of -(velocity x acceleration).
    sideways: f64,
}

/// The propagations of a filter, with the latest ones kept. A tracker reports at even times that are rounded to
/// picoseconds, so a filter needs three: two times between reports, and the prediction interval.
#[derive(Clone, Debug)]
pub(super) struct Propagations {
    decay: Decay,
    kept: RefCell<[(f64, Propagation); 3]>,
}

impl Propagations {
    pub(super) fn of(decay: Decay) -> Self {
        Self { decay, kept: RefCell::new([(0.0, Propagation::over(0.0, decay)); 3]) }
    }

    /// Returns the propagation over `dt` seconds, which is not negative.
    pub(super) fn over(&self, dt: f64) -> Propagation {
        let mut kept = self.kept.borrow_mut();
        if let Some((_, found)) = kept.iter().find(|(of, _)| *of == dt) {
            return *found;
        }
        let made = Propagation::over(dt, self.decay);
        kept.rotate_right(1);
        kept[0] = (dt, made);
        made
    }

    /// Returns the factors of velocity and acceleration in the way of `dt` seconds, and the factor of -(velocity x
    /// acceleration) in the rotation vector of a turn.
    ///
    /// A way back in time decays like a way forwards, because earlier velocities are as uncertain as later ones.
    pub(super) fn way(&self, dt: f64) -> [f64; 3] {
        self.over(dt.abs()).turned(dt.signum())
    }
}

impl Propagation {
    /// Returns the propagation over `dt` seconds, which is not negative.
    ///
    /// A power series gives it for a time so short that hardly anything decays. This time is then doubled. No
    /// transcendental function is used, so all computers return the same bits.
    pub(super) fn over(dt: f64, decay: Decay) -> Self {
        let mut h = dt;
        let mut doublings = 0;
        while h * decay.velocity.max(decay.acceleration) > LARGEST_DECAY {
            h /= 2.0;
            doublings += 1;
        }
        (0..doublings).fold(Self::series(h, decay), |half, _| half.doubled())
    }

    /// Returns the factors of [`Propagations::way`], with `sign` -1 for a way back in time.
    pub(super) fn turned(&self, sign: f64) -> [f64; 3] {
        [self.step.y_axis.x * sign, self.step.z_axis.x, self.sideways * sign]
    }

    fn series(h: f64, decay: Decay) -> Self {
        let rates = DMat3::from_cols(
            DVec3::ZERO,
            DVec3::new(1.0, -decay.velocity, 0.0),
            DVec3::new(0.0, 1.0, -decay.acceleration),
        );
        let mut term = DMat3::IDENTITY;
        let mut step = term;
        let mut added = DMat3::from_diagonal(DVec3::Z) * h;
        let mut growth = added;
        for n in 1..=TERMS {
            // Terms of exp(rates h), and of the solution of growth' = rates growth + growth rates^T + noise.
            term = rates * term * (h / f64::from(n));
            step += term;
            let change = rates * added * (h / f64::from(n + 1));
            added = change + change.transpose();
            growth += added;
        }
        Self { step, growth, sideways: h * h * h / 12.0 }
    }

    fn doubled(&self) -> Self {
        let Self { step, growth, sideways } = *self;
        let [by_velocity, by_acceleration] = [step.y_axis.x, step.z_axis.x];
        let [velocity, gained, acceleration] = [step.y_axis.y, step.z_axis.y, step.z_axis.z];
        // Two turns in succession add half of their cross product (Baker, Campbell and Hausdorff).
        let product = by_velocity * (by_velocity * gained + by_acceleration * (acceleration - velocity));
        Self {
            step: step * step,
            growth: growth + step * growth * step.transpose(),
            sideways: sideways * (1.0 + velocity * acceleration) + product / 2.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DECAYS: [(f64, f64); 5] = [(0.0, 0.0), (3.0, 0.0), (0.0, 40.0), (7.0, 7.0), (200.0, 900.0)];

    /// Returns value, velocity and acceleration after `dt` seconds, from many small steps of the differential equation.
    fn integrate(mut state: DVec3, dt: f64, (b, c): (f64, f64)) -> DVec3 {
        let n = 40_000;
        let h = dt / f64::from(n);
        let slope = |s: DVec3| DVec3::new(s.y, s.z - b * s.y, -c * s.z);
        for _ in 0..n {
            state += slope(state + slope(state) * (h / 2.0)) * h;
        }
        state
    }

    #[test]
    fn the_step_and_the_growth_solve_the_differential_equation_of_decaying_motion() {
        let dt = 0.15;
        for (b, c) in DECAYS {
            let found = Propagation::over(dt, Decay { velocity: b, acceleration: c });
            for (axis, start) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
                let error = (found.step.col(axis) - integrate(start, dt, (b, c))).length();
                assert!(error < 1e-6, "{b} {c} {axis}: {error}");
            }
            // The growth is the integral of the products of the responses to a jerk at each instant.
            let n = 3_000;
            let growth = (0..n).fold(DMat3::ZERO, |sum, i| {
                let s = (f64::from(i) + 0.5) / f64::from(n) * dt;
                let r = Propagation::over(s, Decay { velocity: b, acceleration: c }).step.z_axis;
                sum + DMat3::from_cols(r * r.x, r * r.y, r * r.z) * (dt / f64::from(n))
            });
            let error = (growth - found.growth).to_cols_array().into_iter().fold(0.0, |most, e| e.abs().max(most));
            assert!(error < 2e-3 * found.growth.z_axis.z, "{b} {c}: {error}");
        }
    }

    /// Tests the two limits of the model: a velocity that decays at once leaves the value, and an acceleration that
    /// decays at once leaves a constant velocity.
    #[test]
    fn no_motion_and_constant_velocity_are_limits_of_decaying_motion() {
        let of = |velocity, acceleration| Propagations::of(Decay { velocity, acceleration }).way(0.1);
        let [still, by_acceleration, _] = of(1e6, 1e6);
        assert!(still < 1.1e-6 && by_acceleration < 1e-9, "{still} {by_acceleration}");
        let [moving, by_acceleration, _] = of(0.0, 1e6);
        assert!((moving - 0.1).abs() < 1e-12 && by_acceleration < 1.1e-7, "{moving} {by_acceleration}");
        assert_eq!(of(0.0, 0.0).map(|x| (x * 1e12).round()), [1e11, 5e9, (1e9f64 / 12.0).round()]);
    }
}
