//! Where a picture's latency goes: parts that add up to the whole, to the picosecond.
//!
//! The way is that of the last eye, because it decides when the picture can be shown. A part begins where the one
//! before it ends; what had already happened by then costs nothing, so a stage that is hidden behind another counts
//! only as far as it comes out behind it. Parts that a pipeline does not have are zero.

use crate::experiment::Outcome;
use crate::observation::StageSpan;
use crate::pipelines::PictureTimes;
use crate::report::{DefinedStatistics, Statistics};
use pxpl5_gp::Stage;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Eye, FieldParity};
use std::collections::BTreeMap;

/// A part of the way from the tracker's sample to light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartDefinition {
    /// Name.
    pub name: &'static str,
    /// From when to when.
    pub definition: &'static str,
    /// Whether it belongs to the latency that the papers state.
    pub published: bool,
}

/// All parts, in order of time.
pub const LATENCY_PARTS: [PartDefinition; 12] = [
    part("send", "from the sample of the pose to the end of SEND", false),
    part("wait_for_edit", "from there to the begin of EDIT on the first GP", false),
    part("edit", "from there to the start of TRANSFORM on the first GP", false),
    part("transform", "from the start of TRANSFORM to its end on the last GP, of the first eye in stereo", true),
    part("wait_for_last_transform", "from there to the start of the last eye's TRANSFORM", true),
    part("last_transform", "from there to the end of the last eye's TRANSFORM on the last GP", true),
    part("wait_for_render", "from there to the begin of the last eye's RENDER", true),
    part("render", "from there until the renderers have accepted the last command", true),
    part("wait_for_copy", "from there to the begin of the last eye's COPY", true),
    part("copy", "from there to the end of the last COPY, at most to the retrace", true),
    part(
        "wait_for_retrace",
        "from there to the retrace from which on the picture is shown, or to the beam where there is no swap",
        true,
    ),
    part("scan", "from there until the beam is at the first visible pixel", false),
];

const fn part(name: &'static str, definition: &'static str, published: bool) -> PartDefinition {
    PartDefinition { name, definition, published }
}

/// The parts of one picture's latency, in the order of [`LATENCY_PARTS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatencyParts {
    /// The picture.
    pub picture: u64,
    /// When its pose was sampled; the start of TRANSFORM if that is not known.
    pub begin: Time,
    /// The parts.
    pub spans: [Span; LATENCY_PARTS.len()],
}

impl LatencyParts {
    /// When the first pixel lights up.
    #[must_use]
    pub fn end(&self) -> Time {
        self.begin + self.spans.iter().copied().sum::<Span>()
    }

    /// The latency that the papers state: from the start of TRANSFORM to the retrace.
    #[must_use]
    pub fn published(&self) -> Span {
        LATENCY_PARTS.iter().zip(self.spans).filter(|(part, _)| part.published).map(|(_, span)| span).sum()
    }
}

/// The stages of one picture.
type Stages = Vec<StageSpan>;

impl Outcome {
    /// The parts of the latency of all pictures after the warm-up.
    #[must_use]
    pub fn latency_parts(&self) -> Vec<LatencyParts> {
        let stages = by_picture(self.stages());
        let none = Stages::new();
        let of = |times: &PictureTimes| self.parts(times, stages.get(&times.picture).unwrap_or(&none));
        self.steady_pictures().iter().map(of).collect()
    }

    fn parts(&self, times: &PictureTimes, stages: &[StageSpan]) -> LatencyParts {
        let PictureTimes { picture, sampled_at, transform_at, shown_at, .. } = *times;
        let light = self.light(shown_at);
        let eye = last_eye(stages);
        let begin = |stage, eye| of(stages, stage, eye).map(|span| span.begin).min();
        let end = |stage, eye| of(stages, stage, eye).filter_map(|span| span.end).max();
        let first_eye = eye.map(|_| Eye::Left);
        // The end of each part but the last, and the time that it cannot pass.
        let ends = [
            (end(Stage::Send, None).filter(|_| sent_for_it(stages, sampled_at)), transform_at),
            (begin(Stage::Edit, None), transform_at),
            (Some(transform_at), transform_at),
            (end(Stage::Transform, first_eye), shown_at),
            (begin(Stage::Transform, eye), shown_at),
            (end(Stage::Transform, eye), shown_at),
            (begin(Stage::Render, eye), shown_at),
            (end(Stage::Render, eye), shown_at),
            (begin(Stage::Copy, eye), shown_at),
            (times.copied_at, shown_at),
            (Some(shown_at), shown_at),
            (Some(light), light),
        ];
        let first = sampled_at.unwrap_or(transform_at);
        let mut before = first;
        let spans = ends.map(|(time, limit)| {
            let at = time.unwrap_or(before).min(limit).max(before);
            at - std::mem::replace(&mut before, at)
        });
        LatencyParts { picture, begin: first, spans }
    }

    /// When the beam is at the first visible pixel after a retrace.
    pub(crate) fn light(&self, shown_at: Time) -> Time {
        let video = self.machine().video();
        let field = video.field_at(shown_at);
        video.when(0, FieldParity::of_field(field).first_line(), field).unwrap_or(shown_at)
    }

    /// Their statistics in milliseconds, by name and definition.
    pub(crate) fn latency_part_statistics(&self) -> Vec<NamedStatistics> {
        let parts = self.latency_parts();
        let of = |(i, part): (usize, &PartDefinition)| NamedStatistics {
            name: part.name.to_owned(),
            in_published_latency: part.published,
            statistics: Statistics::of(parts.iter().map(|parts| parts.spans[i].as_ms())).defined(part.definition),
        };
        LATENCY_PARTS.iter().enumerate().map(of).collect()
    }
}

/// Statistics of one part.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct NamedStatistics {
    /// Name of the part.
    pub name: String,
    /// Whether it belongs to the latency that the papers state.
    pub in_published_latency: bool,
    /// The numbers and their definition.
    #[serde(flatten)]
    pub statistics: DefinedStatistics,
}

fn by_picture(stages: Vec<StageSpan>) -> BTreeMap<u64, Stages> {
    let mut pictures: BTreeMap<u64, Stages> = BTreeMap::new();
    for span in stages {
        pictures.entry(span.picture).or_default().push(span);
    }
    pictures
}

/// The spans of a stage: those of one eye, and those of both.
fn of(stages: &[StageSpan], stage: Stage, eye: Option<Eye>) -> impl Iterator<Item = &StageSpan> {
    let same_eye = move |span: &StageSpan| span.eye.is_none() || eye.is_none() || span.eye == eye;
    stages.iter().filter(move |span| span.stage == stage && same_eye(span))
}

/// The last eye that has a TRANSFORM of its own.
fn last_eye(stages: &[StageSpan]) -> Option<Eye> {
    stages.iter().filter(|span| span.stage == Stage::Transform).filter_map(|span| span.eye).max()
}

/// Whether SEND counts pictures as the other stages do: it begins with the sample.
fn sent_for_it(stages: &[StageSpan], sampled_at: Option<Time>) -> bool {
    of(stages, Stage::Send, None).any(|span| Some(span.begin) == sampled_at)
}
