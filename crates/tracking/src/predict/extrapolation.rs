use std::collections::VecDeque;

use glam::DVec3;

use super::channel::{Channel, VectorDifference};
use crate::time::span_s;

/// The order of an extrapolation, which is the highest derivative that the extrapolation uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Zeroth,
    /// Order 1: the first derivative (velocity) stays constant.
    First,
    /// Order 2: the second derivative (acceleration) stays constant.
    Second,
}

/// An extrapolation by the Newton polynomial through the last value and one or two earlier values, `baseline` reports
/// apart. The result is exact for motions that are polynomials up to the extrapolation's order, even for reports at
/// irregular times.
#[derive(Clone, Debug)]
pub(super) struct Extrapolation<T> {
    order: Order,
    baseline: usize,
    /// Past values with their times (ps), the newest first. The queue always has a value.
    past: VecDeque<(u64, T)>,
}

impl<T: VectorDifference> Extrapolation<T> {
    pub(super) fn new(order: Order, baseline: usize, start: T) -> Self {
        Self { order, baseline, past: VecDeque::from([(0, start)]) }
    }

    /// Returns the time in seconds and the value of the report that came `age` reports before the newest report. Time
    /// and value are relative to the newest report, so the time is negative.
    fn point(&self, age: usize) -> (f64, DVec3) {
        let (newest_ps, newest) = self.past[0];
        let (t_ps, value) = self.past[age];
        (span_s(newest_ps, t_ps), value.since(newest))
    }

    fn first_order(&self, dt_s: f64) -> DVec3 {
        let (t, offset) = self.point(self.baseline.min(self.past.len() - 1));
        offset / t * dt_s
    }

    fn second_order(&self, dt_s: f64) -> DVec3 {
        let oldest = (2 * self.baseline).min(self.past.len() - 1);
        let (t1, offset1) = self.point(oldest / 2);
        let (t2, offset2) = self.point(oldest);
        // Newton's divided differences with the newest value at the origin.
        let slope = offset1 / t1;
        let curvature = ((offset2 - offset1) / (t2 - t1) - slope) / t2;
        slope * dt_s + curvature * (dt_s * (dt_s - t1))
    }
}

impl<T: VectorDifference> Channel<T> for Extrapolation<T> {
    fn restart(&mut self, t_ps: u64, value: T) {
        self.past.clear();
        self.past.push_front((t_ps, value));
    }

    fn update(&mut self, t_ps: u64, value: T) {
        self.past.truncate(2 * self.baseline);
        self.past.push_front((t_ps, value));
    }

    fn extrapolate(&self, dt_s: f64) -> T {
        let newest = self.past[0].1;
        match (self.order, self.past.len()) {
            (Order::Zeroth, _) | (_, 1) => newest,
            (Order::First, _) | (_, 2) => newest.moved(self.first_order(dt_s)),
            (Order::Second, _) => newest.moved(self.second_order(dt_s)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotation;
    use crate::time::PS_PER_MS;
    use glam::DQuat;

    /// Times of tracker reports in ms, at irregular intervals.
    const TIMES: [u64; 7] = [0, 3, 11, 12, 20, 31, 33];

    fn fed<T: VectorDifference>(order: Order, baseline: usize, value: impl Fn(f64) -> T) -> Extrapolation<T> {
        let mut filter = Extrapolation::new(order, baseline, value(0.0));
        filter.restart(0, value(0.0));
        TIMES[1..].iter().for_each(|&t| filter.update(t * PS_PER_MS, value(t as f64 / 1e3)));
        filter
    }

    fn line(t: f64) -> DVec3 {
        DVec3::new(1.0 - 2.0 * t, 0.3 * t, 5.0)
    }

    fn parabola(t: f64) -> DVec3 {
        DVec3::new(1.0 - 2.0 * t + 4.0 * t * t, 3.0 * t * t, 0.1)
    }

    fn pan(t: f64) -> DQuat {
        rotation::about_y(3.0 + 6.0 * t)
    }

    fn faster_and_faster(t: f64) -> DQuat {
        rotation::about_x(0.5 * t + 9.0 * t * t)
    }

    #[test]
    fn first_order_is_exact_for_constant_velocity() {
        for baseline in [1, 2, 3] {
            let filter = fed(Order::First, baseline, line);
            assert!((filter.extrapolate(0.2) - line(0.233)).length() < 1e-14);
        }
    }

    #[test]
    fn second_order_is_exact_for_constant_acceleration() {
        for baseline in [1, 2, 3] {
            let filter = fed(Order::Second, baseline, parabola);
            assert!((filter.extrapolate(0.2) - parabola(0.233)).length() < 1e-12);
        }
    }

    #[test]
    fn both_orders_are_exact_for_a_pan_through_180_degrees() {
        for order in [Order::First, Order::Second] {
            assert!(rotation::angle_deg(fed(order, 2, pan).extrapolate(0.1), pan(0.133)) < 1e-10);
        }
    }

    #[test]
    fn second_order_is_exact_for_an_accelerated_rotation_about_one_axis() {
        let filter = fed(Order::Second, 2, faster_and_faster);
        assert!(rotation::angle_deg(filter.extrapolate(0.1), faster_and_faster(0.133)) < 1e-10);
    }

    #[test]
    fn with_few_reports_the_order_is_reduced() {
        let mut filter = Extrapolation::new(Order::Second, 4, DVec3::ZERO);
        filter.restart(0, DVec3::X);
        assert_eq!(filter.extrapolate(1.0), DVec3::X);
        filter.update(1000 * PS_PER_MS, DVec3::X * 2.0);
        assert_eq!(filter.extrapolate(1.0), DVec3::X * 3.0);
    }

    #[test]
    fn sinusoids_are_predicted_with_the_gains_of_the_derivatives() {
        // Reports are 0.1 ms apart, so differences agree with derivatives to w x 0.1 ms = 0.1 %. Frequency 2 Hz,
        // prediction 100 ms.
        let w = core::f64::consts::TAU * 2.0;
        let p = 0.1;
        // The gain of x + v p is 1 + j w p. The second order adds (j w p)^2 / 2.
        for (order, re, im) in [(Order::First, 1.0, w * p), (Order::Second, 1.0 - (w * p).powi(2) / 2.0, w * p)] {
            let mut filter = Extrapolation::new(order, 1, DVec3::ZERO);
            for i in 0..5000u64 {
                let (sin, cos) = (w * i as f64 * 1e-4).sin_cos();
                filter.update(i * PS_PER_MS / 10 + 1, DVec3::X * sin);
                let expected = re * sin + im * cos;
                assert!(i < 10 || (filter.extrapolate(p).x - expected).abs() < 5e-3, "{order:?} {i}");
            }
        }
    }

    #[test]
    fn a_sign_change_of_the_quaternion_is_not_a_rotation() {
        let mut filter = Extrapolation::new(Order::First, 1, DQuat::IDENTITY);
        filter.restart(0, DQuat::IDENTITY);
        filter.update(PS_PER_MS, -DQuat::IDENTITY);
        assert!(rotation::angle_deg(filter.extrapolate(0.1), DQuat::IDENTITY) < 1e-12);
    }
}
