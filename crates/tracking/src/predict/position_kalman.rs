use glam::{DMat3, DVec3};

use super::channel::Channel;
use crate::time::span_s;

#[derive(Clone, Copy, Debug)]
pub(super) struct NoiseModel {
    pub(super) measurement: f64,
    pub(super) jerk: f64,
    /// Variances of the head's velocity and acceleration that the filter assumes before the first measurement.
    pub(super) start: (f64, f64),
}

/// Returns the covariance that is added over `dt` seconds for value, velocity and acceleration. The cause is jerk that
/// is white noise of spectral density 1. The covariance is the integral of (s^2/2, s, 1)(s^2/2, s, 1)^T for s from 0 to
/// `dt`.
pub(super) fn white_jerk(dt: f64) -> DMat3 {
    let d2 = dt * dt;
    let d3 = dt * dt * dt;
    DMat3::from_cols(
        DVec3::new(d2 * d3 / 20.0, d2 * d2 / 8.0, d3 / 6.0),
        DVec3::new(d2 * d2 / 8.0, d3 / 3.0, d2 / 2.0),
        DVec3::new(d3 / 6.0, d2 / 2.0, dt),
    )
}

/// Linear Kalman filter for position. Its state is position, velocity and acceleration along each axis, and jerk is
/// white noise. All axes have the same noise and measurement times, so they share one covariance.
#[derive(Clone, Debug)]
pub(super) struct PositionKalman {
    belief: NoiseModel,
    t_ps: u64,
    position: DVec3,
    velocity: DVec3,
    acceleration: DVec3,
    covariance: DMat3,
}

impl PositionKalman {
    pub(super) fn new(belief: NoiseModel) -> Self {
        let zero = DVec3::ZERO;
        let mut filter =
            Self { belief, t_ps: 0, position: zero, velocity: zero, acceleration: zero, covariance: DMat3::ZERO };
        filter.restart(0, zero);
        filter
    }

    fn predict(&mut self, dt: f64) {
        self.position += self.velocity * dt + self.acceleration * (dt * dt / 2.0);
        self.velocity += self.acceleration * dt;
        let step = DMat3::from_cols(DVec3::X, DVec3::new(dt, 1.0, 0.0), DVec3::new(dt * dt / 2.0, dt, 1.0));
        self.covariance = symmetric(step * self.covariance * step.transpose() + white_jerk(dt) * self.belief.jerk);
    }

    /// Corrects state and covariance by a measurement. Joseph's form keeps the covariance positive definite under any
    /// rounding.
    fn correct(&mut self, measured: DVec3) {
        let column = self.covariance.x_axis;
        let gain = column / (column.x + self.belief.measurement);
        let surprise = measured - self.position;
        self.position += surprise * gain.x;
        self.velocity += surprise * gain.y;
        self.acceleration += surprise * gain.z;
        let keep = DMat3::from_cols(DVec3::X - gain, DVec3::Y, DVec3::Z);
        let noise = DMat3::from_cols(gain * gain.x, gain * gain.y, gain * gain.z) * self.belief.measurement;
        self.covariance = symmetric(keep * self.covariance * keep.transpose() + noise);
    }
}

impl Channel<DVec3> for PositionKalman {
    fn restart(&mut self, t_ps: u64, position: DVec3) {
        self.t_ps = t_ps;
        self.position = position;
        self.velocity = DVec3::ZERO;
        self.acceleration = DVec3::ZERO;
        let (speed, acceleration) = self.belief.start;
        self.covariance = DMat3::from_diagonal(DVec3::new(self.belief.measurement, speed, acceleration));
    }

    fn update(&mut self, t_ps: u64, position: DVec3) {
        self.predict(span_s(self.t_ps, t_ps));
        self.t_ps = t_ps;
        self.correct(position);
    }

    fn extrapolate(&self, dt_s: f64) -> DVec3 {
        self.position + self.velocity * dt_s + self.acceleration * (dt_s * dt_s / 2.0)
    }
}

/// Returns the mean of a covariance matrix and its transpose, because rounding makes the matrix asymmetric.
pub(super) fn symmetric(m: DMat3) -> DMat3 {
    (m + m.transpose()) * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::predict::tests::{is_positive_definite, norm};
    use crate::random::normal_pair;
    use crate::time::{PS_PER_S, nearest_ps};
    use proptest::prelude::*;

    const BELIEF: NoiseModel = NoiseModel { measurement: 6.4e-7, jerk: 64.0, start: (1.0, 25.0) };

    proptest! {
        #[test]
        fn the_covariance_stays_positive_definite_for_any_times_and_noise(
            steps in prop::collection::vec(-6.0..-0.7f64, 1..200),
            noise in -10.0..0.0f64,
            jerk in -4.0..6.0f64,
        ) {
            let belief = NoiseModel { measurement: 10f64.powf(noise), jerk: 10f64.powf(jerk), start: (1.0, 25.0) };
            let mut filter = PositionKalman::new(belief);
            let mut t_ps = 0;
            for step in steps {
                t_ps += nearest_ps(10f64.powf(step));
                filter.update(t_ps, DVec3::X);
                prop_assert!(is_positive_definite(&filter.covariance.to_cols_array_2d()), "{}", filter.covariance);
            }
        }

        #[test]
        fn a_step_of_the_position_filter_equals_the_textbook_form(dt in 1e-4..0.2f64, x in -1.0..1.0f64) {
            let mut filter = PositionKalman::new(BELIEF);
            let p = filter.covariance;
            filter.update(nearest_ps(dt), DVec3::X * x);
            let f = DMat3::from_cols(DVec3::X, DVec3::new(dt, 1.0, 0.0), DVec3::new(dt * dt / 2.0, dt, 1.0));
            let p = f * p * f.transpose() + white_jerk(dt) * BELIEF.jerk;
            // A report measures the position alone: h = (1, 0, 0).
            let k = p.x_axis / (p.x_axis.x + BELIEF.measurement);
            let p = (DMat3::IDENTITY - DMat3::from_cols(k, DVec3::ZERO, DVec3::ZERO)) * p;
            let error = norm(&(p - filter.covariance).to_cols_array_2d());
            prop_assert!(error < 1e-8 * norm(&p.to_cols_array_2d()));
            let state = DVec3::new(filter.position.x, filter.velocity.x, filter.acceleration.x);
            prop_assert!((k * x - state).length() < 1e-8 * (1.0 + state.length()));
        }
    }

    #[test]
    fn the_growth_under_white_jerk_is_the_integral_of_its_impulse_responses() {
        let dt = 0.3;
        let n = 3000;
        let sum = (0..n).fold(DMat3::ZERO, |sum, i| {
            let s = (f64::from(i) + 0.5) / f64::from(n) * dt;
            let r = DVec3::new(s * s / 2.0, s, 1.0);
            sum + DMat3::from_cols(r * r.x, r * r.y, r * r.z) * (dt / f64::from(n))
        });
        assert!((sum - white_jerk(dt)).to_cols_array().iter().all(|e| e.abs() < 1e-8));
    }

    fn parabola(t: f64) -> DVec3 {
        DVec3::new(0.5 * t, -t * t, 1.0)
    }

    #[test]
    fn without_noise_a_parabola_is_followed_exactly() {
        let mut filter = PositionKalman::new(NoiseModel { measurement: 1e-12, ..BELIEF });
        for i in 0..240u64 {
            filter.update(i * PS_PER_S / 120 + 1, parabola(i as f64 / 120.0));
        }
        assert!((filter.extrapolate(0.1) - parabola(239.0 / 120.0 + 0.1)).length() < 1e-4);
    }

    #[test]
    fn after_an_hour_the_error_of_the_position_filter_stays_within_its_covariance() {
        // The head is still. Errors over the last minute stay within the deviation that the filter claims, because the
        // filter expects jerks that do not occur.
        let mut filter = PositionKalman::new(BELIEF);
        let mut squares = 0.0;
        for i in 1..=432_000u64 {
            let noise = normal_pair(1, i).0 * BELIEF.measurement.sqrt();
            filter.update(i * PS_PER_S / 120, DVec3::X * noise);
            if i > 424_800 {
                squares += filter.position.x.powi(2) / 7200.0;
            }
        }
        assert!(squares < filter.covariance.x_axis.x && squares > 0.2 * filter.covariance.x_axis.x);
    }
}
