//! Tests of shared edges. No pixel may be missing or drawn twice, even if clipping cuts the edges.

use crate::support::native::Piece;
use crate::support::{HEIGHT, WIDTH, at_pixel, pixel_view};
use glam::{Mat4, Vec3};
use proptest::prelude::*;
use pxpl5_geometry::{Culling, SetupStats, Transform, Triangle, ViewTransform, Viewport};

/// Counts how often each pixel is drawn.
fn draw(view: &ViewTransform, triangles: &[[Vec3; 3]]) -> (Vec<u8>, SetupStats) {
    draw_by(&Transform::new(view, Viewport::FRAME, Culling::None).expect("a finite view"), triangles)
}

/// The same by the program of Slats.
fn draw_singly(view: &ViewTransform, triangles: &[[Vec3; 3]]) -> (Vec<u8>, SetupStats) {
    draw_by(&Transform::in_single_precision(view, Viewport::FRAME, Culling::None).expect("a finite view"), triangles)
}

fn draw_by(transform: &Transform, triangles: &[[Vec3; 3]]) -> (Vec<u8>, SetupStats) {
    let mut counts = vec![0_u8; (WIDTH * HEIGHT) as usize];
    let mut stats = SetupStats::default();
    for positions in triangles {
        let triangle = Triangle { positions: *positions, normals: [Vec3::Z; 3], colours: [[0; 3]; 3] };
        for piece in Piece::of(transform, &triangle, &mut stats) {
            piece.pixels(|x, y| counts[(y * WIDTH + x) as usize] += 1);
        }
    }
    (counts, stats)
}

fn count(counts: &[u8], x: i32, y: i32) -> u8 {
    counts[(y * WIDTH + x) as usize]
}

/// Returns a fan of triangles between `hub` and the points of `rim`. Every second triangle has the other winding.
fn fan(hub: Vec3, rim: &[Vec3]) -> Vec<[Vec3; 3]> {
    let sectors = (0..rim.len()).map(|n| {
        let next = rim[(n + 1) % rim.len()];
        if n.is_multiple_of(2) { [hub, rim[n], next] } else { [next, rim[n], hub] }
    });
    sectors.collect()
}

fn on_screen() -> impl Strategy<Value = [i32; 2]> {
    // The coordinates are multiples of half a pixel, so that edges often pass through pixel centres.
    [40..1240, 40..920]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_fan_around_any_corner_covers_the_screen_exactly_once(
        hub in on_screen(), steps in prop::collection::vec(0..64_i32, 4..12),
    ) {
        let hub = at_pixel(hub[0] as f32 * 0.5, hub[1] as f32 * 0.5, 1.0);
        // The rim follows a frame 10 px outside the screen.
        let corners = [[-10, -10], [650, -10], [650, 490], [-10, 490]];
        let mut rim = Vec::new();
        for (side, from) in corners.iter().enumerate() {
            let to = corners[(side + 1) % 4];
            let mut places: Vec<i32> = steps.iter().skip(side).step_by(4).copied().collect();
            places.push(0);
            places.sort_unstable();
            places.dedup();
            for place in places {
                let [x, y] = [0, 1].map(|i| from[i] as f32 + (to[i] - from[i]) as f32 * place as f32 / 64.0);
                rim.push(at_pixel(x, y, 1.0 + place as f32 / 32.0));
            }
        }
        for draw in [draw, draw_singly] {
            let (counts, stats) = draw(&pixel_view(1.0, 16_384.0), &fan(hub, &rim));
            prop_assert!(counts.iter().all(|&n| n == 1), "{stats:?}");
        }
    }

    /// Corners beyond the guard band are limited by the program of Slats, and clipped by the other code.
    ///
    /// An edge to such a corner is multiplied by a factor, and its coefficients are rounded (kernels/slats_rules.md,
    /// rule 5). Both triangles of the edge use opposite numbers, but edges with different factors no longer meet at the
    /// exact corner. At a pixel, in units of 1/16 px, an edge's expression has an error of at most
    /// (10,240 + 7,680) / 2 + 1.5 = 8,962, and its gradient is at least 65,536 - 10,240. So an edge misses the hub by at
    /// most 0.162 / 16 px. The hub is at a multiple of half a pixel, and the spokes are more than 2.4 degrees apart. So
    /// only the pixel whose centre is the hub can be near two spokes: it may be drawn any number of times.
    #[test]
    fn a_fan_with_corners_beyond_the_guard_band_covers_the_screen_exactly_once(
        hub in on_screen(), turn in 0.0..1.0_f32, bands in prop_oneof![0.5..4.0_f32, 4.0..1e5_f32], count in 5..12_usize,
    ) {
        let is_hub = |n: usize| hub == [n as i32 % WIDTH, n as i32 / WIDTH].map(|pixel| 2 * pixel + 1);
        let corner = at_pixel(hub[0] as f32 * 0.5, hub[1] as f32 * 0.5, 1.0);
        let rim: Vec<Vec3> = (0..count).map(|n| {
            let (sine, cosine) = ((n as f32 + turn) / count as f32 * std::f32::consts::TAU).sin_cos();
            // Every third corner lies on the screen's border, near the hub.
            let reach = if n % 3 == 2 { 0.2 } else { bands };
            at_pixel(320.0 + reach * 4096.0 * cosine, 240.0 + reach * 4096.0 * sine, 1.0)
        }).collect();
        let (counts, stats) = draw_singly(&pixel_view(1.0, 16_384.0), &fan(corner, &rim));
        let wrong = counts.iter().enumerate().filter(|(n, times)| **times != 1 && !is_hub(*n)).count();
        prop_assert!(stats.clipped == 0 && wrong == 0, "{wrong} pixels: {stats:?}");
    }

    #[test]
    fn two_triangles_share_a_clipped_edge_without_a_gap(
        a in prop::array::uniform3(-3.0..3.0_f32), b in prop::array::uniform3(-3.0..3.0_f32),
        depth in -4.0..-1.5_f32, scale in prop_oneof![Just(1.0_f32), Just(1e3), Just(1e5)],
    ) {
        // A plane near the eye is divided by lines through a hub. The plane must cover each pixel of the screen once.
        let view = ViewTransform {
            model_view: Mat4::IDENTITY,
            projection: Mat4::perspective_rh(1.0, 4.0 / 3.0, 0.25, 1e6),
        };
        let [a, b] = [a, b].map(Vec3::from_array);
        let hub = Vec3::new(0.1, -0.2, depth);
        let spokes = [a, b, -a, -b].map(|v| hub + v * scale);
        let (counts, stats) = draw(&view, &fan(hub, &spokes));
        prop_assert!(counts.iter().all(|&n| n <= 1), "a pixel twice: {stats:?}");
        // A hole is an uncovered pixel between covered neighbours, away from the parallelogram's rim.
        for y in 2..HEIGHT - 2 {
            for x in 2..WIDTH - 2 {
                let ring = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
                let surrounded = ring.iter().all(|&(dx, dy)| count(&counts, x + dx, y + dy) == 1);
                prop_assert!(count(&counts, x, y) == 1 || !surrounded, "hole at {x}, {y}: {stats:?}");
            }
        }
    }
}

#[test]
fn a_long_edge_close_to_the_eye_is_clipped_at_the_exact_point() {
    // With cuts in single precision, a cut had an error of five pixels. The pieces overlapped and drew 85 pixels twice.
    let projection = Mat4::perspective_rh(1.0, 4.0 / 3.0, 0.25, 1e6);
    let view = ViewTransform { model_view: Mat4::IDENTITY, projection };
    let [a, b] = [Vec3::new(0.182_420_76, 0.094_211_22, 2.811_083_8), Vec3::new(2.750_59, -2.228_786_5, -2.321_554_4)];
    let hub = Vec3::new(0.1, -0.2, -1.855_645_9);
    let (counts, stats) = draw(&view, &fan(hub, &[a, b, -a, -b].map(|v| hub + v * 1e5)));
    assert!(counts.iter().all(|&n| n <= 1), "{stats:?}");
}

#[test]
fn a_corner_on_a_pixel_centre_belongs_to_exactly_one_of_its_triangles() {
    let hub = at_pixel(100.5, 100.5, 1.0);
    let rim = [[90.5, 100.5], [100.5, 90.5], [110.5, 100.5], [100.5, 110.5]].map(|[x, y]| at_pixel(x, y, 1.0));
    let (counts, _) = draw(&pixel_view(1.0, 16_384.0), &fan(hub, &rim));
    assert_eq!(count(&counts, 100, 100), 1);
    // The result counts the pixel centres in the diamond |x| + |y| <= 10, without the lower and right rim. A row at
    // height k from the middle has centres -w..=w with w = 10 - |k|. Its left end is on a left edge and counts. Its
    // right end is on a right edge and does not count. The row of the bottom corner is empty, because no left or top
    // edge contains the corner as an inner point. The row of the top corner is empty, because the corner is on a right
    // edge.
    let expected: u32 = (-9_i32..=9).map(|k| 2 * (10 - k.unsigned_abs())).sum();
    assert_eq!(counts.iter().map(|&n| u32::from(n)).sum::<u32>(), expected);
}

#[test]
fn only_the_part_of_a_triangle_beyond_the_near_plane_is_drawn() {
    // The floor y = -1 extends from far in front of the eye to far behind the eye. Every pixel below the horizon must
    // be covered.
    let view = pixel_view(0.5, 1e6);
    let corners = [Vec3::new(-1e5, -1.0, 1e4), Vec3::new(1e5, -1.0, 1e4), Vec3::new(0.0, -1.0, -9e5)];
    let (counts, stats) = draw(&view, &[corners]);
    assert_eq!(stats.clipped, 1);
    // y = -1 at distance t is at 240 + 240 / t px. Row 479 is at t = 1.002, before the near plane.
    for y in [242, 300, 479] {
        assert!((0..WIDTH).all(|x| count(&counts, x, y) == 1), "row {y}");
    }
    assert!((0..WIDTH).all(|x| count(&counts, x, 239) == 0));
    // With the near plane at 2, no pixel is nearer, so rows below 240 + 120 stay empty.
    let (counts, _) = draw(&pixel_view(2.0, 1e6), &[corners]);
    assert_eq!((count(&counts, 320, 359), count(&counts, 320, 360)), (1, 0));
}

#[test]
fn triangles_with_corners_a_million_pixels_off_the_screen_share_their_edge() {
    // Without the guard band these edges would need 40 bits. Every second triangle is reversed.
    let rim = [[-1.0, -0.9], [1.0, -1.1], [0.8, 1.0], [-0.7, 1.0]];
    let rim = rim.map(|[x, y]| at_pixel(320.0 + x * 1e6, 240.0 + y * 1e6, 1.0));
    let hub = at_pixel(300.25, 200.75, 1.0);
    for (draw, clipped) in [(draw as fn(&_, &_) -> _, 4), (draw_singly, 0)] {
        let (counts, stats) = draw(&pixel_view(1.0, 16_384.0), &fan(hub, &rim));
        assert_eq!(stats.clipped, clipped);
        assert!(counts.iter().all(|&n| n == 1));
    }
}
