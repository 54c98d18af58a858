//! The cheapest level of detail whose deviation from the cycle level stays within a bound.
//!
//! The cheaper levels use the mean times of the i860 code, and the cycle level runs this code for every triangle. So they
//! deviate in four ways. Each gives a condition that the closed form can evaluate:
//!
//! - **Scenes.** A mean time differs from the time in one scene, so the closed form is evaluated with primitives that
//!   take [`SCENES`] more and less. This also shows a limit of the load that is near.
//! - **Starts.** The begin of a pass, a clump or a chain has a time of its own, which depends on the caches
//!   ([`STARTS_MS`]). This matters where the compared time is short.
//! - **Rules.** The closed form knows only means of what several processors and renderers do at once ([`FORM_MS`]).
//! - **Retraces.** A picture waits for a retrace, so an error moves a latency by a whole period if a copy ends near one.

use super::{compared_ms, deviation_percent, summarise};
use crate::edges::to_other_retraces;
use pphigs::RegionBinning;
use pxpl5_run::{Experiment, ExperimentError, Level, Registry, RenderingControl, Slats, Summary};
use std::any::Any;
use std::fmt::{Display, Formatter, Result};

/// A level of detail for an experiment, with the reason for the choice.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelChoice {
    /// Chosen level.
    pub level: Level,
    /// Reason, for a reader.
    pub reason: String,
}

impl Display for LevelChoice {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "level {}: {}", self.level, self.reason)
    }
}

/// Part by which the time of a primitive in one scene may differ from the mean over scenes. Assumed: the test of the
/// times of code allows as much.
const SCENES: f64 = 0.05;
/// Largest fixed deviation of the transaction level, in milliseconds. Assumed: the largest one was 0.05 in the random
/// experiments 0 to 399, all of which were in view when this margin and the next ones were chosen.
const STARTS_MS: f64 = 0.06;
/// Largest deviation of the closed form from the transaction level, in milliseconds: under Slats with commands to all
/// regions, under Slats with commands to touched regions, and under Rendering Control. Assumed: the largest ones were
/// 0.02, 0.08 and 0.24.
const FORM_MS: [f64; 3] = [0.03, 0.1, 0.3];
/// Change in percent above which the time of primitives decides a latency of Rendering Control. The closed form of its
/// load is then up to 10 % off, so it is not used.
const LOADED_PERCENT: f64 = 0.5;

/// Returns the experiment with the times of its code in the table, at a level and with primitives that take `factor`
/// times as long.
fn with_times(experiment: &Experiment, level: Level, factor: f64) -> Experiment {
    let mut machine = experiment.config().clone().with_times_of_code(experiment.pipeline().properties().code_use);
    let gp = &mut machine.gp;
    for ns in [&mut gp.triangle_ns, &mut gp.sphere_ns, &mut gp.bin_entry_ns, &mut gp.guard_ns] {
        *ns = (*ns as f64 * factor).round() as u64;
    }
    experiment.clone().with_machine(machine).level(level)
}

/// Values of the closed form with primitives that take the mean time, less and more.
struct Forms {
    value_ms: f64,
    /// Deviation with less and with more time, in percent.
    spread_percent: f64,
    /// Distance of a copy from a retrace that would change a latency, in milliseconds.
    to_retrace_ms: f64,
    is_same_count: bool,
}

impl Forms {
    fn of(registry: &Registry, experiment: &Experiment) -> std::result::Result<Self, String> {
        if experiment.head.is_some() {
            return Err("a tracked head has no closed form".to_owned());
        }
        let summary = |factor| -> std::result::Result<Summary, ExperimentError> {
            summarise(registry, &with_times(experiment, Level::Analytic, factor))
        };
        let all =
            [1.0, 1.0 - SCENES, 1.0 + SCENES].map(summary).into_iter().collect::<std::result::Result<Vec<_>, _>>();
        let all = all.map_err(|error| match error {
            ExperimentError::Level => format!("{} has no closed form", experiment.pipeline().name()),
            other => format!("the closed form says: {other}"),
        })?;
        let values: Vec<f64> = all.iter().map(|summary| compared_ms(experiment, summary)).collect();
        let retraces = to_other_retraces(&all[0]).filter(|_| values[0].is_finite());
        let Some(retraces) = retraces else { return Err("the closed form shows no picture in time".to_owned()) };
        let shown = all.iter().map(|summary| summary.due.map(|due| due.not_shown()));
        let spread_percent = values[1..].iter().map(|value| deviation_percent(*value, values[0])).fold(0.0, f64::max);
        Ok(Self {
            value_ms: values[0],
            spread_percent,
            // The missing second distance of Slats is not a number, which `min` leaves out.
            to_retrace_ms: retraces[0].min(retraces[1]) * all[0].field_ms,
            is_same_count: shown.clone().all(|count| Some(count) == shown.clone().next()),
        })
    }
}

/// Chooses the cheapest level whose expected deviation from the cycle level is at most `within_percent`. Returns the
/// choice, and the experiment at this level with the times of its code. The analytic level is left out if
/// `needs_events` is true.
///
/// The deviation is that of [`compared_ms`]: mean latency, or the time to the first copy of Slats. Other quantities may
/// deviate more. Pipelines without a closed form, and tracked heads, run at the cycle level, because no formula
/// tells how near their copies end to a retrace.
pub fn choose_level(
    registry: &Registry,
    experiment: &Experiment,
    within_percent: f64,
    needs_events: bool,
) -> (LevelChoice, Experiment) {
    let cycle = |reason: String| {
        let choice = LevelChoice { level: Level::Cycle, reason };
        (choice, experiment.clone().level(Level::Cycle))
    };
    let forms = match Forms::of(registry, experiment) {
        Ok(forms) => forms,
        Err(reason) => return cycle(reason),
    };
    let pipeline = experiment.pipeline().as_ref() as &dyn Any;
    let slats: Option<&Slats> = pipeline.downcast_ref();
    // Other closed forms were never compared with the cycle level.
    if slats.is_none() && !pipeline.is::<RenderingControl>() {
        return cycle(format!("the deviation of the closed form of {} is not known", experiment.pipeline().name()));
    }
    let form_ms = FORM_MS[slats.map_or(2, |slats| usize::from(slats.binning != RegionBinning::All))];
    let is_loaded = slats.is_none() && forms.spread_percent > LOADED_PERCENT;
    let expected = |fixed_ms: f64| forms.spread_percent + 100.0 * fixed_ms / forms.value_ms;
    if !forms.is_same_count {
        let percent = 100.0 * SCENES;
        return cycle(format!(
            "{percent:.0} % more or less time of primitives changes how many pictures are shown in time"
        ));
    }
    if forms.to_retrace_ms < STARTS_MS + form_ms {
        return cycle(format!("a copy ends within {:.2} ms of a retrace that would change it", forms.to_retrace_ms));
    }
    let why_not = match expected(STARTS_MS + form_ms) {
        _ if needs_events => "events are wanted".to_owned(),
        _ if is_loaded => "the closed form is not exact under this load".to_owned(),
        percent if percent <= within_percent => {
            let reason = format!("it may be off by {percent:.1} %, and no retrace is near");
            let choice = LevelChoice { level: Level::Analytic, reason };
            return (choice, with_times(experiment, Level::Analytic, 1.0));
        }
        percent => format!("the closed form may be off by {percent:.1} %"),
    };
    let percent = expected(STARTS_MS);
    if percent > within_percent {
        return cycle(format!("mean times may be off by {percent:.1} %, {:.2} ms being compared", forms.value_ms));
    }
    let reason = format!("it may be off by {percent:.1} %; {why_not}");
    let choice = LevelChoice { level: Level::Transaction, reason };
    (choice, with_times(experiment, Level::Transaction, 1.0))
}
