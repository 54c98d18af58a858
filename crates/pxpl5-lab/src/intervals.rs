//! Intervals of the published figures, while parameters that no paper prints vary within their ranges.
//!
//! The intervals come from three sets of experiments at the analytic level. For differences between settings, this
//! level agrees closely enough with the transaction level.
//!
//! - *one at a time*: one parameter at the low or high end of its range, all others at their presets
//! - *interpretations*: another answer to one open question of the papers at a time ([`Interpretation::neighbours`])
//! - *joint*: [`SAMPLES`] machines with every parameter drawn uniformly from its range, from a fixed seed
//!
//! Parameters that were fitted to a figure keep their values, except the time per triangle of the Slats code of 1995. It
//! varies within the range that reproduces the figure exactly. The interval of a fitted figure therefore shows the
//! figure's error without a new fit.
//!
//! Some figures need a simulation with events. For these figures, only two machine parameters without a source vary:
//! the depth of the FIFO and the number of channels of a sender. For the figure of the pendulum rig, the photodiode's
//! position and the interpretations vary too.

use crate::figures::{Bench, FIGURES, Interpretation, PHOTODIODE_LINE, WITHOUT_CLOSED_FORM};
use pxpl5_gp::GpTiming;
use pxpl5_machine::MachineConfig;
use pxpl5_run::Level;
use pxpl5_sim::figures::FigureRow;
use pxpl5_sim::mix;
use pxpl5_sim::parameters::Provenance;
use serde::Serialize;

/// Number of machines in the set of experiments *joint*. Each machine has random values of all varied parameters.
pub const SAMPLES: u64 = 500;

const SEED: u64 = 0x5EED_0F05;

/// Number of seeds and of frames of the scene "mig" for each random machine.
const MIG: (u64, u64) = (6, 150);

/// A parameter that varies within its range.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Variation {
    /// Path of the parameter. If the variation applies to one preset only, the path begins with the preset's name and a
    /// colon.
    pub path: String,
    /// Value of the parameter in the preset.
    pub value: u64,
    /// Smallest and largest value that the sources allow.
    pub range: (u64, u64),
    /// Provenance of the preset's value: derived or assumed, never published.
    pub provenance: Provenance,
}

/// Effect of one parameter on one figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Effect {
    /// Path of the parameter, as in [`Variation::path`].
    pub path: String,
    /// Values of the figure at the low end and at the high end of the parameter's range.
    pub ends: [f64; 2],
    /// Relative change of the figure divided by the relative change of the parameter, from the low to the high end of
    /// the range.
    pub elasticity: f64,
}

/// Interval of a figure's value due to the ranges of all unpublished parameters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// Number of the figure in [`FIGURES`].
    pub id: &'static str,
    /// Value of the figure for the presets at the analytic level. A figure without a closed form is simulated with
    /// events instead.
    pub nominal: f64,
    /// Minimum and maximum of the figure if one parameter at a time is set to each end of its range.
    pub one_at_a_time: [f64; 2],
    /// Minimum and maximum of the figure over the interpretations that change one answer at a time.
    pub interpretations: [f64; 2],
    /// Interpretations that change the figure, with the resulting value. The greatest change comes first.
    pub rules: Vec<(String, f64)>,
    /// Minimum and maximum of the figure over the random machines of the joint set.
    pub joint: [f64; 2],
    /// 5th and 95th percentile of the figure over the random machines of the joint set.
    pub likely: [f64; 2],
    /// Parameters that change the figure. The strongest effect comes first.
    pub effects: Vec<Effect>,
}

impl Interval {
    /// Returns the minimum and maximum over `one_at_a_time`, `interpretations` and `joint`.
    pub const fn bounds(&self) -> [f64; 2] {
        let [low, high] = self.of_parameters();
        [low.min(self.interpretations[0]), high.max(self.interpretations[1])]
    }

    /// Returns the minimum and maximum while only the parameters vary, with the same interpretation of the papers.
    pub const fn of_parameters(&self) -> [f64; 2] {
        [self.one_at_a_time[0].min(self.joint[0]), self.one_at_a_time[1].max(self.joint[1])]
    }
}

/// Times per triangle in nanoseconds of the machines for Slats. The time of 1994 is that of the code, with the range of
/// the scenes (docs/gp-timing.md). The time of 1995 is fitted to the largest number of triangles (row 14 of
/// ACCURACY.md), and any time within its range reproduces the figure exactly.
const OF_SLATS: [(&str, u64, (u64, u64)); 2] = [
    ("slats:gp.triangle_ns", GpTiming::SLATS_1994.triangle_ns, (27_066, 27_539)),
    ("slats-1995:gp.triangle_ns", 55_800, (55_400, 56_300)),
];

/// Returns all parameters that are derived or assumed, have a range, and can change a figure at the analytic level.
///
/// Parameters of the i860 are left out, because the analytic level executes no code. An interval would wrongly suggest
/// that these parameters never matter, but they matter at the cycle level. In the intervals, the range of
/// `gp.triangle_ns` stands for their effect.
pub fn variations() -> Vec<Variation> {
    let parameters = MachineConfig::small_hmd().parameters().into_iter().filter(|p| !p.path.starts_with("i860."));
    let open = parameters.filter(|p| p.info.provenance != Provenance::Published && p.info.range.0 < p.info.range.1);
    let of_machine = open.filter_map(|p| {
        let range = p.info.whole_range()?;
        Some(Variation { path: p.path, value: p.value.whole()?, range, provenance: p.info.provenance })
    });
    let of_slats = OF_SLATS.iter().map(|(path, value, range)| Variation {
        path: (*path).to_owned(),
        value: *value,
        range: *range,
        provenance: Provenance::Derived,
    });
    of_machine.chain(of_slats).collect()
}

/// Measures all figures with changed parameters. A figure without a result is `None`.
fn measure(bench: &Bench, changes: Vec<(String, u64)>) -> Vec<Option<f64>> {
    let bench = Bench { changes, ..bench.clone() };
    FIGURES.iter().map(|figure| value_of(&bench, figure.id)).collect()
}

/// Returns the value of a figure, or `None` if the figure has no closed form or no finite value.
fn value_of(bench: &Bench, id: &str) -> Option<f64> {
    if WITHOUT_CLOSED_FORM.contains(&id) {
        return None;
    }
    Some(bench.measure(id).ok()?.value).filter(|value| value.is_finite())
}

/// Computes the intervals of all figures at the analytic level. `bench` has the settings of all measurements. The list
/// is empty if another thread sets the flag of `bench`.
pub fn intervals(bench: &Bench) -> Vec<Interval> {
    let bench = Bench { level: Level::Analytic, ..bench.clone() }.with_mig(MIG.0, MIG.1);
    let variations = variations();
    let nominal = measure(&bench, Vec::new());
    let ends: Vec<_> = variations.iter().flat_map(|v| [(v, v.range.0), (v, v.range.1)]).collect();
    // Measure at both ends of each range, one parameter at a time.
    let at_ends = crate::parallel::map(&ends, |(v, value)| measure(&bench, vec![(v.path.clone(), *value)]));
    let samples: Vec<u64> = (0..SAMPLES).collect();
    // Measure machines with all parameters drawn at random.
    let joint = crate::parallel::map(&samples, |sample| measure(&bench, draw(&variations, *sample)));
    let neighbours = bench.interpretation.neighbours();
    // Measure with other interpretations, each with another answer to one question.
    let results = crate::parallel::map(&neighbours, |interpretation| measure(&bench.with(*interpretation), Vec::new()));
    // After a stop, values are missing.
    if bench.stop.is_stopped() {
        return Vec::new();
    }
    // Collect the results for each figure. A missing value counts as the value for the presets.
    let mut intervals = Vec::new();
    for (index, figure) in FIGURES.iter().enumerate().filter(|(_, figure)| !WITHOUT_CLOSED_FORM.contains(&figure.id)) {
        let nominal = nominal[index].unwrap_or(f64::NAN);
        let ends: Vec<f64> = at_ends.iter().map(|all| all[index].unwrap_or(nominal)).collect();
        let joint = joint.iter().filter_map(|all| all[index]).collect();
        let mut interval = interval(figure.id, nominal, &ends, joint, &variations);
        let values =
            neighbours.iter().zip(&results).filter_map(|(interpretation, all)| Some((*interpretation, all[index]?)));
        interval.add_interpretations(&bench.interpretation, values);
        intervals.push(interval);
    }
    intervals.extend(of_rig(&bench));
    intervals.extend(WITH_A_TRACKER.iter().filter_map(|id| with_events(&bench, id)));
    intervals
}

/// Figures of a tracker combined with a pipeline, which are always simulated with events.
const WITH_A_TRACKER: [&str; 2] = ["19", "19b"];

/// Machine parameters without a source, which vary for figures that need a simulation with events.
const OF_EVENTS: [&str; 2] = ["renderer.fifo_words", "ring.source_channels"];

/// Computes the interval of a figure that needs a simulation with events. One parameter of [`OF_EVENTS`] at a time is
/// set to each end of its range.
fn with_events(bench: &Bench, id: &'static str) -> Option<Interval> {
    let variations: Vec<_> = variations().into_iter().filter(|v| OF_EVENTS.contains(&v.path.as_str())).collect();
    let nominal = bench.measure(id).ok()?.value;
    let ends = ends_with_events(bench, id, &variations, nominal);
    Some(interval(id, nominal, &ends, vec![nominal], &variations))
}

/// Returns the values of a figure at both ends of each parameter's range, while all other parameters have their
/// presets. `nominal` replaces the result of a failed experiment.
fn ends_with_events(bench: &Bench, id: &str, variations: &[Variation], nominal: f64) -> Vec<f64> {
    let ends: Vec<_> = variations.iter().flat_map(|v| [(v, v.range.0), (v, v.range.1)]).collect();
    crate::parallel::map(&ends, |(v, value)| {
        let changes = bench.changes.iter().cloned().chain([(v.path.clone(), *value)]).collect();
        let moved = Bench { changes, ..bench.clone() };
        // The end of a range can be the value that all machines have.
        if bench.has_machines_of(&moved) {
            return nominal;
        }
        moved.measure(id).map_or(nominal, |measured| measured.value)
    })
}

/// Number in [`FIGURES`] of the figure from the pendulum rig.
const OF_RIG: &str = "17";

/// Computes the interval of the pendulum rig's figure by simulation with events. The photodiode's position, machine
/// parameters and interpretations vary.
fn of_rig(bench: &Bench) -> Option<Interval> {
    let value = |bench: Bench| Some(bench.measure(OF_RIG).ok()?.value);
    let of_machine = variations().into_iter().filter(|v| OF_EVENTS.contains(&v.path.as_str()));
    let variations: Vec<_> = [photodiode_line()?].into_iter().chain(of_machine).collect();
    let nominal = value(bench.clone())?;
    let ends = ends_with_events(bench, OF_RIG, &variations, nominal);
    let mut interval = interval(OF_RIG, nominal, &ends, vec![nominal], &variations);
    let neighbours = bench.interpretation.neighbours();
    let results = crate::parallel::map(&neighbours, |interpretation| value(bench.with(*interpretation)));
    let values =
        neighbours.into_iter().zip(results).filter_map(|(interpretation, value)| Some((interpretation, value?)));
    interval.add_interpretations(&bench.interpretation, values);
    Some(interval)
}

/// Returns the line of the screen under the photodiode as a parameter that varies. The preset's value is assumed.
pub(crate) fn photodiode_line() -> Option<Variation> {
    let line = crate::tracking_parameters().into_iter().find(|parameter| parameter.path == PHOTODIODE_LINE)?;
    let (value, range) = (line.value.whole()?, line.info.whole_range()?);
    Some(Variation { path: line.path, value, range, provenance: line.info.provenance })
}

/// Combines two sets of experiments into the interval of one figure. `ends` has the figure's values at both ends of
/// each parameter's range, one parameter after the other. `joint` has the figure's values on the random machines.
fn interval(id: &'static str, nominal: f64, ends: &[f64], mut joint: Vec<f64>, variations: &[Variation]) -> Interval {
    joint.sort_by(f64::total_cmp);
    Interval {
        id,
        nominal,
        one_at_a_time: bounds(ends.iter().copied().chain([nominal])),
        interpretations: [nominal; 2],
        rules: Vec::new(),
        joint: [percentile(&joint, 0.0), percentile(&joint, 1.0)],
        likely: [percentile(&joint, 0.05), percentile(&joint, 0.95)],
        effects: effects(variations, ends, nominal),
    }
}

impl Interval {
    fn add_interpretations(&mut self, usual: &Interpretation, values: impl Iterator<Item = (Interpretation, f64)>) {
        let reach = |value: f64| (value / self.nominal - 1.0).abs();
        // Interpretations without a visible effect are left out.
        let moving = values.filter(|(_, value)| reach(*value) > VISIBLE);
        let mut rules: Vec<_> =
            moving.map(|(interpretation, value)| (interpretation.difference(usual), value)).collect();
        rules.sort_by(|a, b| reach(b.1).total_cmp(&reach(a.1)));
        self.interpretations = bounds(rules.iter().map(|(_, value)| *value).chain([self.nominal]));
        self.rules = rules;
    }
}

/// Returns a percentile of an ascending list. `share` is the position of the percentile: 0 means the first value of the
/// list, and 1 means the last value. The position is rounded to the nearest value of the list.
fn percentile(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share).round() as usize]
}

fn draw(variations: &[Variation], sample: u64) -> Vec<(String, u64)> {
    let drawn = (0..).zip(variations).map(|(index, v)| {
        // The hash depends on the sample and the parameter only, so samples are reproducible.
        let hash = mix(SEED ^ mix(sample * 1_000 + index));
        (v.path.clone(), v.range.0 + hash % (v.range.1 - v.range.0 + 1))
    });
    drawn.collect()
}

fn bounds(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

/// Minimum relative change of a figure. Parameters and interpretations with smaller changes are not listed.
const VISIBLE: f64 = 1e-3;

fn effects(variations: &[Variation], ends: &[f64], nominal: f64) -> Vec<Effect> {
    let pairs = variations.iter().zip(ends.chunks(2));
    let mut effects: Vec<_> = pairs.map(|(v, ends)| effect(v, [ends[0], ends[1]], nominal)).collect();
    effects.retain(|effect| effect.reach(nominal) > VISIBLE);
    effects.sort_by(|a, b| b.reach(nominal).total_cmp(&a.reach(nominal)));
    effects
}

fn effect(v: &Variation, ends: [f64; 2], nominal: f64) -> Effect {
    let relative = (v.range.1 - v.range.0) as f64 / v.value.max(1) as f64;
    let elasticity = (ends[1] - ends[0]) / nominal / relative;
    Effect { path: v.path.clone(), ends, elasticity }
}

impl Effect {
    /// Returns the largest change of a figure that a parameter causes, relative to the value for the presets.
    fn reach(&self, nominal: f64) -> f64 {
        bounds(self.ends.iter().map(|end| (end / nominal - 1.0).abs()))[1]
    }
}

/// Copies the computed intervals into the rows of the figures. At the analytic level, a figure without a closed form
/// has no value.
pub fn fill(rows: &mut [FigureRow], intervals: &[Interval]) {
    for row in rows {
        let interval = intervals.iter().find(|interval| interval.id == row.id);
        let of_model = interval.filter(|interval| !WITHOUT_CLOSED_FORM.contains(&interval.id));
        row.analytic = of_model.map(|interval| interval.nominal);
        row.interval = interval.map(Interval::bounds);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::{Figure, FigureValue};

    /// Returns row 2 of ACCURACY.md for a simulated value. The published value of this row is 31.2 ms. The interval of
    /// the analytic level is 20 to 22 ms, with 21 ms for the presets.
    fn row_of_figure_2(simulated: f64) -> FigureRow {
        let figure: &Figure = FIGURES.iter().find(|figure| figure.id == "2").expect("listed");
        let interval = Interval {
            id: figure.id,
            nominal: 21.0,
            one_at_a_time: [20.5, 22.0],
            interpretations: [21.0, 21.0],
            rules: Vec::new(),
            joint: [20.0, 21.5],
            likely: [20.2, 21.0],
            effects: Vec::new(),
        };
        let mut rows = [figure.row(FigureValue::from(simulated))];
        fill(&mut rows, &[interval]);
        let [row] = rows;
        row
    }

    #[test]
    fn an_interval_is_not_moved_to_the_simulated_value() {
        for simulated in [1.0, 21.0, 500.0] {
            let row = row_of_figure_2(simulated);
            assert_eq!((row.interval, row.analytic), (Some([20.0, 22.0]), Some(21.0)));
        }
    }

    #[test]
    fn a_figure_outside_its_widened_interval_is_out_of_reach() {
        // 31.2 ms minus the last printed digit, 0.312, is 8.888 above the upper bound of 22 ms.
        for (distance, out_of_reach) in [(0.0, true), (8.8, true), (-8.8, true), (8.9, false), (-8.9, false)] {
            let row = row_of_figure_2(21.0 + distance);
            assert_eq!(row.is_out_of_reach(), out_of_reach, "levels {distance} ms apart");
        }
    }

    #[test]
    fn the_figure_without_a_closed_form_has_no_interval() {
        let figure = FIGURES.iter().find(|figure| figure.id == "8").expect("listed");
        let mut rows = [figure.row(FigureValue::from(9.0))];
        fill(&mut rows, &[]);
        assert_eq!((rows[0].interval, rows[0].analytic), (None, None));
        assert!(!rows[0].is_out_of_reach());
    }

    /// Tests the effect of the line at which the photodiode is mounted. The last of the 240 lines lights 239 times
    /// 63.56 us after the first line.
    #[test]
    fn the_figure_of_the_pendulum_rig_moves_with_the_line_of_the_photodiode() {
        let interval = of_rig(&Bench::new(Level::Analytic)).expect("it is measured");
        let line = interval.effects.iter().find(|effect| effect.path == PHOTODIODE_LINE).expect("it moves");
        let [low, high] = line.ends;
        assert!((high - low - 239.0 * 0.063_556).abs() < 0.01, "{low} to {high}");
        assert!(low < interval.nominal && interval.nominal < high);
        let figure = FIGURES.iter().find(|figure| figure.id == OF_RIG).expect("listed");
        let mut rows = [figure.row(FigureValue::from(interval.nominal))];
        fill(&mut rows, std::slice::from_ref(&interval));
        assert_eq!((rows[0].interval, rows[0].analytic), (Some(interval.bounds()), None));
    }

    #[test]
    fn every_variation_lies_around_its_preset() {
        for v in variations() {
            assert!((v.range.0..=v.range.1).contains(&v.value), "{}", v.path);
        }
        for (path, value, _) in OF_SLATS {
            let (preset, path) = path.split_once(':').expect("names a preset");
            let parameters = MachineConfig::preset(preset).expect("exists").parameters();
            assert_eq!(parameters.iter().find(|p| p.path == path).map(|p| p.value), Some(value.into()), "{preset}");
        }
    }

    #[test]
    fn random_parameters_are_the_same_for_each_sample_number_and_stay_in_range() {
        let all = variations();
        assert_eq!(draw(&all, 17), draw(&all, 17));
        assert_ne!(draw(&all, 17), draw(&all, 18));
        for sample in 0..100 {
            for ((path, value), v) in draw(&all, sample).iter().zip(&all) {
                assert!((v.range.0..=v.range.1).contains(value), "{path} = {value}");
            }
        }
    }
}
