//! Flow arrows of each picture, from SEND to the first period that shows the picture.

use super::model::{Events, Flow, Slice, Step, Trace};
use super::slices::stage_name;
use crate::updates::Updates;
use pxpl5_gp::Stage;
use pxpl5_run::Outcome;
use pxpl5_sim::Time;
use pxpl5_wire::PictureNumber;
use std::collections::BTreeMap;

/// Position of a slice, an event with a duration: its start time, its track and its index in the track.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Stop {
    begin: Time,
    track: usize,
    place: usize,
}

pub(super) fn connect(trace: &mut Trace, outcome: &Outcome) {
    let updates = Updates::of(&outcome.final_results(), &outcome.stages());
    let sends = firsts(trace, &[Stage::Send]);
    let stages = firsts(trace, &[Stage::Transform, Stage::Render, Stage::Copy]);
    let shown = first_shown(trace);
    // A flow leads from SEND through the stages to the first period that shows the picture.
    for times in outcome.pictures() {
        let sent = updates.shown_by(times).and_then(|update| sends.get(&update));
        let worked = stages.get(&times.picture);
        let stops = sent.into_iter().chain(worked).flatten().copied();
        let mut way: Vec<Stop> = stops.filter(|stop| stop.begin <= times.shown_at).collect();
        way.extend(shown.get(&times.picture));
        way.sort_unstable();
        mark(trace, times.picture.next().0, &way);
    }
}

/// Returns the first events of `stages`, by picture. Events with different names count separately, so that the result
/// has the first event of each surface.
fn firsts(trace: &Trace, stages: &[Stage]) -> BTreeMap<PictureNumber, Vec<Stop>> {
    let mut all: BTreeMap<(PictureNumber, String), Stop> = BTreeMap::new();
    let names: Vec<String> = stages.iter().map(|stage| stage_name(*stage)).collect();
    for (stop, track, slice) in stops(trace).filter(|(_, track, _)| names.iter().any(|name| name == track)) {
        let Some(picture) = slice.picture else { continue };
        // Slices of COPY have the names of regions. The name of the track is used instead, so only the first region of
        // each surface counts.
        let name = if track == "COPY" { format!("COPY {}", stop.track) } else { slice.name.clone() };
        let first = all.entry((picture, name)).or_insert(stop);
        *first = stop.min(*first);
    }
    let mut pictures: BTreeMap<PictureNumber, Vec<Stop>> = BTreeMap::new();
    for ((picture, _), first) in all {
        pictures.entry(picture).or_default().push(first);
    }
    pictures
}

/// Returns all slices (events with a duration), each with its position and the name of its track.
fn stops(trace: &Trace) -> impl Iterator<Item = (Stop, &str, &Slice)> {
    trace.tracks.iter().enumerate().flat_map(|(track, it)| {
        let slices = if let Events::Slices(slices) = &it.events { &slices[..] } else { &[] };
        let stops = slices.iter().enumerate();
        stops.map(move |(place, slice)| (Stop { begin: slice.begin, track, place }, it.name.as_str(), slice))
    })
}

fn first_shown(trace: &Trace) -> BTreeMap<PictureNumber, Stop> {
    let mut periods = BTreeMap::new();
    for (stop, _, slice) in stops(trace).filter(|(_, track, _)| *track == "displayed") {
        if let Some(picture) = slice.picture {
            periods.entry(picture).or_insert(stop);
        }
    }
    periods
}

fn mark(trace: &mut Trace, id: u64, way: &[Stop]) {
    for (i, stop) in way.iter().enumerate() {
        let step = match i {
            0 => Step::First,
            _ if i + 1 == way.len() => Step::Last,
            _ => Step::Middle,
        };
        if let Events::Slices(slices) = &mut trace.tracks[stop.track].events {
            // If two pictures show the same update, the slice belongs to the flow of the first.
            slices[stop.place].flow.get_or_insert(Flow { id, step });
        }
    }
}
