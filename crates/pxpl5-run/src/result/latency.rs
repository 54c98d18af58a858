//! The parts of a picture's latency. The sum of the parts is the latency, to the picosecond.
//!
//! The parts are measured on the eye that is drawn last, because this eye decides when the picture can be shown. If two
//! stages overlap, the later stage counts from the end of the earlier stage. A stage that a pipeline does not have
//! takes zero time.

use crate::pipeline::PictureTimes;
use pxpl5_gp::Stage;
use pxpl5_machine::{Record, StageSpan};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{PictureNumber, SurfaceId};

/// Definition of one part of the time from the sample of the head's pose to the light of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartDefinition {
    /// Name of this part of the latency in tables, files and timelines.
    pub name: &'static str,
    /// Sentence that defines the start and the end of this part of the latency.
    pub definition: &'static str,
    /// True if the latency stated in the papers includes this part.
    pub published: bool,
}

/// All parts of the latency, in order of time.
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

/// Parts of one picture's latency, in the order of [`LATENCY_PARTS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatencyParts {
    /// Picture to which the latency belongs.
    pub picture: PictureNumber,
    /// Time at which the pose was sampled, or the start of TRANSFORM if the sample time is unknown.
    pub begin: Time,
    /// Duration of each part of [`LATENCY_PARTS`], in the same order. The sum is the latency.
    pub spans: [Span; LATENCY_PARTS.len()],
}

impl LatencyParts {
    /// Returns the end of the latency: the time at which the first pixel of the picture is lit.
    pub fn end(&self) -> Time {
        self.begin + self.spans.iter().copied().sum::<Span>()
    }

    /// Returns the part of the latency that the papers count, from the start of TRANSFORM to the retrace.
    pub fn published(&self) -> Span {
        LATENCY_PARTS.iter().zip(self.spans).filter(|(part, _)| part.published).map(|(_, span)| span).sum()
    }
}

/// Returns the latency parts of pictures.
pub(crate) fn parts_of_pictures<'a>(
    record: &Record,
    pictures: impl IntoIterator<Item = &'a PictureTimes>,
) -> Vec<LatencyParts> {
    let stages = record.stages();
    let pictures = pictures.into_iter();
    pictures.map(|times| parts(record, times, of_picture(&stages, times.picture))).collect()
}

/// Returns the stages of a picture.
pub(crate) fn of_picture(stages: &[StageSpan], picture: PictureNumber) -> &[StageSpan] {
    let first = stages.partition_point(|span| span.picture < picture);
    let count = stages[first..].iter().take_while(|span| span.picture == picture).count();
    &stages[first..first + count]
}

/// Divides the latency of a picture into the parts of [`LATENCY_PARTS`]. `stages` must contain only the stages of this
/// picture.
pub(crate) fn parts(record: &Record, times: &PictureTimes, stages: &[StageSpan]) -> LatencyParts {
    let PictureTimes { picture, sampled_at, transform_at, shown_at, .. } = *times;
    let light = first_light(record, shown_at);
    let last = last_surface(stages);
    let first = last.map(|_| SurfaceId(0));
    // Each entry holds the end of a part, and the latest time that this end can have.
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
    // Each part ends no earlier than the part before it.
    let mut before = begin;
    let spans = ends.map(|(time, limit)| {
        let at = time.unwrap_or(before).min(limit).max(before);
        at - std::mem::replace(&mut before, at)
    });
    LatencyParts { picture, begin, spans }
}

fn first_light(record: &Record, shown_at: Time) -> Time {
    let display = record.display();
    display.first_light(0, display.period_at(shown_at)).unwrap_or(shown_at)
}

/// Times of a stereo frame. Each eye has a separate TRANSFORM and COPY, but the eyes share the swap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pair {
    pub(crate) transform_at: [Time; 2],
    pub(crate) copied_at: [Time; 2],
    pub(crate) shown_at: Time,
    pub(crate) light_at: Time,
}

/// The three latencies of a stereo frame: of the first eye, of the second eye, and from the first to the second eye.
/// Each entry has the index of the eye that starts the latency and of the eye that ends the latency.
pub(crate) const LATENCY_SURFACES: [(usize, usize); 3] = [(0, 0), (1, 1), (0, 1)];

/// Function that returns the time of the event that ends a latency. The argument is the index of the eye.
pub(crate) type End = fn(&Pair, usize) -> Time;

pub(crate) const ENDS: [(&str, &str, End); 3] = [
    ("end_of_copy", "the end of its COPY", |pair, surface| pair.copied_at[surface]),
    ("swap", "the retrace at which the frame is swapped in", |pair, _| pair.shown_at),
    ("light", "the beam at the first visible pixel", |pair, _| pair.light_at),
];

/// Returns the times of a stereo frame, or `None` if both eyes share TRANSFORM or COPY. `stages` must contain only the
/// stages of this picture.
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

fn own_times(stages: &[StageSpan], surface: SurfaceId) -> Option<(Time, Time)> {
    let own = || stages.iter().filter(|span| span.surface == Some(surface));
    let transform_at = own().filter(|span| span.stage == Stage::Transform).map(|span| span.begin).min()?;
    let copied_at = own().filter(|span| span.stage == Stage::Copy).filter_map(|span| span.end).max()?;
    Some((transform_at, copied_at))
}

/// Returns the executions of `stage` for `surface`, or for every surface if `surface` is `None`. Executions for all
/// surfaces together are included.
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

fn last_surface(stages: &[StageSpan]) -> Option<SurfaceId> {
    stages.iter().filter(|span| span.stage == Stage::Transform).filter_map(|span| span.surface).max()
}

/// Returns true if a SEND stage begins at `sampled_at`. In some pipelines, the numbers of SEND count messages instead
/// of pictures. The latency then has no part for SEND.
fn sent_for_it(stages: &[StageSpan], sampled_at: Option<Time>) -> bool {
    spans_of(stages, Stage::Send, None).any(|span| Some(span.begin) == sampled_at)
}
