//! Tests of the touched regions. The tests compare the regions with an exhaustive search and with an independent exact
//! test.

use crate::support::{at_pixel, pixel_view};
use glam::Vec3;
use proptest::prelude::*;
use pxpl5_geometry::{Culling, Light, Outline, RegionMask, SetupStats, Transform, Triangle, Viewport};
use pxpl5_wire::{FieldParity, Lines, RegionGrid, RegionId};

fn viewports() -> [Viewport; 4] {
    let small = RegionGrid { width: 200, height: 100, region_width: 40, region_height: 16 };
    [
        Viewport::FRAME,
        Viewport::field(FieldParity::Even),
        Viewport::field(FieldParity::Odd),
        Viewport::new(small, Lines::Frame).expect("a small picture"),
    ]
}

fn screen(viewport: Viewport, points: [[i32; 2]; 3]) -> (Option<Outline>, SetupStats) {
    // The positions are in 1/16 px of a frame of 640 x 480, scaled for smaller pictures.
    let [sx, sy] = [viewport.grid().width as f32 / 640.0, viewport.frame_lines() as f32 / 480.0];
    let positions = points.map(|[x, y]| at_pixel(x as f32 / 16.0 / sx, y as f32 / 16.0 / sy, 1.0));
    let transform = Transform::new(&pixel_view(1.0, 16_384.0), viewport, Culling::None).expect("a finite view");
    let triangle = Triangle { positions, normals: [Vec3::Z; 3], colours: [[0; 3]; 3] };
    let mut found = Vec::new();
    let mut stats = SetupStats::default();
    transform.gouraud(&triangle, &Light::NONE, &mut stats, |t| found.push(t.outline));
    let mut masks = Vec::new();
    transform.bin(&triangle.positions, &mut SetupStats::default(), |m| masks.push(m));
    assert_eq!(masks, found.iter().map(|o| o.regions).collect::<Vec<_>>());
    assert!(found.len() <= 1);
    (found.first().copied(), stats)
}

fn line(viewport: &Viewport, row: u32) -> i32 {
    (row * viewport.line_step() + viewport.first_line()) as i32
}

fn edge(o: &Outline, i: usize, [x, y]: [i64; 2]) -> i64 {
    let p = i;
    let q = (i + 1) % 3;
    let [px, py, qx, qy] = [o.x[p], o.y[p], o.x[q], o.y[q]].map(i64::from);
    let dx = qx - px;
    let dy = qy - py;
    let tie = i64::from(!(dy < 0 || (dy == 0 && dx > 0)));
    dx * (y - py) - dy * (x - px) - tie
}

fn covered(o: &Outline, x: i32, y: i32) -> bool {
    let centre = [16 * i64::from(x) + 8, 16 * i64::from(y) + 8];
    (0..3).all(|i| edge(o, i, centre) >= 0)
}

/// Returns true if a region contains a covered pixel.
fn holds_a_pixel(viewport: &Viewport, o: &Outline, region: RegionId) -> bool {
    let [left, top, width, height] = viewport.grid().rectangle(region);
    let rows = top..top + height;
    rows.clone().any(|row| (left..left + width).any(|x| covered(o, x as i32, line(viewport, row))))
}

/// Returns true if the closed triangle meets the closed box of a region's pixel centres, computed exactly in 1/16 px.
///
/// Triangle and box meet if a corner of one is inside the other, or if an edge of the triangle crosses a side of the
/// box.
fn meets(viewport: &Viewport, o: &Outline, region: RegionId) -> bool {
    let [left, top, width, height] = viewport.grid().rectangle(region);
    let x = [left, left + width - 1].map(|v| 16 * i64::from(v) + 8);
    let y = [top, top + height - 1].map(|v| 16 * i64::from(line(viewport, v)) + 8);
    let corners = [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
    let points: [[i64; 2]; 3] = std::array::from_fn(|i| [o.x[i].into(), o.y[i].into()]);
    let sides = [0, 1, 2].map(|i| [points[i], points[(i + 1) % 3]]);
    points.iter().any(|[px, py]| (x[0]..=x[1]).contains(px) && (y[0]..=y[1]).contains(py))
        || corners.iter().any(|&corner| sides.iter().all(|&[from, to]| twice_area(from, to, corner) >= 0))
        || sides.iter().any(|side| (0..4).any(|k| cross(*side, [corners[k], corners[(k + 1) % 4]])))
}

/// Returns true if two lines cross or touch.
fn cross(one: [[i64; 2]; 2], other: [[i64; 2]; 2]) -> bool {
    !on_one_side(one, other) && !on_one_side(other, one)
}

/// Returns true if both ends are strictly on the same side of the line through two points.
fn on_one_side([from, to]: [[i64; 2]; 2], ends: [[i64; 2]; 2]) -> bool {
    let [first, last] = ends.map(|end| twice_area(from, to, end).signum());
    first * last > 0
}

fn twice_area(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn point() -> impl Strategy<Value = [i32; 2]> {
    let anywhere = [-600..10_840_i32, -600..8_280_i32];
    let border = (0..6_i32, 0..5_i32, -12..12_i32, -12..12_i32)
        .prop_map(|(column, row, dx, dy)| [column * 2048 + dx, row * 1920 + dy]);
    prop_oneof![anywhere, border]
}

fn triangle() -> impl Strategy<Value = [[i32; 2]; 3]> {
    let shrunk = ([point(), point(), point()], 1..200_i32)
        .prop_map(|([a, b, c], s)| [a, b, c].map(|p| [a[0] + (p[0] - a[0]) / s, a[1] + (p[1] - a[1]) / s]));
    prop_oneof![shrunk, [point(), point(), point()]]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_region_with_a_covered_pixel_is_touched_and_every_touched_region_meets_the_triangle(
        points in triangle(),
    ) {
        for viewport in viewports() {
            let (outline, stats) = screen(viewport, points);
            // A triangle without regions has no outline here, so use the outline from the whole picture.
            let Some(outline) = outline else {
                prop_assert_eq!(stats.untouched + stats.degenerate + stats.outside, 1);
                continue;
            };
            for n in 0..viewport.grid().regions() {
                let region = RegionId(n as u16);
                let touched = outline.regions.contains(region);
                if touched {
                    prop_assert!(meets(&viewport, &outline, region), "{outline:?} does not meet {n}");
                } else {
                    prop_assert!(!holds_a_pixel(&viewport, &outline, region), "{outline:?} has pixels in {n}");
                }
            }
        }
    }

    #[test]
    fn a_triangle_that_touches_no_region_covers_no_pixel(points in triangle()) {
        let viewport = Viewport::FRAME;
        let (outline, stats) = screen(viewport, points);
        if outline.is_none() && stats.untouched == 1 {
            let [x, y] = [0, 1].map(|i| points.map(|p| p[i]));
            let mut all = Outline { x, y, z: [0; 3], regions: RegionMask::EMPTY };
            if edge(&all, 0, [x[2].into(), y[2].into()]) < 0 {
                all.x = [x[0], x[2], x[1]];
                all.y = [y[0], y[2], y[1]];
            }
            for n in 0..20 {
                prop_assert!(!holds_a_pixel(&viewport, &all, RegionId(n)));
            }
        }
    }
}

/// Region 6 has pixel centres from 128.5 to 255.5 px. The bounding box of the second triangle contains only the centre at
/// (128.5, 128.5), which its hypotenuse passes on the outside; that of the third triangle passes it on the inside.
#[test]
fn triangles_touch_the_regions_of_the_pixel_centres_that_their_edges_enclose() {
    let sixth = RegionMask::only(RegionId(6));
    let all = (0..20).map(|n| RegionMask::only(RegionId(n))).fold(RegionMask::EMPTY, RegionMask::union);
    for (points, regions) in [
        ([[2080, 2080], [2240, 2080], [2080, 2240]], Some(sixth)),
        ([[2049, 2067], [2067, 2049], [2050, 2050]], Some(sixth)),
        ([[2049, 2057], [2057, 2049], [2050, 2050]], None),
        // A triangle between pixel centres, and one that covers the screen.
        ([[2057, 2057], [2070, 2058], [2060, 2069]], None),
        ([[-16_000, -160], [26_000, -160], [5_000, 30_000]], Some(all)),
    ] {
        let (outline, stats) = screen(Viewport::FRAME, points);
        assert_eq!(outline.map(|outline| outline.regions), regions, "{points:?}");
        assert_eq!(stats.untouched, u64::from(regions.is_none()), "{points:?}");
    }
}

#[test]
fn a_diagonal_triangle_skips_corner_regions_of_its_bounding_box() {
    let (outline, _) = screen(Viewport::FRAME, [[8, 8], [24, 8], [10_000, 7_600]]);
    let regions = outline.expect("it is on the screen").regions;
    assert!(regions.contains(RegionId(0)) && regions.contains(RegionId(19)));
    assert!(!regions.contains(RegionId(4)) && !regions.contains(RegionId(15)));
}
