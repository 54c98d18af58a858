//! Results as numbers, with units in the names.

use crate::compare::PixelErrors;
use crate::display::Display;
use crate::experiment::Outcome;
use crate::head_to_light::{Budget, Head};
use crate::latency::NamedStatistics;
use crate::observation::LateRegion;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Mean, sample standard deviation, least and greatest of some numbers. All zero for none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// Mean.
    pub mean: f64,
    /// Sample standard deviation (n - 1).
    pub sd: f64,
    /// Least.
    pub min: f64,
    /// Greatest.
    pub max: f64,
}

impl Statistics {
    /// Of some numbers.
    #[must_use]
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.collect();
        if values.is_empty() {
            return Self::default();
        }
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>();
        Self {
            mean,
            sd: if values.len() > 1 { (squares / (n - 1.0)).sqrt() } else { 0.0 },
            min: values.iter().copied().fold(f64::INFINITY, f64::min),
            max: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// With what they are statistics of.
    #[must_use]
    pub fn defined(self, definition: &str) -> DefinedStatistics {
        DefinedStatistics { statistics: self, definition: definition.to_owned() }
    }
}

/// Statistics with their definition beside them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DefinedStatistics {
    /// The numbers.
    #[serde(flatten)]
    pub statistics: Statistics,
    /// What they are of.
    pub definition: String,
}

/// The numbers of one experiment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Name and version of this record's layout.
    pub schema: String,
    /// Version of the program.
    pub version: String,
    /// Preset of the machine.
    pub machine: String,
    /// Name of everything on which the trace depends ([`crate::Experiment::config_hash`]).
    pub config_hash: String,
    /// Level of modelling.
    pub level: String,
    /// Seed of the head motion.
    pub seed: u64,
    /// Pipeline.
    pub pipeline: String,
    /// Its variant.
    pub variant: String,
    /// Parameters of the machine that differ from the preset's, by path.
    pub overrides: BTreeMap<String, u64>,
    /// Graphics processors.
    pub n_gps: usize,
    /// Renderers.
    pub n_renderers: usize,
    /// Scene.
    pub scene: String,
    /// Triangles in the scene.
    pub triangles: usize,
    /// Spheres in the scene.
    pub spheres: usize,
    /// Fields simulated.
    pub fields: u64,
    /// Pictures that the statistics are over.
    pub pictures: usize,
    /// Latency in NTSC fields of 1001/60000 s.
    pub latency_fields: DefinedStatistics,
    /// Latency in milliseconds.
    pub latency_ms: DefinedStatistics,
    /// Where the latency goes, in milliseconds: parts that add up to the way from the sample of the pose to light.
    pub latency_parts_ms: Vec<NamedStatistics>,
    /// Complete pictures per second of simulated time.
    pub updates_hz: f64,
    /// Retraces missed.
    pub missed_retraces: u64,
    /// What that means here.
    pub missed_retraces_definition: String,
    /// Regions that came after their deadline.
    pub late_regions: usize,
    /// The first of them; lateness in picoseconds.
    pub first_late_regions: Vec<LateRegion>,
    /// From the head to light; nothing of a run without a tracker.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub head: Option<HeadReport>,
    /// Hash of everything that happened.
    pub trace_hash: String,
    /// Events handled.
    pub events: u64,
    /// Time that the run took on this host.
    pub host_seconds: f64,
}

/// What a tracker, a predictor and a display make of a pipeline.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HeadReport {
    /// Tracker.
    pub tracker: String,
    /// Predictor.
    pub predictor: String,
    /// Display.
    pub display: Display,
    /// From the head's pose to light, milliseconds.
    pub end_to_end: Budget,
    /// Where pixels are against where they should be.
    pub error: PixelErrors,
}

impl HeadReport {
    pub(crate) fn of(outcome: &Outcome, head: &Head) -> Option<Self> {
        Some(Self {
            tracker: head.tracker().config().name.clone(),
            predictor: format!("{:?}", head.predictor_kind()),
            display: head.shown_on(),
            end_to_end: Budget::of(outcome),
            error: outcome.pixel_errors()?,
        })
    }
}

impl Report {
    /// Name and version of the layout.
    pub const SCHEMA: &'static str = "pxpl5-report/1";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_of_a_known_sample() {
        let s = Statistics::of([2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].into_iter());
        assert_eq!((s.mean, s.min, s.max), (5.0, 2.0, 9.0));
        assert!((s.sd - (32.0f64 / 7.0).sqrt()).abs() < 1e-12);
        assert_eq!(Statistics::of(std::iter::empty()), Statistics::default());
    }
}
