//! Computes the effect of 10 % more of each resource of a machine.

use crate::error::StudyError;
use crate::estimate::{Estimate, RunWork};
use crate::levels::summarise;
use crate::study::Study;
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, KeptRecords, Pixels, Registry, Summary};
use pxpl5_sim::Watcher;
use serde::Serialize;
use std::fmt;
use std::sync::Arc;

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
        config.settings().into_iter().find(|(own, _)| own == path)?.1.whole()
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

/// The question of the effect of 10 % more of each resource.
#[derive(Clone, Debug)]
pub struct WhatIfQuery {
    /// Registry that contains the pipeline's closed form.
    pub registry: Arc<Registry>,
    /// The experiment on the unchanged machine.
    pub experiment: Experiment,
}

impl Study for WhatIfQuery {
    type Report = Vec<WhatIf>;

    fn estimate(&self, _: usize) -> Estimate {
        Estimate::of_all([RunWork::of(&self.experiment, false).estimate(); 1 + KNOBS.len()], 1)
    }

    /// Finds the effects: the experiment runs again for each resource, without pixels. Formulas are used only for an
    /// experiment at the analytic level, because near saturation their error exceeds the effect of 10 % more of a
    /// resource. A changed experiment that cannot run has no results.
    fn run(&self, watcher: &mut dyn Watcher) -> Result<Vec<WhatIf>, StudyError> {
        let (registry, experiment) = (&self.registry, self.experiment.clone().stopped_by(watcher.stop()));
        let tried = experiment.pixels(Pixels::Off).keep(KeptRecords::Statistics);
        let base = summarise(registry, &tried)?;
        let level = tried.level.name();
        let of = |summary: Option<&Summary>| {
            let latency = summary.map(|summary| summary.latency_ms().mean).filter(|mean| mean.is_finite());
            (latency, summary.and_then(|summary| summary.updates_hz))
        };
        // Change one resource at a time. All other settings stay the same.
        let tell = |knob: &Knob| {
            let (from, to, machine) = knob.more(tried.config())?;
            let changed = summarise(registry, &tried.clone().with_machine(machine)).ok();
            let ((before_ms, before_hz), (after_ms, after_hz)) = (of(Some(&base)), of(changed.as_ref()));
            let [latency_ms, updates_hz] = [[before_ms, after_ms], [before_hz, after_hz]];
            Some(WhatIf { resource: knob.resource, key: knob.key, from, to, latency_ms, updates_hz, level })
        };
        let mut effects = Vec::new();
        for (done, knob) in (1..).zip(&KNOBS) {
            let effect = tell(knob);
            if watcher.stop().is_stopped() {
                break;
            }
            effect.iter().for_each(|effect| watcher.row("resources", effect));
            effects.extend(effect);
            watcher.progress(done, KNOBS.len() as u64);
        }
        Ok(effects)
    }
}

impl fmt::Display for WhatIf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cell = |[before, after]: [Option<f64>; 2]| match before.zip(after) {
            Some((before, after)) => format!("{before:.1} to {after:.1}"),
            None => "-".to_owned(),
        };
        let setting = format!("{} {} to {}", self.key, self.from, self.to);
        let [latency, updates] = [self.latency_ms, self.updates_hz].map(cell);
        write!(f, "{:<32} {setting:<42} {latency:<16} {updates}", self.resource)
    }
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
