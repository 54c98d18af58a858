//! Registry entries of the address recalculation pipelines: names, settings and variants.

use super::keys::{FacePolicy, LENS, NAMES, POLICY, SEGMENT, WARP};
use super::pipeline::{FacePipeline, FaceSource};
use crate::keys::PipelineSettings;
use crate::pipeline::Pipeline;
use crate::pipelines::{SHADING, shading_or};
use crate::registry::{Goal, LimitCriterion, PipelineEntry, TestScene};
use address_recalculation::priority::PriorityTiming;
use address_recalculation::{Latch, Lens};
use pxpl5_sim::parameters::Key;
use std::sync::Arc;

/// Settings of the pipelines of each row of [`NAMES`]. An ideal renderer supports every policy, and its settings for
/// cells have an effect only under a policy with cells.
const KEYS: [&[Key]; 5] = [
    &[SHADING, LENS],
    &[SHADING, LENS],
    &[SHADING, LENS, SEGMENT],
    &[SHADING, LENS, SEGMENT, WARP],
    &[SHADING, LENS, POLICY, SEGMENT, WARP],
];

/// Description of the pipeline with one orientation for each field, for each row of [`NAMES`].
const ABOUT: [&str; 5] = [
    "six faces in one memory, looked up with one orientation for each field (VRAIS 93)",
    "six faces in several memories, with each object in the slowest memory that keeps its image valid (SIGGRAPH 94)",
    "objects cut at the borders of square cells, with near cells drawn more often than far cells (ACSC 2005)",
    "cells with vertices that are moved so that memories meet at their borders (ACSC 2005)",
    "faces of an ideal renderer that takes no time: the best result that a faster machine could reach",
];

/// Description of the pipelines that follow in the row.
const BY_LINE: &str = "the same, with an orientation for each line";
const BY_PIXEL: &str = "the same, with an orientation for each pixel, as far as the host's connection can carry them";

pub(crate) const ENTRIES: [[PipelineEntry; 3]; 5] = [row::<0>(), row::<1>(), row::<2>(), row::<3>(), row::<4>()];

const fn row<const ROW: usize>() -> [PipelineEntry; 3] {
    [entry::<ROW, 0>(), entry::<ROW, 1>(), entry::<ROW, 2>()]
}

const fn entry<const ROW: usize, const LATCH: usize>() -> PipelineEntry {
    PipelineEntry {
        name: NAMES[ROW][LATCH],
        family: "arp",
        about: [ABOUT[ROW], BY_LINE, BY_PIXEL][LATCH],
        preset: "small-hmd",
        keys: KEYS[ROW],
        build: build::<ROW, LATCH>,
        limit: |_| LimitCriterion { goal: Goal::RateHz(20.0), scene: TestScene::Typical, fields: 60 },
        tables: &[("priority", || Box::new(PriorityTiming::PAPERS))],
        closed_form: None,
        compared: true,
    }
}

fn build<const ROW: usize, const LATCH: usize>(settings: &PipelineSettings) -> Arc<dyn Pipeline> {
    let chosen = || settings.chosen(POLICY.name).unwrap_or(FacePolicy::Full);
    // The row after the rows of the policies has the ideal renderer.
    let (source, policy) = FacePolicy::ALL
        .get(ROW)
        .map_or_else(|| (FaceSource::Ideal, chosen()), |(_, policy)| (FaceSource::PixelPlanes, *policy));
    let new = FacePipeline::new(policy);
    Arc::new(FacePipeline {
        source,
        policy,
        latch: Latch::ALL[LATCH].1,
        shading: shading_or(settings, new.shading),
        segmented: settings.flag(SEGMENT.name).unwrap_or(new.segmented),
        falloff: settings.chosen(WARP.name).unwrap_or(new.falloff),
        lens: settings.text(LENS.name).and_then(|text| text.parse().ok()).filter(|lens| *lens != Lens::Flat),
    })
}
