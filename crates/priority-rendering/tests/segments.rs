//! Meshes cut at cells: nothing is lost, nothing is twice, and cuts are shared bit for bit.

use glam::DVec3;
use priority_rendering::{Cell, Dealing, Segmentation};
use proptest::prelude::*;
use std::collections::BTreeMap;

fn area(corners: [DVec3; 3]) -> f64 {
    (corners[1] - corners[0]).cross(corners[2] - corners[0]).length() / 2.0
}

fn total(vertices: &[DVec3], triangles: impl IntoIterator<Item = [u32; 3]>) -> f64 {
    triangles.into_iter().map(|triangle| area(triangle.map(|i| vertices[i as usize]))).sum()
}

/// A closed surface: an octahedron of any corners.
const OCTAHEDRON: [[u32; 3]; 8] =
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];

/// Every directed edge of the pieces is there once, and once the other way: no crack, no overlap, no vertex in the middle of a
/// neighbour's edge.
fn is_closed(cut: &Segmentation) -> bool {
    let mut edges: BTreeMap<[u32; 2], i32> = BTreeMap::new();
    for [a, b, c] in cut.segments.values().flatten().copied() {
        for edge in [[a, b], [b, c], [c, a]] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    edges.iter().all(|([from, to], count)| edges.get(&[*to, *from]) == Some(count))
}

fn lies_in(cell: Cell, place: DVec3, side: f64) -> bool {
    let inside = |place: f64, number: i64| (number as f64 * side..=(number + 1) as f64 * side).contains(&place);
    inside(place.x, cell.x) && inside(place.z, cell.z)
}

proptest! {
    #[test]
    fn a_closed_surface_stays_closed_and_whole(
        corners in prop::array::uniform6((-12.0..12.0_f64, -3.0..3.0_f64, -12.0..12.0_f64)),
        side in prop_oneof![Just(5.0), Just(0.7), 1.0..20.0_f64],
        on_border in any::<bool>(),
    ) {
        let mut vertices = corners.map(|(x, y, z)| DVec3::new(x, y, z));
        if on_border {
            vertices[0].x = 2.0 * side;
            vertices[3].z = -side;
        }
        let cut = Segmentation::new(&vertices, &OCTAHEDRON, side).expect("cut");
        prop_assert!(is_closed(&cut));
        let pieces = cut.segments.values().flatten().copied();
        let whole = total(&vertices, OCTAHEDRON);
        prop_assert!((total(&cut.vertices, pieces) - whole).abs() <= 1e-9 * whole);
        for (cell, triangles) in &cut.segments {
            for corner in triangles.iter().flatten() {
                prop_assert!(lies_in(*cell, cut.vertices[*corner as usize], side), "{:?}", cell);
            }
        }
    }

    /// Whoever cuts the line, from whichever end: the same bits.
    #[test]
    fn a_shared_line_is_cut_at_the_same_places_by_both_sides(
        ends in prop::array::uniform2((-12.0..12.0_f64, -3.0..3.0_f64, -12.0..12.0_f64)),
        others in prop::array::uniform2((-12.0..12.0_f64, -3.0..3.0_f64, -12.0..12.0_f64)),
    ) {
        let [a, b] = ends.map(|(x, y, z)| DVec3::new(x, y, z));
        let [c, d] = others.map(|(x, y, z)| DVec3::new(x, y, z));
        let together = Segmentation::new(&[a, b, c, d], &[[0, 1, 2], [1, 0, 3]], 5.0).expect("cut");
        let alone = Segmentation::new(&[a, b, c], &[[0, 1, 2]], 5.0).expect("cut");
        for vertex in &alone.vertices {
            prop_assert!(together.vertices.contains(vertex));
        }
    }
}

/// A wall of 12 m along x in cells of 5 m from x = 1: 4, 5 and 3 m of it.
#[test]
fn a_wall_is_cut_in_three() {
    let corners = [(1.0, 0.0), (13.0, 0.0), (13.0, 3.0), (1.0, 3.0)].map(|(x, y)| DVec3::new(x, y, 2.0));
    let cut = Segmentation::new(&corners, &[[0, 1, 2], [0, 2, 3]], 5.0).expect("cut");
    let areas: Vec<(i64, f64)> =
        cut.segments.iter().map(|(cell, t)| (cell.x, total(&cut.vertices, t.iter().copied()))).collect();
    assert_eq!(areas.iter().map(|(x, _)| *x).collect::<Vec<_>>(), [0, 1, 2]);
    for ((_, found), expected) in areas.iter().zip([12.0, 15.0, 9.0]) {
        assert!((found - expected).abs() < 1e-12);
    }
    // The bottom, the top and the diagonal, each at x = 5 and x = 10.
    assert_eq!(cut.cuts.len(), 6);
    let dealing = Dealing { home: Cell { x: 4, z: 0 }, side_m: 5.0, inner_rings: 1, memories: 4 };
    assert_eq!(cut.fastest_memory(&dealing), Some(1), "as its nearest cell, two rings away");
}

#[test]
fn what_lies_in_a_border_belongs_to_its_positive_side() {
    let corners = [(0.0, 1.0), (0.0, 4.0), (3.0, 2.0)].map(|(y, z)| DVec3::new(5.0, y, z));
    let cut = Segmentation::new(&corners, &[[0, 1, 2]], 5.0).expect("cut");
    assert_eq!(cut.segments.keys().copied().collect::<Vec<_>>(), [Cell { x: 1, z: 0 }]);
    assert!(cut.cuts.is_empty());
    // 3 x 0.1 is more than 0.3: borders are multiples, not quotients.
    for n in -1_000..1_000_i64 {
        assert_eq!(Cell::of(n as f64 * 0.1, 0.0, 0.1).x, n);
    }
}

#[test]
fn what_cannot_be_cut_is_refused() {
    let refusal = |vertices: &[DVec3], triangles: &[[u32; 3]], side: f64| {
        Segmentation::new(vertices, triangles, side).expect_err("refused").to_string()
    };
    let corners = [DVec3::ZERO, DVec3::X * 1e5, DVec3::Z * 1e5];
    assert_eq!(refusal(&corners, &[], f64::NAN), "priority.cell_m: expected a length above 0, found NaN");
    assert!(refusal(&[DVec3::X * 1.1e6], &[], 5.0).starts_with("scene: expected coordinates up to 1000000 m, found"));
    assert!(refusal(&[DVec3::NAN], &[], 5.0).starts_with("scene: expected coordinates"));
    assert_eq!(refusal(&corners, &[[0, 1, 3]], 5.0), "scene: expected corners below 3, found 3");
    assert!(refusal(&corners, &[[0, 1, 2]], 1.0).starts_with("priority.cell_m: expected at most 10000000 pieces"));
}
