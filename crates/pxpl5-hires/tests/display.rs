//! Tests of the high-resolution frame buffer through its interface. Times are fractions of its 72 Hz period; a model
//! that paints whole regions gives the expected pictures.

use image::{Rgb, RgbImage};
use pxpl5_display::{Display, DisplayConfig, DisplayEvent, DisplayOutput};
use pxpl5_hires::HiResConfig;
use pxpl5_sim::{Phase, Span, TestBench, Time};
use pxpl5_wire::{
    Body, CopyTarget, Lines, MAX_MESSAGE_WORDS, NodeId, PeriodNumber, PictureNumber, PixelSource, RegionGrid, RegionId,
    RegionPixels, Word, swap_request,
};
use std::sync::Arc;

const NODES: [NodeId; 2] = [NodeId(40), NodeId(41)];
const SIZE: [u32; 2] = [1280, 1024];
const GRID: RegionGrid = RegionGrid { width: 1280, height: 1024, region_width: 128, region_height: 128 };
/// A word of the ring.
const WORD: Span = Span::from_ns(50);
/// Picoseconds of a second.
const SECOND: u128 = 1_000_000_000_000;

/// A pixel source whose colours encode region and row.
#[derive(Debug)]
struct Counted(RegionId);

fn colour(region: RegionId, row: u32) -> [u8; 3] {
    [0, region.0 as u8, row as u8]
}

impl PixelSource for Counted {
    fn pixels(&self) -> Arc<[Word]> {
        let word = |row| u32::from_be_bytes([0, 0, colour(self.0, row)[1], colour(self.0, row)[2]]);
        (0..128 * 128).map(|pixel| word(pixel / 128)).collect()
    }
}

struct Rig {
    display: Box<dyn Display>,
    bench: TestBench<DisplayEvent, DisplayOutput>,
}

impl Rig {
    fn new() -> Self {
        Self { display: HiResConfig::PAPERS.build(&NODES).expect("it can be built"), bench: TestBench::new() }
    }

    fn tick(&mut self, scan: u64) -> Time {
        let scan = PeriodNumber(scan);
        let at = self.display.tick(scan);
        self.bench.feed(at, Phase::Arrive, DisplayEvent::Tick(scan));
        at
    }

    /// Sends a region to the buffer of a port, its messages a nanosecond apart.
    fn region(&mut self, at: Time, port: usize, buffer: u8, region: u16) -> CopyTarget {
        let (frame_buffer, region) = (NODES[port], RegionId(region));
        let picture = PictureNumber(3);
        let target = CopyTarget { frame_buffer, buffer, lines: Lines::Frame, grid: GRID, region, picture };
        for part in 0..16 {
            let image = Arc::new(Counted(region)) as _;
            let body = Body::Pixels(RegionPixels { target, image, part, parts: 128 * 128 / MAX_MESSAGE_WORDS });
            self.deliver(at + Span::from_ns(part.into()), port, body);
        }
        target
    }

    fn deliver(&mut self, at: Time, port: usize, body: Body) {
        self.bench.feed(at, Phase::Arrive, DisplayEvent::Delivered { port, body });
    }

    fn run(&mut self) {
        let display = &mut self.display;
        self.bench.run(|event, context| display.handle(event, context));
    }
}

/// Returns a black picture with some regions of the grid in their colours.
fn painted(regions: &[u16]) -> RgbImage {
    RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        let region = (y / 128 * 10 + x / 128) as u16;
        Rgb(if regions.contains(&region) { colour(RegionId(region), y % 128) } else { [0; 3] })
    })
}

#[test]
fn its_clock_is_72_hz_and_its_scan_fills_each_period() {
    let display = Rig::new().display;
    for scan in [0_u64, 1, 2, 71, 72, 1_000_003] {
        let tick = display.tick(PeriodNumber(scan));
        assert!(u128::from(tick.0).abs_diff(u128::from(scan) * SECOND / 72) <= 1, "{scan}");
        assert_eq!(display.period_at(tick), PeriodNumber(scan));
        assert_eq!(display.period_at(Time(tick.0 + 1)), PeriodNumber(scan));
        if scan > 0 {
            assert_eq!(display.period_at(Time(tick.0 - 1)), PeriodNumber(scan - 1));
        }
        for (x, y) in [(0, 0), (1, 0), (0, 1), (640, 511), (1279, 1023)] {
            let pixels = u128::from(y * 1280 + x);
            let expected = u128::from(tick.0) + SECOND * pixels / (72 * 1280 * 1024);
            let lit = display.lights(1, x, y, PeriodNumber(scan)).expect("it is seen");
            assert!(u128::from(lit.0).abs_diff(expected) <= 1, "{scan}: {x}, {y}");
        }
        assert_eq!([(1280, 0), (0, 1024)].map(|(x, y)| display.lights(0, x, y, PeriodNumber(scan))), [None; 2]);
    }
}

#[test]
fn it_says_what_it_is() {
    let config = HiResConfig::PAPERS;
    let display = Rig::new().display;
    assert_eq!((display.name(), DisplayConfig::name(&config)), ("hires", "hires"));
    assert!(config.about().contains("1280 x 1024"));
    assert_eq!(display.nodes(), NODES);
    let surfaces: Vec<_> = display.surfaces().iter().map(|eye| (eye.label, [eye.width, eye.height])).collect();
    assert_eq!(surfaces, [("left", SIZE), ("right", SIZE)]);
    let mut changed = config;
    assert_eq!(changed.tables_mut().iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["hires"]);
    assert!(config.equals(&*config.boxed()));
    changed.refresh_hz = 60;
    assert!(!config.equals(&changed));
    changed.width = 0;
    assert!(changed.build(&NODES).is_err_and(|error| error.to_string().contains("hires.width")));
}

#[test]
fn a_picture_is_shown_from_the_scan_after_it_was_asked_for() {
    let mut rig = Rig::new();
    let first = rig.tick(0);
    let target = rig.region(first + Span::from_us(1), 1, 1, 37);
    rig.deliver(first + Span::from_us(9), 1, Body::Words(swap_request(1)));
    assert!(rig.display.last_seen().is_none() && rig.display.seen(1, PeriodNumber(0)).is_none());
    let second = rig.tick(1);
    let third = rig.tick(2);
    rig.run();
    let arrived = |part: u64| first + Span::from_us(1) + Span::from_ns(part);
    let region =
        DisplayOutput::RegionArrived { surface: 1, target, first_part_at: arrived(0), last_part_at: arrived(15) };
    let swapped = DisplayOutput::Swapped { surface: 1, buffer: 1, tick: PeriodNumber(1) };
    assert_eq!(rig.bench.outputs, [(arrived(15) + WORD, region), (second + WORD, swapped)]);
    assert!(third > second);

    assert_eq!(
        rig.display.counters().iter().map(|counter| (counter.name, counter.count)).collect::<Vec<_>>(),
        [("scans", 3)]
    );
    assert_eq!(rig.display.shown(1), Some(painted(&[37])));
    assert_eq!(rig.display.shown(0), Some(painted(&[])));
    assert_eq!(rig.display.shown(2), None);
    // Three scans have begun and two are over. The display remembers the last of these.
    assert_eq!(rig.display.last_seen(), Some(PeriodNumber(1)));
    assert_eq!(rig.display.seen(1, PeriodNumber(1)), Some(painted(&[37])));
    assert_eq!([0, 2].map(|scan| rig.display.seen(1, PeriodNumber(scan))), [None, None]);
    assert_eq!(rig.display.faults(), (0, None));
}

#[test]
fn what_a_port_cannot_use_is_counted() {
    let mut rig = Rig::new();
    rig.deliver(Time(1), 0, Body::Words(swap_request(2)));
    rig.deliver(Time(2), 1, Body::Words([7].into()));
    rig.run();
    assert_eq!(rig.display.faults(), (2, Some("expected buffer 0 or 1, found 2".to_owned())));
}

/// A board accepts regions at both of its ports. A number of ports that cannot be divided among boards is an error.
#[test]
fn a_board_with_two_ports_takes_regions_at_both() {
    let config = HiResConfig { ports: 2, ..HiResConfig::PAPERS };
    assert_eq!((config.ports(1), config.ports(2)), (2, 4));
    let nodes = [5, 6, 7, 8].map(NodeId);
    let display = config.build(&nodes).expect("two boards of two ports");
    assert_eq!((display.surfaces().len(), display.nodes().len()), (2, 4));
    let error = config.build(&nodes[..3]).expect_err("three ports").to_string();
    assert_eq!(error, "hires.ports: expected a multiple of 2 nodes, found 3");
}
