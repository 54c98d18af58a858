//! Comparison of all policies and kinds of warping during one walk through one scene.

use crate::experiment::WalkOutcome;
use crate::plan::WalkPlan;
use crate::report::ArpReport;
use crate::tears::TearWidths;
use pxpl5_scene::Scene;
use pxpl5_sim::Watcher;
use pxpl5_sim::parameters::PathSettings;
use serde::Serialize;

/// Variants of a comparison. Each variant has a name and the settings that it changes.
const VARIANTS: [(&str, &[(&str, &str)]); 9] = [
    ("full", &[("policy", "full")]),
    ("objects", &[("policy", "objects"), ("segment", "off")]),
    ("objects, cut", &[("policy", "objects"), ("segment", "on")]),
    ("cells, uncut", &[("policy", "cells"), ("segment", "off"), ("warp", "none")]),
    ("cells, torn", &[("policy", "cells"), ("segment", "on"), ("warp", "none")]),
    ("cells, warped", &[("policy", "cells"), ("segment", "on"), ("warp", "linear")]),
    ("cells, smoothstep", &[("policy", "cells"), ("segment", "on"), ("warp", "smoothstep")]),
    ("cells, step", &[("policy", "cells"), ("segment", "on"), ("warp", "step")]),
    ("cells, no cascade", &[("policy", "cells"), ("segment", "on"), ("warp", "linear"), ("priority.cascade", "off")]),
];

/// Returns the number of combinations of policy, segmentation and warping that [`compare`] runs.
pub const fn variant_count() -> u64 {
    VARIANTS.len() as u64
}

/// Cost and image error of one combination of policy, segmentation and warping.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ComparedRow {
    /// Name of the variant: its policy, segmentation and warping.
    pub variant: &'static str,
    /// Updates per second of each display memory.
    pub rates_hz: Vec<f64>,
    /// Number of segments (parts of objects) drawn per second.
    pub draws_per_s: f64,
    pub triangles_per_s: f64,
    /// Percentage of draws saved, relative to drawing everything in every frame.
    pub saved_percent: f64,
    /// Distance between the eye and the position from which a memory was drawn, in mm, averaged over memories.
    pub eye_age_mm: f64,
    /// Widths of the displayed tears (gaps between memories), in texels. Null in JSON if no object is cut between two
    /// memories.
    pub tears: Option<TearWidths>,
    /// Angles by which warping moves vertices, in texels, as percentiles. Null in JSON without warping.
    pub stretch: Option<TearWidths>,
    /// Number of times that cells (squares of the floor) were assigned to memories anew. With the policy `objects`, the
    /// number of times that an object changed its memory.
    pub changes: u64,
    /// Number of retraces at which an update was incomplete, summed over all memories.
    pub missed: u64,
}

/// Results of all variants, including variants that failed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ArpComparison {
    pub schema: &'static str,
    pub scene: String,
    pub frames: u64,
    pub m_per_s: f64,
    /// Results of the variants that succeeded.
    pub rows: Vec<ComparedRow>,
    /// Variants that failed, with the reason.
    pub failed: Vec<(&'static str, String)>,
}

/// Simulates the walk with every variant. After a stop, the result has the variants that were finished.
pub fn compare(scene: &Scene, plan: &WalkPlan, watcher: &mut dyn Watcher) -> ArpComparison {
    let mut stop = watcher.stop();
    let mut comparison = ArpComparison {
        schema: "pxpl5-arp-comparison/1",
        scene: scene.name().to_owned(),
        frames: plan.walk.frames,
        m_per_s: plan.walk.m_per_s,
        rows: Vec::new(),
        failed: Vec::new(),
    };
    for (done, (variant, choices)) in (1..).zip(VARIANTS) {
        // Failed variants are reported, and the comparison continues.
        let mut plan = plan.clone();
        let chosen = choices.iter().try_for_each(|(path, value)| plan.set(path, value, variant));
        let outcome = chosen.and_then(|()| WalkOutcome::of(scene, &plan, &mut stop));
        if stop.is_stopped() {
            break;
        }
        match outcome {
            Ok(outcome) => comparison.rows.push(ComparedRow::of(variant, &outcome)),
            Err(error) => comparison.failed.push((variant, error.to_string())),
        }
        watcher.progress(done, variant_count());
    }
    comparison
}

impl ComparedRow {
    fn of(variant: &'static str, outcome: &WalkOutcome) -> Self {
        let ArpReport { memories, priority, tears_texels, .. } = &outcome.report.report;
        Self {
            variant,
            rates_hz: memories.iter().map(|memory| memory.updates_hz).collect(),
            draws_per_s: priority.draws_per_s,
            triangles_per_s: outcome.triangles_per_s(),
            saved_percent: priority.saved_percent,
            eye_age_mm: memories.iter().map(|memory| memory.eye_age_mm).sum::<f64>() / memories.len() as f64,
            tears: tears_texels.after,
            stretch: tears_texels.stretch,
            changes: priority.redeals.or(priority.moved_objects).unwrap_or(0),
            missed: memories.iter().map(|memory| memory.missed).sum(),
        }
    }
}
