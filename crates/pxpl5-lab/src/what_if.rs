//! Computes the effect of 10 % more of each resource of a machine.

use crate::levels::summarise;
use crate::parallel;
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, ExperimentError, KeptRecords, Pixels, Registry, Summary};
use serde::Serialize;

/// Effect of one changed resource of the machine on latency and update rate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WhatIf {
    /// Name of the increased resource.
    pub resource: &'static str,
    /// Key of the changed setting, such as `machine.n_gps`.
    pub key: &'static str,
    /// Value of the setting on the unchanged machine.
    pub from: u64,
    /// Value of the setting on the changed machine: a time divided by 1.1 and rounded up, or any other value increased
    /// by 10 % (at least by 1).
    pub to: u64,
    /// Mean latency in milliseconds before and after the change. `None` if no picture was complete.
    pub latency_ms: [Option<f64>; 2],
    /// Number of complete new pictures per second before and after the change. `None` if fewer than two pictures were
    /// shown.
    pub updates_hz: [Option<f64>; 2],
    /// Level of detail of the results: `analytic`, or the level of the run.
    pub level: &'static str,
}

/// A resource of the machine, and the setting for its amount or speed.
struct Knob {
    resource: &'static str,
    key: &'static str,
    /// True if the setting is a time, so that a faster machine has a smaller value.
    is_time: bool,
}

const KNOBS: [Knob; 6] = [
    Knob { resource: "graphics processors", key: "machine.n_gps", is_time: false },
    Knob { resource: "speed of a graphics processor", key: "machine.gp.triangle_ns", is_time: true },
    Knob { resource: "renderers", key: "machine.n_renderers", is_time: false },
    Knob { resource: "speed of a renderer", key: "machine.renderer.clock_hz", is_time: false },
    Knob { resource: "channels of the ring", key: "machine.ring.channels", is_time: false },
    Knob { resource: "speed of a channel and of a port", key: "machine.ring.word_ns", is_time: true },
];

impl Knob {
    fn value(&self, config: &MachineConfig) -> Option<u64> {
        let path = self.key.strip_prefix("machine.")?;
        match path {
            "n_gps" => Some(config.n_gps as u64),
            "n_renderers" => Some(config.n_renderers as u64),
            _ => config.parameters().into_iter().find(|parameter| parameter.path == path)?.value.whole(),
        }
    }

    /// Returns the old value of the setting, the new value, and the machine with 10 % more of the resource. Returns
    /// `None` if the machine cannot have more of the resource.
    fn more(&self, config: &MachineConfig) -> Option<(u64, u64, MachineConfig)> {
        let from = self.value(config)?;
        let to = if self.is_time { from.min((from * 10).div_ceil(11)) } else { from + (from / 10).max(1) };
        let mut more = config.clone();
        more.set(self.key.strip_prefix("machine.")?, to).ok()?;
        (to != from && more.check().is_ok()).then_some((from, to, more))
    }
}

/// Returns the effect of 10 % more of each resource: the experiment runs again for each resource, without pixels and in
/// parallel. Formulas are used only for an experiment at the analytic level. Near saturation they miss the times of a run
/// by more than a tenth of a resource changes, so they cannot be mixed with runs.
///
/// # Errors
///
/// Fails in the same cases as [`Experiment::run`] for the unchanged experiment. A changed experiment that cannot run
/// has no results.
pub fn what_if(registry: &Registry, experiment: &Experiment) -> Result<Vec<WhatIf>, ExperimentError> {
    let tried = experiment.clone().pixels(Pixels::Off).keep(KeptRecords::Statistics);
    let level = tried.modelling_level().name();
    // Change one resource at a time. All other settings stay the same.
    let changed: Vec<_> = KNOBS.iter().filter_map(|knob| Some((knob, knob.more(tried.config())?))).collect();
    let machines: Vec<&MachineConfig> =
        std::iter::once(tried.config()).chain(changed.iter().map(|(_, (.., machine))| machine)).collect();
    let mut summaries =
        parallel::map(&machines, |machine| summarise(registry, &tried.clone().with_machine((*machine).clone())))
            .into_iter();
    let base = summaries.next().ok_or(ExperimentError::Level)??;
    let of = |summary: Option<&Summary>| {
        let latency = summary.map(|summary| summary.latency_ms().mean).filter(|mean| mean.is_finite());
        (latency, summary.and_then(|summary| summary.updates_hz))
    };
    let rows = changed.iter().zip(summaries).map(|((knob, (from, to, _)), summary)| {
        let ((before_ms, before_hz), (after_ms, after_hz)) = (of(Some(&base)), of(summary.as_ref().ok()));
        let [latency_ms, updates_hz] = [[before_ms, after_ms], [before_hz, after_hz]];
        WhatIf { resource: knob.resource, key: knob.key, from: *from, to: *to, latency_ms, updates_hz, level }
    });
    Ok(rows.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_what_if_increase_is_a_tenth_and_at_least_one_step() {
        let config = MachineConfig::preset("large").expect("a preset");
        let tried: Vec<(u64, u64)> =
            KNOBS.iter().filter_map(|knob| knob.more(&config)).map(|(from, to, _)| (from, to)).collect();
        assert!(tried.contains(&(50, 55)), "graphics processors: {tried:?}");
        assert!(tried.contains(&(20, 22)), "renderers: {tried:?}");
        assert!(tried.contains(&(8, 9)), "channels: {tried:?}");
        assert!(tried.contains(&(50, 46)), "a word of 50 ns takes 50 / 1.1 = 45.5 ns, rounded up: {tried:?}");
        assert!(tried.contains(&(21_700, 19_728)), "21,700 / 1.1 = 19,727.3 ns, rounded up: {tried:?}");
        assert_eq!(tried.len(), KNOBS.len());
    }
}
