//! Tests of hard cases. The errors must be within the limits of docs/numerics.md, and this file must be up to date:
//! `PXPL5_UPDATE_NUMERICS=1 cargo test -p pxpl5-geometry --test main numerics` writes it.

use crate::support::cases::Case;
use crate::support::measure::Row;
use crate::support::report::{self, Measured};
use std::path::Path;
use std::sync::OnceLock;

/// Returns the measurements of all cases, which are made once for all tests.
fn measured() -> &'static Measured {
    static MEASURED: OnceLock<Measured> = OnceLock::new();
    MEASURED.get_or_init(Measured::all)
}

fn rows() -> &'static [(Case, Row)] {
    &measured().triangles
}

fn row(name: &str) -> &'static Row {
    let found = rows().iter().find(|(case, _)| case.name == name);
    &found.unwrap_or_else(|| panic!("no case named {name}")).1
}

#[test]
fn the_numerics_document_is_fresh() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/numerics.md");
    let expected = report::text(measured());
    let page = std::fs::read_to_string(&path).expect("docs/numerics.md exists");
    // The chapter "Time" at the end comes from the published figures, and their tests keep it fresh.
    let (mut found, time) = page.split_at(page.find("<!-- time").unwrap_or(page.len()));
    if std::env::var_os("PXPL5_UPDATE_NUMERICS").is_some() {
        std::fs::write(&path, format!("{expected}{time}")).expect("docs can be written");
        found = &expected;
    }
    for (n, (found, expected)) in found.lines().zip(expected.lines()).enumerate() {
        assert_eq!(found, expected, "line {}: stale, PXPL5_UPDATE_NUMERICS=1 writes it again", n + 1);
    }
    assert_eq!(found.lines().count(), expected.lines().count());
}

#[test]
fn tilings_cover_each_pixel_exactly_once() {
    let tilings = rows().iter().filter(|(case, _)| case.tiling);
    assert_eq!(tilings.clone().count(), 3);
    for (case, row) in tilings {
        assert_eq!((row.holes, row.overlaps), (Some(0), Some(0)), "{}", case.name);
    }
}

/// Snaps exact corners to the same grid for comparison. A few more pixels can differ, because the program of Slats limits
/// edges and does not subtract the position of the eye.
#[test]
fn the_program_of_slats_has_tilings_without_holes_and_right_edges_up_to_4_guard_bands() {
    let tilings: Vec<_> = measured().single.iter().filter(|(case, _)| case.tiling).collect();
    assert_eq!(tilings.len(), 6);
    for (case, row) in tilings {
        assert_eq!((row.holes, row.overlaps), (Some(0), Some(0)), "{}", case.name);
        assert_eq!(row.stats.clipped, 0, "{}", case.name);
        assert!(row.wrong <= row.grids[2] + row.grids[2] / 10 + 10, "{}: {} {}", case.name, row.wrong, row.grids[2]);
    }
}

#[test]
fn triangles_with_corners_on_pixel_centres_or_region_borders_have_no_wrong_pixel() {
    for name in ["corners on pixel centres", "corners on region borders"] {
        assert_eq!(row(name).wrong, 0, "{name}");
    }
}

#[test]
fn a_model_at_10_to_the_6_units_from_the_origin_has_only_the_errors_of_the_snapping_grid() {
    // The limit includes the error of the grid itself, and a few pixels for 32-bit vertices.
    let far = row("10^6 from the origin");
    assert!(far.wrong <= far.grids[2] + 10, "{} {}", far.wrong, far.grids[2]);
}

#[test]
fn depth_planes_have_errors_below_1_61_units_and_colour_planes_below_0_57_units() {
    for (case, row) in rows().iter().filter(|(_, row)| row.stats.flattened_planes == 0) {
        // Half a unit is the rounding of the pixel. The set-up contributes 282/256 and 282/4096.
        assert!(row.depth_plane <= 0.5 + 282.0 / 256.0, "{} {}", case.name, row.depth_plane);
        assert!(row.colour_plane <= 0.5 + 282.0 / 4096.0, "{} {}", case.name, row.colour_plane);
    }
}

#[test]
fn planes_are_flattened_only_where_a_triangle_is_thinner_than_a_subpixel_and_then_counted() {
    for (case, row) in rows() {
        let flattened = if case.name == "half a subpixel thick, near to far" { 20 } else { 0 };
        assert_eq!(row.stats.flattened_planes, flattened, "{}", case.name);
    }
}

#[test]
fn every_sphere_that_is_drawn_is_exact_to_the_pixel() {
    for (case, row) in &measured().spheres {
        assert_eq!(row.wrong, 0, "{}", case.name);
    }
}

#[test]
fn parallel_surfaces_more_than_three_depth_units_apart_never_exchange_their_order() {
    for fight in measured().fights.iter().filter(|f| f.name.starts_with("parallel") && f.apart > 3.0) {
        assert_eq!(fight.wrong, 0, "{}", fight.name);
    }
}
