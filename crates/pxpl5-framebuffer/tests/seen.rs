//! Compares scanned fields with a model, pixel by pixel. For every pixel, the model finds the last word that had
//! arrived.

use crate::support::{self, Board, Counted, MESSAGE, n_parts, source, target};
use proptest::prelude::*;
use pxpl5_framebuffer::{FrameBufferConfig, FrameBufferEvent, ScannedField, ScannedLateRegion};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{CopyTarget, FieldParity, Lines, PeriodNumber, RegionGrid};
use std::sync::Arc;

/// Number of the scanned field.
const FIELD: u64 = 5;
const BEGINS: u64 = 83_416_666_666;
const ENDS: u64 = 100_100_000_000;

#[derive(Clone, Debug)]
struct Copied {
    target: CopyTarget,
    image: Arc<Counted>,
    /// Arrival time of message 0.
    first_at: u64,
    gap: u64,
    /// Word time in units of 50 ns.
    slowness: u64,
}

impl Copied {
    fn line(&self, row: u32) -> u32 {
        match self.target.lines {
            Lines::Frame => row,
            Lines::Field(FieldParity::Even) => 2 * row,
            Lines::Field(FieldParity::Odd) => 2 * row + 1,
        }
    }

    /// Returns the arrival time of the word of pixel `i`. The last word of a message arrives at the time of the
    /// message. The earlier words arrive one word time apart. Words of a message that has not ended at the end of the
    /// field do not count.
    fn arrival(&self, i: u32) -> u64 {
        let [_, _, width, height] = self.target.grid.rectangle(self.target.region);
        let message_end = (width * height).min((i / 1_024 + 1) * 1_024);
        let message_at = self.first_at + self.gap * u64::from(i / 1_024);
        if message_at >= ENDS {
            return ENDS;
        }
        message_at - 50_000 * self.slowness * u64::from(message_end - 1 - i)
    }

    fn each_pixel(&self, mut call: impl FnMut(u32, u32, u32)) {
        let [left, top, width, height] = self.target.grid.rectangle(self.target.region);
        for i in 0..width * height {
            call(left + i % width, self.line(top + i / width), i);
        }
    }
}

/// Returns the time at which odd field 5 scans a pixel, computed from the NTSC standard. Before field 5 come two frames
/// of 525 lines and an even field of 262.5 lines. Field 5 begins with 22 blank lines.
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
    let slowness = prop_oneof![Just(1), Just(2), Just(4)];
    (prop::collection::vec(copy, 1..24), slowness).prop_map(|(copies, slowness)| {
        let mut begins = BEGINS - 3_000_000_000;
        let copy = |(picture, ((lines, grid), region, pause, gap)): (u64, ((Lines, RegionGrid), u16, u64, u64))| {
            let gap = gap * slowness;
            let region = region % grid.regions() as u16;
            let target = target(0, lines, grid, region, picture);
            let first_at = begins + pause + MESSAGE.0 * slowness;
            begins = first_at + gap * u64::from(n_parts(&target));
            let image = source((picture as u32 + 1) << 16, 1, 128 * 128);
            Copied { target, image, first_at, gap, slowness }
        };
        (0..).zip(copies).map(copy).collect()
    })
}

fn seen(copies: &[Copied], shuffle: u64) -> ScannedField {
    let mut board = Board::slow(copies[0].slowness);
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

/// Returns for each pixel the newest word that had arrived when the pixel was scanned.
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

fn model_late(copy: &Copied) -> Option<ScannedLateRegion> {
    let mut lines = Vec::new();
    let mut lateness = 0;
    copy.each_pixel(|x, y, i| {
        if let Some(late) = scanned_at(x, y).and_then(|scan| copy.arrival(i).checked_sub(scan))
            && late > 0
        {
            lines.push(y);
            lateness = lateness.max(late);
        }
    });
    lines.dedup();
    let last_at = copy.first_at + copy.gap * u64::from(n_parts(&copy.target) - 1);
    // The board has no record of a region whose first message has not ended at the end of the field.
    (copy.first_at < ENDS && !lines.is_empty()).then(|| ScannedLateRegion {
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
    fn every_pixel_shows_the_newest_arrived_word_and_every_late_region_is_listed(
        copies in copies(),
        shuffle in any::<u64>(),
    ) {
        let seen = seen(&copies, shuffle);
        let picture = seen.picture();
        let words: Vec<_> = picture.pixels().map(|p| u32::from_be_bytes([0, p.0[0], p.0[1], p.0[2]])).collect();
        prop_assert!(words == model_picture(&copies));
        // Single pixels equal those of the picture. A stride without a common factor with 640 reaches all columns.
        for place in (0..640 * 480).step_by(2_011) {
            let [x, y] = [place % 640, place / 640];
            let expected = (y % 2 == 1).then(|| picture.get_pixel(x, y / 2).0);
            prop_assert_eq!(seen.pixel([x, y]), expected, "({}, {})", x, y);
        }
        let late: Vec<_> = copies.iter().filter_map(model_late).collect();
        prop_assert_eq!(seen.late_regions(), late);
    }
}

/// A message at the instant of a retrace gives the same result in any order of the events.
#[test]
fn the_order_of_simultaneous_events_does_not_change_the_picture() {
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

/// Makes a board that keeps more than two fields.
fn remembering() -> Board {
    Board::with(FrameBufferConfig { fields_kept: 8, ..FrameBufferConfig::NTSC })
}

/// Makes a board with two fields of one frame, each in one colour.
fn two_fields() -> Board {
    let mut board = Board::new();
    board.retraces(0..=6);
    for (parity, first) in [(FieldParity::Even, RED), (FieldParity::Odd, GREEN)] {
        for region in 0..RegionGrid::FIELD.regions() as u16 {
            let field = support::field_target(0, parity, region, 0);
            board.region(Time(MESSAGE.0 * 16 * u64::from(region + 1)), field, &support::colour(first));
        }
    }
    board.run();
    board
}

const RED: u32 = 0x00_00_ff;
const GREEN: u32 = 0x00_ff_00;

#[test]
fn two_fields_of_a_frame_interleave_in_either_order() {
    let board = two_fields();
    let seen = |field| board.device.seen(PeriodNumber(field)).expect("remembered");
    let even = seen(4).picture();
    let odd = seen(5).picture();
    assert_ne!(even.get_pixel(9, 9), odd.get_pixel(9, 9), "the fields can be told apart");
    for frame in [seen(4).interlaced_with(&seen(5)), seen(5).interlaced_with(&seen(4))] {
        assert_eq!(frame.dimensions(), (640, 480));
        for (x, y) in [(0, 0), (9, 1), (9, 18), (639, 479)] {
            let field = if y % 2 == 0 { &even } else { &odd };
            assert_eq!(frame.get_pixel(x, y), field.get_pixel(x, y / 2), "({x}, {y})");
        }
    }
}

/// If both fields have the same parity, the later one is shown on a black frame.
#[test]
fn two_fields_of_the_same_lines_give_the_later_field() {
    let mut board = remembering();
    board.retraces(0..=6);
    let early = support::field_target(0, FieldParity::Even, 0, 0);
    board.region(Time(MESSAGE.0 * 16), early, &support::colour(RED));
    let between = board.device.video().retrace(PeriodNumber(3));
    let late = support::field_target(0, FieldParity::Even, 0, 1);
    board.region(between + MESSAGE * 16, late, &support::colour(GREEN));
    board.run();
    let seen = |field| board.device.seen(PeriodNumber(field)).expect("remembered");
    let expected = seen(4).picture();
    assert_ne!(seen(2).picture().get_pixel(5, 5), expected.get_pixel(5, 5), "they differ");
    for frame in [seen(2).interlaced_with(&seen(4)), seen(4).interlaced_with(&seen(2))] {
        assert_eq!(frame.get_pixel(5, 10), expected.get_pixel(5, 5));
        assert_eq!(frame.get_pixel(5, 11).0, [0, 0, 0], "lines of the other field are black");
    }
}

#[test]
fn a_field_records_the_scanned_buffer() {
    let mut board = remembering();
    assert_eq!(board.device.scanning(), None);
    assert!(board.device.last_seen().is_none() && board.device.displayed() == 0);
    board.retraces(0..=6);
    let swapped = board.device.video().retrace(PeriodNumber(4));
    board.swap(Time(swapped.0 - 1), 1);
    board.run();
    let buffers: Vec<u8> =
        (2..6).map(|field| board.device.seen(PeriodNumber(field)).expect("remembered").buffer()).collect();
    assert_eq!(buffers, [0, 0, 1, 1]);
    assert_eq!(board.device.last_seen().map(|seen| seen.field()), Some(PeriodNumber(5)));
    assert_eq!(board.device.scanning(), Some(PeriodNumber(6)));
    assert_eq!(board.device.displayed(), 1);
}

#[test]
fn a_region_that_arrives_during_the_scan_of_its_field_is_late() {
    // The first of the region's 16 messages arrives 15 messages before the last, at the end of the field. Either of the
    // two simultaneous events can come first.
    let begins_at_the_end = ENDS + MESSAGE.0 * 15;
    let cases = [(BEGINS, false), (BEGINS + MESSAGE.0 * 60, true), (begins_at_the_end, false)];
    for ((last, is_late), shuffle) in cases.into_iter().flat_map(|case| (0..8).map(move |shuffle| (case, shuffle))) {
        let mut board = remembering();
        board.bench.queue().shuffle_ties(shuffle);
        board.retraces(0..=FIELD + 2);
        let top = support::field_target(0, FieldParity::Odd, 0, 0);
        board.region(Time(last), top, &support::colour(RED));
        board.run();
        let seen = board.device.seen(PeriodNumber(FIELD)).expect("remembered");
        assert_eq!(!seen.late_regions().is_empty(), is_late, "{last}");
    }
}

/// The second message of a region arrives exactly at the end of the field. In either order of events, its words count
/// as missing. If the first message arrives then, the region is not late for that field.
#[test]
fn a_message_that_arrives_at_the_end_of_a_field_is_not_in_that_field() {
    let grid = RegionGrid { region_height: 16, ..RegionGrid::FIELD };
    let image = source(1, 1, 128 * 16);
    for shuffle in 0..16 {
        let mut board = remembering();
        board.bench.queue().shuffle_ties(shuffle);
        board.retraces(0..=FIELD + 2);
        let target = target(0, Lines::Field(FieldParity::Odd), grid, 0, 0);
        board.part(Time(BEGINS), target, &image, 0);
        board.part(Time(ENDS), target, &image, 1);
        board.run();
        let late = board.device.seen(PeriodNumber(FIELD)).expect("remembered").late_regions();
        // Row 8 is line 17 of the frame.
        let lateness = Span(ENDS - scanned_at(0, 17).expect("an odd line"));
        assert_eq!(
            late,
            [ScannedLateRegion { target, arrived_at: None, first_line: 17, lines: 8, lateness }],
            "{shuffle}"
        );
        let mut board = remembering();
        board.bench.queue().shuffle_ties(shuffle);
        board.retraces(0..=FIELD + 2);
        board.part(Time(ENDS), target, &image, 0);
        board.run();
        let late = board.device.seen(PeriodNumber(FIELD)).expect("remembered").late_regions();
        assert_eq!(late, [], "{shuffle}");
    }
}
