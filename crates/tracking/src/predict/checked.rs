use glam::DVec3;
use std::collections::VecDeque;

use super::channel::{Channel, VectorDifference};
use super::extrapolation::{Extrapolation, Order};
use crate::time::span_s;

/// Time in seconds over which the squares of past predictions count. Assumed, 1 to 10: a few movements of a head.
const CHECKED_S: f64 = 3.0;
/// Least mean square error, m^2 or rad^2. It only avoids a division by zero.
const LEAST: f64 = 1e-18;

/// Share of the prediction interval at which predictions are checked too. A display that moves pictures needs poses that
/// are nearer than those of the pictures.
const NEAR: u64 = 4;

/// A Kalman filter that is checked against two simpler predictions: the last report, and a constant velocity.
///
/// A filter is tuned for one kind of motion, and a head has several. So this channel predicts every report from the
/// reports that came an interval earlier, in all three ways, and gives each way a weight by its recent errors. Where the
/// filter expects more or less motion than there is, a simpler prediction takes over.
#[derive(Clone, Debug)]
pub(super) struct Checked<T, K> {
    last: Extrapolation<T>,
    velocity: Extrapolation<T>,
    filter: K,
    /// Time and value of the newest report.
    newest: (u64, T),
    /// Checks over a share of the prediction interval, and over all of it.
    checks: [Check<T>; 2],
}

/// The errors of past predictions over one interval: last report, constant velocity, filter.
#[derive(Clone, Debug)]
struct Check<T> {
    interval_ps: u64,
    /// Predictions for instants after the newest report.
    pending: VecDeque<(u64, [T; 3])>,
    squares: [f64; 3],
}

impl<T: VectorDifference> Check<T> {
    /// Compares past predictions with the pose between two successive reports.
    fn compare(&mut self, (before_ps, before): (u64, T), (t_ps, value): (u64, T)) {
        let way = value.since(before);
        while let Some((at_ps, predicted)) = self.pending.front().copied().filter(|(at_ps, _)| *at_ps <= t_ps) {
            self.pending.pop_front();
            let reported = before.moved(way * (span_s(before_ps, at_ps) / span_s(before_ps, t_ps)));
            let kept = libm::exp(-span_s(before_ps, t_ps) / CHECKED_S);
            for (square, predicted) in self.squares.iter_mut().zip(predicted) {
                *square = *square * kept + predicted.since(reported).length_squared();
            }
        }
    }

    /// Returns the shares of the three predictions. Before the first check, the filter alone counts.
    fn shares(&self) -> [f64; 3] {
        if self.squares == [0.0; 3] {
            return [0.0, 0.0, 1.0];
        }
        // A prediction loses weight by the sixth power of its square error (assumed, 3 to 10): the best one decides,
        // unless another is nearly as good.
        let weights = self.squares.map(|square| {
            let cube = (square + LEAST) * (square + LEAST) * (square + LEAST);
            1.0 / (cube * cube)
        });
        let all: f64 = weights.iter().sum();
        weights.map(|weight| weight / all)
    }
}

impl<T: VectorDifference, K: Channel<T>> Checked<T, K> {
    pub(super) fn new(filter: K, baseline: usize, interval_ps: u64, start: T) -> Self {
        let check = |interval_ps| Check { interval_ps, pending: VecDeque::new(), squares: [0.0; 3] };
        Self {
            last: Extrapolation::new(Order::Zeroth, 1, start),
            velocity: Extrapolation::new(Order::First, baseline, start),
            filter,
            newest: (0, start),
            checks: [interval_ps / NEAR, interval_ps].map(check),
        }
    }

    fn each(&self, dt_s: f64) -> [T; 3] {
        [self.last.extrapolate(dt_s), self.velocity.extrapolate(dt_s), self.filter.extrapolate(dt_s)]
    }
}

impl<T: VectorDifference, K: Channel<T>> Channel<T> for Checked<T, K> {
    fn restart(&mut self, t_ps: u64, value: T) {
        self.last.restart(t_ps, value);
        self.velocity.restart(t_ps, value);
        self.filter.restart(t_ps, value);
        self.newest = (t_ps, value);
        for check in &mut self.checks {
            check.pending.clear();
            check.squares = [0.0; 3];
        }
    }

    fn update(&mut self, t_ps: u64, value: T) {
        self.checks.iter_mut().for_each(|check| check.compare(self.newest, (t_ps, value)));
        self.last.update(t_ps, value);
        self.velocity.update(t_ps, value);
        self.filter.update(t_ps, value);
        self.newest = (t_ps, value);
        for i in [0, 1] {
            let interval_ps = self.checks[i].interval_ps;
            let predicted = self.each(span_s(0, interval_ps));
            self.checks[i].pending.push_back((t_ps + interval_ps, predicted));
        }
    }

    fn extrapolate(&self, dt_s: f64) -> T {
        let filtered = self.filter.extrapolate(dt_s);
        // Between the two intervals the shares change evenly.
        let [near_s, far_s] = [0, 1].map(|i| span_s(0, self.checks[i].interval_ps));
        let part = ((dt_s.abs() - near_s) / (far_s - near_s).max(1e-9)).clamp(0.0, 1.0);
        let [near, far] = [0, 1].map(|i| self.checks[i].shares());
        let moves = self.each(dt_s).into_iter().zip(near.into_iter().zip(far));
        let moved = |(value, (near, far)): (T, (f64, f64))| value.since(filtered) * (near + (far - near) * part);
        filtered.moved(moves.map(moved).sum::<DVec3>())
    }
}
