//! Tests of the display on the ring: updates, swaps, orientations and the displayed picture.

use crate::support::bench::{Bench, CONFIG, flat};
use crate::support::turned;
use address_recalculation::{
    ArpConfig, CubeFace, Latch, begin_update, face_region, orientation_message, region_grid, swap_together,
};
use glam::DQuat;
use pxpl5_sim::Time;
use pxpl5_wire::display::{Display, DisplayConfig, DisplayEvent, DisplayOutput};
use pxpl5_wire::{
    Body, CopyTarget, Eye, FieldParity, Lines, NodeId, PeriodNumber, RegionId, RegionPixels, swap_request,
};
use std::sync::atomic::Ordering;

#[test]
fn an_update_is_shown_from_the_next_retrace() {
    let mut bench = Bench::new(&ArpConfig { fields_kept: 4, ..CONFIG });
    bench.update(0, 1, &flat(0x11_22_33, 500));
    (1..4).for_each(|field| bench.tick(field));
    assert_eq!(
        [bench.pixel(0, 320, 240), bench.pixel(1, 320, 241), bench.pixel(2, 320, 240)],
        [0, 0x11_22_33, 0x11_22_33]
    );
    let swaps = bench.outputs.iter().filter(
        |(_, output)| matches!(output, DisplayOutput::Updated { surface: 0, buffer: 1, tick, .. } if tick.0 == 1),
    );
    assert_eq!(swaps.count(), 1);
    let arrived = bench.outputs.iter().filter(|(_, output)| matches!(output, DisplayOutput::RegionArrived { .. }));
    assert_eq!(arrived.count(), 6);
    assert_eq!(bench.display.last_seen(), Some(PeriodNumber(2)));
    assert_eq!(bench.display.faults(), (0, None));
}

#[test]
fn texels_are_computed_only_when_a_picture_reads_them() {
    let mut bench = Bench::new(&CONFIG);
    let source = flat(0x33, 1);
    bench.update(0, 1, &source);
    (1..3).for_each(|field| bench.tick(field));
    assert_eq!(source.asked.load(Ordering::Relaxed), 0);
    // A view of 60 degrees straight ahead hits one face, which has one region of 128 texels.
    assert_eq!(bench.pixel(1, 320, 241), 0x33);
    assert_eq!(source.asked.load(Ordering::Relaxed), 1);
    bench.pixel(1, 5, 5);
    assert_eq!(source.asked.load(Ordering::Relaxed), 1, "once");
}

#[test]
fn an_incomplete_update_is_never_shown_and_its_lateness_is_counted() {
    let mut bench = Bench::new(&CONFIG);
    bench.update(0, 1, &flat(0xAA, 9));
    bench.tick(1);
    let front = face_region(128, CubeFace::NegZ, 0, 0).expect("a region").0;
    let late = flat(0xBB, 9);
    bench.begin(0, 0, &[front, 0]);
    bench.parts(0, 0, front, &late, 0..32);
    bench.parts(0, 0, 0, &late, 0..31);
    bench.words(Time(1_000), 0, swap_request(0));
    (2..4).for_each(|field| bench.tick(field));
    assert_eq!([bench.pixel(1, 9, 9), bench.pixel(2, 9, 8)], [0xAA, 0xAA], "the last message is missing");
    bench.parts(0, 0, 0, &late, 31..32);
    (4..6).for_each(|field| bench.tick(field));
    assert_eq!(bench.pixel(4, 9, 8), 0xBB);
    let stats = *bench.arp().memories(Eye::Left)[0].stats();
    assert_eq!((stats.swaps, stats.missed, stats.regions), (2, 2, 8));
    let two_fields = bench.display.tick(PeriodNumber(4)).since(bench.display.tick(PeriodNumber(2)));
    assert_eq!(stats.lateness, two_fields);
    let counters = bench.display.counters().into_iter().map(|counter| (counter.name, counter.count));
    let counters: Vec<(&str, u64)> = counters.filter(|(name, _)| !name.starts_with("matri")).collect();
    assert_eq!(counters, [("fields", 6), ("regions", 8), ("swaps", 2), ("swaps missed", 2)]);
    assert_eq!(bench.arp().memories(Eye::Left)[1].stats().missed, 0);
}

#[test]
fn regions_without_primitives_are_empty_without_being_sent() {
    let mut bench = Bench::new(&CONFIG);
    bench.update(0, 1, &flat(0xAA, 9));
    bench.tick(1);
    bench.begin(0, 0, &[]);
    bench.words(Time(1_000), 0, swap_request(0));
    (2..4).for_each(|field| bench.tick(field));
    assert_eq!([bench.pixel(1, 9, 9), bench.pixel(2, 9, 8)], [0xAA, 0]);
}

#[test]
fn a_swap_request_at_the_instant_of_a_retrace_waits_for_the_next_retrace() {
    let retrace = Bench::new(&CONFIG).display.tick(PeriodNumber(1));
    for (at, shown_in) in [(Time(retrace.0 - 1), 1), (retrace, 2)] {
        let mut bench = Bench::new(&CONFIG);
        bench.begin(0, 1, &[]);
        bench.words(at, 0, swap_request(1));
        (1..4).for_each(|field| bench.tick(field));
        let swapped = bench.outputs.iter().find_map(|(_, output)| match output {
            DisplayOutput::Updated { tick, .. } => Some(tick.0),
            _ => None,
        });
        assert_eq!(swapped, Some(shown_in));
        assert_eq!(bench.arp().memories(Eye::Left)[0].stats().missed, 0, "it is not late");
    }
}

#[test]
fn memories_that_exchange_objects_swap_together_or_not_at_all() {
    let mut bench = Bench::new(&CONFIG);
    bench.begin(0, 1, &[]);
    bench.begin(1, 1, &[3]);
    bench.words(Time(1_000), 0, swap_together(1, 0b11));
    bench.words(Time(1_000), 1, swap_together(1, 0b11));
    bench.tick(1);
    let buffers = |bench: &Bench| [0, 1].map(|k| bench.arp().memories(Eye::Left)[k].shown_buffer());
    assert_eq!(buffers(&bench), [0, 0], "the second one waits for a region");
    bench.parts(1, 1, 3, &flat(1, 1), 0..32);
    bench.tick(2);
    assert_eq!(buffers(&bench), [1, 1]);
    let missed = [0, 1].map(|k| bench.arp().memories(Eye::Left)[k].stats().missed);
    assert_eq!(missed, [1, 1]);
}

/// Checks that a swap request that arrives exactly at the retrace is too late for this retrace. The other memory of the
/// set then has to wait as well.
#[test]
fn a_group_of_memories_with_one_late_swap_request_waits_for_the_next_retrace() {
    let mut bench = Bench::new(&CONFIG);
    let retrace = bench.display.tick(PeriodNumber(1));
    [0, 1].into_iter().for_each(|port| bench.begin(port, 1, &[]));
    bench.words(Time(1_000), 0, swap_together(1, 0b11));
    bench.words(retrace, 1, swap_together(1, 0b11));
    let buffers = |bench: &Bench| [0, 1].map(|k| bench.arp().memories(Eye::Left)[k].shown_buffer());
    bench.tick(1);
    assert_eq!(buffers(&bench), [0, 0]);
    bench.tick(2);
    assert_eq!(buffers(&bench), [1, 1]);
}

/// Checks that regions are numbered by face and row. A map has a bit for each region, starting at the lowest bit of its
/// first word.
#[test]
fn a_region_map_has_one_bit_for_each_region_of_six_faces() {
    for texels in [128, 256, 512] {
        let across = texels / 128;
        let all = CubeFace::ALL
            .into_iter()
            .flat_map(|face| (0..across).flat_map(move |row| (0..across).map(move |column| (face, column, row))));
        for (number, (face, column, row)) in (0..).zip(all) {
            assert_eq!(face_region(texels, face, column, row), Some(RegionId(number)));
            let words = begin_update(texels, 1, &[RegionId(number)]);
            let bits = (0..)
                .zip(&words[2..])
                .flat_map(|(word, map)| (0..32).filter(move |bit| map >> bit & 1 == 1).map(move |bit| 32 * word + bit));
            assert_eq!(bits.collect::<Vec<u16>>(), [number], "{texels}");
        }
        for (column, row) in [(across, 0), (0, across)] {
            assert_eq!(face_region(texels, CubeFace::PosX, column, row), None);
        }
        let count = 6 * across * across;
        let beyond = begin_update(texels, 0, &[RegionId(count as u16)]);
        assert_eq!(beyond.len() as u32, 2 + count.div_ceil(32));
        assert!(beyond[1..].iter().all(|word| *word == 0), "there is no such region");
    }
}

/// Checks two memories, of which the second waits to swap together with the first. The first memory shows an update of
/// its own first. If this update counted as the common update, the common update would wait forever.
#[test]
fn an_update_of_one_memory_does_not_complete_the_common_update_of_two_memories() {
    let mut bench = Bench::new(&CONFIG);
    let buffers = |bench: &Bench| [0, 1].map(|k| bench.arp().memories(Eye::Left)[k].shown_buffer());
    bench.begin(0, 1, &[]);
    bench.begin(1, 1, &[]);
    bench.words(Time(1_000), 0, swap_request(1));
    bench.words(Time(1_000), 1, swap_together(1, 0b11));
    bench.tick(1);
    assert_eq!(buffers(&bench), [1, 0], "the first memory's older update is shown alone");
    bench.begin(0, 0, &[]);
    bench.words(bench.arp().tick(PeriodNumber(1)), 0, swap_together(0, 0b11));
    bench.tick(2);
    assert_eq!(buffers(&bench), [0, 1]);
}

#[test]
fn memories_are_composed_by_depth_over_the_ring() {
    for (depths, expected) in
        [([7, 8], 0xA0), ([8, 7], 0xB0), ([7, 7], 0xA0), ([0xFF_FFFF, 8], 0xB0), ([0xFF_FFFF; 2], 0)]
    {
        let mut bench = Bench::new(&CONFIG);
        bench.update(0, 1, &flat(0xA0, depths[0]));
        bench.update(1, 1, &flat(0xB0, depths[1]));
        (1..3).for_each(|field| bench.tick(field));
        assert_eq!(bench.pixel(1, 77, 33), expected, "{depths:?}");
    }
}

/// A function that sends a message to the display on a test bench.
type Send = fn(&mut Bench);

#[test]
fn an_invalid_message_is_counted_as_a_fault_and_has_no_effect() {
    let cases: [(&str, Send); 11] = [
        ("not of six faces", |bench| {
            let target = bench.target(0, 1, 0);
            bench.pixels(CopyTarget { grid: region_grid(256), ..target });
        }),
        ("not of six faces", |bench| {
            let target = bench.target(0, 1, 0);
            bench.pixels(CopyTarget { lines: Lines::Field(FieldParity::Even), ..target });
        }),
        ("pixels for another port", |bench| {
            bench.begin(0, 1, &[0]);
            let target = bench.target(1, 1, 0);
            bench.pixels(target);
        }),
        ("shown", |bench| bench.begin(0, 0, &[1])),
        ("shown", |bench| bench.parts(0, 0, 0, &flat(1, 1), 0..1)),
        ("announced", |bench| bench.parts(0, 1, 0, &flat(1, 1), 0..1)),
        ("twice", |bench| {
            bench.begin(0, 1, &[0]);
            bench.parts(0, 1, 0, &flat(1, 1), 0..1);
            bench.parts(0, 1, 0, &flat(1, 1), 0..1);
        }),
        ("expected buffer 0 or 1, found 2", |bench| bench.words(Time(5), 0, swap_request(2))),
        ("expected a map of 6 regions, found region 31", |bench| {
            bench.words(Time(5), 0, vec![0x0041_5042, 1, 1 << 31].into())
        }),
        ("expected 9 components, found 2", |bench| bench.words(Time(5), 0, vec![0x0041_504D, 1, 2].into())),
        ("expected BEGIN, SWAP, TOGETHER or MATRIX", |bench| bench.words(Time(5), 0, vec![12].into())),
    ];
    for (expected, send) in cases {
        let mut bench = Bench::new(&CONFIG);
        send(&mut bench);
        assert_eq!(bench.display.faults().0, 1, "{expected}");
        assert!(bench.fault().contains(expected), "{}", bench.fault());
    }
}

/// Checks that a memory with depth refuses a region of colours alone, which takes 16 messages. The background memory
/// accepts nothing else.
#[test]
fn only_the_background_memory_accepts_regions_without_depths() {
    let config = ArpConfig { has_background_memory: true, ..CONFIG };
    for (port, parts, faults) in [(0, 16, 1), (0, 32, 0), (2, 16, 0), (2, 32, 1)] {
        let mut bench = Bench::new(&config);
        bench.begin(port, 1, &[0]);
        let pixels = RegionPixels { target: bench.target(port, 1, 0), image: flat(5, 5), part: 0, parts };
        bench.event(Time(99), DisplayEvent::Delivered { port, body: Body::Pixels(pixels) });
        assert_eq!(bench.display.faults().0, faults, "port {port}, {parts} messages");
    }
}

#[test]
fn the_background_memory_shows_where_all_other_memories_are_empty() {
    let config = ArpConfig { has_background_memory: true, ..CONFIG };
    let mut bench = Bench::new(&config);
    bench.begin(2, 1, &[0, 1, 2, 3, 4, 5]);
    let sky = flat(0x77, 0);
    for region in 0..6 {
        for part in 0..16 {
            let pixels = RegionPixels { target: bench.target(2, 1, region), image: sky.clone(), part, parts: 16 };
            bench.event(Time(99), DisplayEvent::Delivered { port: 2, body: Body::Pixels(pixels) });
        }
    }
    bench.words(Time(100), 2, swap_request(1));
    (1..3).for_each(|field| bench.tick(field));
    assert_eq!(bench.pixel(1, 3, 3), 0x77);
    bench.update(0, 1, &flat(0x88, 0xFF_FFFE));
    (3..5).for_each(|field| bench.tick(field));
    assert_eq!(bench.pixel(3, 3, 3), 0x88);
}

/// Sends six faces, each filled with its own colour.
fn coloured(bench: &mut Bench) {
    let regions: Vec<u16> = (0..6).collect();
    bench.begin(0, 1, &regions);
    regions.iter().for_each(|face| bench.parts(0, 1, *face, &flat(0x10 * (u32::from(*face) + 1), 9), 0..32));
    bench.words(Time(1_000), 0, swap_request(1));
}

const QUARTER: [[f64; 3]; 3] = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]];

#[test]
fn the_display_latches_an_orientation_at_the_predicted_picosecond() {
    for (latch, x, y) in [(Latch::Field, 0, 0), (Latch::Line, 0, 100), (Latch::Pixel, 7, 200)] {
        let config = ArpConfig { latch, ..CONFIG };
        let latched = config.scan().expect("valid").latches(latch, x, y, PeriodNumber(2)).expect("an even line");
        for (late, expected) in [(0, 0x20), (1, 0x60)] {
            let mut bench = Bench::new(&config);
            coloured(&mut bench);
            bench.tick(1);
            bench.tick(2);
            bench.words(latched + pxpl5_sim::Span(late), 1, orientation_message(QUARTER));
            (3..4).for_each(|field| bench.tick(field));
            assert_eq!(bench.pixel(2, x, y), expected, "{latch:?}, {late} ps late");
        }
    }
}

/// Checks a matrix that arrives in the middle of a line. Depending on the setting, it takes effect at the next pixel,
/// the next line or the next field.
#[test]
fn a_picture_is_torn_at_the_line_where_the_orientation_is_latched() {
    let split = |latch| {
        let config = ArpConfig { latch, ..CONFIG };
        let lit = config.scan().expect("valid").latches(Latch::Pixel, 320, 100, PeriodNumber(2)).expect("an even line");
        let mut bench = Bench::new(&config);
        coloured(&mut bench);
        (1..3).for_each(|field| bench.tick(field));
        bench.arp_mut().load_orientation(Eye::Left, QUARTER, lit).expect("a rotation");
        bench.tick(3);
        [(0, 100), (319, 100), (320, 100), (0, 102), (639, 478)].map(|(x, y)| bench.pixel(2, x, y))
    };
    assert_eq!(split(Latch::Field), [0x60, 0x60, 0x60, 0x60, 0x60]);
    assert_eq!(split(Latch::Line), [0x60, 0x60, 0x60, 0x20, 0x20]);
    assert_eq!(split(Latch::Pixel), [0x60, 0x60, 0x20, 0x20, 0x20]);
}

#[test]
fn an_invalid_tracker_orientation_is_refused_and_the_last_valid_one_stays() {
    let mirror = [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let stretched = [[1.01, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let not_finite = [[f64::NAN, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, f64::INFINITY]];
    let mut bench = Bench::new(&CONFIG);
    coloured(&mut bench);
    bench.arp_mut().load_orientation(Eye::Left, QUARTER, Time(5)).expect("a rotation");
    for (rows, what) in [
        (mirror, "a reflection"),
        (stretched, "rows 0 and 0"),
        (not_finite, "a component of NaN"),
        ([[0.0; 3]; 3], "rows 0 and 0"),
    ] {
        let error = bench.arp_mut().load_orientation(Eye::Left, rows, Time(6)).expect_err(what).to_string();
        assert!(
            error.starts_with("orientation: expected a rotation within 1e-3, found ") && error.contains(what),
            "{error}"
        );
        bench.words(Time(7), 0, orientation_message(rows));
    }
    (1..3).for_each(|field| bench.tick(field));
    assert_eq!(bench.pixel(1, 320, 241), 0x20);
    let counters = bench.display.counters();
    let count = |name| counters.iter().find(|counter| counter.name == name).map(|counter| counter.count);
    assert_eq!([count("matrix loads"), count("matrices refused")], [Some(1), Some(8)]);
    assert_eq!(bench.display.faults().0, 4, "those that came over the ring");
}

#[test]
fn the_last_orientation_stays_if_the_tracker_stops_reporting() {
    let mut bench = Bench::new(&CONFIG);
    coloured(&mut bench);
    bench
        .arp_mut()
        .load_orientation(Eye::Left, turned(DQuat::from_rotation_y(std::f64::consts::PI)).rows(), Time(5))
        .expect("a rotation");
    (1..200).for_each(|field| bench.tick(field));
    assert_eq!(bench.pixel(198, 320, 240), 0x50, "behind");
    assert_eq!(bench.display.seen(0, PeriodNumber(100)), None, "no longer remembered");
}

#[test]
fn each_eye_has_its_own_memories_and_orientation() {
    let nodes: Vec<NodeId> = (1..=4).map(NodeId).collect();
    let display = CONFIG.build(&nodes, pxpl5_sim::Span::from_ns(50)).expect("valid");
    assert_eq!((display.surfaces().len(), CONFIG.ports(2), display.nodes().len()), (2, 4, 4));
    let mut bench = Bench { display, outputs: Vec::new(), texels: 128 };
    bench.tick(0);
    bench.update(0, 1, &flat(0x0A, 3));
    bench.update(3, 1, &flat(0x0B, 3));
    (1..3).for_each(|field| bench.tick(field));
    let seen = [0, 1].map(|eye| bench.display.seen(eye, PeriodNumber(1)).expect("remembered").get_pixel(9, 9).0[2]);
    assert_eq!(seen, [0x0A, 0x0B]);
    let updated = bench.outputs.iter().filter_map(|(_, output)| match output {
        DisplayOutput::Updated { surface, port, .. } => Some((*surface, *port)),
        _ => None,
    });
    assert_eq!(updated.collect::<Vec<_>>(), [(0, nodes[0]), (1, nodes[3])]);
    let error = CONFIG.build(&nodes[..3], pxpl5_sim::Span::from_ns(50)).expect_err("three ports").to_string();
    assert_eq!(error, "arp: expected 2 ports for one eye, 4 for two, found 3");
}

#[test]
fn the_displayed_picture_follows_the_newest_orientation() {
    let mut bench = Bench::new(&CONFIG);
    coloured(&mut bench);
    bench.tick(1);
    let shown = bench.display.shown(0).expect("a picture");
    assert_eq!(shown.dimensions(), (640, 480));
    assert!(shown.pixels().all(|pixel| pixel.0[2] == 0x60));
}
