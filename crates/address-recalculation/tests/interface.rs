//! Tests of the display's interface to the machine and the viewer, and of the contents of its memories.

use crate::support::bench::{Bench, CONFIG};
use crate::support::{texels, turned};
use address_recalculation::{
    AddressUnit, ArpConfig, ArpTiming, CubeFace, FaceSet, Footprint, Latch, Lens, Lookup, Orientation, ScanTiming,
    TexelAddress, face_region, region_grid,
};
use glam::DQuat;
use pxpl5_sim::{Span, SplitMix64, Time};
use pxpl5_wire::display::{Coverage, DisplayConfig};
use pxpl5_wire::{Eye, PeriodNumber, PixelSource, Word, swap_request};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Words of a region, with a flag that becomes true when the words are read.
#[derive(Debug)]
struct Words {
    words: Arc<[Word]>,
    is_asked: AtomicBool,
}

impl PixelSource for Words {
    fn pixels(&self) -> Arc<[Word]> {
        self.is_asked.store(true, Ordering::Relaxed);
        Arc::clone(&self.words)
    }
}

/// Fills each region of the first memory with `parts` messages of random words. The memory is visible from field 1 on.
fn filled(config: &ArpConfig, parts: u32, seed: u64) -> (Bench, Vec<Arc<Words>>) {
    let mut bench = Bench::new(config);
    let mut random = SplitMix64::new(seed);
    let regions: Vec<u16> = (0..region_grid(bench.texels).regions() as u16).collect();
    bench.begin(0, 1, &regions);
    let sources = regions.iter().map(|region| {
        let words = (0..parts * 1_024).map(|_| random.bits() as Word).collect();
        let source = Arc::new(Words { words, is_asked: AtomicBool::new(false) });
        let image: Arc<dyn PixelSource> = Arc::<Words>::clone(&source);
        bench.parts_of(parts, (0, 1, *region), &image, 0..parts);
        source
    });
    let sources = sources.collect();
    bench.words(Time(1_000), 0, swap_request(1));
    assert_eq!(bench.display.faults(), (0, None));
    (bench, sources)
}

/// Extends a number from `bits` bits to eight bits by repeating its upper bits.
fn widened(number: u32, bits: usize) -> u32 {
    let digits = format!("{number:0bits$b}").repeat(2);
    u32::from_str_radix(&digits[..8], 2).expect("binary")
}

/// Checks texels of 16 + 16 bits. The depth is in the upper half of a word, and colours of 5, 6 and 5 bits are in the
/// lower half. The farthest depth marks an empty texel.
#[test]
fn a_texel_is_packed_into_two_halves_of_16_bits() {
    let timing = ArpTiming { colour_bits: 16, depth_bits: 16, ..CONFIG.timing };
    let config = ArpConfig { timing, ..CONFIG };
    let mut bench = Bench::new(&config);
    let mut random = SplitMix64::new(5);
    bench.begin(0, 1, &[2]);
    let words: Arc<[Word]> = (0..16_384)
        .map(|place| match place % 3 {
            0 => 0xFFFF_0000 | random.bits() as Word & 0xFFFF,
            1 => 0xFFFE_0000 | random.bits() as Word & 0xFFFF,
            _ => random.bits() as Word,
        })
        .collect();
    let image: Arc<dyn PixelSource> = Arc::new(Words { words: Arc::clone(&words), is_asked: AtomicBool::new(false) });
    bench.parts_of(16, (0, 1, 2), &image, 0..16);
    bench.words(Time(1_000), 0, swap_request(1));
    bench.tick(1);
    assert_eq!(bench.display.faults(), (0, None));
    let faces = bench.arp().memories(Eye::Left)[0].shown_faces();
    for texel in texels(128) {
        let expected = (texel.face.index() == 2).then(|| words[(texel.row * 128 + texel.column) as usize]);
        let expected = expected.filter(|word| word >> 16 != 0xFFFF).map(|word| {
            let [red, green, blue] =
                [(word >> 11 & 31, 5), (word >> 5 & 63, 6), (word & 31, 5)].map(|(n, bits)| widened(n, bits));
            (red << 16 | green << 8 | blue, word >> 16)
        });
        assert_eq!(faces.texel(texel), expected, "{texel:?}");
    }
}

/// Returns the footprints (the four texels and their weights) of all pixels of a frame for one orientation, computed by
/// the address unit.
fn footprints(config: &ArpConfig, orientation: &Orientation) -> Vec<Footprint> {
    let table = config.table().expect("valid");
    let matrix = orientation.words(config.timing.matrix_bits);
    let unit = AddressUnit::new(&config.timing);
    let places = (0..table.height()).flat_map(|y| (0..table.width()).map(move |x| (x, y)));
    places.map(|(x, y)| unit.footprint(matrix.turn(table.entry(x, y))).expect("a direction")).collect()
}

fn piece(size: u32, texel: TexelAddress) -> u16 {
    face_region(size, texel.face, texel.column / 128, texel.row / 128).expect("on a face").0
}

/// Checks that only regions with a texel of some pixel's footprint are computed. The picture equals the picture from
/// completely computed faces.
///
/// The test covers faces with and without guard texels, and both exact and wider words.
#[test]
fn only_regions_that_a_pixel_reads_are_computed() {
    let narrow = ArpTiming { display_memories: 1, horizontal_deg: 9.0, ..ArpTiming::PAPERS };
    let wide = ArpTiming { vector_bits: 24, matrix_bits: 24, quotient_bits: 20, ..narrow };
    let scan = ScanTiming { visible_pixels: 30, visible_lines: 10, ..ScanTiming::PAPERS };
    let mut random = SplitMix64::new(11);
    let mut counts = BTreeSet::new();
    for case in 0..24 {
        let words = if case % 2 == 0 { narrow } else { wide };
        let timing = ArpTiming { guard_texels: case / 2 % 2, weight_bits: if case % 5 == 4 { 0 } else { 4 }, ..words };
        let config = ArpConfig { timing, scan, ..CONFIG };
        let mut axis = || f64::from(random.unit()) - 0.5;
        // Some cases look at borders: straight ahead at the middle of a face, where four regions meet, and by 45
        // degrees at an edge between two faces.
        let quaternion = match case / 4 {
            0 => DQuat::IDENTITY,
            1 => DQuat::from_rotation_y(45_f64.to_radians()),
            _ => DQuat::from_xyzw(axis(), axis(), axis(), axis()).normalize(),
        };
        let orientation = turned(quaternion);
        let (mut bench, sources) = filled(&config, 32, case);
        bench.arp_mut().load_orientation(Eye::Left, orientation.rows(), Time(5)).expect("a rotation");
        (1..4).for_each(|field| bench.tick(field));
        let seen = bench.display.seen(0, PeriodNumber(2)).expect("remembered");
        let read = footprints(&config, &orientation);
        let expected: BTreeSet<u16> =
            read.iter().flat_map(|footprint| footprint.texels).flatten().map(|texel| piece(256, texel)).collect();
        let asked = (0..).zip(&sources).filter(|(_, source)| source.is_asked.load(Ordering::Relaxed));
        assert_eq!(asked.map(|(region, _)| region).collect::<BTreeSet<u16>>(), expected, "case {case}");
        counts.insert(expected.len());
        let faces: FaceSet = bench.arp().memories(Eye::Left)[0].shown_faces();
        let table = config.table().expect("valid");
        let mut pixels = vec![0; seen.pixels().len()];
        Lookup::new(&config, &table, vec![&faces], None).run(0, &orientation.words(timing.matrix_bits), &mut pixels);
        let found: Vec<u32> =
            seen.pixels().map(|pixel| u32::from_be_bytes([0, pixel[0], pixel[1], pixel[2]])).collect();
        assert!(found == pixels, "case {case}");
        let stats = bench.arp().lookup_stats(Eye::Left, PeriodNumber(2)).expect("remembered");
        let lines = read.chunks(30).step_by(2).flatten();
        let [split, conflicts] = lines.fold([0, 0], |[split, conflicts], footprint| {
            [split + u64::from(footprint.is_split), conflicts + u64::from(footprint.has_conflict())]
        });
        assert_eq!([stats.split, stats.conflicts], [split, conflicts], "case {case}");
    }
    assert!(counts.len() > 2, "{counts:?} regions");
}

/// Checks views of a small area near a border between regions or across the border. Texels 127 and 128 lie in different
/// regions.
#[test]
fn a_region_is_computed_only_if_a_pixel_reads_one_of_its_texels() {
    let timing = ArpTiming { display_memories: 1, ..ArpTiming::PAPERS };
    let scan = ScanTiming { visible_pixels: 8, visible_lines: 2, ..ScanTiming::PAPERS };
    // Positions of texels on the front face, which has 254 texels between its edges and one guard texel on each side.
    let beside = |place: f64| (place - 0.5) / 127.0 - 1.0;
    for (column, row, pieces) in [
        (127.5, 60.5, vec![(0, 0), (1, 0)]),
        (60.5, 127.5, vec![(0, 0), (0, 1)]),
        (127.5, 127.5, vec![(0, 0), (1, 0), (0, 1), (1, 1)]),
        (126.5, 128.5, vec![(0, 1)]),
        (128.5, 126.5, vec![(1, 0)]),
    ] {
        let vector = [beside(column), -beside(row), -1.0];
        let config = ArpConfig { timing, scan, lens: Lens::Table([vector; 32].into()), ..CONFIG };
        let (mut bench, sources) = filled(&config, 32, 1);
        (1..4).for_each(|field| bench.tick(field));
        bench.display.seen(0, PeriodNumber(2)).expect("remembered");
        let asked = (0..).zip(&sources).filter(|(_, source)| source.is_asked.load(Ordering::Relaxed));
        let asked: BTreeSet<u16> = asked.map(|(region, _)| region).collect();
        let piece = |(column, row)| face_region(256, CubeFace::NegZ, column, row).expect("on the face").0;
        assert_eq!(asked, pieces.into_iter().map(piece).collect(), "{column}, {row}");
    }
}

/// Checks a line with two orientations. The display reads the orientation for each pixel, and a matrix arrives in the
/// middle of the line. Pixels before its arrival use the previous matrix.
#[test]
fn pixels_before_the_arrival_of_an_orientation_in_a_line_use_the_previous_orientation() {
    let timing = ArpTiming { display_memories: 1, ..ArpTiming::PAPERS };
    let scan = ScanTiming { visible_pixels: 30, visible_lines: 10, ..ScanTiming::PAPERS };
    let config = ArpConfig { timing, scan, latch: Latch::Pixel, ..CONFIG };
    let (x, y) = (11, 8);
    let latched = config.scan().expect("valid").latches(Latch::Pixel, x, y, PeriodNumber(2)).expect("an even line");
    let later = turned(DQuat::from_rotation_y(0.4));
    let (mut bench, _) = filled(&config, 32, 2);
    (1..3).for_each(|field| bench.tick(field));
    bench.arp_mut().load_orientation(Eye::Left, later.rows(), latched).expect("a rotation");
    bench.tick(3);
    let seen = bench.display.seen(0, PeriodNumber(2)).expect("remembered");
    let faces: FaceSet = bench.arp().memories(Eye::Left)[0].shown_faces();
    let table = config.table().expect("valid");
    let pictures = [Orientation::IDENTITY, later].map(|orientation| {
        let mut pixels = vec![0; seen.pixels().len()];
        Lookup::new(&config, &table, vec![&faces], None).run(0, &orientation.words(16), &mut pixels);
        pixels
    });
    for (at, pixel) in (0..).zip(seen.pixels()) {
        // The beam drew the odd lines in the previous field, with the previous matrix.
        let is_later = at / 30 % 2 == 0 && (at / 30, at % 30) >= (y, x);
        let expected = pictures[usize::from(is_later)][at as usize];
        assert_eq!(u32::from_be_bytes([0, pixel[0], pixel[1], pixel[2]]), expected, "{}, {}", at % 30, at / 30);
    }
    assert_ne!(pictures[0], pictures[1]);
}

#[test]
fn a_recorded_field_has_the_matrix_of_each_pixel() {
    let mut bench = Bench::new(&CONFIG);
    let orientation = turned(DQuat::from_rotation_x(0.3));
    let after = Time(bench.display.tick(PeriodNumber(1)).0 + 1);
    bench.arp_mut().load_orientation(Eye::Left, orientation.rows(), after).expect("a rotation");
    (1..4).for_each(|field| bench.tick(field));
    let latched = |y, field| bench.arp().latched(Eye::Left, 17, y, PeriodNumber(field));
    assert_eq!(latched(40, 2), Some(orientation.words(16)));
    assert_eq!(latched(41, 1), Some(orientation.words(16)));
    assert_eq!(latched(41, 2), None, "an odd line in an even field");
    assert_eq!(latched(40, 4), None, "it has not been");
    assert_eq!(bench.arp().latched(Eye::Right, 17, 40, PeriodNumber(2)), None, "there is one eye");
    assert_eq!(bench.arp().lookup_stats(Eye::Left, PeriodNumber(4)), None);
}

/// Checks the size of a memory: two buffers of six faces. The background memory stores only colours.
#[test]
fn a_memory_has_bits_of_colour_and_depth_for_each_texel_of_two_buffers() {
    for (colour_bits, depth_bits) in [(24, 24), (16, 16), (16, 24)] {
        let timing = ArpTiming { colour_bits, depth_bits, ..CONFIG.timing };
        let bench = Bench::new(&ArpConfig { timing, has_background_memory: true, ..CONFIG });
        let bytes: Vec<u64> = bench.arp().memories(Eye::Left).iter().map(|memory| memory.bytes()).collect();
        let texels = 12 * 128 * 128;
        let [with, without] = [texels * (colour_bits + depth_bits) / 8, texels * colour_bits / 8];
        assert_eq!(bytes, [with, with, without]);
    }
}

#[test]
fn clock_and_scan_follow_from_the_parameters() {
    let bench = Bench::new(&CONFIG);
    let scan = CONFIG.scan().expect("valid");
    for n in [0, 1, 2, 59, 60, 1_001] {
        let period = PeriodNumber(n);
        let tick = bench.display.tick(period);
        assert_eq!(tick, scan.retrace(period));
        let next = bench.display.tick(period.next());
        for inside in [tick, tick + Span(1), Time(next.0 - 1)] {
            assert_eq!(bench.display.period_at(inside), period);
        }
        assert_eq!(bench.display.rows_lit(period), (n as u32 % 2, 2));
        for (x, y) in [(0, 0), (0, 1), (639, 478), (639, 479), (640, 0)] {
            assert_eq!(bench.display.lights(0, x, y, period), scan.when(x, y, period), "{n}: {x}, {y}");
        }
    }
    assert!(bench.display.lights(0, 0, 0, PeriodNumber(0)).is_some());
}

#[test]
fn a_configuration_is_identified_by_name_and_by_all_its_values() {
    let config: Box<dyn DisplayConfig> = CONFIG.boxed();
    assert_eq!((config.name(), Bench::new(&CONFIG).display.name()), ("arp", "arp"));
    assert!(config.about().starts_with("address recalculation pipeline"));
    let names = |tables: Vec<(&'static str, &dyn pxpl5_sim::parameters::ParameterTable)>| -> Vec<&str> {
        tables.into_iter().map(|(name, _)| name).collect()
    };
    assert_eq!(names(config.tables()), ["arp", "arp_scan"]);
    let mut other = CONFIG;
    let tables: Vec<&str> = other.tables_mut().into_iter().map(|(name, _)| name).collect();
    assert_eq!(tables, ["arp", "arp_scan"]);
    assert!(config.coverage() == Coverage::Surroundings && config.equals(&CONFIG));
    other.remember(7);
    assert_eq!(other.fields_kept, 7);
    assert!(!config.equals(&other));
    other.set_background(0xFF_12_34_56);
    assert_eq!(other.background, 0x12_34_56);
    assert!(DisplayConfig::check(&other).is_ok());
    other.remember(0);
    let error = DisplayConfig::check(&other).expect_err("no field is kept").to_string();
    assert!(error.contains("fields_kept"), "{error}");
}
