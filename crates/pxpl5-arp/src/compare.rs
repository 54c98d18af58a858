//! Policies and warps beside each other: one scene, one walk.

use crate::experiment::WalkOutcome;
use crate::plan::Plan;
use crate::report::Report;
use crate::tears::Percentiles;
use pxpl5_scene::Scene;
use serde::Serialize;

/// Variants and what they set; what their names do not say is as in the plan.
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

/// How many rows [`compare`] gives.
#[must_use]
pub const fn variant_count() -> u64 {
    VARIANTS.len() as u64
}

/// What a variant costs and how wrong it is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ComparedRow {
    /// Policy, cuts, warp.
    pub variant: &'static str,
    /// Pictures a second of each memory.
    pub rates_hz: Vec<f64>,
    /// Segments drawn a second.
    pub draws_per_s: f64,
    /// Triangles drawn a second.
    pub triangles_per_s: f64,
    /// Of drawing all in every frame, percent.
    pub saved_percent: f64,
    /// How far the eye was from where memories were drawn, mean over memories, mm.
    pub eye_age_mm: f64,
    /// Widths of cuts as drawn, texels; null where no memories meet in a cut.
    pub tears: Option<Percentiles>,
    /// By how much warping turns vertices, texels; null without warping.
    pub stretch: Option<Percentiles>,
    /// Cells dealt anew, or objects that changed memories.
    pub changes: u64,
    /// Retraces at which an update was not whole, all memories together.
    pub missed: u64,
}

/// All variants, and those that could not be walked with the reason: what is done is kept.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ArpComparison {
    /// Name and version of the record's layout.
    pub schema: &'static str,
    /// Name of the scene.
    pub scene: String,
    /// Length of the walk, frames.
    pub frames: u64,
    /// Speed of the walk.
    pub m_per_s: f64,
    /// Variants that were walked.
    pub rows: Vec<ComparedRow>,
    /// The others: variant and reason.
    pub failed: Vec<(&'static str, String)>,
}

/// Walks with every variant; `finished` hears how many of them are done.
#[must_use]
pub fn compare(scene: &Scene, plan: &Plan, finished: impl Fn(u64, u64)) -> ArpComparison {
    let mut comparison = ArpComparison {
        schema: "pxpl5-arp-comparison/1",
        scene: scene.name().to_owned(),
        frames: plan.walk.frames,
        m_per_s: plan.walk.m_per_s,
        rows: Vec::new(),
        failed: Vec::new(),
    };
    for (done, (variant, choices)) in (1..).zip(VARIANTS) {
        let mut plan = plan.clone();
        let chosen = choices.iter().try_for_each(|(path, value)| plan.set(path, value, variant));
        match chosen.and_then(|()| WalkOutcome::of(scene, &plan, |_, _| {})) {
            Ok(outcome) => comparison.rows.push(ComparedRow::of(variant, &outcome)),
            Err(error) => comparison.failed.push((variant, error.to_string())),
        }
        finished(done, variant_count());
    }
    comparison
}

impl ComparedRow {
    fn of(variant: &'static str, outcome: &WalkOutcome) -> Self {
        let Report { memories, priority, tears_px, .. } = &outcome.report.report;
        Self {
            variant,
            rates_hz: memories.iter().map(|memory| memory.updates_hz).collect(),
            draws_per_s: priority.draws_per_s,
            triangles_per_s: outcome.triangles_per_s(),
            saved_percent: priority.saved_percent,
            eye_age_mm: memories.iter().map(|memory| memory.eye_age_mm).sum::<f64>() / memories.len() as f64,
            tears: tears_px.after,
            stretch: tears_px.stretch,
            changes: priority.redeals.or(priority.moved_objects).unwrap_or(0),
            missed: memories.iter().map(|memory| memory.missed).sum(),
        }
    }
}
