//! What is seen, pixel by pixel, against a model that asks of every pixel which word had arrived last.

mod support;

use proptest::prelude::*;
use pxpl5_framebuffer::{FrameBufferEvent, SeenField, SeenLateRegion};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{CopyTarget, FieldParity, Lines, PeriodNumber, RegionGrid};
use std::sync::Arc;
use support::{Board, Counted, MESSAGE, n_parts, source, target};

/// The scanned field.
const FIELD: u64 = 5;
const BEGINS: u64 = 83_416_666_666;
const ENDS: u64 = 100_100_000_000;

#[derive(Clone, Debug)]
struct Copied {
    target: CopyTarget,
    image: Arc<Counted>,
    /// When message 0 arrived.
    first_at: u64,
    gap: u64,
}

impl Copied {
    fn line(&self, row: u32) -> u32 {
        match self.target.lines {
            Lines::Frame => row,
            Lines::Field(FieldParity::Even) => 2 * row,
            Lines::Field(FieldParity::Odd) => 2 * row + 1,
        }
    }

    /// When the word of pixel `i` arrived: the last word of its message came with it, those before 50 ns apart.
    fn arrival(&self, i: u32) -> u64 {
        let [_, _, width, height] = self.target.grid.rectangle(self.target.region);
        let message_end = (width * height).min((i / 1_024 + 1) * 1_024);
        let message_at = self.first_at + self.gap * u64::from(i / 1_024);
        message_at - 50_000 * u64::from(message_end - 1 - i)
    }

    /// Calls with column, frame line and number of each pixel.
    fn each_pixel(&self, mut call: impl FnMut(u32, u32, u32)) {
        let [left, top, width, height] = self.target.grid.rectangle(self.target.region);
        for i in 0..width * height {
            call(left + i % width, self.line(top + i / width), i);
        }
    }
}

/// When the odd field 5 scans a pixel, from the standard: the frame before it has 2 x 525 lines, the even field's
/// 262.5 and the half, 22 blank ones.
fn scanned_at(x: u32, y: u32) -> Option<u64> {
    let line = 2 * 525 + 263 + 22 + u64::from(y / 2);
    (y % 2 == 1).then(|| (line * 780 + 140 + u64::from(x)) * 11_000_000 / 135)
}

fn copies() -> impl Strategy<Value = Vec<Copied>> {
    let odd_cut = RegionGrid { width: 611, height: 233, region_width: 100, region_height: 67 };
    let grids = prop_oneof![
        Just((Lines::Frame, RegionGrid::FRAME)),
        Just((Lines::Field(FieldParity::Odd), RegionGrid::FIELD)),
        Just((Lines::Field(FieldParity::Even), RegionGrid::FIELD)),
        Just((Lines::Field(FieldParity::Odd), odd_cut)),
    ];
    let copy = (grids, any::<u16>(), 0u64..2_000_000_000, MESSAGE.0..150_000_000);
    prop::collection::vec(copy, 1..24).prop_map(|copies| {
        let mut begins = BEGINS - 3_000_000_000;
        let copy = |(picture, ((lines, grid), region, pause, gap)): (u64, ((Lines, RegionGrid), u16, u64, u64))| {
            let region = region % grid.regions() as u16;
            let target = target(0, lines, grid, region, picture);
            let first_at = begins + pause + MESSAGE.0;
            begins = first_at + gap * u64::from(n_parts(&target));
            let image = source((picture as u32 + 1) << 16, 1, 128 * 128);
            Copied { target, image, first_at, gap }
        };
        (0..).zip(copies).map(copy).collect()
    })
}

fn seen(copies: &[Copied], shuffle: u64) -> SeenField {
    let mut board = Board::new();
    board.bench.queue().shuffle_ties(shuffle);
    for copy in copies {
        for part in 0..n_parts(&copy.target) {
            board.part(Time(copy.first_at + copy.gap * u64::from(part)), copy.target, &copy.image, part);
        }
    }
    board.retraces(0..=FIELD + 1);
    board.run();
    assert_eq!(board.device.faults().count, 0);
    board.device.seen(PeriodNumber(FIELD)).expect("kept")
}

/// Per pixel the youngest word that had arrived when it was scanned.
fn model_picture(copies: &[Copied]) -> Vec<u32> {
    let mut words = vec![0; 640 * 240];
    for copy in copies {
        copy.each_pixel(|x, y, i| {
            if scanned_at(x, y).is_some_and(|scan| copy.arrival(i) <= scan) {
                words[(y / 2 * 640 + x) as usize] = copy.image.first + i;
            }
        });
    }
    words
}

fn model_late(copy: &Copied) -> Option<SeenLateRegion> {
    let mut lines = Vec::new();
    let mut lateness = 0;
    copy.each_pixel(|x, y, i| {
        if let Some(late) = scanned_at(x, y).and_then(|scan| copy.arrival(i).min(ENDS).checked_sub(scan))
            && late > 0
        {
            lines.push(y);
            lateness = lateness.max(late);
        }
    });
    lines.dedup();
    let last_at = copy.first_at + copy.gap * u64::from(n_parts(&copy.target) - 1);
    // Of a region whose first message is still under way at the end the board knows nothing.
    (copy.first_at < ENDS && !lines.is_empty()).then(|| SeenLateRegion {
        target: copy.target,
        arrived_at: (last_at < ENDS).then_some(Time(last_at)),
        first_line: lines[0],
        lines: lines.len() as u32,
        lateness: Span(lateness),
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_pixel_shows_the_youngest_word_that_had_arrived_and_every_late_region_is_listed(
        copies in copies(),
        shuffle in any::<u64>(),
    ) {
        let seen = seen(&copies, shuffle);
        let picture = seen.picture();
        let words: Vec<_> = picture.pixels().map(|p| u32::from_be_bytes([0, p.0[0], p.0[1], p.0[2]])).collect();
        prop_assert!(words == model_picture(&copies));
        let late: Vec<_> = copies.iter().filter_map(model_late).collect();
        prop_assert_eq!(seen.late_regions(), late);
    }
}

/// A message that arrives at the instant of a retrace is seen or not, and listed or not, whatever comes first.
#[test]
fn simultaneous_events_commute() {
    let image = source(1, 1, 128 * 128);
    let target = target(0, Lines::Frame, RegionGrid::FRAME, 0, 0);
    let results: Vec<_> = (0..32)
        .map(|shuffle| {
            let mut board = Board::new();
            board.bench.queue().shuffle_ties(shuffle);
            board.retraces(0..=3);
            let retrace = board.device.video().retrace(PeriodNumber(2));
            board.region(retrace, target, &image);
            board.feed(retrace, FrameBufferEvent::SwapRequested { buffer: 0 });
            board.run();
            let seen = [1, 2].map(PeriodNumber).map(|field| board.device.seen(field));
            let seen = seen.map(|seen| seen.map(|s| (s.picture(), s.late_regions())));
            let mut outputs = board.bench.outputs.clone();
            outputs.sort_by_key(|output| format!("{output:?}"));
            (seen, outputs)
        })
        .collect();
    assert!(results.iter().all(|result| *result == results[0]));
}
