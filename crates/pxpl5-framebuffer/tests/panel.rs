//! Tests of panels through their interface. Times are fractions of a period. A model that paints whole regions computes
//! the expected pictures.

use image::{Rgb, RgbImage};
use pxpl5_framebuffer::{HiResConfig, LcdConfig, OledConfig, PanelConfig, PanelNumbers};
use pxpl5_sim::{Phase, Span, TestBench, Time};
use pxpl5_wire::display::{Display, DisplayConfig, DisplayEvent, DisplayOutput, ScanOrder};
use pxpl5_wire::{
    Body, CopyTarget, Lines, MAX_MESSAGE_WORDS, NodeId, PeriodNumber, PictureNumber, PixelSource, RegionGrid, RegionId,
    RegionPixels, Word, swap_request,
};
use std::sync::Arc;

const NODES: [NodeId; 2] = [NodeId(40), NodeId(41)];
const SIZE: [u32; 2] = [1280, 1024];
const GRID: RegionGrid = RegionGrid { width: 1280, height: 1024, region_width: 128, region_height: 128 };
/// Time of a word on the ring.
const WORD: Span = Span::from_ns(50);
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
        Self {
            display: HiResConfig::PAPERS.build(&NODES, pxpl5_sim::Span::from_ns(50)).expect("it can be built"),
            bench: TestBench::new(),
        }
    }

    fn tick(&mut self, scan: u64) -> Time {
        let scan = PeriodNumber(scan);
        let at = self.display.tick(scan);
        self.bench.feed(at, Phase::Arrive, DisplayEvent::Tick(scan));
        at
    }

    /// Sends a region to the buffer of a port. The messages of the region arrive one nanosecond apart.
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
fn the_panel_has_a_clock_of_72_hz_and_a_scan_that_fills_each_period() {
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
fn the_description_of_the_panel_has_its_size_name_and_surfaces() {
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
    assert!(
        changed
            .build(&NODES, pxpl5_sim::Span::from_ns(50))
            .is_err_and(|error| error.to_string().contains("hires.width"))
    );
}

#[test]
fn a_picture_is_shown_from_the_scan_after_its_swap_request() {
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
    // Three scans have begun and two have ended. The display keeps the second scan.
    assert_eq!(rig.display.last_seen(), Some(PeriodNumber(1)));
    assert_eq!(rig.display.seen(1, PeriodNumber(1)), Some(painted(&[37])));
    assert_eq!([0, 2].map(|scan| rig.display.seen(1, PeriodNumber(scan))), [None, None]);
    assert_eq!(rig.display.faults(), (0, None));
}

#[test]
fn invalid_messages_of_a_port_are_counted() {
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
    let display = config.build(&nodes, pxpl5_sim::Span::from_ns(50)).expect("two boards of two ports");
    assert_eq!((display.surfaces().len(), display.nodes().len()), (2, 4));
    let error = config.build(&nodes[..3], pxpl5_sim::Span::from_ns(50)).expect_err("three ports").to_string();
    assert_eq!(error, "hires.ports: expected a multiple of 2 nodes, found 3");
}

/// A panel of 100 x 50 pixels at 100 Hz, whose lines light in the first 8 ms of each period of 10 ms.
fn small() -> PanelConfig {
    PanelConfig { width: 100, height: 50, refresh_hz: 100, active_permille: 800, ..PanelConfig::PAPERS }
}

fn built(config: PanelConfig) -> Box<dyn Display> {
    config.build(&[NodeId(1)], pxpl5_sim::Span::from_ns(50)).expect("it can be built")
}

/// Returns the times at which some pixels light in the second period, in microseconds from the start of the period.
fn lit_us(config: PanelConfig, pixels: &[(u32, u32)]) -> Vec<Option<u64>> {
    let display = built(config);
    let begin = display.tick(PeriodNumber(1));
    let lit = pixels.iter().map(|(x, y)| display.lights(0, *x, *y, PeriodNumber(1)));
    lit.map(|at| at.map(|at| at.since(begin).0.div_ceil(1_000_000))).collect()
}

/// 5,000 pixels light in 8,000 us, 1.6 us for each pixel. A line of 100 pixels takes 160 us, and a column of 50 pixels
/// takes 80 us.
#[test]
fn a_scan_follows_its_direction_and_a_global_scan_lights_at_its_end() {
    let corners = [(0, 0), (1, 0), (0, 1), (99, 49)];
    let expected: [(u64, u64, [u64; 4]); 5] = [
        (0, 0, [0, 2, 160, 7_999]),
        (0, 1, [49 * 160, 49 * 160 + 2, 48 * 160, 159]),
        (0, 2, [0, 80, 2, 7_999]),
        (0, 3, [99 * 80, 98 * 80, 99 * 80 + 2, 79]),
        (1, 0, [8_000; 4]),
    ];
    for (scan, direction, expected) in expected {
        let found = lit_us(PanelConfig { scan, direction, ..small() }, &corners);
        assert_eq!(found, expected.map(Some), "scan {scan}, direction {direction}");
        let display = built(PanelConfig { scan, direction, ..small() });
        let all = || (0..50).flat_map(|y| (0..100).map(move |x| (x, y)));
        let lit: Vec<Time> = all().filter_map(|(x, y)| display.lights(0, x, y, PeriodNumber(3))).collect();
        assert_eq!(display.first_light(0, PeriodNumber(3)), lit.iter().copied().min());
        assert_eq!(display.last_light(0, PeriodNumber(3)), lit.iter().copied().max());
    }
}

/// A field of 25 lines takes 8,000 us, so each line takes 320 us.
#[test]
fn an_interlaced_panel_lights_every_second_line_and_keeps_the_others() {
    let config = PanelConfig { interlace: 1, ..small() };
    assert_eq!(lit_us(config, &[(0, 0), (0, 1), (0, 2), (0, 3)]), [None, Some(0), None, Some(320)]);
    let mut display = built(config);
    assert_eq!(display.rows_lit(PeriodNumber(1)), (1, 2));
    assert_eq!(display.rows_lit(PeriodNumber(2)), (0, 2));
    let mut bench = TestBench::new();
    let grid = RegionGrid { width: 100, height: 50, region_width: 128, region_height: 128 };
    let parts = (100 * 50_u32).div_ceil(MAX_MESSAGE_WORDS);
    let target = CopyTarget {
        frame_buffer: NodeId(1),
        buffer: 1,
        lines: Lines::Frame,
        grid,
        region: RegionId(0),
        picture: PictureNumber(1),
    };
    for part in 0..parts {
        let image = Arc::new(Counted(RegionId(9))) as _;
        let body = Body::Pixels(RegionPixels { target, image, part, parts });
        bench.feed(Time(1), Phase::Arrive, DisplayEvent::Delivered { port: 0, body });
    }
    bench.feed(Time(2), Phase::Arrive, DisplayEvent::Delivered { port: 0, body: Body::Words(swap_request(1)) });
    // The swap takes place before period 1, which lights the odd lines. Period 0 has left the even lines black.
    for period in [0, 1, 2].map(PeriodNumber) {
        bench.feed(Time(2).max(display.tick(period)), Phase::Arrive, DisplayEvent::Tick(period));
    }
    bench.run(|event, context| display.handle(event, context));
    let seen = display.seen(0, PeriodNumber(1)).expect("it is over");
    let is_new = |y: u32| *seen.get_pixel(0, y) == *display.shown(0).expect("a surface").get_pixel(0, y);
    assert!(is_new(1) && is_new(3), "the odd lines are new");
    assert!(!is_new(0) && !is_new(2), "the even lines are still black");
    assert_eq!(display.last_seen(), Some(PeriodNumber(1)));
}

#[test]
fn panels_keep_the_highest_bits_of_colours() {
    let mut display = built(PanelConfig { width: 128, height: 128, bits: 6, ..small() });
    let grid = RegionGrid { width: 128, height: 128, region_width: 128, region_height: 128 };
    let mut bench = TestBench::new();
    for part in 0..16 {
        let target = CopyTarget {
            frame_buffer: NodeId(1),
            buffer: 0,
            lines: Lines::Frame,
            grid,
            region: RegionId(0),
            picture: PictureNumber(1),
        };
        let body = Body::Pixels(RegionPixels { target, image: Arc::new(Counted(RegionId(200))), part, parts: 16 });
        bench.feed(Time(1), Phase::Arrive, DisplayEvent::Delivered { port: 0, body });
    }
    bench.run(|event, context| display.handle(event, context));
    let shown = display.shown(0).expect("a surface");
    // The panel shows two bits of each primary colour: 200 is 11001000, and 127 is 01111111.
    assert_eq!(*shown.get_pixel(5, 127), Rgb([0, 0b1100_0000, 0b0100_0000]));
}

#[test]
fn invalid_panel_numbers_are_refused_with_the_expected_range() {
    let wide = PanelConfig { width: 1440, height: 1600, ..PanelConfig::PAPERS };
    let long = PanelConfig { refresh_hz: 90, persistence_us: 20_000, ..PanelConfig::PAPERS };
    let odd = PanelConfig { interlace: 1, height: 481, ..PanelConfig::PAPERS };
    let global = PanelConfig { interlace: 1, scan: 1, ..PanelConfig::PAPERS };
    let bits = PanelConfig { bits: 16, ..PanelConfig::PAPERS };
    let still = PanelConfig { refresh_hz: 0, ..PanelConfig::PAPERS };
    for (config, expected) in [
        (
            wide,
            "panel.width: expected at most 128 regions of 128 x 128, as many as firmware can number, found 156 (1440 x 1600 pixels)",
        ),
        (long, "panel.persistence_us: expected 0 to 11111, a period of 90 Hz, found 20000"),
        (odd, "panel.height: expected an even number of interlaced lines, found 481"),
        (global, "panel.interlace: expected 0: an interlaced scan is rolling, and goes down or up, found 1"),
        (bits, "panel.bits: expected a multiple of 3, as many for each primary, found 16"),
    ] {
        assert_eq!(DisplayConfig::check(&config).expect_err("refused").to_string(), expected);
    }
    // `PanelNumbers` were not checked against the table of parameters, so their own rules must refuse a zero.
    for (zero, name) in [
        (PanelConfig { width: 0, ..PanelConfig::PAPERS }, "width"),
        (PanelConfig { height: 0, ..PanelConfig::PAPERS }, "height"),
        (still, "refresh_hz"),
    ] {
        let error = PanelNumbers::of(&zero).check("panel").expect_err("refused").to_string();
        assert_eq!(error, format!("panel.{name}: expected 1 or more, found 0"));
    }
    let endless = PanelConfig { width: u64::MAX, height: u64::MAX, ..PanelConfig::PAPERS };
    let error = PanelNumbers::of(&endless).check("panel").expect_err("refused").to_string();
    assert!(error.starts_with("panel.width: expected at most 128 regions"), "{error}");
    let error = DisplayConfig::check(&still).expect_err("refused").to_string();
    assert!(error.starts_with("panel.refresh_hz") && error.contains('0') && error.contains("1000"), "{error}");
}

/// The centre of a light of 2 ms with a time constant of 0.1 ms is 1.1 ms after its start.
#[test]
fn the_panels_of_the_presets_have_the_published_scan_and_light_times() {
    let light = OledConfig::PAPERS
        .build(&[1, 2, 3, 4, 5, 6, 7, 8].map(NodeId), pxpl5_sim::Span::from_ns(50))
        .expect("eight ports")
        .light();
    assert_eq!((light.scan, light.centre()), (ScanOrder::Down, Span::from_us(1_100)));
    let light = LcdConfig::PAPERS
        .build(&[1, 2, 3, 4, 5, 6, 7, 8].map(NodeId), pxpl5_sim::Span::from_ns(50))
        .expect("eight ports")
        .light();
    assert_eq!(
        (light.scan, light.persistence, light.centre()),
        (ScanOrder::Global, Span::from_us(330), Span::from_us(165))
    );
    assert!(Rig::new().display.light().is_instant());
}
