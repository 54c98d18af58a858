//! What a timeline shows, before it is drawn.

use super::path::{self, Arrow, Updates};
use super::{MAX_FIELDS, TimelineOptions};
use crate::experiment::{Outcome, WARM_UP_PICTURES};
use crate::observation::{Arrival, StageSpan};
use crate::pipelines::PictureTimes;
use pxpl5_framebuffer::Video;
use pxpl5_gp::Stage;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Eye, Lines, MAX_MESSAGE_WORDS};
use std::collections::BTreeMap;

/// A stage of a picture in a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bar {
    /// The stage.
    pub stage: Stage,
    /// Frame, field, or update of the host.
    pub picture: u64,
    /// The eye, for stages that take one eye at a time.
    pub eye: Option<Eye>,
    /// Whether it is the bottom half of a picture whose halves are copied apart; `None` for a whole one.
    pub bottom: Option<bool>,
    /// Begin.
    pub begin: Time,
    /// End; that of the run for a stage that did not end.
    pub end: Time,
    /// Where in the row it stands, from the top.
    pub lane: usize,
    /// When a port really received, for COPY.
    pub receiving: Vec<(Time, Time)>,
}

/// A resource that works independently.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Its name.
    pub name: &'static str,
    /// Its stages in order of begin.
    pub bars: Vec<Bar>,
    /// How many bars stand above each other at most.
    pub lanes: usize,
}

/// A field being scanned out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scan {
    /// The field.
    pub field: u64,
    /// The picture that is shown in it.
    pub picture: Option<u64>,
    /// When the beam is at the first visible line.
    pub begin: Time,
    /// When it is at the last.
    pub end: Time,
}

/// A part of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Timeline {
    /// Its begin, a retrace.
    pub from: Time,
    /// Its end, a retrace.
    pub to: Time,
    /// Retraces, the fields that they begin first.
    pub retraces: Vec<(u64, Time)>,
    /// Poses that were sampled, the picture or update first; `None` when they are not shown.
    pub samples: Option<Vec<(u64, Time)>>,
    /// The boards.
    pub rows: Vec<Row>,
    /// The beam.
    pub scans: Vec<Scan>,
    /// The picture whose dependencies are shown.
    pub picture: Option<u64>,
    /// The update of the host that this picture shows.
    pub update: Option<u64>,
    /// The dependencies.
    pub arrows: Vec<Arrow>,
}

impl Timeline {
    /// The part of a run that the options ask for.
    #[must_use]
    pub fn of(outcome: &Outcome, options: &TimelineOptions) -> Self {
        let video = outcome.machine().video();
        let chosen = chosen(outcome.pictures(), options.picture);
        let stages = outcome.stages();
        let mut rows = rows(outcome, &stages, options);
        let update = chosen.and_then(|times| Updates::of(outcome, &stages).shown_by(times));
        let sample = rows.first().and_then(|row| row.bars.iter().find(|bar| Some(bar.picture) == update));
        let sampled_at = sample.filter(|bar| bar.stage == Stage::Send).map(|bar| bar.begin);
        let (first, last) = fields(outcome, options, chosen, sampled_at);
        let (from, to) = (video.retrace(first), video.retrace(last));
        for row in &mut rows {
            row.bars.retain(|bar| bar.begin < to && bar.end >= from);
            row.lanes = lanes(&mut row.bars, (to - from) / TOUCHING);
        }
        let mut timeline = Self {
            from,
            to,
            retraces: (first..=last).map(|field| (field, video.retrace(field))).collect(),
            samples: (!options.without_host).then(|| samples(outcome, from, to)),
            scans: (first..last).filter_map(|field| scan(video, outcome.pictures(), field)).collect(),
            rows,
            picture: chosen.map(|times| times.picture),
            update,
            arrows: Vec::new(),
        };
        timeline.arrows = path::arrows(&timeline, video, chosen);
        timeline
    }

    /// Whether a bar belongs to the picture whose dependencies are shown.
    #[must_use]
    pub fn is_chosen(&self, bar: &Bar) -> bool {
        let number = if bar.stage == Stage::Send { self.update } else { self.picture };
        number == Some(bar.picture)
    }
}

fn chosen(pictures: &[PictureTimes], wanted: Option<u64>) -> Option<&PictureTimes> {
    match wanted {
        Some(picture) => pictures.iter().find(|times| times.picture == picture),
        None => pictures.get(WARM_UP_PICTURES).or(pictures.last()),
    }
}

/// The first field and the one after the last.
fn fields(
    outcome: &Outcome,
    options: &TimelineOptions,
    chosen: Option<&PictureTimes>,
    sampled_at: Option<Time>,
) -> (u64, u64) {
    let video = outcome.machine().video();
    let begin = chosen.map_or(Time::ZERO, |times| sampled_at.or(times.sampled_at).unwrap_or(times.transform_at));
    let first = options.first_field.unwrap_or_else(|| video.field_at(begin)).min(outcome.fields());
    let shown = chosen.map_or(first + 4, |times| video.field_at(times.shown_at) + 2);
    let count = options.fields.unwrap_or_else(|| shown.saturating_sub(first).max(4));
    (first, first + count.clamp(1, MAX_FIELDS))
}

fn samples(outcome: &Outcome, from: Time, to: Time) -> Vec<(u64, Time)> {
    let sends = outcome.observation().marks.iter().filter(|mark| mark.stage == Stage::Send);
    let begun = sends.filter(|mark| mark.edge == pxpl5_gp::Edge::Begin && (from..to).contains(&mark.time));
    begun.map(|mark| (mark.picture, mark.time)).collect()
}

fn scan(video: &Video, pictures: &[PictureTimes], field: u64) -> Option<Scan> {
    let first = u32::try_from(field % 2).ok()?;
    let shown = pictures.iter().rev().find(|times| times.shown_at < video.retrace(field + 1));
    Some(Scan {
        field,
        picture: shown.map(|times| times.picture),
        begin: video.when(0, first, field)?,
        end: video.when(video.width() - 1, video.height() - 2 + first, field)?,
    })
}

fn rows(outcome: &Outcome, stages: &[StageSpan], options: &TimelineOptions) -> Vec<Row> {
    let end = outcome.end();
    let mono = outcome.machine().frame_buffers().len() == 1;
    let of = |name, wanted: &[Stage]| {
        let chosen = stages.iter().filter(|span| wanted.contains(&span.stage));
        row(name, chosen.map(|span| bar(span, end, mono)).collect())
    };
    let message = outcome.machine().ring().timing().occupancy(MAX_MESSAGE_WORDS);
    let mut rows = Vec::new();
    if !options.without_host {
        rows.push(of("host", &[Stage::Send]));
    }
    rows.push(of("graphics processors", &[Stage::Edit, Stage::Transform]));
    rows.push(of("renderers", &[Stage::Render]));
    for (board, _) in outcome.machine().frame_buffers().iter().enumerate() {
        let name = if mono { "frame buffer" } else { ["left frame buffer", "right frame buffer"][board.min(1)] };
        rows.push(row(name, copies(outcome, board, mono, message)));
    }
    rows
}

fn row(name: &'static str, mut bars: Vec<Bar>) -> Row {
    bars.sort_by_key(|bar| (bar.begin, bar.picture, bar.eye));
    Row { name, bars, lanes: 1 }
}

fn bar(span: &StageSpan, end_of_run: Time, mono: bool) -> Bar {
    let StageSpan { picture, eye, stage, begin, end } = *span;
    let end = end.unwrap_or(end_of_run).max(begin);
    let eye = eye.filter(|_| !mono);
    Bar { stage, picture, eye, bottom: None, begin, end, lane: 0, receiving: Vec::new() }
}

/// COPY of each picture into a frame buffer; two bars where the bottom half begins only after the retrace.
fn copies(outcome: &Outcome, board: usize, mono: bool, message: Span) -> Vec<Bar> {
    let video = outcome.machine().video();
    let mut bars: BTreeMap<(u64, Option<bool>), Bar> = BTreeMap::new();
    for arrival in outcome.observation().arrivals.iter().filter(|arrival| arrival.board == board) {
        let (picture, begin) = (arrival.target.picture, arrival.begins_at(message));
        let bottom = half(video, arrival, begin);
        let bar = bars.entry((picture, bottom)).or_insert_with(|| Bar {
            stage: Stage::Copy,
            picture,
            eye: (!mono).then_some(Eye::BOTH[board.min(1)]),
            bottom,
            begin,
            end: arrival.last_part_at,
            lane: 0,
            receiving: Vec::new(),
        });
        bar.begin = bar.begin.min(begin);
        bar.end = bar.end.max(arrival.last_part_at);
        bar.receiving.push((begin, arrival.last_part_at));
    }
    let split: Vec<u64> = bars.keys().filter(|key| key.1 == Some(true)).map(|key| key.0).collect();
    let apart = |bar: &Bar| split.contains(&bar.picture);
    let mut bars: Vec<Bar> = bars.into_values().collect();
    for bar in &mut bars {
        bar.bottom = bar.bottom.filter(|_| apart(bar));
        join(&mut bar.receiving);
    }
    bars
}

/// Of a field in a top and a bottom row of regions: whether the region came after the retrace from which on it is shown.
fn half(video: &Video, arrival: &Arrival, begin: Time) -> Option<bool> {
    match arrival.target.lines {
        Lines::Field(_) if arrival.target.grid.rows() == 2 => Some(begin >= video.retrace(arrival.target.picture)),
        _ => None,
    }
}

/// Transfers that follow each other within this time are drawn as one: it is less than a tenth of a unit.
const JOINED: Span = Span(20_000_000);

fn join(times: &mut Vec<(Time, Time)>) {
    times.sort_unstable();
    let mut joined: Vec<(Time, Time)> = Vec::new();
    for (begin, end) in times.drain(..) {
        match joined.last_mut() {
            Some(last) if begin <= last.1 + JOINED => last.1 = last.1.max(end),
            _ => joined.push((begin, end)),
        }
    }
    *times = joined;
}

/// Bars that overlap by less than this part of the drawing are drawn in one lane.
const TOUCHING: u64 = 300;

/// Gives each bar the first lane that is free; the number of lanes.
fn lanes(bars: &mut [Bar], touching: Span) -> usize {
    let mut free_at: Vec<Time> = Vec::new();
    for bar in bars {
        let free = free_at.iter().position(|time| time.since(bar.begin) <= touching);
        bar.lane = free.unwrap_or(free_at.len());
        if free.is_none() {
            free_at.push(bar.end);
        }
        free_at[bar.lane] = free_at[bar.lane].max(bar.end);
    }
    free_at.len().max(1)
}
