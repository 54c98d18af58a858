//! Tests of meshes that are cut at cells: nothing is lost or duplicated, and both sides of a cut have bit-identical
//! vertices.

use address_recalculation::priority::{Cell, CellAssignment, Segmentation};
use glam::DVec3;
use proptest::prelude::*;
use std::collections::BTreeMap;

fn area(corners: [DVec3; 3]) -> f64 {
    (corners[1] - corners[0]).cross(corners[2] - corners[0]).length() / 2.0
}

fn total(vertices: &[DVec3], triangles: impl IntoIterator<Item = [u32; 3]>) -> f64 {
    triangles.into_iter().map(|triangle| area(triangle.map(|i| vertices[i as usize]))).sum()
}

/// A closed surface: an octahedron with arbitrary corners.
const OCTAHEDRON: [[u32; 3]; 8] =
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];

/// Returns true if every directed edge of the pieces occurs once, and once in the opposite direction.
///
/// Such a mesh has no cracks, overlaps or T-junctions.
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
    fn cutting_keeps_a_closed_surface_closed(
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
        for (made, lies) in cut.vertices[vertices.len()..].iter().zip(&cut.cuts) {
            let [from, to] = lies.between.map(|end| cut.vertices[end as usize]);
            prop_assert!(lies.between[0] < lies.between[1] && lies.share > 0.0 && lies.share < 1.0, "{:?}", lies);
            prop_assert!((from.lerp(to, lies.share) - made).length() < 1e-9, "{:?}", lies);
            prop_assert!([made.x, made.z].iter().any(|at| (at / side).round() * side == *at), "on a border: {}", made);
        }
        prop_assert_eq!(cut.vertices.len(), vertices.len() + cut.cuts.len());
        let pieces = cut.segments.values().flatten().copied();
        let whole = total(&vertices, OCTAHEDRON);
        prop_assert!((total(&cut.vertices, pieces) - whole).abs() <= 1e-9 * whole);
        for (cell, triangles) in &cut.segments {
            for corner in triangles.iter().flatten() {
                prop_assert!(lies_in(*cell, cut.vertices[*corner as usize], side), "{:?}", cell);
            }
        }
    }

    /// An edge has bit-identical cut vertices for every triangle that shares it, and for both directions of the edge.
    #[test]
    fn both_triangles_of_a_shared_edge_are_cut_at_the_same_points(
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

/// A wall of 12 m along x starts at x = 1. Cells of 5 m cut it into 4, 5 and 3 m.
#[test]
fn cells_of_5_m_cut_a_wall_of_12_m_into_three_segments() {
    let corners = [(1.0, 0.0), (13.0, 0.0), (13.0, 3.0), (1.0, 3.0)].map(|(x, y)| DVec3::new(x, y, 2.0));
    let cut = Segmentation::new(&corners, &[[0, 1, 2], [0, 2, 3]], 5.0).expect("cut");
    let areas: Vec<(i64, f64)> =
        cut.segments.iter().map(|(cell, t)| (cell.x, total(&cut.vertices, t.iter().copied()))).collect();
    assert_eq!(areas.iter().map(|(x, _)| *x).collect::<Vec<_>>(), [0, 1, 2]);
    for ((_, found), expected) in areas.iter().zip([12.0, 15.0, 9.0]) {
        assert!((found - expected).abs() < 1e-12);
    }
    // The bottom, the top and the diagonal are each cut at x = 5 and x = 10.
    assert_eq!(cut.cuts.len(), 6);
    let assignment =
        CellAssignment { home: Cell { x: 4, z: 0 }, side_m: 5.0, inner_rings: 1, ring_growth: 1, memories: 4 };
    assert_eq!(cut.fastest_memory(&assignment), Some(1), "as its nearest cell, two rings away");
}

#[test]
fn a_triangle_within_a_border_plane_belongs_to_the_positive_side() {
    let corners = [(0.0, 1.0), (0.0, 4.0), (3.0, 2.0)].map(|(y, z)| DVec3::new(5.0, y, z));
    let cut = Segmentation::new(&corners, &[[0, 1, 2]], 5.0).expect("cut");
    assert_eq!(cut.segments.keys().copied().collect::<Vec<_>>(), [Cell { x: 1, z: 0 }]);
    assert!(cut.cuts.is_empty());
    let before =
        Segmentation::new(&[1.0, 4.0, 5.0].map(|x| DVec3::new(x, x * x, 2.0)), &[[0, 1, 2]], 5.0).expect("cut");
    assert_eq!(before.segments.keys().copied().collect::<Vec<_>>(), [Cell { x: 0, z: 0 }], "it ends at the border");
    // 3 x 0.1 exceeds 0.3 in floating point. Borders must be products, not quotients.
    for n in -1_000..1_000_i64 {
        assert_eq!(Cell::of(n as f64 * 0.1, 0.0, 0.1).x, n);
    }
}

/// A corner on the border belongs to both parts. Only the line opposite to the corner is cut.
#[test]
fn a_vertex_on_a_border_is_not_duplicated() {
    let corners = [(5.0, 0.0), (1.0, 3.0), (9.0, 2.0)].map(|(x, y)| DVec3::new(x, y, 1.0));
    for triangle in [[0, 1, 2], [2, 1, 0]] {
        let cut = Segmentation::new(&corners, &[triangle], 5.0).expect("cut");
        assert_eq!((cut.cuts.len(), cut.vertices[3]), (1, DVec3::new(5.0, 2.5, 1.0)));
        assert_eq!((cut.cuts[0].between, cut.cuts[0].share), ([1, 2], 0.5));
        assert!(cut.segments.values().map(Vec::len).eq([1, 1]), "a triangle on each side");
    }
}

#[test]
fn an_empty_mesh_is_in_no_memory() {
    let assignment =
        CellAssignment { home: Cell { x: 0, z: 0 }, side_m: 5.0, inner_rings: 1, ring_growth: 1, memories: 4 };
    let mesh = |x: f64| {
        let corners = [0.0, 1.0, 2.0].map(|along| DVec3::new(x + along, along * along, 1.0));
        Segmentation::new(&corners, &[[0, 1, 2]], 5.0).expect("cut").fastest_memory(&assignment)
    };
    assert_eq!([1.0, 11.0, 16.0].map(mesh), [Some(0), Some(1), Some(2)], "0, 2 and 3 rings away");
    assert_eq!(Segmentation::new(&[], &[], 5.0).expect("nothing").fastest_memory(&assignment), None);
}

/// The number of pieces is bounded by the cells of a triangle's bounding rectangle. 3,125 x 3,200 is ten million, the
/// limit.
#[test]
fn more_than_ten_million_segments_are_refused() {
    let from = DVec3::new(100.0, 0.0, -300.0);
    let cut = |columns: f64, rows: f64| {
        // This triangle has no area and few pieces, but the check counts the cells of its bounding rectangle.
        let to = from + DVec3::new((columns - 1.0) * 0.5, 7.0, (rows - 1.0) * 0.5);
        Segmentation::new(&[from, to], &[[0, 1, 1]], 0.5)
    };
    cut(3_125.0, 3_200.0).expect("ten million");
    let refusal = |columns, rows| cut(columns, rows).expect_err("more").to_string();
    let most = "priority.cell_m: expected at most 10000000 pieces, found up to";
    assert_eq!(refusal(3_125.0, 3_201.0), format!("{most} {}", 3_125 * 3_201));
    assert_eq!(refusal(3_126.0, 3_200.0), format!("{most} {}", 3_126 * 3_200));
}

#[test]
fn a_mesh_that_cannot_be_cut_is_refused() {
    let refusal = |vertices: &[DVec3], triangles: &[[u32; 3]], side: f64| {
        Segmentation::new(vertices, triangles, side).expect_err("refused").to_string()
    };
    let corners = [DVec3::ZERO, DVec3::X * 1e5, DVec3::Z * 1e5];
    assert_eq!(refusal(&corners, &[], f64::NAN), "priority.cell_m: expected a length above 0, found NaN");
    assert!(refusal(&[DVec3::X * 1.1e6], &[], 5.0).starts_with("scene: expected coordinates up to 1000000 m, found"));
    for wrong in [DVec3::NAN, DVec3::new(f64::NAN, 0.0, 0.0), DVec3::NEG_Z * f64::INFINITY, DVec3::NEG_Y * 1.1e6] {
        assert!(refusal(&[wrong], &[], 5.0).starts_with("scene: expected coordinates"), "{wrong}");
    }
    for side in [0.0, -1.0, f64::INFINITY] {
        let expected = format!("priority.cell_m: expected a length above 0, found {side}");
        assert_eq!(refusal(&corners, &[], side), expected);
    }
    Segmentation::new(&[DVec3::NEG_X * 1e6], &[], 5.0).expect("the farthest");
    assert_eq!(refusal(&corners, &[[0, 1, 3]], 5.0), "scene: expected corners below 3, found 3");
    assert!(refusal(&corners, &[[0, 1, 2]], 1.0).starts_with("priority.cell_m: expected at most 10000000 pieces"));
}
