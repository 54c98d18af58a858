use glam::DVec3;
use std::collections::VecDeque;

use super::channel::{Channel, VectorDifference};
use super::extrapolation::{Extrapolation, Order};
use crate::time::span_s;

/// Time in seconds over which the squares of past predictions count. Assumed, 1 to 10: a few movements of a head.
const CHECKED_S: f64 = 3.0;
/// Least mean square error, m^2 or rad^2. It only avoids a division by zero.
const LEAST: f64 = 1e-18;

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
    interval_ps: u64,
    /// Time and value of the newest report.
    newest: (u64, T),
    /// Past predictions for instants after the newest report: last report, constant velocity, filter.
    pending: VecDeque<(u64, [T; 3])>,
    squares: [f64; 3],
}

impl<T: VectorDifference, K: Channel<T>> Checked<T, K> {
    pub(super) fn new(filter: K, baseline: usize, interval_ps: u64, start: T) -> Self {
        Self {
            last: Extrapolation::new(Order::Zeroth, 1, start),
            velocity: Extrapolation::new(Order::First, baseline, start),
            filter,
            interval_ps,
            newest: (0, start),
            pending: VecDeque::new(),
            squares: [0.0; 3],
        }
    }

    fn each(&self, dt_s: f64) -> [T; 3] {
        [self.last.extrapolate(dt_s), self.velocity.extrapolate(dt_s), self.filter.extrapolate(dt_s)]
    }

    /// Compares past predictions with the pose between two successive reports.
    fn check(&mut self, t_ps: u64, value: T) {
        let (before_ps, before) = self.newest;
        let way = value.since(before);
        while let Some((at_ps, predicted)) = self.pending.pop_front_if(|(at_ps, _)| *at_ps <= t_ps) {
            let part = span_s(before_ps, at_ps) / span_s(before_ps, t_ps);
            let reported = before.moved(way * part);
            let kept = libm::exp(-span_s(before_ps, t_ps) / CHECKED_S);
            for (square, predicted) in self.squares.iter_mut().zip(predicted) {
                *square = *square * kept + predicted.since(reported).length_squared();
            }
        }
    }
}

impl<T: VectorDifference, K: Channel<T>> Channel<T> for Checked<T, K> {
    fn restart(&mut self, t_ps: u64, value: T) {
        self.last.restart(t_ps, value);
        self.velocity.restart(t_ps, value);
        self.filter.restart(t_ps, value);
        self.newest = (t_ps, value);
        self.pending.clear();
        self.squares = [0.0; 3];
    }

    fn update(&mut self, t_ps: u64, value: T) {
        self.check(t_ps, value);
        self.last.update(t_ps, value);
        self.velocity.update(t_ps, value);
        self.filter.update(t_ps, value);
        self.newest = (t_ps, value);
        self.pending.push_back((t_ps + self.interval_ps, self.each(span_s(0, self.interval_ps))));
    }

    fn extrapolate(&self, dt_s: f64) -> T {
        let filtered = self.filter.extrapolate(dt_s);
        // A prediction loses weight by the sixth power of its square error (assumed, 3 to 10): the best one decides,
        // unless another is nearly as good.
        let weights = self.squares.map(|square| {
            let cube = (square + LEAST) * (square + LEAST) * (square + LEAST);
            1.0 / (cube * cube)
        });
        let all: f64 = weights.iter().sum();
        // Before the first check all weights are equal, and the filter alone counts.
        if self.squares == [0.0; 3] {
            return filtered;
        }
        let moved = |(weight, value): (f64, T)| value.since(filtered) * (weight / all);
        filtered.moved(weights.into_iter().zip(self.each(dt_s)).map(moved).sum::<DVec3>())
    }
}
