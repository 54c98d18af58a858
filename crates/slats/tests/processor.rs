//! Tests of the graphics processor that leads Slats, as the only processor of the machine. The tests choose the times
//! at which the renderers acknowledge copies.

use pphigs::{DisplayList, DisplayStructure, EyeView, FrameView, ModelFrame, RegionBinning, Shading, Share};
use pxpl5_geometry::Culling;
use pxpl5_gp::{BoardBench, GpBoard, GpEvent, GpTiming, Priority};
use pxpl5_renderer::Layout;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Body, COPY_ACKNOWLEDGEMENT, Message, NodeId, PeriodNumber, ViewNumber, read_swap_request};
use slats::{CLUMP, CopySchedule, SlatsConfig, processor};
use std::sync::Arc;

const BOARD: NodeId = NodeId(1);
const FRAME_BUFFERS: [NodeId; 2] = [NodeId(2), NodeId(3)];
const FIRST_RENDERER: u16 = 10;
/// Number of renderers, which is four more than the number of regions.
const RENDERERS: u16 = 24;
const REGIONS: u64 = 20;
const CYCLE: Span = Span(25_000);
/// Duration of a field, in milliseconds.
const FIELD_MS: u64 = 20;

/// Times of the processor. A triangle takes 30 us for each eye, a time chosen for these tests.
const TIMING: GpTiming = GpTiming { triangle_ns: 30_000, ..GpTiming::SLATS_FITTED };

const fn us(us: u64) -> Time {
    Time(us * 1_000_000)
}

/// The processor on a test bench. `us` is the simulated time in microseconds.
struct Rig {
    bench: BoardBench,
    us: u64,
}

impl Rig {
    /// Returns a bench whose processor holds invisible triangles and has received the first view.
    fn new(copy: CopySchedule, triangles: usize) -> Self {
        let config = SlatsConfig {
            host: NodeId(0),
            processors: vec![BOARD],
            renderers: (FIRST_RENDERER..FIRST_RENDERER + RENDERERS).map(NodeId).collect(),
            frame_buffers: FRAME_BUFFERS,
            copy,
            binning: RegionBinning::All,
            shading: Shading::Precomputed,
            layout: Layout::slats(),
            pixels: false,
        };
        let structure = DisplayStructure {
            triangles: 0..triangles,
            spheres: 0..0,
            frame: ModelFrame::World,
            culling: Culling::None,
        };
        let list = DisplayList {
            positions: vec![glam::Vec3::ZERO; 3],
            normals: vec![glam::Vec3::Z; 3],
            colours: vec![[0; 3]; 3],
            triangles: vec![[0, 1, 2]; triangles],
            structures: vec![structure],
            ..DisplayList::default()
        };
        let mut board = GpBoard::new(BOARD, TIMING, CYCLE);
        let gp = board.handle_for(Priority::Foreground);
        let binding = config.check().expect("a renderer for each region");
        for (priority, program) in processor(&gp, &config, &binding, Share::new(Arc::new(list), 0, 1), 0) {
            board.load(priority, Box::pin(program));
        }
        let mut rig = Self { bench: BoardBench::new(board), us: 0 };
        let one = glam::Mat4::IDENTITY;
        let eye = EyeView { world_to_eye: one, head_to_eye: one, projection: one };
        let view = FrameView { number: ViewNumber::FIRST, eyes: vec![eye; 2], edits: Vec::new() };
        rig.deliver(Body::Words(view.to_words().into()));
        rig
    }

    fn deliver(&mut self, body: Body) {
        let message = Message { source: NodeId(0), destination: BOARD, words: 4, body };
        self.bench.feed(us(self.us), GpEvent::Delivered(message));
    }

    /// Simulates up to the time `until_us`, with a retrace every 20 ms. The messages of the processor are accepted from
    /// `accepting_us` on.
    fn run_to(&mut self, until_us: u64, accepting_us: u64) {
        while self.us < until_us {
            self.us += 10;
            let now = us(self.us);
            if self.us.is_multiple_of(FIELD_MS * 1_000) {
                let field = PeriodNumber(self.us / (FIELD_MS * 1_000));
                self.bench.feed(now, GpEvent::Retrace(field));
            }
            if self.us >= accepting_us {
                self.bench.accept_all(now);
            }
            self.bench.run_until(now);
        }
        assert_eq!(self.bench.board.fault(), None);
    }
}

/// A request of the processor: to show a buffer (sent to a frame buffer) or to copy regions into a buffer (sent to a
/// renderer).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Asked {
    Show(u8),
    Write(u8),
}

fn asked(message: &Message) -> Option<Asked> {
    match &message.body {
        Body::Words(words) => read_swap_request(words).map(Asked::Show),
        Body::Commands(list) => list.copies.first().map(|order| Asked::Write(order.target.buffer)),
        Body::Pixels(_) => None,
    }
}

/// Tests the buffers that the processor requests if one field is late.
///
/// At a retrace, the processor asks for the last complete field that has the lines of the next period. It asks before
/// it orders the copies of the bottom regions, because these copies occupy the ports of the frame buffers. A new field
/// is written into the other buffer. After a late field, the next field has the lines of the other parity.
#[test]
fn a_late_field_is_replaced_by_the_last_complete_field_of_its_lines() {
    use Asked::{Show, Write};
    let mut rig = Rig::new(CopySchedule::Backup, 3);
    // The fields are 2 and 3 (in time), 4 (late), 5 and 6 (in time), 7 (late by more than a field), 8 (late because of
    // field 7) and 11.
    for copied_ms in [30, 50, 85, 95, 110, 165, 175, 190] {
        rig.run_to(copied_ms * 1_000, 0);
        (0..REGIONS / 2).for_each(|_| rig.deliver(Body::Words([COPY_ACKNOWLEDGEMENT, 0, 0, 0].into())));
    }
    rig.run_to(220_000 - 10, 0);
    let mut found: Vec<(u64, Asked)> = Vec::new();
    for (time, message) in rig.bench.sent() {
        let Some(asked) = asked(message) else { continue };
        let period = time.0 / us(FIELD_MS * 1_000).0;
        if found.last() != Some(&(period, asked)) {
            found.push((period, asked));
        }
    }
    let expected = [
        [(1, Show(0)), (1, Write(1)), (1, Show(1)), (1, Write(1))].as_slice(),
        &[(2, Show(0)), (2, Write(1)), (2, Show(1)), (2, Write(1))],
        &[(3, Show(1)), (3, Write(0))],
        // Field 4 is complete now, and field 5 follows.
        &[(4, Show(1)), (4, Write(0)), (4, Show(0)), (4, Write(0))],
        // Field 4 is requested.
        &[(5, Show(0)), (5, Write(1)), (5, Show(1)), (5, Write(1))],
        &[(6, Show(0)), (6, Write(1))],
        &[(7, Show(1))],
        // Fields 7 and 8 are complete now.
        &[(8, Show(0)), (8, Write(1)), (8, Write(0))],
        &[(9, Show(0)), (9, Write(0))],
        &[(10, Show(0))],
    ];
    assert_eq!(found, expected.concat());
}

/// Tests the time of the second clump. The processor has one clump buffer, so it makes the clump when all receivers
/// have begun to take the first clump. A clump takes 30 us for each triangle and eye.
#[test]
fn the_next_clump_is_prepared_while_the_previous_one_is_drained() {
    const SECOND: usize = 7;
    let mut rig = Rig::new(CopySchedule::Whole, CLUMP + SECOND);
    let first_retrace = FIELD_MS * 1_000;
    let accepting = first_retrace + 8_000;
    rig.run_to(accepting - 10, accepting);
    let of_first = rig.bench.sent().count();
    assert_eq!(of_first as u64, REGIONS, "a message for each region");
    rig.run_to(accepting + 2_000, accepting);
    let time = rig.bench.sent().nth(of_first).map(|(time, _)| time);
    let work = Span::from_ns(2 * SECOND as u64 * TIMING.triangle_ns);
    assert_eq!(time, Some(us(accepting) + work + Span::from_ns(TIMING.message_ns) + CYCLE));
}

/// Returns the times at which the processor ordered copies of bottom regions.
fn bottom_orders(rig: &Rig) -> Vec<Time> {
    let is_bottom = |message: &Message| match &message.body {
        Body::Commands(list) => list.copies.first().is_some_and(|order| u32::from(order.target.region.0) >= 5),
        _ => false,
    };
    rig.bench.sent().filter(|(_, message)| is_bottom(message)).map(|(time, _)| time).collect()
}

/// Tests both orders of two events: the retrace, and the acknowledgement of the last of the ten top regions. The copies
/// of the bottom regions must wait for both.
#[test]
fn bottom_regions_are_copied_after_the_last_top_region_and_the_retrace() {
    let acknowledge = |rig: &mut Rig, count| {
        (0..count).for_each(|_| rig.deliver(Body::Words([COPY_ACKNOWLEDGEMENT, 0, 0, 0].into())));
    };
    let message = GpTiming::SLATS_FITTED.message_ns / 1_000;
    // Late case: the last acknowledgement arrives 3 ms after the retrace at 40 ms.
    let mut rig = Rig::new(CopySchedule::Split, 3);
    rig.run_to(30_000, 0);
    acknowledge(&mut rig, 9);
    rig.run_to(43_000, 0);
    assert_eq!(bottom_orders(&rig), [], "one top region is not copied");
    acknowledge(&mut rig, 1);
    rig.run_to(45_000, 0);
    let begins = us(43_000 + message) + CYCLE;
    assert_eq!(bottom_orders(&rig), [begins; 10], "after the software of one message");
    // Early case: all acknowledgements have arrived before the retrace.
    let mut rig = Rig::new(CopySchedule::Split, 3);
    rig.run_to(30_000, 0);
    acknowledge(&mut rig, 10);
    rig.run_to(39_990, 0);
    assert_eq!(bottom_orders(&rig), [], "the beam scans the lines");
    rig.run_to(41_000, 0);
    assert_eq!(bottom_orders(&rig), [us(40_000) + CYCLE; 10]);
}

/// Tests that the first commands of a field, which clear its bottom regions, wait for the copies of the previous
/// field's bottom regions.
#[test]
fn the_next_field_does_not_overwrite_regions_before_they_are_copied() {
    let mut rig = Rig::new(CopySchedule::Split, 3);
    rig.run_to(59_000, 0);
    let clumps = |rig: &Rig, from: Time| {
        let clumps = rig.bench.sent().filter(|(time, message)| {
            *time > from && matches!(&message.body, Body::Commands(list) if list.copies.is_empty())
        });
        clumps.count() as u64
    };
    assert_eq!(clumps(&rig, us(40_000)), 0, "no top region has been acknowledged");
    (0..10).for_each(|_| rig.deliver(Body::Words([COPY_ACKNOWLEDGEMENT, 0, 0, 0].into())));
    rig.run_to(59_990, 0);
    assert_eq!((bottom_orders(&rig).len() as u64, clumps(&rig, us(59_000))), (10, REGIONS));
}
