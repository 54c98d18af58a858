//! The way of each picture from SEND to the first field that shows it.

use super::collect::stage_name;
use super::{Events, Flow, Slice, Step, Trace};
use crate::experiment::Outcome;
use crate::timeline::Updates;
use pxpl5_gp::Stage;
use pxpl5_sim::Time;
use std::collections::BTreeMap;

/// A slice by track and place.
type Place = (usize, usize);

/// Gives slices their places in the flows of the pictures that were shown.
pub(super) fn connect(trace: &mut Trace, outcome: &Outcome) {
    let updates = Updates::of(outcome, &outcome.stages());
    let sends = firsts(trace, &[Stage::Send]);
    let stages = firsts(trace, &[Stage::Transform, Stage::Render, Stage::Copy]);
    let fields = shown(trace);
    for times in outcome.pictures() {
        let sent = updates.shown_by(times).and_then(|update| sends.get(&update));
        let worked = stages.get(&times.picture);
        let steps = sent.into_iter().chain(worked).flatten().copied();
        let mut way: Vec<(Time, Place)> = steps.filter(|(begin, _)| *begin <= times.shown_at).collect();
        way.extend(fields.get(&times.picture));
        way.sort_unstable();
        mark(trace, times.picture + 1, &way);
    }
}

/// By picture: the first slices of the stages, one for each name, so that each eye has its own.
fn firsts(trace: &Trace, stages: &[Stage]) -> BTreeMap<u64, Vec<(Time, Place)>> {
    let mut all: BTreeMap<(u64, String), (Time, Place)> = BTreeMap::new();
    for (track, name, place, slice) in slices(trace) {
        let (Some(picture), true) = (slice.picture, stages.iter().any(|stage| stage_name(*stage) == name)) else {
            continue;
        };
        // Regions have names of their own: the first of each frame buffer counts.
        let key = if name == "COPY" { format!("COPY {track}") } else { slice.name.clone() };
        let entry = all.entry((picture, key)).or_insert((slice.begin, (track, place)));
        *entry = (*entry).min((slice.begin, (track, place)));
    }
    let mut pictures: BTreeMap<u64, Vec<(Time, Place)>> = BTreeMap::new();
    for ((picture, _), first) in all {
        pictures.entry(picture).or_default().push(first);
    }
    pictures
}

fn slices(trace: &Trace) -> impl Iterator<Item = (usize, &str, usize, &Slice)> {
    trace.tracks.iter().enumerate().flat_map(|(number, track)| {
        let slices = if let Events::Slices(slices) = &track.events { &slices[..] } else { &[] };
        slices.iter().enumerate().map(move |(place, slice)| (number, track.name.as_str(), place, slice))
    })
}

/// The first field that shows each picture.
fn shown(trace: &Trace) -> BTreeMap<u64, (Time, Place)> {
    let mut fields = BTreeMap::new();
    for (track, _, place, slice) in slices(trace).filter(|(_, name, ..)| *name == "displayed") {
        if let Some(picture) = slice.picture {
            fields.entry(picture).or_insert((slice.begin, (track, place)));
        }
    }
    fields
}

fn mark(trace: &mut Trace, id: u64, way: &[(Time, Place)]) {
    for (i, (_, (track, place))) in way.iter().enumerate() {
        let step = match i {
            0 => Step::First,
            _ if i + 1 == way.len() => Step::Last,
            _ => Step::Middle,
        };
        if let Events::Slices(slices) = &mut trace.tracks[*track].events {
            // An update that two pictures show begins the flow of the first.
            slices[*place].flow.get_or_insert(Flow { id, step });
        }
    }
}
