//! An outcome as the few numbers that every level of modelling gives.

use pxpl5_gp::Stage;
use pxpl5_run::{Outcome, Statistics, Summary};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{PictureNumber, SurfaceId};
use std::collections::BTreeMap;

/// First and last word of regions that are copied one after the other: an eye of Rendering Control, a half of Slats.
struct CopySpan {
    begin: Time,
    end: Time,
}

/// Copies by picture and place in it.
type Copies = BTreeMap<(PictureNumber, u8), CopySpan>;

/// The numbers of an outcome over the pictures after the warm-up.
#[must_use]
pub fn summary(outcome: &Outcome) -> Summary {
    let pictures = outcome.steady_pictures();
    let message = outcome.record().message_span();
    let copies = copies(outcome, message);
    let mean = |place: u8| {
        let spans = pictures.iter().filter_map(|p| copies.get(&(p.picture, place)));
        let mean = Statistics::of(spans.map(|span| (span.end - span.begin).as_ms())).mean;
        if mean.is_nan() { 0.0 } else { mean }
    };
    let begins = pictures.iter().filter_map(|p| {
        let begin = copies.get(&(p.picture, 0))?.begin;
        Some(begin.since(p.transform_at).as_ms())
    });
    Summary {
        latencies_ms: outcome.complete_pictures().map(|p| (p.shown_at - p.transform_at).as_ms()).collect(),
        field_ms: outcome.field_ms(),
        updates_hz: outcome.updates_hz(),
        due: outcome.due(),
        eye_latencies_ms: eye_latencies(outcome),
        eye_swap_latencies_ms: eye_swap_latencies(outcome),
        region_copy_us: region_copy_us(outcome, message),
        first_copy_ms: mean(0),
        last_copy_ms: mean(1),
        copy_begins_ms: Statistics::of(begins).mean,
    }
}

fn copies(outcome: &Outcome, message: Span) -> Copies {
    let mut copies = Copies::new();
    for arrival in &outcome.observation().arrivals {
        let place = outcome.pipeline().copy_part(arrival);
        let begin = Time(arrival.first_part_at.0.saturating_sub(message.0));
        let fresh = CopySpan { begin, end: arrival.last_part_at };
        let span = copies.entry((arrival.target.picture, place)).or_insert(fresh);
        span.begin = span.begin.min(begin);
        span.end = span.end.max(arrival.last_part_at);
    }
    copies
}

fn region_copy_us(outcome: &Outcome, message: Span) -> f64 {
    let mut ms = 0.0;
    let mut pixels = 0u64;
    for arrival in &outcome.observation().arrivals {
        let [_, _, width, height] = arrival.target.grid.rectangle(arrival.target.region);
        ms += (arrival.last_part_at - arrival.first_part_at + message).as_ms();
        pixels += u64::from(width * height);
    }
    ms * 1e3 * 15_360.0 / pixels.max(1) as f64
}

fn eye_latencies(outcome: &Outcome) -> Vec<f64> {
    let stages = outcome.stages();
    let ends: BTreeMap<(PictureNumber, Option<SurfaceId>), Time> = stages
        .iter()
        .filter(|s| s.stage == Stage::Copy)
        .filter_map(|s| Some(((s.picture, s.surface), s.end?)))
        .collect();
    let [Some(first), Some(last)] = [outcome.steady_pictures().first(), outcome.pictures().last()] else {
        return Vec::new();
    };
    let of_eyes = stages.iter().filter(|s| s.stage == Stage::Transform && s.surface.is_some());
    let steady = of_eyes.filter(|s| (first.picture..=last.picture).contains(&s.picture));
    steady.filter_map(|s| Some(ends.get(&(s.picture, s.surface))?.since(s.begin).as_ms())).collect()
}

/// From an eye's first TRANSFORM on any slave to the swap of its picture.
fn eye_swap_latencies(outcome: &Outcome) -> Vec<f64> {
    let shown: BTreeMap<PictureNumber, Time> = outcome.complete_pictures().map(|p| (p.picture, p.shown_at)).collect();
    let mut begins: BTreeMap<(PictureNumber, SurfaceId), Time> = BTreeMap::new();
    for stage in outcome.stages().iter().filter(|s| s.stage == Stage::Transform && shown.contains_key(&s.picture)) {
        let Some(eye) = stage.surface else { continue };
        begins.entry((stage.picture, eye)).and_modify(|begin| *begin = stage.begin.min(*begin)).or_insert(stage.begin);
    }
    begins.iter().map(|((picture, _), begin)| shown[picture].since(*begin).as_ms()).collect()
}
