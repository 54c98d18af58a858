//! Tests of buffers, swaps and scanned fields, rule by rule.

use crate::support::{Board, MESSAGE, NODE, WORD, colour, field_target, n_parts, source, target};
use pxpl5_framebuffer::{
    FrameBuffer, FrameBufferConfig, FrameBufferEvent, FrameBufferFault, FrameBufferOutput, RgbImage,
};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{FieldParity, Lines, NodeId, PeriodNumber, RegionGrid, RegionPixels};
use std::sync::Arc;
use std::sync::atomic::Ordering;

const RED: u32 = 0x00ff_0000;
const GREEN: u32 = 0x0000_ff00;

fn word(picture: &RgbImage, x: u32, y: u32) -> u32 {
    let [red, green, blue] = picture.get_pixel(x, y).0;
    u32::from_be_bytes([0, red, green, blue])
}

/// Makes a board whose buffer 0 is red and buffer 1 green before field 2 begins.
fn painted() -> Board {
    let mut board = Board::new();
    for region in 0..20 {
        for (buffer, word) in [(0, RED), (1, GREEN)] {
            let at = Time(1_000_000_000 * (1 + u64::from(region)));
            board.region(at, target(buffer, Lines::Frame, RegionGrid::FRAME, region, 0), &colour(word));
        }
    }
    board
}

fn swaps(board: &Board) -> Vec<(Time, u8, PeriodNumber)> {
    let swaps = board.bench.outputs.iter().filter_map(|(time, output)| match output {
        FrameBufferOutput::Swapped { buffer, field } => Some((*time, *buffer, *field)),
        FrameBufferOutput::RegionArrived { .. } => None,
    });
    swaps.collect()
}

#[test]
fn a_swap_takes_effect_at_the_next_retrace_only() {
    let mut board = painted();
    board.retraces(0..=4);
    let retrace = board.device.video().retrace(PeriodNumber(3));
    board.swap(Time(retrace.0 - 1), 1);
    board.run();
    assert_eq!(swaps(&board), [(retrace + WORD, 1, PeriodNumber(3))]);
    let seen = [2, 3].map(|field| word(&board.device.seen(PeriodNumber(field)).expect("kept").picture(), 5, 5));
    assert_eq!(seen, [RED, GREEN]);
    assert_eq!(board.device.displayed(), 1);
}

#[test]
fn a_swap_requested_at_the_instant_of_a_retrace_waits_for_the_next_retrace() {
    for seed in 0..20 {
        let mut board = Board::new();
        board.bench.queue().shuffle_ties(seed);
        board.retraces(0..=4);
        let [third, fourth] = [3, 4].map(|field| board.device.video().retrace(PeriodNumber(field)));
        board.swap(third, 1);
        board.run();
        assert_eq!(swaps(&board), [(fourth + WORD, 1, PeriodNumber(4))]);
    }
}

#[test]
fn the_last_of_several_swap_requests_takes_effect() {
    let mut board = Board::new();
    board.retraces(0..=2);
    board.swap(Time(10), 1);
    board.swap(Time(20), 0);
    board.swap(Time(30), 1);
    board.run();
    assert_eq!(swaps(&board).len(), 1);
    assert_eq!((board.device.displayed(), board.device.stats().swaps), (1, 1));
}

#[test]
fn a_region_has_arrived_when_its_last_message_arrives() {
    let mut board = Board::new();
    let top_left = field_target(1, FieldParity::Even, 0, 9);
    let last_part_at = Time(5_000_000_000);
    board.region(last_part_at, top_left, &colour(RED));
    board.run();
    let first_part_at = Time(last_part_at.0 - (MESSAGE * 14).0);
    let arrived = FrameBufferOutput::RegionArrived { target: top_left, first_part_at, last_part_at };
    assert_eq!(board.bench.outputs, [(last_part_at + WORD, arrived)]);
    assert_eq!((board.device.stats().messages, board.device.stats().regions), (15, 1));
}

#[test]
fn rows_of_a_field_region_fill_the_lines_of_that_field() {
    let mut board = Board::new();
    let image = source(1, 1, 128 * 120);
    board.region(Time(2_000_000_000), field_target(0, FieldParity::Odd, 6, 0), &image);
    board.retraces(0..=3);
    board.run();
    let frame = board.device.displayed_frame().picture();
    // Region 6 is the second region of the bottom row. Its first row is row 120 of the field, which is line 241 of the
    // frame.
    assert_eq!(word(&frame, 128, 241), 1);
    assert_eq!(word(&frame, 255, 241), 128);
    assert_eq!(word(&frame, 128, 243), 129);
    assert_eq!([word(&frame, 128, 242), word(&frame, 127, 241), word(&frame, 256, 241)], [0; 3]);
    let odd = board.device.seen(PeriodNumber(1)).expect("kept").picture();
    assert_eq!((odd.dimensions(), word(&odd, 128, 120)), ((640, 240), 1));
    assert_eq!(word(&board.device.seen(PeriodNumber(2)).expect("kept").picture(), 128, 120), 0);
}

/// The last pixel of a message arrives at the time of the message. Message 0 of a field region ends with pixel 127 of
/// row 7.
#[test]
fn a_word_is_shown_if_it_arrives_with_the_beam_but_not_a_picosecond_later() {
    for (late, expected) in [(0, GREEN), (1, RED)] {
        let mut board = painted();
        board.retraces(0..=3);
        let beam = board.device.video().when(127, 14, PeriodNumber(2)).expect("scanned");
        board.part(beam + Span(late), field_target(0, FieldParity::Even, 0, 1), &colour(GREEN), 0);
        board.run();
        let picture = board.device.seen(PeriodNumber(2)).expect("kept").picture();
        assert_eq!(word(&picture, 127, 7), expected);
        // The previous pixel arrives 50 ns earlier, but the beam reaches it 81 ns earlier.
        assert_eq!(word(&picture, 126, 7), RED);
    }
}

/// Words arrive faster than the beam moves. A region is therefore in time if its first word is in time.
#[test]
fn a_region_is_late_from_a_picosecond_after_its_first_pixel_was_scanned() {
    for late in [0, 1] {
        let mut board = painted();
        board.retraces(0..=3);
        let bottom = field_target(0, FieldParity::Even, 5, 1);
        let reached = board.device.video().reaches(&bottom, PeriodNumber(2)).expect("scanned");
        let last = reached + Span(late) + WORD * 1_023 + MESSAGE * 14;
        board.region(last, bottom, &colour(GREEN));
        board.run();
        let seen = board.device.seen(PeriodNumber(2)).expect("kept");
        let listed = seen.late_regions();
        assert_eq!(listed.len(), late as usize);
        for region in listed {
            assert_eq!((region.target, region.arrived_at), (bottom, Some(last)));
            assert_eq!((region.first_line, region.lines, region.lateness), (240, 1, Span(1)));
        }
        assert_eq!(word(&seen.picture(), 0, 120), if late == 0 { GREEN } else { RED });
    }
}

#[test]
fn a_retrace_a_picosecond_late_is_a_fault() {
    let mut board = Board::new();
    let field = PeriodNumber(1);
    board.feed(Time(board.device.video().retrace(field).0 + 1), FrameBufferEvent::Retrace { field });
    board.run();
    assert_eq!(board.device.faults().count, 1);
}

#[test]
fn pixels_are_computed_when_a_picture_is_read_and_hidden_pixels_are_never_computed() {
    let mut board = Board::new();
    let hidden = source(RED, 0, 128 * 120);
    let shown = source(GREEN, 0, 128 * 120);
    let top = |picture| field_target(0, FieldParity::Even, 3, picture);
    board.region(Time(1_500_000_000), top(0), &hidden);
    board.region(Time(17_000_000_000), top(1), &shown);
    board.retraces(0..=3);
    board.run();
    let asked = || [&hidden, &shown].map(|image| image.asked.load(Ordering::Relaxed));
    assert_eq!(asked(), [0, 0]);
    let seen = board.device.seen(PeriodNumber(2)).expect("kept");
    assert_eq!(word(&seen.picture(), 400, 0), GREEN);
    assert_eq!(asked(), [0, 1]);
}

#[test]
fn regions_that_cannot_be_seen_are_discarded() {
    let mut board = Board::new();
    let mut images = Vec::new();
    for field in 0..400u64 {
        board.retraces(field..=field);
        let begin = board.device.video().retrace(PeriodNumber(field));
        for region in 0..10 {
            let image = colour(RED);
            images.push(Arc::downgrade(&image));
            let at = begin + MESSAGE * (15 * (u64::from(region) + 1));
            let parity = FieldParity::of_field(PeriodNumber(field / 2));
            board.region(at, field_target((field % 2) as u8, parity, region, field), &image);
        }
        // Send a region that never becomes complete.
        board.part(begin + MESSAGE * 200, target(0, Lines::Frame, RegionGrid::FRAME, 3, field), &colour(GREEN), 2);
        board.run();
    }
    let alive = images.iter().filter(|image| image.strong_count() > 0).count();
    // Two buffers hold two fields of ten regions each. The two recorded fields hold older regions.
    assert!((40..=80).contains(&alive), "{alive}");
}

#[test]
fn regions_of_other_grids_are_discarded_when_newer_regions_cover_them() {
    let mut board = Board::new();
    let first = colour(RED);
    let old = Arc::downgrade(&first);
    board.region(Time(1_000_000_000), target(0, Lines::Frame, RegionGrid::FRAME, 0, 0), &first);
    drop(first);
    let fine = RegionGrid { width: 640, height: 480, region_width: 32, region_height: 32 };
    for region in 0..300 {
        board.region(
            Time(2_000_000_000 + 1_000 * u64::from(region)),
            target(0, Lines::Frame, fine, region, 0),
            &colour(1),
        );
    }
    board.retraces(0..=4);
    board.run();
    assert_eq!(old.strong_count(), 0);
    assert_eq!(word(&board.device.displayed_frame().picture(), 127, 127), 1);
}

#[test]
fn a_complete_region_can_be_sent_again_for_the_same_picture() {
    let mut board = Board::new();
    let target = target(0, Lines::Frame, RegionGrid::FRAME, 3, 7);
    board.region(Time(1_000_000_000), target, &colour(RED));
    board.region(Time(3_000_000_000), target, &colour(GREEN));
    board.run();
    assert_eq!((board.device.stats().regions, board.device.faults().count), (2, 0));
    assert_eq!(word(&board.device.displayed_frame().picture(), 3 * 128 + 5, 5), GREEN);
}

#[test]
fn an_invalid_message_is_counted_as_a_fault_with_its_reason() {
    let frame = |region| target(0, Lines::Frame, RegionGrid::FRAME, region, 0);
    let huge = RegionGrid { width: u32::MAX, height: u32::MAX, region_width: 1, region_height: 1 };
    let empty = RegionGrid { width: 640, height: 480, region_width: 0, region_height: 0 };
    let wide = RegionGrid { width: 640, height: 480, region_width: 640, region_height: 8 };
    let tall = target(0, Lines::Field(FieldParity::Even), RegionGrid::FRAME, 0, 0);
    let elsewhere = pxpl5_wire::CopyTarget { frame_buffer: NodeId(1), ..frame(0) };
    let cases = [
        (elsewhere, 0, 16, "pixels for node 1 came to the frame buffer at node 7"),
        (target(2, Lines::Frame, RegionGrid::FRAME, 0, 0), 0, 16, "expected buffer 0 or 1, found 2"),
        (frame(20), 0, 16, "region 20 of"),
        (target(0, Lines::Frame, huge, 0, 0), 0, 1, "does not lie in the frame of 640 x 480"),
        (target(0, Lines::Frame, empty, 0, 0), 0, 1, "does not lie in the frame"),
        (target(0, Lines::Frame, wide, 0, 0), 0, 5, "exceeds 128 x 128"),
        (tall, 0, 16, "does not lie in the frame"),
        (frame(0), 0, 15, "region 0 needs 16 messages of pixels, found 15"),
        (frame(0), 16, 16, "message 16 of 16 of region 0 does not exist"),
    ];
    for (target, part, parts, expected) in cases {
        let mut board = Board::new();
        let pixels = RegionPixels { target, image: colour(RED), part, parts };
        board.feed(Time(5), FrameBufferEvent::Pixels(pixels));
        board.run();
        let (time, fault) = board.device.faults().first.clone().expect(expected);
        assert_eq!(time, Time(5));
        assert!(fault.to_string().contains(expected), "{fault}");
    }
    let mut board = Board::new();
    board.part(Time(5), frame(0), &colour(RED), 3);
    board.part(Time(6), frame(0), &colour(RED), 3);
    board.swap(Time(7), 9);
    board.run();
    assert_eq!(board.device.faults().count, 2);
    let first = board.device.faults().first.clone().map(|fault| fault.1);
    assert_eq!(first, Some(FrameBufferFault::Part { target: frame(0), found: 3, parts: n_parts(&frame(0)) }));
}

#[test]
fn a_region_whose_source_has_too_few_pixels_stays_black() {
    let mut board = Board::new();
    board.region(Time(2_000_000_000), target(0, Lines::Frame, RegionGrid::FRAME, 0, 0), &source(RED, 0, 100));
    board.run();
    let picture = board.device.buffer(0).expect("exists").picture();
    assert_eq!([word(&picture, 0, 0), word(&picture, 0, 1)], [0, 0]);
    assert!(board.device.buffer(2).is_none());
}

#[test]
fn a_board_that_cannot_be_built_is_refused_with_the_reason() {
    let config = FrameBufferConfig { fields_kept: 0, ..FrameBufferConfig::NTSC };
    let error = FrameBuffer::new(config, NODE, WORD).expect_err("nothing kept");
    assert_eq!(error.to_string(), "frame buffer: fields_kept must be 1 to 1000, found 0");
}

#[test]
fn a_buffer_that_is_not_displayed_shows_nothing() {
    let mut board = Board::new();
    board.retraces(0..=8);
    let retrace =
        |n| FrameBuffer::new(FrameBufferConfig::NTSC, NODE, WORD).expect("valid").video().retrace(PeriodNumber(n));
    for (picture, field) in [(0, 1), (1, 3), (2, 7)] {
        board.region(
            retrace(field) + MESSAGE * 16,
            target(1, Lines::Frame, RegionGrid::FRAME, 0, picture),
            &colour(RED),
        );
    }
    // Picture 0 is overwritten before it is shown. Picture 1 is shown in fields 4 and 5.
    board.swap(Time(retrace(4).0 - 1), 1);
    board.swap(Time(retrace(6).0 - 1), 0);
    board.run();
    assert_eq!(board.device.stats().lines_never_shown, 128);
}
