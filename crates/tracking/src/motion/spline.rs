//! Uniform quintic B-splines with random coefficients: smooth noise that is not periodic and can be evaluated at any
//! instant without stored state.

use glam::DVec3;

use crate::identity::SettingSink;
use crate::random::{bell, bits, stream, unit};
use crate::time::seconds;

/// Variance of a spline whose coefficients are independent with variance 1. The variance is the integral of the squared
/// quintic B-spline, which equals the centre value of the B-spline of degree 11: 655177 / 1663200.
const VARIANCE: f64 = 655_177.0 / 1_663_200.0;

/// Number of successive knots with the same activity level. Periods of weak and of strong motion therefore last some
/// seconds.
const KNOTS_PER_SPELL: u64 = 8;

/// The distribution of the random activity level of a head. The level multiplies the motion's amplitude. With u uniform
/// in 0 to 1, the level is `calm + (1 - calm) u^power`, scaled to a mean square of 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Activity {
    pub(super) calm: f64,
    pub(super) power: u32,
}

impl Activity {
    fn mean_square(self) -> f64 {
        let calm = self.calm;
        let lively = 1.0 - self.calm;
        let power = f64::from(self.power);
        calm * calm + 2.0 * calm * lively / (power + 1.0) + lively * lively / (2.0 * power + 1.0)
    }

    /// Returns the activity level for a number from 0 to 1, before it is scaled to a mean square of 1.
    fn unscaled(self, u: f64) -> f64 {
        self.calm + (1.0 - self.calm) * u.powi(self.power as i32)
    }
}

/// Three independent random splines with the same knots, one for each coordinate.
#[derive(Clone, Debug)]
pub(super) struct Spline {
    spacing_ps: u64,
    scale: DVec3,
    activity: Activity,
    /// Root of the mean square of the unscaled activity levels.
    root_mean_square: f64,
    seeds: [u64; 3],
    spells: u64,
}

impl Spline {
    /// Creates splines whose values have the standard deviations `deviation`. Splines with the same seed `spells` have
    /// their periods of strong motion at the same times.
    pub(super) fn new(spacing_ps: u64, deviation: DVec3, activity: Activity, seed: u64, spells: u64) -> Self {
        let seeds = core::array::from_fn(|axis| stream(seed, axis as u64));
        let root_mean_square = activity.mean_square().sqrt();
        Self { spacing_ps, scale: deviation / VARIANCE.sqrt(), activity, root_mean_square, seeds, spells }
    }

    pub(super) fn identify(&self, key: &str, settings: &mut SettingSink) {
        let Self { spacing_ps, scale, activity, seeds, spells, .. } = self;
        let Activity { calm, power } = activity;
        let [x, y, z] = scale.to_array();
        let [a, b, c] = seeds;
        settings(key, &format_args!("{spacing_ps} {x} {y} {z} {calm} {power} {a} {b} {c} {spells}"));
    }

    /// Returns the three values of the splines at `t_ps`, and their derivatives per second.
    pub(super) fn at(&self, t_ps: u64) -> (DVec3, DVec3) {
        // Six B-splines overlap every knot interval.
        let knot = t_ps / self.spacing_ps;
        let u = (t_ps % self.spacing_ps) as f64 / self.spacing_ps as f64;
        let (weights, slopes) = basis(u);
        // The knots of six B-splines lie in at most two spells.
        let spell = |knot: u64| knot / KNOTS_PER_SPELL;
        let [first_gain, last_gain] = [knot, knot + 5].map(|knot| self.gain(spell(knot)));
        let mut value = DVec3::ZERO;
        let mut rate = DVec3::ZERO;
        for i in 0..6 {
            let own = knot + i as u64;
            let gain = if spell(own) == spell(knot) { first_gain } else { last_gain };
            let coefficient = self.coefficient(own, gain);
            value += coefficient * weights[i];
            rate += coefficient * slopes[i];
        }
        (value, rate / seconds(self.spacing_ps))
    }

    /// Returns the activity level of a spell.
    fn gain(&self, spell: u64) -> f64 {
        self.activity.unscaled(unit(bits(self.spells, spell))) / self.root_mean_square
    }

    fn coefficient(&self, knot: u64, gain: f64) -> DVec3 {
        let [x, y, z] = self.seeds.map(|seed| bell(bits(seed, knot)));
        DVec3::new(x, y, z) * self.scale * gain
    }
}

/// Returns the weights of the six quintic B-splines that overlap a knot interval, and their derivatives. `u` is the
/// fraction of the interval.
fn basis(u: f64) -> ([f64; 6], [f64; 6]) {
    let v = 1.0 - u;
    let u2 = u * u;
    let v2 = v * v;
    // Polynomials of the six B-splines in Horner form, times 120.
    let weights = [
        v2 * v2 * v,
        26.0 + u * (-50.0 + u * (20.0 + u * (20.0 + u * (-20.0 + 5.0 * u)))),
        66.0 + u2 * (-60.0 + u2 * (30.0 - 10.0 * u)),
        26.0 + u * (50.0 + u * (20.0 + u * (-20.0 + u * (-20.0 + 10.0 * u)))),
        1.0 + u * (5.0 + u * (10.0 + u * (10.0 + u * (5.0 - 5.0 * u)))),
        u2 * u2 * u,
    ];
    // Derivatives of these polynomials.
    let slopes = [
        -5.0 * v2 * v2,
        -50.0 + u * (40.0 + u * (60.0 + u * (-80.0 + 25.0 * u))),
        u * (-120.0 + u2 * (120.0 - 50.0 * u)),
        50.0 + u * (40.0 + u * (-60.0 + u * (-80.0 + 50.0 * u))),
        5.0 + u * (20.0 + u * (30.0 + u * (20.0 - 25.0 * u))),
        5.0 * u2 * u2,
    ];
    (weights.map(|w| w / 120.0), slopes.map(|s| s / 120.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVEN: Activity = Activity { calm: 1.0, power: 1 };

    #[test]
    fn the_weights_of_the_spline_basis_add_up_to_one() {
        for u in [0.0, 0.1, 0.5, 0.77, 1.0] {
            let (weights, slopes) = basis(u);
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            assert!(slopes.iter().sum::<f64>().abs() < 1e-14);
        }
    }

    #[test]
    fn value_and_slope_are_continuous_across_a_knot() {
        let spline = Spline::new(1_000_000, DVec3::ONE, EVEN, 1, 1);
        for knot in 1..50 {
            let before = spline.at(knot * 1_000_000 - 1);
            let after = spline.at(knot * 1_000_000);
            assert!((before.0 - after.0).length() < 1e-5);
            assert!((before.1 - after.1).length() * seconds(1_000_000) < 1e-5);
        }
    }

    #[test]
    fn the_variance_of_the_random_spline_is_the_square_of_the_stated_deviation() {
        // The mean covers 200,000 knots. Neighbouring values are correlated, so the standard error is about 0.5 %.
        for activity in [EVEN, Activity { calm: 0.2, power: 3 }] {
            let spline = Spline::new(1000, DVec3::new(1.0, 2.0, 0.5), activity, 9, 4);
            let sum = (0..400_000).map(|i| spline.at(i * 500).0).fold(DVec3::ZERO, |s, x| s + x * x);
            let ratio = sum / 400_000.0 / DVec3::new(1.0, 4.0, 0.25);
            assert!((ratio - 1.0).abs().max_element() < 0.03, "{ratio}");
        }
    }
}
