//! Tests of the set-up against exact integers: edges, planes and ranges.

use crate::support::native::Piece;
use proptest::prelude::*;
use pxpl5_geometry::{
    DEPTH_FAR, DEPTH_NEAR, GouraudTriangle, NORMAL_UNIT, Outline, RegionMask, ScreenTriangle, SetupStats,
    SurfaceNormals, VertexColours, Viewport,
};
use pxpl5_wire::{FieldParity, Linear, format};

const GUARD: i32 = pxpl5_geometry::GUARD_PIXELS * 16;

/// Returns a clockwise triangle that touches every region according to its mask, so that the tests check all pixels.
fn screen(x: [i32; 3], y: [i32; 3], z: [u32; 3], colours: [[u16; 3]; 3]) -> Option<Piece> {
    let regions = (0..20).map(|n| RegionMask::only(pxpl5_wire::RegionId(n)));
    let mut outline = Outline { x, y, z, regions: regions.fold(RegionMask::EMPTY, RegionMask::union) };
    let twice_area = i64::from(x[1] - x[0]) * i64::from(y[2] - y[0]) - i64::from(y[1] - y[0]) * i64::from(x[2] - x[0]);
    if twice_area < 0 {
        outline.x = [x[0], x[2], x[1]];
        outline.y = [y[0], y[2], y[1]];
    }
    let surface = VertexColours(colours);
    let screen = ScreenTriangle { outline, surface };
    (twice_area != 0).then(|| Piece::new(screen, &mut SetupStats::default()))
}

/// Returns coordinates near the screen, in the whole guard band, or on pixel centres.
fn coordinate(size: i32) -> impl Strategy<Value = i32> {
    prop_oneof![
        4 => -160..(size + 10) * 16,
        1 => -GUARD..=GUARD,
        2 => (-2..size + 2).prop_map(|p| p * 16 + 8),
        1 => (0..6).prop_map(|p| p * 2048),
    ]
}

fn corners() -> impl Strategy<Value = ([i32; 3], [i32; 3])> {
    let flat = ([pixel_centre(640), pixel_centre(640), pixel_centre(640)], pixel_centre(480), coordinate(480))
        .prop_map(|(x, y, other)| (x, [y, other, y]));
    // Small and thin triangles around the first corner.
    let near = (coordinates(640), coordinates(480), 1..40_i32).prop_map(|(x, y, s)| (pulled(x, s), pulled(y, s)));
    prop_oneof![2 => (coordinates(640), coordinates(480)), 2 => near, 1 => flat]
}

fn coordinates(size: i32) -> [impl Strategy<Value = i32>; 3] {
    [coordinate(size), coordinate(size), coordinate(size)]
}

fn pixel_centre(size: i32) -> impl Strategy<Value = i32> {
    (0..size).prop_map(|p| p * 16 + 8)
}

/// Reduces the distances of the second and the third number from the first by the factor `s`.
fn pulled(v: [i32; 3], s: i32) -> [i32; 3] {
    v.map(|c| v[0] + (c - v[0]) / s)
}

fn depths() -> impl Strategy<Value = [u32; 3]> {
    [depth(), depth(), depth()]
}

fn depth() -> impl Strategy<Value = u32> {
    prop_oneof![Just(DEPTH_NEAR), Just(DEPTH_FAR), DEPTH_NEAR..=DEPTH_FAR]
}

fn colours() -> impl Strategy<Value = [[u16; 3]; 3]> {
    [colour(), colour(), colour()]
}

fn colour() -> [impl Strategy<Value = u16>; 3] {
    [component(), component(), component()]
}

fn component() -> impl Strategy<Value = u16> {
    prop_oneof![Just(0_u16), Just(255 * 256), 0..=255_u16 * 256]
}

/// Returns true if a pixel is inside the triangle. The function applies the definition of edges and the tie rule in
/// 1/256 square px, with 128 bits.
fn inside(outline: &Outline, x: i32, y: i32) -> bool {
    let centre = [16 * i128::from(x) + 8, 16 * i128::from(y) + 8];
    let corners = [0, 1, 2].map(|i| [i128::from(outline.x[i]), i128::from(outline.y[i])]);
    (0..3).all(|i| {
        let from = corners[i];
        let to = corners[(i + 1) % 3];
        let dx = to[0] - from[0];
        let dy = to[1] - from[1];
        let area = dx * (centre[1] - from[1]) - dy * (centre[0] - from[0]);
        area > 0 || (area == 0 && (dy < 0 || (dy == 0 && dx > 0)))
    })
}

/// Returns the limit of the error that the set-up documents: `(|dx| + |dy|) / 2 + 1`, rounded up. The distances are
/// measured from the middle of the visible bounding box.
///
/// One more pixel in each direction accounts for the rounding of the middle itself.
fn allowed_error(piece: &Piece, x: i32, y: i32) -> i128 {
    let outline = &piece.screen.outline;
    let from_middle = (visible_middle(&outline.x, 640) - x).abs() + (visible_middle(&outline.y, 480) - y).abs();
    i128::from(from_middle / 2 + 2)
}

/// Returns the pixel in the middle of the visible bounding box, along one axis of a picture.
fn visible_middle(corners: &[i32; 3], size: i32) -> i32 {
    let clamped = corners.map(|c| c.clamp(0, size * 16 - 1));
    let ends = clamped.iter().min().zip(clamped.iter().max());
    ends.map_or(0, |(low, high)| (low + high) / 32)
}

fn edges_and_colours(triangle: &GouraudTriangle) -> [Linear; 6] {
    let [e0, e1, e2] = triangle.edges;
    let [r, g, b] = triangle.rgb;
    [e0, e1, e2, r, g, b]
}

fn value(e: &Linear, x: i32, y: i32) -> i128 {
    i128::from(e.a) * i128::from(x) + i128::from(e.b) * i128::from(y) + i128::from(e.c)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_pixel_is_inside_exactly_where_all_edges_are_not_negative((x, y) in corners()) {
        let Some(piece) = screen(x, y, [DEPTH_NEAR; 3], [[0; 3]; 3]) else { return Ok(()) };
        for py in (0..480).step_by(7) {
            for px in (0..640).step_by(5) {
                prop_assert_eq!(piece.inside_edges(px, py), inside(&piece.screen.outline, px, py));
            }
        }
        // Ties occur in the rows and columns of the corners.
        for corner in 0..9 {
            let px = x[corner % 3] >> 4;
            let py = y[corner / 3] >> 4;
            prop_assert_eq!(piece.inside_edges(px, py), inside(&piece.screen.outline, px, py));
        }
    }

    #[test]
    fn edges_never_leave_32_bits_within_the_largest_picture((x, y) in corners()) {
        let Some(piece) = screen(x, y, [DEPTH_NEAR; 3], [[0; 3]; 3]) else { return Ok(()) };
        for e in piece.planes.edges {
            for (px, py) in [(0, 0), (2047, 0), (0, 2047), (2047, 2047)] {
                let exact = value(&e, px, py);
                prop_assert_eq!(exact, i128::from(e.at(px, py)));
                prop_assert!(exact.abs() <= (1 << 30) + 1);
            }
        }
    }

    #[test]
    fn depth_is_within_its_stated_error_and_never_wraps(
        (x, y) in corners(), z in depths(),
    ) {
        let Some(piece) = screen(x, y, z, [[0; 3]; 3]) else { return Ok(()) };
        let mut stats = SetupStats::default();
        let _ = piece.screen.gouraud(&Viewport::FRAME, &mut stats);
        let mut failure = None;
        piece.pixels(|px, py| {
            let (sum, area) = piece.exact_plane(piece.depth_corners(), px, py);
            let found = i128::from(piece.planes.z.at(px, py) as u32);
            let allowed =
                if stats.flattened_planes > 0 { 1_i128 << 32 } else { allowed_error(&piece, px, py) };
            if (found * area - sum).abs() > allowed * area {
                failure = Some((px, py, found, sum / area));
            }
        });
        prop_assert_eq!(failure, None);
    }

    #[test]
    fn colours_are_rounded_to_the_nearest_and_never_wrap(
        (x, y) in corners(), colours in colours(),
    ) {
        let Some(piece) = screen(x, y, [DEPTH_NEAR; 3], colours) else { return Ok(()) };
        let mut stats = SetupStats::default();
        let _ = piece.screen.gouraud(&Viewport::FRAME, &mut stats);
        let mut failure = None;
        piece.pixels(|px, py| {
            for i in 0..3 {
                let (sum, area) = piece.exact_plane(piece.colour_corners(i), px, py);
                let found = i128::from(piece.colour(i, px, py)) * 256;
                // The limit is half a unit, and 282/4096 of a unit for the plane.
                let allowed = if stats.flattened_planes > 0 { 256 * 256 } else { 128 + 18 };
                if (found * area - sum).abs() > allowed * area {
                    failure = Some((px, py, i, found, sum / area));
                }
            }
        });
        prop_assert_eq!(failure, None);
    }

    #[test]
    fn interpolated_normals_have_an_error_of_at_most_one_unit(
        (x, y) in corners(),
        normals in prop::array::uniform3(prop::array::uniform3(-NORMAL_UNIT..=NORMAL_UNIT)),
    ) {
        let Some(piece) = screen(x, y, [DEPTH_NEAR; 3], [[0; 3]; 3]) else { return Ok(()) };
        let surface = SurfaceNormals { normals, colour: [9, 8, 7] };
        let screen = ScreenTriangle { outline: piece.screen.outline, surface };
        let mut stats = SetupStats::default();
        let planes = screen.phong(&Viewport::FRAME, &mut stats);
        prop_assume!(stats.flattened_planes == 0);
        let mut failure = None;
        piece.pixels(|px, py| {
            for (i, plane) in planes.normal.iter().enumerate() {
                let corners = normals.map(|n| i128::from(n[i]));
                let (sum, area) = piece.exact_plane(corners, px, py);
                let found = i128::from(plane.at(px, py) >> format::NORMAL_FRACTION_BITS);
                // One unit of a normal is 16 of the corners' units.
                if (found * 16 * area - sum).abs() > 16 * area {
                    failure = Some((px, py, i, found, sum / area));
                }
            }
        });
        prop_assert_eq!(failure, None);
        prop_assert_eq!(planes.colour, [9, 8, 7]);
        prop_assert_eq!(planes.edges, piece.planes.edges);
        prop_assert_eq!(planes.z, piece.planes.z);
    }

    #[test]
    fn rows_of_a_field_have_the_values_of_their_frame_lines(
        (x, y) in corners(), z in depths(), colours in colours(),
    ) {
        let Some(piece) = screen(x, y, z, colours) else { return Ok(()) };
        for parity in [FieldParity::Even, FieldParity::Odd] {
            let viewport = Viewport::field(parity);
            let field = piece.screen.gouraud(&viewport, &mut SetupStats::default());
            for (px, row) in [(0, 0), (639, 0), (17, 101), (0, 239), (639, 239)] {
                let line = 2 * row + parity.first_line() as i32;
                for (f, w) in edges_and_colours(&field).iter().zip(edges_and_colours(&piece.planes)) {
                    prop_assert_eq!(f.at(px, row), w.at(px, line));
                }
                prop_assert_eq!(field.z.at(px, row), piece.planes.z.at(px, line));
            }
        }
    }
}

#[test]
fn a_plane_too_steep_for_64_bits_is_flat_and_counted() {
    // Twice the area is 1/256 square px, and the depths cover the whole range. The slope is more than 2^32 * 2^12 per
    // pixel.
    let piece = screen([0, 8000, 7999], [8, 5008, 5007], [DEPTH_NEAR, DEPTH_NEAR, DEPTH_FAR], [[0; 3]; 3])
        .expect("it has an area");
    let mut stats = SetupStats::default();
    let planes = piece.screen.gouraud(&Viewport::FRAME, &mut stats);
    let mean = (2 * u64::from(DEPTH_NEAR) + u64::from(DEPTH_FAR)) as f64 / 3.0;
    assert_eq!((planes.z.a, planes.z.b), (0, 0));
    assert!((f64::from(planes.z.c as u32) - mean).abs() <= 0.5);
    assert_eq!(stats.flattened_planes, 1);
}

#[test]
fn a_wall_seen_edge_on_keeps_its_depth_though_its_slope_needs_more_than_32_bits() {
    // The wall is one pixel wide and extends from near to far, which gives a slope of 2^32 per pixel.
    let piece =
        screen([100 * 16, 101 * 16, 100 * 16], [0, 0, 480 * 16], [DEPTH_NEAR, DEPTH_FAR, DEPTH_NEAR], [[0; 3]; 3])
            .expect("it has an area");
    let slope = f64::from(DEPTH_FAR - DEPTH_NEAR);
    assert!(slope > 2_147_483_648.0);
    let mut seen = 0;
    piece.pixels(|x, y| {
        seen += 1;
        let exact = f64::from(DEPTH_NEAR) + slope * (f64::from(x) + 0.5 - 100.0);
        assert!((f64::from(piece.planes.z.at(x, y) as u32) - exact).abs() <= 282.0);
    });
    assert!(seen > 200);
}
