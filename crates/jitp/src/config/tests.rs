//! Tests of strips, of their numbers and of their times, against formulas for a beam of constant speed.

use super::*;

/// Duration of a field, in picoseconds.
const FIELD: u64 = 16_000_000;
const ROW: u64 = 60_000;
const PIXEL: u64 = 80;
const BLANK: u64 = 1_000_000;

fn at(field: u64, row: u64, x: u64) -> Time {
    Time(field * FIELD + BLANK + row * ROW + x * PIXEL)
}

fn config(schedule: DrawingSchedule, slaves: u16) -> JitpConfig {
    JitpConfig {
        host: NodeId(0),
        master: NodeId(1),
        slaves: (2..2 + slaves).map(NodeId).collect(),
        renderers: vec![NodeId(20), NodeId(21), NodeId(22)],
        frame_buffer: NodeId(30),
        schedule,
        beam: Beam::new(|field, row, x| at(field.0, row.into(), x.into()), |field| Time(field.0 * FIELD)),
        aim: Aim::Middle,
        layout: Layout::slats(),
        pixels: false,
        timing: JitpTiming { margin_ns: 1, ..JitpTiming::PAPERS },
    }
}

fn strips(strip_rows: u32) -> JitpConfig {
    config(DrawingSchedule::Beam { viewpoint: Viewpoint::Strip, racing: true, strip_rows }, 2)
}

fn blocks(block: u32) -> JitpConfig {
    config(DrawingSchedule::Roam { block, batch: 4, order: BlockOrder::new(|step| RegionId(step as u16 + 7)) }, 2)
}

#[test]
fn strips_and_blocks_outside_the_limits_are_refused() {
    let refusal = |config: JitpConfig| config.check().expect_err("refused").to_string();
    for rows in [1, 128] {
        assert_eq!(strips(rows).check(), Ok(()));
    }
    for rows in [0, 129] {
        assert_eq!(refusal(strips(rows)), format!("strips or blocks must have 1 to 128 lines, found {rows}"));
    }
    for block in [4, 128] {
        assert_eq!(blocks(block).check(), Ok(()));
    }
    for block in [3, 129] {
        assert_eq!(refusal(blocks(block)), format!("strips or blocks must have 4 to 128 lines, found {block}"));
    }
    let no_slave = JitpConfig { slaves: Vec::new(), ..strips(64) };
    assert_eq!(refusal(no_slave), "just-in-time pixels need a master and at least one slave GP, found no slave");
}

#[test]
fn strip_numbers_are_unique_over_all_fields() {
    let numbers =
        (0..3).flat_map(|field| (0..240).map(move |strip| JitpConfig::view_number(PeriodNumber(field), strip)));
    let numbers: Vec<ViewNumber> = numbers.collect();
    assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]), "later strips and fields have greater numbers");
}

#[test]
fn a_field_is_cut_into_strips_and_a_frame_into_squares() {
    let grid = strips(100).grid();
    assert_eq!([grid.width, grid.height, grid.region_height, grid.rows()], [640, 240, 100, 3]);
    assert_eq!(grid.region_width, RegionGrid::FIELD.region_width);
    let grid = blocks(16).grid();
    assert_eq!([grid.width, grid.height, grid.region_width, grid.region_height], [640, 480, 16, 16]);
}

#[test]
fn strips_cover_each_row_and_region_once() {
    for strip_rows in [1, 7, 64, 100, 128] {
        let config = strips(strip_rows);
        let n = 240_u32.div_ceil(strip_rows);
        let rows: Vec<u32> = (0..n).map(|strip| config.rows(strip)).flat_map(|(first, last)| first..=last).collect();
        assert_eq!(rows, (0..240).collect::<Vec<_>>(), "{strip_rows}");
        let regions: Vec<u16> = (0..n).flat_map(|strip| config.strip_regions(strip)).map(|region| region.0).collect();
        assert_eq!(regions, (0..5 * n as u16).collect::<Vec<_>>(), "640 pixels are five regions, {strip_rows}");
        let middles: Vec<u32> = (0..n).filter(|strip| config.is_middle(*strip)).collect();
        assert_eq!(middles, [n / 2], "{strip_rows}");
    }
}

#[test]
fn renderers_take_regions_in_turn_and_send_them_to_one_frame_buffer() {
    let config = strips(64);
    let nodes = [0, 1, 2, 3, 7].map(|region| config.renderer_of(RegionId(region)).0);
    assert_eq!(nodes, [20, 21, 22, 20, 21]);
    for field in [6, 7] {
        let picture = PictureNumber::drawn_for(PeriodNumber(field));
        let target = config.target(picture, RegionId(9));
        let parity = FieldParity::of_field(PeriodNumber(field));
        assert_eq!(target.lines, Lines::Field(parity));
        assert_eq!(config.extent(picture).0, Viewport::field(parity));
        assert_eq!((target.frame_buffer, target.region, target.picture), (NodeId(30), RegionId(9), picture));
    }
    let (viewport, lines) = blocks(16).extent(PictureNumber(3));
    assert_eq!((viewport, lines), (Viewport::FRAME, Lines::Frame));
}

#[test]
fn blocks_are_drawn_in_the_chosen_order() {
    let DrawingSchedule::Roam { order, .. } = blocks(16).schedule else { panic!("blocks") };
    assert_eq!([order.at(0), order.at(5)], [RegionId(7), RegionId(12)]);
}

#[test]
fn strips_and_fields_have_the_times_of_their_first_pixels() {
    let config = strips(100);
    let field = PeriodNumber(3);
    // Strip 1 has rows 100 to 199. Strip 2 has the remaining rows up to row 239.
    assert_eq!(config.deadline(field, 1), at(3, 100, 0));
    assert_eq!(config.ends(field), (at(3, 0, 0), at(3, 239, 639)));
    let middle = |first: Time, last: Time| Time((first.0 + last.0) / 2);
    assert_eq!(config.aimed_at_strip(field, 1), middle(at(3, 100, 0), at(3, 199, 639)));
    assert_eq!(config.aimed_at_strip(field, 2), middle(at(3, 200, 0), at(3, 239, 639)));
    assert_eq!(config.aimed_at_field(field), middle(at(3, 0, 0), at(3, 239, 639)));
    assert_eq!(config.scanned(field, 1), at(3, 199, 639));
    assert_eq!(config.scanned(field, 2), at(3, 239, 639));
    assert_eq!(config.field_time(), Span(FIELD));
    let at_retrace = JitpConfig { aim: Aim::Retrace, ..config.clone() };
    assert_eq!(at_retrace.aimed_at_strip(field, 1), Time(3 * FIELD));
    let whole = (239 * ROW + 639 * PIXEL) as f64;
    let parts = [config.part(field, 1), at_retrace.part(field, 1)];
    let expected = [(150 * ROW - ROW / 2 + 639 * PIXEL / 2) as f64 / whole, -(BLANK as f64) / whole];
    for (part, expected) in parts.into_iter().zip(expected) {
        assert!((part - expected).abs() < 1e-12, "{part} {expected}");
    }
}

#[test]
fn the_lead_of_strip_orders_grows_with_the_slaves_and_never_reaches_lines_still_to_be_scanned() {
    let margin = 1_000;
    let lead = |slaves: u16, strip_rows: u32, racing: bool| {
        config(DrawingSchedule::Beam { viewpoint: Viewpoint::Strip, racing, strip_rows }, slaves).lead(racing)
    };
    // 1 ns is 1,000 ps.
    assert_eq!(lead(1, 10, true), Span(10 * ROW + margin));
    assert_eq!(lead(3, 10, true), Span(30 * ROW + margin));
    assert_eq!(lead(3, 10, false), Span(30 * ROW + margin + FIELD));
    // The lines of strip 0 are free after the beam has scanned its last pixel, two fields before the next field of the
    // same parity.
    let scanned = |strip_rows: u64| (strip_rows - 1) * ROW + 639 * PIXEL;
    assert_eq!(lead(9, 128, false), Span(2 * FIELD - scanned(128)));
    assert_eq!(lead(9, 64, true), Span(9 * 64 * ROW + margin).min(Span(2 * FIELD - scanned(64))));
}
