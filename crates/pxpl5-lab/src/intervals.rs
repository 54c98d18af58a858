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
//! Some figures need a simulation with events ([`Varied::ByEvents`]). For these figures, a few parameters vary one at a
//! time, and the interpretations too if they change the figure. The fly-throughs are among them, because the formulas
//! deviate from the simulation by more than the distance of these latencies to the next retrace.

use crate::figures::{FigureSettings, Interpretation, Measurement, PHOTODIODE_LINE, Varied, all};
use crate::parallel;
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

/// Number of seeds and of frames of the scene "mig" for each machine that is simulated with events. The latencies of a
/// machine hardly depend on the seed, except for the scene "head".
const MIG_OF_EVENTS: (u64, u64) = (1, 30);

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
    /// Number of the figure in ACCURACY.md.
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
    ("slats-1995:gp.triangle_ns", GpTiming::SLATS_1995.triangle_ns, (59_500, 60_000)),
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

/// Computes the intervals of all figures. `settings` has the settings of all measurements. The list is empty if another
/// thread sets the flag of `settings`.
pub fn intervals(settings: &FigureSettings) -> Vec<Interval> {
    let by_events: Vec<&Measurement> = all().filter(|figure| matches!(figure.varied, Varied::ByEvents(_))).collect();
    let of_events = || parallel::map(&by_events, |figure| with_events(settings, figure));
    let (mut intervals, of_events) = parallel::both(|| by_formula(settings), of_events);
    intervals.extend(of_events.into_iter().flatten());
    // After a stop, values are missing.
    if settings.stop.is_stopped() { Vec::new() } else { intervals }
}

/// Computes the intervals at the analytic level.
fn by_formula(settings: &FigureSettings) -> Vec<Interval> {
    let figures: Vec<&Measurement> = all().filter(|figure| figure.varied == Varied::ByFormula).collect();
    let settings = FigureSettings { level: Level::Analytic, ..settings.clone() }.with_mig(MIG.0, MIG.1);
    // A figure without a result is `None`.
    let measure = |settings: &FigureSettings| -> Vec<Option<f64>> {
        let value = |figure: &&Measurement| Some(figure.value(settings).ok()?.value).filter(|value| value.is_finite());
        figures.iter().map(value).collect()
    };
    let variations = variations();
    let nominal = measure(&settings);
    let ends: Vec<_> = variations.iter().flat_map(|v| [(v, v.range.0), (v, v.range.1)]).collect();
    // Measure at both ends of each range, one parameter at a time.
    let at_ends = parallel::map(&ends, |(v, value)| measure(&settings.with_changes([(v.path.clone(), *value)])));
    let samples: Vec<u64> = (0..SAMPLES).collect();
    // Measure machines with all parameters drawn at random.
    let joint = parallel::map(&samples, |sample| measure(&settings.with_changes(draw(&variations, *sample))));
    let neighbours = settings.interpretation.neighbours();
    // Measure with other interpretations, each with another answer to one question.
    let results = parallel::map(&neighbours, |interpretation| measure(&settings.with(*interpretation)));
    // Collect the results for each figure. A missing value counts as the value for the presets.
    // A figure without a value on the random machines, as after a stop, has no interval.
    let of_figure = |(index, figure): (usize, &&Measurement)| {
        let nominal = nominal[index].unwrap_or(f64::NAN);
        let ends: Vec<f64> = at_ends.iter().map(|all| all[index].unwrap_or(nominal)).collect();
        let joint: Vec<f64> = joint.iter().filter_map(|all| all[index]).collect();
        if joint.is_empty() {
            return None;
        }
        let mut interval = interval(figure.id, nominal, &ends, joint, &variations);
        let values =
            neighbours.iter().zip(&results).filter_map(|(interpretation, all)| Some((*interpretation, all[index]?)));
        interval.add_interpretations(&settings.interpretation, values);
        Some(interval)
    };
    figures.iter().enumerate().filter_map(of_figure).collect()
}

/// Computes the interval of a figure with events. One parameter at a time is set to each end of its range, while all
/// others have their presets. If the figure depends on the interpretation, each other answer to one question is tried
/// too. The value for the presets replaces the result of a failed experiment.
fn with_events(settings: &FigureSettings, figure: &Measurement) -> Option<Interval> {
    let Varied::ByEvents(paths) = figure.varied else { return None };
    let settings = settings.clone().with_mig(MIG_OF_EVENTS.0, MIG_OF_EVENTS.1);
    let nominal = figure.value(&settings).ok()?.value;
    let all = variations().into_iter().chain(photodiode_line());
    let variations: Vec<_> = all.filter(|v| paths.contains(&v.path.as_str())).collect();
    let ends: Vec<_> = variations.iter().flat_map(|v| [(v, v.range.0), (v, v.range.1)]).collect();
    let ends = parallel::map(&ends, |(v, value)| {
        let moved = settings.with_changes([(v.path.clone(), *value)]);
        // The end of a range can be the value that all machines have.
        if settings.has_machines_of(&moved) {
            return nominal;
        }
        figure.value(&moved).map_or(nominal, |measured| measured.value)
    });
    let mut interval = interval(figure.id, nominal, &ends, vec![nominal], &variations);
    if figure.is_interpreted {
        let neighbours = settings.interpretation.neighbours();
        let results =
            parallel::map(&neighbours, |other| Some((*other, figure.value(&settings.with(*other)).ok()?.value)));
        interval.add_interpretations(&settings.interpretation, results.into_iter().flatten());
    }
    Some(interval)
}

/// Returns the line of the screen under the photodiode as a parameter that varies. The preset's value is assumed.
fn photodiode_line() -> Option<Variation> {
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

/// Copies the computed intervals into the rows of the figures. Only intervals of formulas have a value of the analytic
/// level.
pub(crate) fn fill(rows: &mut [FigureRow], intervals: &[Interval]) {
    for row in rows {
        let interval = intervals.iter().find(|interval| interval.id == row.id);
        let is_formula = all().any(|figure| figure.id == row.id && figure.varied == Varied::ByFormula);
        row.analytic = interval.filter(|_| is_formula).map(|interval| interval.nominal);
        row.interval = interval.map(Interval::bounds);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::FigureValue;

    fn figure(id: &str) -> &'static Measurement {
        all().find(|figure| figure.id == id).expect("listed")
    }

    /// Returns row 2 of ACCURACY.md for a simulated value. The published value of this row is 31.2 ms. The interval of
    /// the analytic level is 20 to 22 ms, with 21 ms for the presets.
    fn row_of_figure_2(simulated: f64) -> FigureRow {
        let figure = figure("2");
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
        let mut rows = [figure("8").row(FigureValue::from(9.0))];
        fill(&mut rows, &[]);
        assert_eq!((rows[0].interval, rows[0].analytic), (None, None));
        assert!(!rows[0].is_out_of_reach());
    }

    /// Tests the effect of the line at which the photodiode is mounted. The last of the 240 lines lights 239 times
    /// 63.56 us after the first line.
    #[test]
    fn the_figure_of_the_pendulum_rig_moves_with_the_line_of_the_photodiode() {
        let interval = with_events(&FigureSettings::new(Level::Analytic), figure("17")).expect("it is measured");
        let line = interval.effects.iter().find(|effect| effect.path == PHOTODIODE_LINE).expect("it moves");
        let [low, high] = line.ends;
        assert!((high - low - 239.0 * 0.063_556).abs() < 0.01, "{low} to {high}");
        assert!(low < interval.nominal && interval.nominal < high);
        let mut rows = [figure("17").row(FigureValue::from(interval.nominal))];
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
