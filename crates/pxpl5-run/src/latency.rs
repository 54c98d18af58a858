//! Where a picture's latency goes: parts that add up to the whole, to the picosecond.
//!
//! The way is that of the last eye, because it decides when the picture can be shown. A part begins where the one
//! before it ends; what had already happened by then costs nothing, so a stage that is hidden behind another counts
//! only as far as it comes out behind it. Parts that a pipeline does not have are zero.

use crate::pipeline::PictureTimes;
use pxpl5_gp::Stage;
use pxpl5_machine::{Record, StageSpan};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{PictureNumber, SurfaceId};

/// A part of the way from the tracker's sample to light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartDefinition {
    /// Its name in tables, files and timelines.
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
    /// The picture whose latency is taken apart.
    pub picture: PictureNumber,
    /// When its pose was sampled; the start of TRANSFORM if that is not known.
    pub begin: Time,
    /// How long each part of [`LATENCY_PARTS`] took, in that order; they add up to the latency.
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

/// The parts of a picture's latency; `stages` are those of the picture.
pub(crate) fn parts(record: &Record, times: &PictureTimes, stages: &[StageSpan]) -> LatencyParts {
    let PictureTimes { picture, sampled_at, transform_at, shown_at, .. } = *times;
    let light = first_light(record, shown_at);
    let last = last_surface(stages);
    let first = last.map(|_| SurfaceId(0));
    // The end of each part but the last, and the time that it cannot pass.
    let ends = [
        (end_of(stages, Stage::Send, None).filter(|_| sent_for_it(stages, sampled_at)), transform_at),
        (begin_of(stages, Stage::Edit, None), transform_at),
        (Some(transform_at), transform_at),
        (end_of(stages, Stage::Transform, first), shown_at),
        (begin_of(stages, Stage::Transform, last), shown_at),
        (end_of(stages, Stage::Transform, last), shown_at),
        (begin_of(stages, Stage::Render, last), shown_at),
        (end_of(stages, Stage::Render, last), shown_at),
        (begin_of(stages, Stage::Copy, last), shown_at),
        (times.copied_at, shown_at),
        (Some(shown_at), shown_at),
        (Some(light), light),
    ];
    let begin = sampled_at.unwrap_or(transform_at);
    let mut before = begin;
    let spans = ends.map(|(time, limit)| {
        let at = time.unwrap_or(before).min(limit).max(before);
        at - std::mem::replace(&mut before, at)
    });
    LatencyParts { picture, begin, spans }
}

/// When the first visible pixel lights in the period that begins, or goes on, at an instant.
fn first_light(record: &Record, shown_at: Time) -> Time {
    let display = record.display();
    display.first_light(0, display.period_at(shown_at)).unwrap_or(shown_at)
}

/// Starts of TRANSFORM and ends of COPY of both surfaces, the swap and the light of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pair {
    pub(crate) transform_at: [Time; 2],
    pub(crate) copied_at: [Time; 2],
    pub(crate) shown_at: Time,
    pub(crate) light_at: Time,
}

/// The surfaces that begin and end a latency: the first, the second, both.
pub(crate) const WHOSE: [(usize, usize); 3] = [(0, 0), (1, 1), (0, 1)];

/// When what ends a latency of a surface happens.
pub(crate) type End = fn(&Pair, usize) -> Time;

/// Name, definition and time of what ends a latency.
pub(crate) const ENDS: [(&str, &str, End); 3] = [
    ("end_of_copy", "the end of its COPY", |pair, surface| pair.copied_at[surface]),
    ("swap", "the retrace at which the frame is swapped in", |pair, _| pair.shown_at),
    ("light", "the beam at the first visible pixel", |pair, _| pair.light_at),
];

/// Of a picture that has them; `stages` are those of the picture.
pub(crate) fn pair(record: &Record, shown_at: Time, stages: &[StageSpan]) -> Option<Pair> {
    let [Some(first), Some(second)] = [SurfaceId(0), SurfaceId(1)].map(|surface| own_times(stages, surface)) else {
        return None;
    };
    Some(Pair {
        transform_at: [first.0, second.0],
        copied_at: [first.1, second.1],
        shown_at,
        light_at: first_light(record, shown_at),
    })
}

/// The start of a surface's own TRANSFORM and the end of its own COPY.
fn own_times(stages: &[StageSpan], surface: SurfaceId) -> Option<(Time, Time)> {
    let own = || stages.iter().filter(|span| span.surface == Some(surface));
    let transform_at = own().filter(|span| span.stage == Stage::Transform).map(|span| span.begin).min()?;
    let copied_at = own().filter(|span| span.stage == Stage::Copy).filter_map(|span| span.end).max()?;
    Some((transform_at, copied_at))
}

/// The spans of a stage: those of one surface, and those of all.
fn spans_of(stages: &[StageSpan], stage: Stage, surface: Option<SurfaceId>) -> impl Iterator<Item = &StageSpan> {
    let concerned = move |span: &StageSpan| span.surface.is_none() || surface.is_none() || span.surface == surface;
    stages.iter().filter(move |span| span.stage == stage && concerned(span))
}

fn begin_of(stages: &[StageSpan], stage: Stage, surface: Option<SurfaceId>) -> Option<Time> {
    spans_of(stages, stage, surface).map(|span| span.begin).min()
}

fn end_of(stages: &[StageSpan], stage: Stage, surface: Option<SurfaceId>) -> Option<Time> {
    spans_of(stages, stage, surface).filter_map(|span| span.end).max()
}

/// The last surface that has a TRANSFORM of its own.
fn last_surface(stages: &[StageSpan]) -> Option<SurfaceId> {
    stages.iter().filter(|span| span.stage == Stage::Transform).filter_map(|span| span.surface).max()
}

/// Whether SEND counts pictures as the other stages do: it begins with the sample.
fn sent_for_it(stages: &[StageSpan], sampled_at: Option<Time>) -> bool {
    spans_of(stages, Stage::Send, None).any(|span| Some(span.begin) == sampled_at)
}
