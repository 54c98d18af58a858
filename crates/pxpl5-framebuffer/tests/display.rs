//! Tests of the NTSC display through its interface. An independent model of the beam and the screen computes the
//! expected pictures.

use crate::support::{WORD, n_parts};
use image::{Rgb, RgbImage};
use pxpl5_framebuffer::{FrameBufferConfig, NtscDisplay, Video};
use pxpl5_sim::{Phase, Span, TestBench, Time};
use pxpl5_wire::display::{Counter, Display, DisplayConfig, DisplayEvent, DisplayOutput};
use pxpl5_wire::{
    Body, CommandList, CopyTarget, Lines, NodeId, PeriodNumber, PictureNumber, PixelSource, RegionGrid, RegionId,
    RegionPixels, Word, swap_request,
};
use std::any::Any;
use std::sync::Arc;

const NODES: [NodeId; 2] = [NodeId(30), NodeId(31)];
const SIZE: [u32; 2] = [640, 480];
/// More than a millisecond passes from a retrace to the first visible line.
const BEFORE_THE_PICTURE: Span = Span::from_us(200);

fn video() -> Video {
    FrameBufferConfig::NTSC.video.video().expect("the papers' numbers")
}

/// Returns the colour of a pixel, which encodes its row, column and picture.
const fn colour_at(x: u32, y: u32, picture: u8) -> [u8; 3] {
    [y as u8, x as u8, picture]
}

/// The pixels of a picture within a region.
#[derive(Debug)]
struct Painted {
    rectangle: [u32; 4],
    picture: u8,
}

impl PixelSource for Painted {
    fn pixels(&self) -> Arc<[Word]> {
        let [left, top, width, height] = self.rectangle;
        let pixel = |i: u32| {
            let [red, green, blue] = colour_at(left + i % width, top + i / width, self.picture);
            Word::from_be_bytes([0, red, green, blue])
        };
        (0..width * height).map(pixel).collect()
    }
}

/// A display on a test bench, with the number of scheduled ticks.
struct Rig {
    display: Box<dyn Display>,
    bench: TestBench<DisplayEvent, DisplayOutput>,
}

impl Rig {
    fn new() -> Self {
        let mut config = FrameBufferConfig::NTSC;
        config.remember(4);
        Self {
            display: config.build(&NODES, pxpl5_sim::Span::from_ns(50)).expect("it can be built"),
            bench: TestBench::new(),
        }
    }

    fn tick(&mut self, field: u64) {
        let field = PeriodNumber(field);
        self.bench.feed(self.display.tick(field), Phase::Arrive, DisplayEvent::Tick(field));
    }

    fn deliver(&mut self, at: Time, port: usize, body: Body) {
        self.bench.feed(at, Phase::Arrive, DisplayEvent::Delivered { port, body });
    }

    /// Sends a whole picture to a port. All its messages arrive at one instant.
    fn paint(&mut self, at: Time, port: usize, buffer: u8, picture: u8) {
        for region in 0..RegionGrid::FRAME.regions() as u16 {
            let (lines, grid, region) = (Lines::Frame, RegionGrid::FRAME, RegionId(region));
            let image = Arc::new(Painted { rectangle: grid.rectangle(region), picture });
            let (frame_buffer, picture) = (NODES[port], PictureNumber(picture.into()));
            let target = CopyTarget { frame_buffer, buffer, lines, grid, region, picture };
            let parts = n_parts(&target);
            for part in 0..parts {
                let image = Arc::clone(&image) as _;
                self.deliver(at, port, Body::Pixels(RegionPixels { target, image, part, parts }));
            }
        }
    }

    fn run_to(&mut self, time: Time) {
        let display = &mut self.display;
        self.bench.run_until(time, |event, context| display.handle(event, context));
    }

    fn count(&self, name: &str) -> u64 {
        self.display.counters().iter().find(|counter| counter.name == name).expect("it is counted").count
    }
}

/// Returns the number of the picture that is sent to the left eye before the beam scans the first line of a field.
const fn picture_of(field: u64) -> u8 {
    10 + field as u8
}

/// Makes a display with fields 0 to `last`, each with a different picture for the left eye. Field `last` has begun, but
/// none of its pixels is scanned.
fn coloured(last: u64) -> Rig {
    let mut rig = Rig::new();
    for field in 0..=last {
        rig.tick(field);
        let at = rig.display.tick(PeriodNumber(field)) + BEFORE_THE_PICTURE;
        rig.paint(at, 0, 0, picture_of(field));
        rig.run_to(at);
    }
    rig
}

/// Returns the expected screen of the left eye at an instant of field `now`: each pixel shows the picture of the last
/// field that lit it.
fn screen(now: u64, time: Time) -> RgbImage {
    let video = video();
    RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        let lit_in = (0..=now).rev().find(|field| video.when(x, y, PeriodNumber(*field)).is_some_and(|at| at <= time));
        Rgb(lit_in.map_or([0; 3], |field| colour_at(x, y, picture_of(field))))
    })
}

/// Asserts that two pictures are equal, and names the first different pixel.
fn assert_same(found: Option<RgbImage>, expected: &RgbImage, what: &str) {
    let found = found.unwrap_or_else(|| panic!("{what}: nothing"));
    assert_eq!(found.dimensions(), expected.dimensions(), "{what}");
    let differs = found.enumerate_pixels().zip(expected.pixels()).find(|((_, _, found), expected)| found != expected);
    assert_eq!(differs, None, "{what}");
}

#[test]
fn the_display_has_a_surface_for_each_eye_and_the_periods_of_the_retraces() {
    let display = Rig::new().display;
    assert_eq!((display.name(), FrameBufferConfig::NTSC.name()), ("ntsc", "ntsc"));
    assert_eq!(display.nodes(), NODES);
    let surfaces: Vec<_> = display.surfaces().iter().map(|eye| (eye.label, [eye.width, eye.height])).collect();
    assert_eq!(surfaces, [("left", SIZE), ("right", SIZE)]);
    let ntsc = (&*display as &dyn Any).downcast_ref::<NtscDisplay>().expect("it is that");
    assert_eq!(ntsc.boards().iter().map(|board| board.node()).collect::<Vec<_>>(), NODES);
    for field in [0, 1, 2, 59_940] {
        // 60,000 fields take 1,001 seconds.
        let expected = u128::from(field) * 1_001_000_000_000_000 / 60_000;
        let tick = display.tick(PeriodNumber(field));
        assert!(u128::from(tick.0).abs_diff(expected) <= 1, "{field}");
        assert_eq!(display.period_at(tick), PeriodNumber(field));
        if field > 0 {
            assert_eq!(display.period_at(Time(tick.0 - 1)), PeriodNumber(field - 1));
        }
        // Even fields have the even lines.
        let first = (field % 2) as u32;
        assert_eq!(display.rows_lit(PeriodNumber(field)), (first, 2));
        for y in [first, first + 2, 478 + first] {
            assert_eq!(display.lights(0, 7, y, PeriodNumber(field)), video().when(7, y, PeriodNumber(field)));
            assert!(display.lights(1, 7, y, PeriodNumber(field)).is_some_and(|at| at > tick));
        }
        assert_eq!(display.lights(0, 7, 1 - first, PeriodNumber(field)), None);
    }
}

#[test]
fn a_port_takes_pixels_and_requests_for_its_own_eye() {
    let mut rig = Rig::new();
    rig.tick(0);
    rig.paint(Time(1_000_000), 1, 1, 77);
    rig.deliver(Time(2_000_000), 1, Body::Words(swap_request(1)));
    rig.tick(1);
    let retrace = rig.display.tick(PeriodNumber(1));
    rig.run_to(retrace);
    // 16 messages for each region of 128 x 128 pixels, and 12 messages for each region in the last 96 rows.
    let counts = ["fields", "messages", "regions", "swaps", Counter::LINES_NEVER_SHOWN].map(|name| rig.count(name));
    assert_eq!(counts, [2, 15 * 16 + 5 * 12, 20, 1, 0]);
    let swapped = DisplayOutput::Swapped { surface: 1, buffer: 1, tick: PeriodNumber(1) };
    assert_eq!(rig.bench.outputs.last(), Some(&(retrace + WORD, swapped)));
    let is_of_right = |output: &DisplayOutput| matches!(output, DisplayOutput::RegionArrived { surface: 1, .. });
    assert_eq!(rig.bench.outputs.iter().filter(|(_, output)| is_of_right(output)).count(), 20);
    let corners = [0, 1].map(|eye| rig.display.shown(eye).expect("two eyes").get_pixel(639, 479).0);
    assert_eq!(corners, [[0; 3], colour_at(639, 479, 77)]);
    assert_eq!(rig.display.shown(2), None);
    assert_eq!(rig.display.faults(), (0, None));
}

#[test]
fn lines_that_were_never_shown_are_counted_for_both_eyes() {
    let mut rig = Rig::new();
    rig.tick(0);
    for port in [0, 1] {
        rig.paint(Time(1_000_000), port, 0, 1);
        rig.paint(Time(2_000_000), port, 0, 2);
    }
    rig.run_to(Time(3_000_000));
    // Each of 480 lines lies in five regions.
    assert_eq!(rig.count(Counter::LINES_NEVER_SHOWN), 2 * 480 * 5);
}

#[test]
fn faults_of_a_port_are_counted_and_the_first_is_reported() {
    let mut rig = Rig::new();
    let commands = CommandList { runs: Vec::new(), context: 0, copies: Vec::new(), content: None };
    rig.deliver(Time(7), 1, Body::Words([0xdead_beef].into()));
    rig.deliver(Time(9), 0, Body::Words(swap_request(5)));
    rig.deliver(Time(9), 0, Body::Commands(commands));
    rig.run_to(Time(10));
    let (count, first) = rig.display.faults();
    assert_eq!(count, 3);
    assert!(first.is_some_and(|fault| fault.starts_with(&Time(7).to_string())));
}

#[test]
fn a_viewer_sees_each_line_as_last_scanned() {
    let rig = coloured(4);
    let end_of = |field: u64| Time(rig.display.tick(PeriodNumber(field + 1)).0 - 1);
    assert_eq!(rig.display.last_seen(), Some(PeriodNumber(3)));
    for field in 1..=3 {
        let expected = screen(field, end_of(field));
        assert_same(rig.display.seen(0, PeriodNumber(field)), &expected, &format!("field {field}"));
        for [x, y] in [[0, 0], [9, 1], [300, 201], [300, 200], [639, 479]] {
            let pixel = rig.display.seen_pixel(0, [x, y], PeriodNumber(field));
            assert_eq!(pixel, Some(expected.get_pixel(x, y).0), "field {field}, ({x}, {y})");
        }
    }
    let no_pixels = [(0, [0, 0], 4), (2, [0, 0], 3), (0, [SIZE[0], 0], 3), (0, [0, SIZE[1]], 3)];
    for (surface, pixel, field) in no_pixels {
        assert_eq!(rig.display.seen_pixel(surface, pixel, PeriodNumber(field)), None, "{pixel:?}, field {field}");
    }
    assert!(rig.display.seen(0, PeriodNumber(4)).is_none(), "it is not over");
    assert!(rig.display.seen(2, PeriodNumber(3)).is_none() && rig.display.seen_at(2, end_of(3)).is_none());
    let black = RgbImage::new(SIZE[0], SIZE[1]);
    assert_same(rig.display.seen(1, PeriodNumber(3)), &black, "the other eye");

    // Instants before, at and after the pixel under the beam.
    let at = video().when(300, 201, PeriodNumber(3)).expect("an odd field has the odd lines");
    for time in [Time(at.0 - 1), at, end_of(3)] {
        assert_same(rig.display.seen_at(0, time), &screen(3, time), &format!("{time}"));
    }
    let at = video().when(639, 0, PeriodNumber(2)).expect("an even one the even ones");
    assert_same(rig.display.seen_at(0, at), &screen(2, at), "the first line");
    assert!(rig.display.seen_at(0, rig.display.tick(PeriodNumber(4))).is_none(), "that field is not over");
}

#[test]
fn a_viewer_sees_the_current_field_up_to_the_beam() {
    let mut rig = coloured(3);
    for (x, y) in [(0, 1), (320, 241), (639, 479)] {
        let now = video().when(x, y, PeriodNumber(3)).expect("an odd field has the odd lines");
        rig.run_to(now);
        assert_same(rig.display.picture_so_far(0, now), &screen(3, now), &format!("{x}, {y}"));
    }
    assert!(rig.display.picture_so_far(2, Time::ZERO).is_none());
    let first = Rig::new().display;
    assert_same(first.picture_so_far(0, Time::ZERO), &RgbImage::new(SIZE[0], SIZE[1]), "before the first retrace");
}

#[test]
fn the_display_has_one_port_for_each_eye() {
    assert_eq!([0, 1, 2, 3].map(|pictures| FrameBufferConfig::NTSC.ports(pictures)), [1, 1, 2, 2]);
    let mut config = FrameBufferConfig::NTSC;
    let names: Vec<_> = DisplayConfig::tables(&config).iter().map(|(name, _)| *name).collect();
    // A frame buffer has no word time of its own: ports receive at the word time of the ring (`build`).
    assert_eq!(names, ["video"]);
    assert_eq!(config.tables_mut().iter().map(|(name, _)| *name).collect::<Vec<_>>(), names);
    assert!(config.about().contains("640 x 480"));
    assert_eq!(DisplayConfig::check(&config), Ok(()));
    config.remember(0);
    let refused = DisplayConfig::check(&config).expect_err("nothing would be remembered");
    assert!(refused.to_string().contains("fields_kept"), "{refused}");
    assert!(config.boxed().build(&NODES, pxpl5_sim::Span::from_ns(50)).is_err());
}
