use glam::{DMat3, DVec3};

use super::channel::Channel;
use super::propagation::{Decay, Propagation, Propagations};
use crate::time::span_s;

#[derive(Clone, Copy, Debug)]
pub(super) struct NoiseModel {
    pub(super) measurement: f64,
    pub(super) jerk: f64,
    pub(super) decay: Decay,
    /// Variances of the head's velocity and acceleration that the filter assumes before the first measurement.
    pub(super) start: (f64, f64),
}

/// Linear Kalman filter for position. Its state is position, velocity and acceleration along each axis. Velocity and
/// acceleration decay, and jerk is white noise. All axes have the same noise and measurement times, so they share one
/// covariance.
#[derive(Clone, Debug)]
pub(super) struct PositionKalman {
    belief: NoiseModel,
    propagations: Propagations,
    t_ps: u64,
    position: DVec3,
    velocity: DVec3,
    acceleration: DVec3,
    covariance: DMat3,
}

impl PositionKalman {
    pub(super) fn new(belief: NoiseModel) -> Self {
        let zero = DVec3::ZERO;
        let propagations = Propagations::of(belief.decay);
        let covariance = DMat3::ZERO;
        let mut filter =
            Self { belief, propagations, t_ps: 0, position: zero, velocity: zero, acceleration: zero, covariance };
        filter.restart(0, zero);
        filter
    }

    fn predict(&mut self, dt: f64) {
        let Propagation { step, growth, .. } = self.propagations.over(dt);
        self.position += self.velocity * step.y_axis.x + self.acceleration * step.z_axis.x;
        self.velocity = self.velocity * step.y_axis.y + self.acceleration * step.z_axis.y;
        self.acceleration *= step.z_axis.z;
        self.covariance = symmetric(step * self.covariance * step.transpose() + growth * self.belief.jerk);
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
        let [by_velocity, by_acceleration, _] = self.propagations.way(dt_s);
        self.position + self.velocity * by_velocity + self.acceleration * by_acceleration
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

    const BELIEF: NoiseModel = NoiseModel { measurement: 6.4e-7, jerk: 64.0, decay: Decay::NONE, start: (1.0, 25.0) };

    proptest! {
        #[test]
        fn the_covariance_stays_positive_definite_for_any_times_and_noise(
            steps in prop::collection::vec(-6.0..-0.7f64, 1..200),
            noise in -10.0..0.0f64,
            jerk in -4.0..6.0f64,
            decays in (0.0..1e3, 0.0..1e3),
        ) {
            let decay = Decay { velocity: decays.0, acceleration: decays.1 };
            let (measurement, jerk) = (10f64.powf(noise), 10f64.powf(jerk));
            let belief = NoiseModel { measurement, jerk, decay, ..BELIEF };
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
            let p = f * p * f.transpose() + Propagation::over(dt, Decay::NONE).growth * BELIEF.jerk;
            // A report measures the position alone: h = (1, 0, 0).
            let k = p.x_axis / (p.x_axis.x + BELIEF.measurement);
            let p = (DMat3::IDENTITY - DMat3::from_cols(k, DVec3::ZERO, DVec3::ZERO)) * p;
            let error = norm(&(p - filter.covariance).to_cols_array_2d());
            prop_assert!(error < 1e-8 * norm(&p.to_cols_array_2d()));
            let state = DVec3::new(filter.position.x, filter.velocity.x, filter.acceleration.x);
            prop_assert!((k * x - state).length() < 1e-8 * (1.0 + state.length()));
        }
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
