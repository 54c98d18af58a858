//! Intervals instead of points: what the figures do when parameters that no paper prints move within their ranges.
//!
//! Two designs, both at the analytic level, which follows the transaction level closely enough for differences:
//!
//! - *one at a time*: each parameter at the low and at the high end of its range, all others at their presets;
//! - *joint*: [`SAMPLES`] machines with every parameter drawn uniformly from its range, from a fixed seed.
//!
//! Parameters that were fitted to a figure stay what they are, except the two times per triangle of Slats, which move
//! within the range that gives the figure exactly. So the interval of a fitted figure says how much it would be off
//! if nothing were fitted anew.

use crate::figures::{Bench, FIGURES, Row};
use parameters::Standing;
use pxpl5_machine::MachineConfig;
use pxpl5_run::Level;
use pxpl5_sim::mix;
use serde::Serialize;

/// Machines of the joint sample.
pub const SAMPLES: u64 = 500;

/// Seed of the joint sample.
const SEED: u64 = 0x5EED_0F05;

/// Seeds and frames of the Mig in every sample.
const MIG: (u64, u64) = (2, 60);

/// A parameter that may be moved.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Variation {
    /// Its path; those of one preset begin with the preset's name and a colon.
    pub path: String,
    /// Its value in the preset.
    pub value: u64,
    /// Smallest and largest value that the sources allow.
    pub range: (u64, u64),
    /// Derived or assumed.
    pub standing: Standing,
}

/// What one parameter does to one figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Effect {
    /// The parameter.
    pub path: String,
    /// The figure with the parameter at the low and at the high end of its range.
    pub ends: [f64; 2],
    /// Relative change of the figure over relative change of the parameter, from end to end.
    pub elasticity: f64,
}

/// What the parameters' ranges imply for a figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// The figure.
    pub id: &'static str,
    /// At the presets, at the analytic level.
    pub nominal: f64,
    /// Least and greatest over the ends of every range, one parameter at a time.
    pub one_at_a_time: [f64; 2],
    /// Least and greatest over the joint sample.
    pub joint: [f64; 2],
    /// 5th and 95th percentile of the joint sample.
    pub likely: [f64; 2],
    /// Parameters that move the figure, the strongest first.
    pub effects: Vec<Effect>,
}

impl Interval {
    /// Both designs together, moved to where the figure is at another level.
    #[must_use]
    pub fn around(&self, simulated: f64) -> [f64; 2] {
        let shift = simulated - self.nominal;
        let low = self.one_at_a_time[0].min(self.joint[0]);
        let high = self.one_at_a_time[1].max(self.joint[1]);
        [low + shift, high + shift]
    }
}

/// Ranges of the times per triangle within which figures 12 and 14 come out exactly.
const FITTED: [(&str, u64, (u64, u64)); 2] =
    [("slats:gp.triangle_ns", 32_500, (32_300, 32_600)), ("slats-1995:gp.triangle_ns", 58_500, (58_100, 59_000))];

/// All parameters that are derived or assumed and have a range.
#[must_use]
pub fn variations() -> Vec<Variation> {
    let parameters = MachineConfig::small_hmd().parameters();
    let open =
        parameters.into_iter().filter(|p| p.info.standing != Standing::Published && p.info.range.0 < p.info.range.1);
    let of_machine = open.filter_map(|p| {
        let range = p.info.whole_range()?;
        Some(Variation { path: p.path, value: p.value.whole()?, range, standing: p.info.standing })
    });
    let fitted = FITTED.iter().map(|(path, value, range)| Variation {
        path: (*path).to_owned(),
        value: *value,
        range: *range,
        standing: Standing::Derived,
    });
    of_machine.chain(fitted).collect()
}

/// A figure that a combination of parameters leaves without a value counts as not moved.
fn measure(bench: &Bench, changes: Vec<(String, u64)>) -> Vec<Option<f64>> {
    let bench = Bench { changes, ..bench.clone() };
    let value = |figure: &crate::figures::Figure| bench.measure(figure.id).ok().map(|measured| measured.value);
    FIGURES.iter().map(|figure| if figure.id == OF_SCENES { None } else { value(figure) }).collect()
}

/// The figure that depends on the scenes alone; no parameter moves it.
const OF_SCENES: &str = "8";

/// Intervals of all figures.
#[must_use]
pub fn intervals() -> Vec<Interval> {
    let bench = Bench::new(Level::Analytic).with_mig(MIG.0, MIG.1);
    let (variations, nominal) = (variations(), measure(&bench, Vec::new()));
    let ends: Vec<_> = variations.iter().flat_map(|v| [(v, v.range.0), (v, v.range.1)]).collect();
    let at_ends = crate::parallel::map(&ends, |(v, value)| measure(&bench, vec![(v.path.clone(), *value)]));
    let samples: Vec<u64> = (0..SAMPLES).collect();
    let joint = crate::parallel::map(&samples, |sample| measure(&bench, draw(&variations, *sample)));
    let of = |(index, figure): (usize, &crate::figures::Figure)| {
        let nominal = nominal[index].unwrap_or(f64::NAN);
        let ends: Vec<f64> = at_ends.iter().map(|all| all[index].unwrap_or(nominal)).collect();
        let mut joint: Vec<f64> = joint.iter().filter_map(|all| all[index]).collect();
        joint.sort_by(f64::total_cmp);
        let part = |share: f64| joint[((joint.len() - 1) as f64 * share).round() as usize];
        Interval {
            id: figure.id,
            nominal,
            one_at_a_time: bounds(ends.iter().copied().chain([nominal])),
            joint: [part(0.0), part(1.0)],
            likely: [part(0.05), part(0.95)],
            effects: effects(&variations, &ends, nominal),
        }
    };
    FIGURES.iter().enumerate().filter(|(_, figure)| figure.id != OF_SCENES).map(of).collect()
}

fn draw(variations: &[Variation], sample: u64) -> Vec<(String, u64)> {
    let draw = |(index, v): (usize, &Variation)| {
        let hash = mix(SEED ^ mix(sample * 1_000 + index as u64));
        (v.path.clone(), v.range.0 + hash % (v.range.1 - v.range.0 + 1))
    };
    variations.iter().enumerate().map(draw).collect()
}

fn bounds(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

/// Smallest relative change that is listed.
const VISIBLE: f64 = 1e-3;

fn effects(variations: &[Variation], ends: &[f64], nominal: f64) -> Vec<Effect> {
    let effect = |(v, ends): (&Variation, &[f64])| {
        let relative = (v.range.1 - v.range.0) as f64 / v.value.max(1) as f64;
        let elasticity = (ends[1] - ends[0]) / nominal / relative;
        Effect { path: v.path.clone(), ends: [ends[0], ends[1]], elasticity }
    };
    let mut effects: Vec<_> = variations.iter().zip(ends.chunks(2)).map(effect).collect();
    let reach = |effect: &Effect| bounds(effect.ends.iter().map(|end| (end / nominal - 1.0).abs()))[1];
    effects.retain(|effect| reach(effect) > VISIBLE);
    effects.sort_by(|a, b| reach(b).total_cmp(&reach(a)));
    effects
}

/// Puts the intervals into the rows; the figure that depends on scenes alone gets the range of its scenes.
pub fn fill(rows: &mut [Row], intervals: &[Interval]) {
    for row in rows {
        let scenes = || bounds(row.details.iter().map(|detail| detail.value));
        let interval = intervals.iter().find(|interval| interval.id == row.id);
        row.interval = Some(interval.map_or_else(scenes, |interval| interval.around(row.simulated)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variation_lies_around_its_preset() {
        for v in variations() {
            assert!((v.range.0..=v.range.1).contains(&v.value), "{}", v.path);
        }
        for (path, value, _) in FITTED {
            let (preset, path) = path.split_once(':').expect("names a preset");
            let parameters = MachineConfig::preset(preset).expect("exists").parameters();
            assert_eq!(parameters.iter().find(|p| p.path == path).map(|p| p.value), Some(value.into()), "{preset}");
        }
    }

    #[test]
    fn draws_are_the_same_every_time_and_stay_in_range() {
        let all = variations();
        assert_eq!(draw(&all, 17), draw(&all, 17));
        assert_ne!(draw(&all, 17), draw(&all, 18));
        for sample in 0..100 {
            let in_range = |((_, value), v): (&(String, u64), &Variation)| (v.range.0..=v.range.1).contains(value);
            assert!(draw(&all, sample).iter().zip(&all).all(in_range));
        }
    }
}
