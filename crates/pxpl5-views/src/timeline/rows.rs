//! Rows of a timeline, each with the work of one board or of all boards of a kind.

use super::model::{Bar, TimelineOptions, TimelineRow};
use crate::ports::{DisplayPort, display_ports, has_separate_ports, shown};
use pxpl5_gp::Stage;
use pxpl5_machine::{Arrival, Record, StageSpan};
use pxpl5_run::FinalResults;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::PictureNumber;
use std::collections::BTreeMap;

/// Returns all rows of a run from top to bottom: host, graphics processors, renderers, surfaces, and ports that swap
/// independently.
pub(super) fn rows(run: &FinalResults<'_>, stages: &[StageSpan], options: &TimelineOptions) -> Vec<TimelineRow> {
    let mut rows = Vec::new();
    if !options.without_host {
        rows.push(stage_row("host", run, stages, &[Stage::Send]));
    }
    rows.push(stage_row("graphics processors", run, stages, &[Stage::Edit, Stage::Transform]));
    rows.push(stage_row("renderers", run, stages, &[Stage::Render]));
    let ports = display_ports(run.record);
    let surfaces = run.record.surfaces().filter(|(id, _)| !has_separate_ports(run.record, *id));
    rows.extend(surfaces.map(|(id, surface)| row(surface.title, copies(run, |arrival| arrival.surface == id))));
    rows.extend(ports.iter().map(|port| port_row(run, port)));
    rows
}

fn row(name: &str, mut bars: Vec<Bar>) -> TimelineRow {
    bars.sort_by_key(|bar| (bar.begin, bar.picture, bar.surface));
    TimelineRow { name: name.to_owned(), bars, lanes: 1, shown: Vec::new() }
}

fn port_row(run: &FinalResults<'_>, port: &DisplayPort) -> TimelineRow {
    let bars = copies(run, |arrival| arrival.target.frame_buffer == port.node);
    TimelineRow { shown: shown(run, port.node), ..row(&port.name, bars) }
}

fn stage_row(name: &str, run: &FinalResults<'_>, stages: &[StageSpan], wanted: &[Stage]) -> TimelineRow {
    let spans = stages.iter().filter(|span| wanted.contains(&span.stage));
    row(name, spans.map(|span| stage_bar(run, span)).collect())
}

fn stage_bar(run: &FinalResults<'_>, span: &StageSpan) -> Bar {
    Bar {
        stage: span.stage,
        picture: span.picture,
        surface: span.surface.filter(|_| has_many_surfaces(run.record)),
        bottom: None,
        first_line: 0,
        begin: span.begin,
        end: span.end.unwrap_or(run.now).max(span.begin),
        lane: 0,
        receiving: Vec::new(),
    }
}

fn has_many_surfaces(record: &Record) -> bool {
    record.surfaces().nth(1).is_some()
}

/// COPY bars of a row. The key of a bar has two numbers. The first is the number of the copied picture. The second is 1
/// for the second COPY of the picture, otherwise 0.
type Parts = BTreeMap<(PictureNumber, u8), Bar>;

/// Returns the COPY bars of a surface or a port. A picture has one bar, or two bars if the picture arrived in two
/// parts, one after the other.
fn copies(run: &FinalResults<'_>, is_there: impl Fn(&Arrival) -> bool) -> Vec<Bar> {
    let message = run.record.message_span();
    let mut parts = Parts::new();
    for arrival in run.record.observation().arrivals.iter().filter(|arrival| is_there(arrival)) {
        let begin = arrival.begins_at(message);
        // Arrivals of the same picture and part extend one bar.
        let key = (arrival.target.picture, run.pipeline.copy_part(arrival));
        let bar = parts.entry(key).or_insert_with(|| copy_bar(run.record, arrival, begin));
        bar.begin = bar.begin.min(begin);
        bar.end = bar.end.max(arrival.last_part_at);
        bar.first_line = bar.first_line.min(first_line(run.record, arrival));
        bar.receiving.push((begin, arrival.last_part_at));
    }
    name_halves(&mut parts);
    parts.values_mut().for_each(|bar| join(&mut bar.receiving));
    parts.into_values().collect()
}

fn copy_bar(record: &Record, arrival: &Arrival, begin: Time) -> Bar {
    Bar {
        stage: Stage::Copy,
        picture: arrival.target.picture,
        surface: has_many_surfaces(record).then_some(arrival.surface),
        bottom: None,
        first_line: u32::MAX,
        begin,
        end: arrival.last_part_at,
        lane: 0,
        receiving: Vec::new(),
    }
}

/// Returns the first line of a surface that a region fills. If the picture has fewer lines than the surface, the line
/// is scaled to the height of the surface.
fn first_line(record: &Record, arrival: &Arrival) -> u32 {
    let grid = &arrival.target.grid;
    let [_, top, _, _] = grid.rectangle(arrival.target.region);
    let height = record.surface(arrival.surface).map_or(grid.height, |surface| surface.height);
    top * height / grid.height.max(1)
}

/// Marks each bar as the top or bottom half of its picture, if the surface received the halves one after the other.
fn name_halves(parts: &mut Parts) {
    let bottoms: Vec<PictureNumber> =
        parts.keys().filter(|(_, part)| *part == 1).map(|(picture, _)| *picture).collect();
    let apart: Vec<PictureNumber> = bottoms.into_iter().filter(|picture| parts.contains_key(&(*picture, 0))).collect();
    for ((picture, part), bar) in parts {
        bar.bottom = apart.contains(picture).then_some(*part == 1);
        if bar.bottom != Some(true) {
            bar.first_line = 0;
        }
    }
}

/// Largest gap between two transfers that are drawn as one bar: 20 us, less than a tenth of an SVG unit.
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

/// Assigns each bar of a row to the first lane that is free when the bar begins. Two bars in one lane may overlap by at
/// most `touching`.
pub(super) fn set_lanes(row: &mut TimelineRow, touching: Span) {
    let mut free_at: Vec<Time> = Vec::new();
    for bar in &mut row.bars {
        let free = free_at.iter().position(|time| time.since(bar.begin) <= touching);
        bar.lane = free.unwrap_or(free_at.len());
        if free.is_none() {
            free_at.push(bar.end);
        }
        free_at[bar.lane] = free_at[bar.lane].max(bar.end);
    }
    row.lanes = free_at.len().max(1);
}
