//! Statistics of a run's results, updated during the run.
//!
//! Each picture is processed once, after all its records are complete, in the order in which pictures are shown. Memory
//! grows only by one byte per display period if the number of samples is limited.

use crate::observe::observers::FinalResults;
use crate::pipeline::{PictureTimes, Pipeline};
use crate::result::latency::{ENDS, LATENCY_PARTS, LATENCY_SURFACES, Pair, of_picture, pair, parts};
use crate::result::picture_ends::PictureResults;
use crate::result::summary::retraces;
use pxpl5_gp::Stage;
use pxpl5_machine::{Arrival, LateRegion, Record, StageSpan};
use pxpl5_sim::Samples;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{PeriodNumber, PictureNumber, SurfaceId};
use std::collections::BTreeMap;

/// Largest number of late regions that a [`Tally`] lists individually.
pub const LATE_REGIONS_LISTED: usize = 20;

/// Statistics of a run's results, over the pictures in the result window ([`ResultWindow`](crate::ResultWindow)).
///
/// Times are in milliseconds. Latencies cover only the complete pictures.
#[derive(Clone, Debug)]
pub struct Tally {
    /// Number of pictures that were begun and evaluated, complete or not.
    pub pictures: u64,
    /// Number of complete pictures that were shown in the whole run, including the warm-up.
    pub shown: u64,
    /// Number of complete pictures in the result window.
    pub complete: u64,
    /// Number of complete pictures since the last picture that was incomplete or late.
    pub shown_in_a_row: u64,
    /// Latencies in milliseconds, by the pipeline's definition. The latency usually lasts from the start of TRANSFORM
    /// until the picture is shown.
    pub latency_ms: Samples,
    /// Durations of each latency part in milliseconds, in the order of [`LATENCY_PARTS`].
    pub parts_ms: Vec<Samples>,
    /// Times from the start of an eye's TRANSFORM to the end of its COPY, for all pictures in the result window.
    pub eye_ms: Samples,
    /// Times from the start of an eye's TRANSFORM to the swap that shows its picture.
    pub eye_swap_ms: Samples,
    /// Numbers of retraces from the start of an eye's TRANSFORM to the swap, including the retrace of the swap.
    pub eye_retraces: Samples,
    /// Durations of the first and of the second copy of each picture in the result window.
    pub copy_ms: [Samples; 2],
    /// Times from the start of TRANSFORM to the first word of the first copy.
    pub copy_begins_ms: Samples,
    /// Durations of TRANSFORM and of RENDER, for all pictures in the result window.
    pub stage_ms: [(Stage, Samples); 2],
    /// Number of pictures in the result window, by layer of the display. Layers without pictures have no entry.
    pub updates: BTreeMap<usize, u64>,
    /// Number of regions that arrived after their deadline.
    pub late_regions: u64,
    /// The first late regions, at most [`LATE_REGIONS_LISTED`].
    pub first_late_regions: Vec<LateRegion>,
    /// Number of records (time stamps, arrivals, swaps) that were read for these statistics. A record that is read
    /// twice counts twice.
    pub records_read: u64,
    surfaces_ms: Vec<Samples>,
    pub(crate) ends: PictureResults,
    pub(crate) window_from: Option<PeriodNumber>,
    region_ms: f64,
    region_pixels: u64,
    pub(crate) end: PeriodNumber,
    field_ms: f64,
    limit: usize,
}

/// Latencies of one eye, or from the first eye of a pair to the second eye.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceLatency<'a> {
    /// Index of the eye whose TRANSFORM begins the latency.
    pub first: usize,
    /// Index of the eye whose event ends the latency.
    pub last: usize,
    /// Short name of the event that ends the latency: `end_of_copy`, `swap` or `light`.
    pub until: &'static str,
    /// Description of the event that ends the latency.
    pub event: &'static str,
    /// Latencies from the start of TRANSFORM to the event, in milliseconds.
    pub ms: &'a Samples,
}

/// The times of the first and the last word of each copy. A copy is one eye under Rendering Control, and half a field
/// under Slats.
type Copies = BTreeMap<(PictureNumber, u8), [Time; 2]>;

impl Tally {
    pub(crate) fn new(end: PeriodNumber, field_ms: f64, limit: usize) -> Self {
        let none = || Samples::keeping(limit);
        Self {
            pictures: 0,
            shown: 0,
            complete: 0,
            shown_in_a_row: 0,
            latency_ms: none(),
            parts_ms: LATENCY_PARTS.map(|_| none()).to_vec(),
            eye_ms: none(),
            eye_swap_ms: none(),
            eye_retraces: none(),
            copy_ms: [none(), none()],
            copy_begins_ms: none(),
            stage_ms: [Stage::Transform, Stage::Render].map(|stage| (stage, none())),
            updates: BTreeMap::new(),
            late_regions: 0,
            first_late_regions: Vec::new(),
            records_read: 0,
            surfaces_ms: vec![none(); LATENCY_SURFACES.len() * ENDS.len()],
            ends: PictureResults::default(),
            window_from: None,
            region_ms: 0.0,
            region_pixels: 0,
            end,
            field_ms,
            limit,
        }
    }

    /// Counts pictures of the whole run, not only of the result window, in the order in which they are shown.
    pub(crate) fn count(&mut self, record: &Record, pictures: &[PictureTimes]) {
        for times in pictures {
            let period = record.display().period_at(times.shown_at);
            self.pictures += 1;
            if period < self.end {
                self.ends.note(period, times.end);
            }
            self.shown_in_a_row = if times.is_shown() { self.shown_in_a_row + 1 } else { 0 };
            self.shown += u64::from(times.is_shown());
        }
    }

    /// Adds the times of pictures in the result window. All records of these pictures must be complete.
    pub(crate) fn take(&mut self, results: &FinalResults<'_>) {
        let FinalResults { pipeline, record, window, .. } = *results;
        let Some(window) = window else { return };
        if self.window_from != Some(window.first_period) {
            // The window begins later than assumed, so all samples so far lie before the window.
            self.restart(window.first_period);
        }
        let steady = results.steady_pictures();
        if steady.is_empty() {
            return;
        }
        // All pictures in the window count for copies and stages. Only complete pictures count for latencies.
        let stages = record.stages();
        self.take_copies(pipeline, record, steady);
        let complete = steady.iter().filter(|times| times.is_shown());
        complete.clone().for_each(|times| self.take_complete(record, times, of_picture(&stages, times.picture)));
        self.take_eye_swaps(&stages, complete);
        self.take_stages(&stages, steady);
        steady.iter().for_each(|times| *self.updates.entry(times.layer).or_default() += 1);
    }

    /// Clears the samples after the result window has moved to a later start. Counts over the whole run keep their
    /// values.
    fn restart(&mut self, first_period: PeriodNumber) {
        let fresh = Self::new(self.end, self.field_ms, self.limit);
        let before = std::mem::replace(self, fresh);
        self.window_from = Some(first_period);
        self.pictures = before.pictures;
        self.shown = before.shown;
        self.shown_in_a_row = before.shown_in_a_row;
        self.late_regions = before.late_regions;
        self.first_late_regions = before.first_late_regions;
        self.records_read = before.records_read;
        self.ends = before.ends;
        self.region_ms = before.region_ms;
        self.region_pixels = before.region_pixels;
    }

    fn take_complete(&mut self, record: &Record, times: &PictureTimes, stages: &[StageSpan]) {
        self.complete += 1;
        self.latency_ms.push((times.shown_at - times.transform_at).as_ms());
        let spans = parts(record, times, stages).spans;
        self.parts_ms.iter_mut().zip(spans).for_each(|(samples, span)| samples.push(span.as_ms()));
        if stages.is_empty() {
            return;
        }
        if let Some(pair) = pair(record, times.shown_at, stages) {
            self.take_pair(&pair);
        }
    }

    fn take_pair(&mut self, pair: &Pair) {
        let latencies = LATENCY_SURFACES.into_iter().flat_map(|whose| ENDS.map(|end| (whose, end)));
        for (samples, ((first, last), (_, _, end))) in self.surfaces_ms.iter_mut().zip(latencies) {
            samples.push((end(pair, last) - pair.transform_at[first]).as_ms());
        }
    }

    /// Returns the latencies of each eye and of the pair of eyes. The iterator is empty if the eyes share one
    /// TRANSFORM.
    pub fn latencies_of_surfaces(&self) -> impl Iterator<Item = SurfaceLatency<'_>> {
        let latencies = LATENCY_SURFACES.into_iter().flat_map(|whose| ENDS.map(|end| (whose, end)));
        let with = self.surfaces_ms.iter().zip(latencies).filter(|(ms, _)| ms.count() > 0);
        with.map(|(ms, ((first, last), (until, event, _)))| SurfaceLatency { first, last, until, event, ms })
    }

    fn take_copies(&mut self, pipeline: &dyn Pipeline, record: &Record, steady: &[PictureTimes]) {
        let copies = copies(pipeline, record);
        for times in steady {
            for (samples, place) in self.copy_ms.iter_mut().zip(0..) {
                let span = copies.get(&(times.picture, place));
                samples.extend(span.map(|[begin, end]| (*end - *begin).as_ms()));
            }
            let first = copies.get(&(times.picture, 0));
            self.copy_begins_ms.extend(first.map(|[begin, _]| begin.since(times.transform_at).as_ms()));
        }
    }

    fn take_eye_swaps<'a>(&mut self, stages: &[StageSpan], complete: impl Iterator<Item = &'a PictureTimes>) {
        let shown: BTreeMap<PictureNumber, Time> = complete.map(|times| (times.picture, times.shown_at)).collect();
        let mut begins: BTreeMap<(PictureNumber, SurfaceId), Time> = BTreeMap::new();
        // The begin of an eye is the earliest TRANSFORM over all slaves.
        let transforms =
            stages.iter().filter(|span| span.stage == Stage::Transform && shown.contains_key(&span.picture));
        for stage in transforms {
            let Some(eye) = stage.surface else { continue };
            let begin = begins.entry((stage.picture, eye)).or_insert(stage.begin);
            *begin = stage.begin.min(*begin);
        }
        // All eyes of a picture are swapped in at the same instant.
        for ((picture, _), begin) in &begins {
            let ms = shown[picture].since(*begin).as_ms();
            self.eye_swap_ms.push(ms);
            self.eye_retraces.push(retraces(ms, self.field_ms));
        }
    }

    fn take_stages(&mut self, stages: &[StageSpan], pictures: &[PictureTimes]) {
        for times in pictures {
            let own = of_picture(stages, times.picture);
            for (stage, samples) in &mut self.stage_ms {
                // A stage without an end has no duration and is left out.
                let spans = own.iter().filter(|span| span.stage == *stage);
                samples.extend(spans.filter_map(|span| Some((span.end? - span.begin).as_ms())));
            }
            // An eye's time ends with the end of its own COPY.
            let of_eyes = own.iter().filter(|span| span.stage == Stage::Transform && span.surface.is_some());
            self.eye_ms.extend(of_eyes.filter_map(|span| {
                let copy = own.iter().find(|copy| copy.stage == Stage::Copy && copy.surface == span.surface)?;
                Some(copy.end?.since(span.begin).as_ms())
            }));
        }
    }

    /// Adds the times for which arrived regions have occupied ports of the display. `message` is the duration of one
    /// message on the ring.
    pub(crate) fn take_arrivals(&mut self, arrivals: &[Arrival], message: Span) {
        for arrival in arrivals {
            let [_, _, width, height] = arrival.target.grid.rectangle(arrival.target.region);
            self.region_ms += (arrival.last_part_at - arrival.first_part_at + message).as_ms();
            self.region_pixels += u64::from(width * height);
        }
    }

    pub(crate) fn take_late(&mut self, late: &[LateRegion]) {
        self.late_regions += late.len() as u64;
        let room = LATE_REGIONS_LISTED - self.first_late_regions.len();
        self.first_late_regions.extend(late.iter().take(room));
    }

    /// Returns the mean time for which 15,360 pixels of a region occupy a port of the display, in microseconds. Returns
    /// NaN if no region arrived.
    pub fn region_copy_us(&self) -> f64 {
        self.region_ms * 1e3 * 15_360.0 / self.region_pixels as f64
    }
}

fn copies(pipeline: &dyn Pipeline, record: &Record) -> Copies {
    let message = record.message_span();
    let mut copies = Copies::new();
    for arrival in &record.observation().arrivals {
        let place = pipeline.copy_part(arrival);
        let begin = arrival.begins_at(message);
        let [first, last] = copies.entry((arrival.target.picture, place)).or_insert([begin, arrival.last_part_at]);
        *first = begin.min(*first);
        *last = arrival.last_part_at.max(*last);
    }
    copies
}
