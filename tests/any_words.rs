//! Tests of displays with messages that no firmware of the papers sends, at every port and at any time. A display must
//! use each message or count a fault, and continue. A new pipeline often sends such messages by mistake.

use proptest::prelude::*;
use pxpl5::device::{Display, DisplayContext, DisplayEvent};
use pxpl5::firmware::{
    Body, CopyTarget, FieldParity, Lines, NodeId, PeriodNumber, PictureNumber, RegionGrid, RegionId, Word,
};
use pxpl5::{Time, registry};
use pxpl5_sim::TestBench;
use pxpl5_wire::{PixelSource, RegionPixels, SWAP_REQUEST};
use rayon::prelude::*;
use std::sync::Arc;

/// Ring address of the displays' first port.
const FIRST_PORT: u16 = 30;
/// Number of simulated periods of a display.
const PERIODS: u64 = 4;

/// A pixel source with as many pixels as a renderer.
#[derive(Debug)]
struct Grey;

impl PixelSource for Grey {
    fn pixels(&self) -> Arc<[Word]> {
        vec![0x80_8080; 128 * 128].into()
    }
}

/// Returns a strategy for numbers, many of which are valid in messages.
fn size() -> impl Strategy<Value = u32> {
    prop_oneof![4 => prop::sample::select(vec![640, 480, 240, 128, 120, 96, 16, 512]), 1 => 0u32..4, 1 => any::<u32>()]
}

fn words() -> impl Strategy<Value = Body> {
    let first = prop_oneof![2 => Just(SWAP_REQUEST), 1 => 0u32..16, 1 => any::<u32>()];
    let rest = prop::collection::vec(prop_oneof![2 => 0u32..4, 1 => any::<u32>()], 0..20);
    let message = (first, rest).prop_map(|(first, rest)| [vec![first], rest].concat());
    prop_oneof![9 => message, 1 => Just(Vec::new())].prop_map(|words| Body::Words(words.into()))
}

fn pixels() -> impl Strategy<Value = Body> {
    let grid = (size(), size(), size(), size()).prop_map(|(width, height, region_width, region_height)| RegionGrid {
        width,
        height,
        region_width,
        region_height,
    });
    let grid = prop_oneof![2 => Just(RegionGrid::FRAME), 2 => Just(RegionGrid::FIELD), 3 => grid];
    let lines =
        prop::sample::select(vec![Lines::Frame, Lines::Field(FieldParity::Even), Lines::Field(FieldParity::Odd)]);
    let region = prop_oneof![4 => 0u16..20, 1 => any::<u16>()];
    let parts = (0u32..16, prop_oneof![4 => 1u32..16, 1 => Just(0), 1 => any::<u32>()]);
    (FIRST_PORT..FIRST_PORT + 12, 0u8..4, lines, grid, region, 0u64..3, parts).prop_map(
        |(port, buffer, lines, grid, region, picture, (part, parts))| {
            let target = CopyTarget {
                frame_buffer: NodeId(port),
                buffer,
                lines,
                grid,
                region: RegionId(region),
                picture: PictureNumber(picture),
            };
            Body::Pixels(RegionPixels { target, image: Arc::new(Grey), part, parts })
        },
    )
}

/// Returns a strategy for a message, its port (modulo the number of ports), and its time in thousandths of all periods.
fn message() -> impl Strategy<Value = (Body, usize, u64)> {
    (prop_oneof![words(), pixels()], 0usize..12, 0u64..1_000)
}

fn read_display(display: &dyn Display, now: Time) {
    for surface in 0..display.surfaces().len() {
        let of_surface = &display.surfaces()[surface];
        for picture in [display.shown(surface), display.picture_so_far(surface, now)].into_iter().flatten() {
            assert_eq!(picture.dimensions(), (of_surface.width, of_surface.height));
        }
        for period in 0..PERIODS {
            drop(display.seen(surface, PeriodNumber(period)));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::support::sample_or_all(12, 96), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_message_at_any_port_is_accepted_or_a_fault(messages in prop::collection::vec(message(), 1..60)) {
        registry().displays().par_iter().for_each(|entry| {
            let config = (entry.config)();
            let nodes: Vec<NodeId> = (FIRST_PORT..).take(config.ports(2)).map(NodeId).collect();
            let mut display = config.build(&nodes, pxpl5_sim::Span::from_ns(50)).expect("the numbers of its papers");
            let mut bench: TestBench<DisplayEvent, _> = TestBench::new();
            let end = display.tick(PeriodNumber(PERIODS));
            for period in 0..PERIODS {
                let tick = PeriodNumber(period);
                bench.feed(display.tick(tick), pxpl5_sim::Phase::Arrive, DisplayEvent::Tick(tick));
            }
            for (body, port, at) in &messages {
                let event = DisplayEvent::Delivered { port: port % nodes.len(), body: body.clone() };
                bench.feed(Time(end.0 / 1_000 * at), pxpl5_sim::Phase::Arrive, event);
            }
            bench.run_until(end, |event, context: &mut DisplayContext| {
                let (faults_before, message) = (display.faults().0, matches!(event, DisplayEvent::Delivered { .. }));
                display.handle(event, context);
                assert!(display.faults().0 <= faults_before + u64::from(message), "{}", entry.name);
            });
            read_display(display.as_ref(), end);
            let (faults, first) = display.faults();
            assert!(faults <= messages.len() as u64);
            assert_eq!(faults > 0, first.is_some(), "{}: the first fault is reported", entry.name);
        });
    }
}
