//! Tests of the display on the ring: the instants at which slices are displayed, and volumes that have arrived only
//! partly.

use pxpl5_sim::{Context, Phase, Span, Time};
use pxpl5_wire::display::{Display, DisplayConfig, DisplayEvent, DisplayOutput};
use pxpl5_wire::{Body, NodeId, PeriodNumber, SWAP_REQUEST, Word, swap_request};
use spatialgl::perspecta::{PerspectaConfig, volume_messages};
use spatialgl::{BitPlanes, Tiling};
use std::sync::Arc;

const CONFIG: PerspectaConfig = PerspectaConfig { slices: 12, width: 64, height: 48, ..PerspectaConfig::PAPERS };

fn build(config: &PerspectaConfig) -> Box<dyn Display> {
    config.build(&[NodeId(7)], pxpl5_sim::Span::from_ns(50)).expect("valid")
}

/// Returns a volume in which a few pixels of some slices are lit.
fn volume(seed: u32) -> BitPlanes {
    let mut planes = BitPlanes::dark([64, 48], 12);
    for k in [0, 3, 4, 11] {
        let words = planes.slice_mut(k);
        words[(17 * seed + k) as usize % 384] = 0x00_81_42_10 + seed;
        words[(230 + 7 * seed) as usize] = 0x00_00_00_FF;
    }
    planes
}

fn messages(planes: &BitPlanes) -> Vec<Arc<[Word]>> {
    volume_messages(planes, Tiling { tile: Some(16), batch: 4 }).expect("fits")
}

fn deliver(display: &mut dyn Display, words: &Arc<[Word]>, at: Time) {
    let mut context = Context::default();
    display.handle(DisplayEvent::Delivered { port: 0, body: Body::Words(Arc::clone(words)) }, context.at(at));
}

fn tick(display: &mut dyn Display, n: u64) -> Vec<(Time, DisplayOutput)> {
    let mut context = Context::default();
    let period = PeriodNumber(n);
    display.handle(DisplayEvent::Tick(period), context.at(display.tick(period)));
    context.drain_outputs().collect()
}

fn shows(display: &dyn Display, planes: &BitPlanes) -> bool {
    (0..12).all(|k| {
        let picture = display.shown(k as usize).expect("a slice");
        let pixels = (0..48).flat_map(|y| (0..64).map(move |x| (x, y)));
        pixels.into_iter().all(|(x, y)| {
            let bits = planes.pixel(k, x, y);
            picture.get_pixel(x, y).0 == [0, 1, 2].map(|c| 255 * (bits >> c & 1))
        })
    })
}

/// Checks that strobe k of revolution n lights at (n + k/N) / f.
#[test]
fn each_slice_lights_at_its_own_angle() {
    let display = build(&PerspectaConfig::PAPERS);
    assert_eq!(display.surfaces().len(), 396);
    assert_eq!(display.surfaces()[395].label, "slice-395");
    let revolution_ps = 60.0e12 / 900.0;
    for (n, k) in [(0u64, 0usize), (0, 1), (3, 198), (1_000_000, 395)] {
        let lit = display.lights(k, 5, 9, PeriodNumber(n)).expect("lit");
        let expected = (n as f64 + k as f64 / 396.0) * revolution_ps;
        assert!((lit.0 as f64 - expected).abs() <= 1.0 + expected * 1e-15, "{n} {k}");
    }
    assert_eq!(display.lights(396, 0, 0, PeriodNumber(0)), None);
    assert_eq!(display.lights(0, 768, 0, PeriodNumber(0)), None);
    assert!((PerspectaConfig::PAPERS.strobe_hz() - 5_940.0).abs() < 1e-9, "the press: 5,940 slices/s");
    assert!((PerspectaConfig { spin_rpm: 730, ..PerspectaConfig::PAPERS }.strobe_hz() - 4_818.0).abs() < 1e-9);
}

#[test]
fn strobes_of_a_revolution_have_no_gaps() {
    for lit_percent in [100, 40] {
        let config = PerspectaConfig { lit_percent, spin_rpm: 730, ..PerspectaConfig::PAPERS };
        let mut end = Time::ZERO;
        for k in 0..396 {
            let (begin, lit) = config.strobe(0, k);
            assert!(begin >= end && (lit_percent < 100 || begin == end));
            end = begin + lit;
        }
        assert!(end <= config.revolution().edge(1));
        assert_eq!(config.strobe(0, 396).0, config.revolution().edge(1));
    }
}

#[test]
fn a_period_is_found_from_a_time() {
    let display = build(&CONFIG);
    for n in [0, 1, 2, 777] {
        let begin = display.tick(PeriodNumber(n));
        assert_eq!(display.period_at(begin), PeriodNumber(n));
        assert_eq!(display.period_at(begin + Span(1)), PeriodNumber(n));
        assert_eq!(display.period_at(Time(display.tick(PeriodNumber(n + 1)).0 - 1)), PeriodNumber(n));
    }
}

#[test]
fn a_volume_is_shown_from_the_strobe_0_after_its_request() {
    let mut display = build(&CONFIG);
    let planes = volume(1);
    tick(&mut *display, 0);
    for words in &messages(&planes) {
        deliver(&mut *display, words, Time(1_000));
    }
    assert!(shows(&*display, &BitPlanes::dark([64, 48], 12)), "it was not requested");
    let at = display.tick(PeriodNumber(1));
    deliver(&mut *display, &swap_request(1), at);
    assert!(tick(&mut *display, 1).is_empty(), "a request at the instant itself comes too late");
    let outputs = tick(&mut *display, 2);
    let expected = DisplayOutput::Swapped { surface: 0, buffer: 1, tick: PeriodNumber(2) };
    assert_eq!(outputs, [(display.tick(PeriodNumber(2)) + Span::from_ns(50), expected)]);
    assert!(shows(&*display, &planes));
    tick(&mut *display, 3);
    assert_eq!(display.last_seen(), Some(PeriodNumber(2)));
    assert_eq!(display.seen(3, PeriodNumber(2)), display.shown(3));
    assert_eq!(display.seen(3, PeriodNumber(1)), None);
    assert_eq!(display.faults(), (0, None));
}

#[test]
fn an_incomplete_slice_is_never_shown() {
    let mut display = build(&CONFIG);
    let planes = volume(2);
    let all = messages(&planes);
    for (i, words) in all.iter().enumerate() {
        deliver(&mut *display, words, Time(10));
        deliver(&mut *display, &swap_request(1), Time(10));
        let is_whole = i + 1 == all.len();
        // Between batches nothing is announced: a sender asks for a swap when it has sent everything.
        let between_maps = all.get(i + 1).is_some_and(|next| next.len() == 3 + 1);
        if !is_whole && !between_maps {
            assert!(tick(&mut *display, 1 + i as u64).is_empty(), "after message {i}");
            assert!(shows(&*display, &BitPlanes::dark([64, 48], 12)));
        }
    }
    assert_eq!(tick(&mut *display, 1_000).len(), 1);
    assert!(shows(&*display, &planes));
}

/// Checks that tiles that are not sent are dark, whatever the store held before.
#[test]
fn slices_missing_from_the_map_are_blank() {
    let mut display = build(&CONFIG);
    for (n, buffer) in [(1u32, 1u8), (2, 0), (3, 1), (4, 0)] {
        let planes = volume(n);
        let at = display.tick(PeriodNumber(u64::from(n) - 1));
        for words in &messages(&planes) {
            deliver(&mut *display, words, at);
        }
        deliver(&mut *display, &swap_request(buffer), at);
        assert_eq!(tick(&mut *display, u64::from(n)).len(), 1);
        assert!(shows(&*display, &planes), "volume {n}");
    }
}

#[test]
fn invalid_messages_are_faults_and_change_nothing() {
    let mut display = build(&CONFIG);
    let planes = volume(1);
    let all = messages(&planes);
    let map = all.iter().find(|words| words.len() == 4).expect("a map").to_vec();
    let tile = all.iter().find(|words| words.len() > 4).expect("a tile").to_vec();
    let changed = |words: &[Word], at: usize, value: Word| {
        let mut words = words.to_vec();
        words[at] = value;
        words
    };
    let bad = [
        vec![],
        vec![1, 2, 3, 4],
        vec![SWAP_REQUEST, 2],
        tile.clone(),
        changed(&map, 1, 12 << 16 | 1),
        changed(&map, 1, 0xFFFF_FFFF),
        changed(&map, 2, 12),
        changed(&map, 2, 0),
        map[..3].to_vec(),
    ];
    for words in &bad {
        deliver(&mut *display, &words.clone().into(), Time(5));
    }
    assert_eq!(display.faults().0, bad.len() as u64);
    deliver(&mut *display, &map.clone().into(), Time(5));
    deliver(&mut *display, &tile[..tile.len() - 1].to_vec().into(), Time(5));
    assert_eq!(display.faults().0, bad.len() as u64 + 1, "a tile cut short");
    deliver(&mut *display, &tile.clone().into(), Time(5));
    deliver(&mut *display, &tile.into(), Time(5));
    assert_eq!(display.faults().0, bad.len() as u64 + 2, "a tile twice");
    assert!(display.faults().1.expect("the first").contains("neither"));
    let mut context: Context<DisplayEvent, DisplayOutput> = Context::default();
    context.at(Time(9)).schedule(Time(9), Phase::Work, DisplayEvent::Timer(1));
    assert_eq!(context.drain_events().count(), 1);
}

#[test]
fn impossible_numbers_of_a_display_are_refused_by_name() {
    let cases = [
        (PerspectaConfig { slices: 395, ..CONFIG }, "perspecta.slices: expected an even number, found 395"),
        (PerspectaConfig { slices: 2, ..CONFIG }, "perspecta.slices must be 4 to 4096, found 2"),
        (PerspectaConfig { width: 100, ..CONFIG }, "perspecta.width: expected a multiple of 8, found 100"),
        (PerspectaConfig { spin_rpm: 0, ..CONFIG }, "perspecta.spin_rpm must be 1 to 1000000, found 0"),
    ];
    for (config, expected) in cases {
        assert_eq!(config.build(&[NodeId(0)], pxpl5_sim::Span::from_ns(50)).expect_err(expected).to_string(), expected);
    }
    assert_eq!(DisplayConfig::ports(&CONFIG, 2), 1);
}
