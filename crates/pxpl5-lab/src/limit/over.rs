//! Limits of any numeric setting: the smallest or greatest value with which an experiment reaches a goal.

use super::is_reached;
use crate::error::StudyError;
use crate::estimate::{Estimate, RunWork};
use crate::experiment_file::{ExperimentFile, Plan};
use crate::study::{Study, check};
use pxpl5_machine::{MachineConfig, PRESETS};
use pxpl5_measure::{CriticalPath, Resource, Shares, Utilisation};
use pxpl5_run::{Experiment, ExperimentError, Goal, KeptRecords, Level, Outcome, Pixels};
use pxpl5_scene::Scene;
use pxpl5_sim::parameters::{SettingError, Value};
use pxpl5_sim::{StopFlag, Watcher};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Equally spaced values of a setting, of which a search tries some.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Values {
    /// Smallest value that a search can try.
    pub from: f64,
    /// Difference between neighbouring values, which is 1 for whole numbers.
    pub step: f64,
    /// Number of values, at least 2.
    pub count: u64,
}

impl Values {
    /// Returns the whole numbers from `from` to `to`, or `None` if there are fewer than two.
    pub fn whole(from: u64, to: u64) -> Option<Self> {
        (to > from).then(|| Self { from: from as f64, step: 1.0, count: to - from + 1 })
    }

    /// Returns real numbers from `from` to `to` in [`STEPS`] equal steps, or `None` for an empty range.
    pub fn real(from: f64, to: f64) -> Option<Self> {
        let step = (to - from) / STEPS as f64;
        (step > 0.0 && step.is_finite()).then_some(Self { from, step, count: STEPS + 1 })
    }

    /// Returns the value with the index `number`, counted from 0.
    pub fn value(&self, number: u64) -> f64 {
        self.from + self.step * number as f64
    }

    /// Returns the greatest value that a search can try.
    pub fn last(&self) -> f64 {
        self.value(self.count - 1)
    }

    fn is_whole(&self) -> bool {
        self.step == 1.0 && self.from.fract() == 0.0
    }

    /// Formats a value as the text of a setting. Whole numbers have no decimal point.
    pub fn text(&self, value: f64) -> String {
        if self.is_whole() { format!("{value:.0}") } else { format!("{value:?}") }
    }
}

/// Limit below which a 64-bit floating-point number represents every whole number.
const MAX_WHOLE: f64 = 1e15;

/// Number of steps between the ends of a range of real numbers.
pub const STEPS: u64 = 64;

/// Estimated number of tried values: five values, and the values of two bisections. For a setting with fractions, a
/// bisection divides the range into 64 steps.
pub const USUAL_VALUES: u64 = 12;

/// A search for the values of one setting with which an experiment reaches a goal.
#[derive(Clone, Debug)]
pub struct OverQuery {
    /// The experiment, with values of all settings except the varied setting.
    pub file: ExperimentFile,
    /// Path of the varied setting, such as `machine.n_gps`.
    pub key: String,
    /// Values of the varied setting, of which the search tries some.
    pub values: Values,
    /// Goal that the experiment must reach.
    pub goal: Goal,
}

/// Result of a search for the values of a setting that reach a goal.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct OverLimit {
    /// Smallest value that reaches the goal. `None` if no value reaches the goal, or if no smaller value misses the
    /// goal.
    pub least: Option<f64>,
    /// Greatest value that reaches the goal. `None` if no value reaches the goal, or if no greater value misses the
    /// goal.
    pub most: Option<f64>,
    /// True if at least one tried value reaches the goal.
    pub reached: bool,
    /// All tried values in ascending order. The boolean is true if the value reaches the goal.
    pub tried: Vec<(f64, bool)>,
    /// Tried values beyond the limits that reach the goal again.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub islands: Vec<f64>,
    /// A value that misses the goal: the value next to the limit, or the best value if all values miss.
    pub missed_at: Option<f64>,
    /// Resource that limits the experiment with the value `missed_at`, in words.
    pub because: Option<String>,
}

struct Trial {
    reached: bool,
    /// Closeness of the result to the goal, in the unit of the goal. A greater score is better.
    score: f64,
    because: Option<String>,
}

impl Study for OverQuery {
    type Report = OverLimit;

    /// Estimates the search by the experiment with the greatest value.
    fn estimate(&self, _: usize) -> Estimate {
        let work = || {
            let plan = self.plan(self.values.last()).ok()?;
            Some(RunWork::of(&plan.experiment(plan.load_scene().ok()?), false).estimate())
        };
        work().map_or(Estimate::NOTHING, |one| Estimate::of_all([one; USUAL_VALUES as usize], 1))
    }

    /// Searches for the limit.
    ///
    /// The search first tries the ends of the range and three values between them. If one of these values reaches the
    /// goal, the search bisects the range on both sides of this value. Values that miss may separate values that reach
    /// the goal. Then the limits are those of the largest group, and of two equal groups those of the group at an end
    /// of the range. The limit is exact if all values on one side of the limit reach the goal and all values on the
    /// other side miss.
    fn run(&self, watcher: &mut dyn Watcher) -> Result<OverLimit, StudyError> {
        let mut search =
            Search { query: self, stop: watcher.stop(), trials: BTreeMap::new(), refused: None, scene: None };
        let last = self.values.count - 1;
        for number in [0, last, last / 2, last / 4, last - last / 4] {
            search.reaches(number);
            search.report(watcher);
        }
        // The values after a stop were not tried.
        check(&watcher.stop())?;
        let Some(inside) = search.largest_group() else { return search.none() };
        // Search towards smaller values, then towards greater values.
        let misses = |search: &Search<'_>, down: bool| {
            let of = search.trials.iter().filter(|(_, trial)| !trial.reached).map(|(number, _)| *number);
            if down { of.filter(|number| *number < inside).max() } else { of.filter(|number| *number > inside).min() }
        };
        let mut ends = [None, None];
        for (end, down) in ends.iter_mut().zip([true, false]) {
            let Some(mut miss) = misses(&search, down) else { continue };
            let mut hit = inside;
            while miss.abs_diff(hit) > 1 {
                let middle = u64::midpoint(miss, hit);
                if search.reaches(middle) {
                    hit = middle
                } else {
                    miss = middle
                }
                search.report(watcher);
            }
            *end = Some((hit, miss));
        }
        check(&watcher.stop())?;
        let [least, most] = ends;
        let miss = least.or(most).map(|(_, miss)| miss);
        let is_beyond =
            |number: u64| least.is_some_and(|(hit, _)| number < hit) || most.is_some_and(|(hit, _)| number > hit);
        let again = search.trials.iter().filter(|(number, trial)| trial.reached && is_beyond(**number));
        let islands = again.map(|(number, _)| self.values.value(*number)).collect();
        Ok(OverLimit {
            least: least.map(|(hit, _)| self.values.value(hit)),
            most: most.map(|(hit, _)| self.values.value(hit)),
            reached: true,
            missed_at: miss.map(|miss| self.values.value(miss)),
            because: miss.and_then(|miss| search.trials[&miss].because.clone()),
            islands,
            tried: search.tried(),
        })
    }
}

impl OverQuery {
    /// Returns the values of a setting that a search can try, from `from` to `to`. The values are whole numbers if both
    /// ends are whole and not negative. If an end is `None`, the default range gives this end.
    ///
    /// The default range of a number of boards is 1 to the number of boards in the largest preset. The default range of
    /// any other parameter is the range that the sources of the parameter allow.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] for a setting without a default range, and for an empty range.
    pub fn values(plan: &Plan, key: &str, from: Option<f64>, to: Option<f64>) -> Result<Values, SettingError> {
        let (from, to) = match (from, to) {
            (None, None) => return Self::default_values(plan, key),
            (Some(from), Some(to)) => (from, to),
            _ => {
                let values = Self::default_values(plan, key)?;
                (from.unwrap_or(values.from), to.unwrap_or(values.last()))
            }
        };
        let is_whole = from.fract() == 0.0 && to.fract() == 0.0 && from >= 0.0 && to < MAX_WHOLE;
        let values = if is_whole { Values::whole(from as u64, to as u64) } else { Values::real(from, to) };
        values.ok_or_else(|| {
            SettingError::value("range", "a least value below the greatest", format_args!("{from} to {to}"))
        })
    }

    fn default_values(plan: &Plan, key: &str) -> Result<Values, SettingError> {
        let path = key.strip_prefix("machine.").unwrap_or(key);
        let found = if ["n_gps", "n_renderers"].contains(&path) {
            // The largest preset is the largest machine with a source.
            let presets = PRESETS.iter().filter_map(|preset| MachineConfig::preset(preset.name).ok());
            let boards = presets.flat_map(|machine| machine.settings()).filter(|(own, _)| own == path);
            Values::whole(1, boards.filter_map(|(_, boards)| boards.whole()).max().unwrap_or(1))
        } else {
            let parameter = plan.parameters().into_iter().find(|parameter| parameter.path == path);
            parameter.and_then(|parameter| match parameter.info.range {
                (Value::Whole(low), Value::Whole(high)) => Values::whole(low, high),
                (low, high) => Values::real(low.real(), high.real()),
            })
        };
        found.ok_or_else(|| {
            SettingError::missing("range", format_args!("the least and the greatest value of {key} that is tried"))
        })
    }

    fn plan(&self, value: f64) -> Result<Plan, SettingError> {
        let mut file = self.file.clone();
        file.set_text(&format!("{}={}", self.key, self.values.text(value)), "limit")?;
        file.resolve()
    }
}

struct Search<'a> {
    query: &'a OverQuery,
    stop: StopFlag,
    trials: BTreeMap<u64, Trial>,
    /// The error of the last value with which no experiment could run.
    refused: Option<StudyError>,
    scene: Option<(crate::SceneChoice, Arc<Scene>)>,
}

impl Search<'_> {
    /// Returns true if the experiment with the value of index `number` reaches the goal. A value without a valid
    /// experiment misses the goal.
    fn reaches(&mut self, number: u64) -> bool {
        if let Some(trial) = self.trials.get(&number) {
            return trial.reached;
        }
        let trial = self.run(self.query.values.value(number)).unwrap_or_else(|error| {
            let because = Some(error.to_string());
            self.refused = Some(error);
            Trial { reached: false, score: f64::NEG_INFINITY, because }
        });
        let reached = trial.reached;
        self.trials.insert(number, trial);
        reached
    }

    fn run(&mut self, value: f64) -> Result<Trial, StudyError> {
        check(&self.stop)?;
        let plan = self.query.plan(value)?;
        let scene = self.load(&plan)?;
        let goal = self.query.goal;
        // The analytic level records no waits, so it cannot name the limiting resource.
        if plan.level == Level::Analytic {
            let summary = plan.run(scene)?.summary;
            let score = score(goal, &summary);
            return Ok(Trial { reached: is_reached(goal, &summary), score, because: None });
        }
        let experiment: Experiment =
            plan.experiment(scene).pixels(Pixels::Off).keep(KeptRecords::Statistics).stopped_by(self.stop.clone());
        // A run that ended early misses the goal, but its records still show the limiting resource.
        let (outcome, is_whole) = match experiment.run() {
            Ok(outcome) => (outcome, true),
            Err(ExperimentError::TooShort { partial, .. } | ExperimentError::Run { partial, .. }) => (*partial, false),
            Err(error) => return Err(error.into()),
        };
        let summary = outcome.summary();
        let reached = is_whole && is_reached(goal, &summary);
        Ok(Trial { reached, score: score(goal, &summary), because: (!reached).then(|| because(&outcome)).flatten() })
    }

    fn load(&mut self, plan: &Plan) -> Result<Arc<Scene>, SettingError> {
        if let Some((_, scene)) = self.scene.as_ref().filter(|(choice, _)| *choice == plan.scene) {
            return Ok(Arc::clone(scene));
        }
        let scene = plan.load_scene()?;
        self.scene = Some((plan.scene.clone(), Arc::clone(&scene)));
        Ok(scene)
    }

    /// Returns a value of the largest group of tried values that all reach the goal. An end of the range makes a group
    /// larger, because monotony ends there only.
    fn largest_group(&self) -> Option<u64> {
        let last = self.query.values.count - 1;
        let trials: Vec<(u64, bool)> = self.trials.iter().map(|(number, trial)| (*number, trial.reached)).collect();
        let groups = trials.chunk_by(|a, b| a.1 == b.1).filter(|group| group[0].1);
        let size = |group: &&[(u64, bool)]| {
            let has_end = group.iter().any(|(number, _)| [0, last].contains(number));
            (group.len(), has_end)
        };
        groups.max_by_key(size).map(|group| group[group.len() - 1].0)
    }

    fn report(&self, watcher: &mut dyn Watcher) {
        let tried = self.trials.len() as u64;
        watcher.progress(tried, tried.max(USUAL_VALUES));
    }

    fn tried(&self) -> Vec<(f64, bool)> {
        self.trials.iter().map(|(number, trial)| (self.query.values.value(*number), trial.reached)).collect()
    }

    /// Returns the result of a search in which all values miss the goal. The run with the best value determines the
    /// limiting resource.
    fn none(mut self) -> Result<OverLimit, StudyError> {
        let is_refused = self.trials.values().all(|trial| trial.score == f64::NEG_INFINITY);
        if let Some(error) = self.refused.take().filter(|_| is_refused) {
            return Err(error);
        }
        let best = self.trials.iter().max_by(|a, b| a.1.score.total_cmp(&b.1.score));
        let (missed_at, because) =
            best.map(|(number, trial)| (self.query.values.value(*number), trial.because.clone())).unzip();
        Ok(OverLimit { tried: self.tried(), missed_at, because: because.flatten(), ..OverLimit::default() })
    }
}

fn score(goal: Goal, summary: &pxpl5_run::Summary) -> f64 {
    let score = match goal {
        Goal::NoMissedRetrace => summary.due.map(|due| -(due.not_shown() as f64)),
        Goal::RateHz(_) => summary.updates_hz,
        Goal::LatencyFields(_) => Some(-summary.latency_fields().mean),
    };
    score.filter(|score| score.is_finite()).unwrap_or(f64::MIN)
}

/// Utilisation above which a board counts as always busy, and so limits the machine. Assumed: the warm-up and retraces
/// leave up to 5 % of a short run idle.
const FULL: f64 = 0.95;

/// Returns the limiting resource of a run in words. This resource is a board that is always busy. If no board is always
/// busy, it is the resource with the longest wait in the latency.
fn because(outcome: &Outcome) -> Option<String> {
    let Utilisation { renderers, gps, ports, ring, .. } = Utilisation::of(outcome.record())?;
    let (renderer, gp) = (("renderer", renderers.executing), ("GP", gps.busy));
    let (port, channel) = (("port", ports.busy), ("channel", ring.channels));
    // The ring fills the first channels first, so only all channels together can limit the machine.
    let is_full = |(board, shares): &&(&str, Shares)| {
        let share = if *board == "channel" { shares.mean } else { shares.max };
        share >= FULL
    };
    if let Some(full) = [&renderer, &gp, &port, &channel].into_iter().find(is_full) {
        return Some(busy(full));
    }
    let Some(path) = CriticalPath::of(outcome) else {
        // Channels are left out, because the ring always prefers the first free channel.
        let busiest = [&renderer, &gp, &port].into_iter().max_by(|a, b| a.1.max.total_cmp(&b.1.max))?;
        return Some(format!("no picture is complete in time, and {}", busy(busiest)));
    };
    let board = match path.parts.first()?.resource {
        Resource::Renderers => Some(&renderer),
        Resource::Ports => Some(&port),
        Resource::Transform | Resource::Messages => Some(&gp),
        _ => None,
    };
    let busiest = board.map_or_else(String::new, |board| format!("; {}", busy(board)));
    Some(format!("limited by {}{busiest}", path.limited_by))
}

fn busy((board, shares): &(&str, Shares)) -> String {
    let idle = if shares.idle > 0 { format!(", {} are idle", shares.idle) } else { String::new() };
    format!("{board} {} is {:.0} % busy{idle}", shares.busiest, shares.max * 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_are_printed_without_a_decimal_point() {
        let values = Values::whole(2, 50).expect("a range");
        assert_eq!((values.count, values.text(values.value(3))), (49, "5".to_owned()));
        assert_eq!(Values::whole(5, 5), None);
    }

    #[test]
    fn real_numbers_advance_in_equal_steps_to_the_end_of_the_range() {
        let values = Values::real(0.0, 16.0).expect("a range");
        assert_eq!((values.value(1), values.last(), values.text(0.25)), (0.25, 16.0, "0.25".to_owned()));
        assert_eq!(Values::real(1.0, 1.0), None);
    }
}
