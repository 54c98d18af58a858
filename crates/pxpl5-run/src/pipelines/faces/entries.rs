//! Registry entries of the address recalculation pipelines: names, settings and variants.

use super::keys::{IDEAL_NAMES, LENS, NAMES, POLICY, SEGMENT, WARP};
use super::pipeline::{FaceLens, FacePipeline, FaceSource};
use super::policy::FacePolicy;
use crate::keys::PipelineSettings;
use crate::pipeline::Pipeline;
use crate::pipelines::{SHADING, shading_or};
use crate::registry::{Goal, LimitCriterion, PipelineEntry, TestScene};
use address_recalculation::Latch;
use address_recalculation::priority::{Falloff, PriorityTiming};
use pxpl5_machine::NamedTable;
use pxpl5_sim::parameters::Key;
use std::sync::Arc;

const KEYS: [&[Key]; 4] =
    [&[SHADING, LENS], &[SHADING, LENS], &[SHADING, LENS, SEGMENT], &[SHADING, LENS, SEGMENT, WARP]];

/// Settings of pipelines with an ideal renderer, which supports every policy. The settings for cells have an effect
/// only under a policy with cells.
const IDEAL_KEYS: &[Key] = &[SHADING, LENS, POLICY, SEGMENT, WARP];

const TABLES: &[NamedTable] = &[("priority", || Box::new(PriorityTiming::PAPERS))];

const fn named(
    name: &'static str,
    about: &'static str,
    keys: &'static [Key],
    build: fn(&PipelineSettings) -> Arc<dyn Pipeline>,
) -> PipelineEntry {
    PipelineEntry {
        name,
        family: "arp",
        about,
        preset: "small-hmd",
        keys,
        build,
        limit: |_| LimitCriterion { goal: Goal::RateHz(20.0), scene: TestScene::Typical, fields: 60 },
        tables: TABLES,
        closed_form: None,
        compared: true,
    }
}

const fn entry(
    (policy, latch): (FacePolicy, Latch),
    about: &'static str,
    build: fn(&PipelineSettings) -> Arc<dyn Pipeline>,
) -> PipelineEntry {
    named(NAMES[policy as usize][latch as usize], about, KEYS[policy as usize], build)
}

const fn ideal(latch: Latch, about: &'static str, build: fn(&PipelineSettings) -> Arc<dyn Pipeline>) -> PipelineEntry {
    named(IDEAL_NAMES[latch as usize], about, IDEAL_KEYS, build)
}

fn with_settings(new: FacePipeline, latch: Latch, settings: &PipelineSettings) -> FacePipeline {
    let falloff = Falloff::ALL.into_iter().find(|(name, _)| settings.name(WARP.name) == Some(name));
    FacePipeline {
        latch,
        shading: shading_or(settings, new.shading),
        segmented: settings.flag(SEGMENT.name).unwrap_or(new.segmented),
        falloff: falloff.map_or(new.falloff, |(_, falloff)| falloff),
        lens: settings.text(LENS.name).and_then(|text| text.parse().ok()).and_then(FaceLens::of).unwrap_or(new.lens),
        ..new
    }
}

fn build(policy: FacePolicy, latch: Latch, settings: &PipelineSettings) -> Arc<dyn Pipeline> {
    Arc::new(with_settings(FacePipeline::new(policy), latch, settings))
}

fn build_ideal(latch: Latch, settings: &PipelineSettings) -> Arc<dyn Pipeline> {
    let policy = settings.name(POLICY.name).and_then(|name| name.parse().ok()).unwrap_or(FacePolicy::Full);
    Arc::new(with_settings(FacePipeline { source: FaceSource::Ideal, ..FacePipeline::new(policy) }, latch, settings))
}

/// Description of a pipeline with an orientation for each line. The list has this pipeline after the same pipeline with
/// one orientation for each field.
const BY_LINE: &str = "the same, with an orientation for each line";
const BY_PIXEL: &str = "the same, with an orientation for each pixel, as far as the host's connection can carry them";

macro_rules! entry {
    ($policy:ident, $latch:ident, $about:expr) => {
        entry((FacePolicy::$policy, Latch::$latch), $about, |settings| {
            build(FacePolicy::$policy, Latch::$latch, settings)
        })
    };
}

pub(crate) const ENTRIES: [PipelineEntry; 15] = [
    entry!(Full, Field, "six faces in one memory, looked up with one orientation for each field (VRAIS 93)"),
    entry!(Full, Line, BY_LINE),
    entry!(Full, Pixel, BY_PIXEL),
    entry!(
        Objects,
        Field,
        "six faces in several memories, with each object in the slowest memory that keeps its image valid (SIGGRAPH 94)"
    ),
    entry!(Objects, Line, BY_LINE),
    entry!(Objects, Pixel, BY_PIXEL),
    entry!(
        Cells,
        Field,
        "objects cut at the borders of square cells, with near cells drawn more often than far cells (ACSC 2005)"
    ),
    entry!(Cells, Line, BY_LINE),
    entry!(Cells, Pixel, BY_PIXEL),
    entry!(CellsWarped, Field, "cells with vertices that are moved so that memories meet at their borders (ACSC 2005)"),
    entry!(CellsWarped, Line, BY_LINE),
    entry!(CellsWarped, Pixel, BY_PIXEL),
    ideal(
        Latch::Field,
        "faces of an ideal renderer that takes no time: the best result that a faster machine could reach",
        |settings| build_ideal(Latch::Field, settings),
    ),
    ideal(Latch::Line, BY_LINE, |settings| build_ideal(Latch::Line, settings)),
    ideal(Latch::Pixel, BY_PIXEL, |settings| build_ideal(Latch::Pixel, settings)),
];
