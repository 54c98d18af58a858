//! Segmentation: a mesh is cut once at the borders of cells, so that only the parts near the viewer must be drawn
//! often.

use crate::priority::cells::{Cell, CellAssignment, border, column};
use glam::DVec3;
use pxpl5_sim::parameters::SettingError;
use std::collections::BTreeMap;

/// Largest coordinate, in metres, of a mesh that [`Segmentation::new`] can cut.
const FARTHEST_M: f64 = 1e6;

const MAX_PIECES: f64 = 1e7;

/// A vertex that a cut has created on the line between two other vertices. Each of these two vertices can itself come
/// from a cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutVertex {
    /// Indices of the line's two end vertices, in ascending order.
    pub between: [u32; 2],
    /// Position on the line, from 0 at the first end vertex to 1 at the second.
    pub share: f64,
}

/// A mesh that was cut at the borders of cells.
///
/// A line is cut once for all triangles that share it. All parts at a cut use the same vertices, so there are no cracks
/// and no T-junctions.
#[derive(Clone, Debug)]
pub struct Segmentation {
    /// The vertices of the mesh, followed by the vertices that cuts have created.
    pub vertices: Vec<DVec3>,
    /// Origin of each vertex that a cut has created, in the order of `vertices`. Programs use the origin to interpolate
    /// colours and normals.
    pub cuts: Vec<CutVertex>,
    /// The triangles in each cell, with the orientation of the original triangles.
    pub segments: BTreeMap<Cell, Vec<[u32; 3]>>,
}

impl Segmentation {
    /// Cuts triangles at the planes x = i a and z = i a for all integers i. The length a is the side of a cell.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the side is not positive and finite, or if a coordinate exceeds 1e6 m. The same
    /// error is returned if an index has no vertex, or if there could be more than ten million pieces.
    pub fn new(vertices: &[DVec3], triangles: &[[u32; 3]], side_m: f64) -> Result<Self, SettingError> {
        check(vertices, triangles, side_m)?;
        let mut cutter = Cutter { side_m, vertices: vertices.to_vec(), cuts: Vec::new(), made: BTreeMap::new() };
        let mut segments: BTreeMap<Cell, Vec<[u32; 3]>> = BTreeMap::new();
        for triangle in triangles {
            // Cut into strips along x, and each strip into pieces along z.
            for strip in cutter.slabs(triangle.to_vec(), Axis::X) {
                for piece in cutter.slabs(strip, Axis::Z) {
                    let fan = (1..piece.len() - 1).map(|i| [piece[0], piece[i], piece[i + 1]]);
                    segments.entry(cutter.cell(&piece)).or_default().extend(fan);
                }
            }
        }
        Ok(Self { vertices: cutter.vertices, cuts: cutter.cuts, segments })
    }

    /// Returns the memory that must hold the uncut mesh. Of the memories whose cells the mesh touches, this memory is
    /// drawn most often. Returns `None` for an empty mesh.
    pub fn fastest_memory(&self, assignment: &CellAssignment) -> Option<usize> {
        self.segments.keys().map(|cell| assignment.memory(*cell)).min()
    }
}

fn check(vertices: &[DVec3], triangles: &[[u32; 3]], side_m: f64) -> Result<(), SettingError> {
    if !(side_m > 0.0 && side_m.is_finite()) {
        return Err(SettingError::value("priority.cell_m", "a length above 0", side_m));
    }
    if let Some(vertex) =
        vertices.iter().find(|vertex| !(vertex.abs().max_element() <= FARTHEST_M && vertex.is_finite()))
    {
        let expected = format_args!("coordinates up to {FARTHEST_M} m");
        return Err(SettingError::value("scene", expected, vertex));
    }
    if let Some(corner) = triangles.iter().flatten().find(|corner| **corner as usize >= vertices.len()) {
        let expected = format_args!("corners below {}", vertices.len());
        return Err(SettingError::value("scene", expected, corner));
    }
    // Limit the number of pieces before cutting, to bound time and memory.
    let pieces: f64 =
        triangles.iter().map(|triangle| most_pieces(triangle.map(|i| vertices[i as usize]), side_m)).sum();
    if pieces > MAX_PIECES {
        let expected = format_args!("at most {MAX_PIECES} pieces");
        return Err(SettingError::value("priority.cell_m", expected, format_args!("up to {pieces:.0}")));
    }
    Ok(())
}

fn most_pieces(corners: [DVec3; 3], side_m: f64) -> f64 {
    let [a, b, c] = corners;
    let size = (a.max(b).max(c) - a.min(b).min(c)) / side_m;
    (size.x.ceil() + 1.0) * (size.z.ceil() + 1.0)
}

/// The axis perpendicular to the planes at which a mesh is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Axis {
    X,
    Z,
}

impl Axis {
    fn of(self, place: DVec3) -> f64 {
        match self {
            Self::X => place.x,
            Self::Z => place.z,
        }
    }
}

#[derive(Debug)]
struct Cutter {
    side_m: f64,
    vertices: Vec<DVec3>,
    cuts: Vec<CutVertex>,
    /// Indices of the vertices that cuts have created so far. The key has the cut line, the axis and the border.
    made: BTreeMap<([u32; 2], Axis, i64), u32>,
}

impl Cutter {
    fn along(&self, vertex: u32, axis: Axis) -> f64 {
        axis.of(self.vertices[vertex as usize])
    }

    fn least(&self, polygon: &[u32], axis: Axis) -> f64 {
        polygon.iter().map(|vertex| self.along(*vertex, axis)).fold(f64::INFINITY, f64::min)
    }

    fn greatest(&self, polygon: &[u32], axis: Axis) -> f64 {
        polygon.iter().map(|vertex| self.along(*vertex, axis)).fold(f64::NEG_INFINITY, f64::max)
    }

    fn cell(&self, polygon: &[u32]) -> Cell {
        let [x, z] = [Axis::X, Axis::Z].map(|axis| column(self.least(polygon, axis), self.side_m));
        Cell { x, z }
    }

    /// Cuts a convex polygon at every border that it crosses. Returns the pieces in ascending order of coordinates.
    fn slabs(&mut self, polygon: Vec<u32>, axis: Axis) -> Vec<Vec<u32>> {
        let mut pieces = Vec::new();
        let mut rest = polygon;
        // The first border lies after the smallest coordinate.
        let mut number = column(self.least(&rest, axis), self.side_m) + 1;
        while self.greatest(&rest, axis) > border(number, self.side_m) {
            let [below, above] = self.cut(&rest, axis, number);
            pieces.push(below);
            rest = above;
            number += 1;
        }
        pieces.push(rest);
        pieces
    }

    /// Cuts a polygon at a border that it crosses. Returns the part below the border and the part above it.
    fn cut(&mut self, polygon: &[u32], axis: Axis, number: i64) -> [Vec<u32>; 2] {
        let at = border(number, self.side_m);
        let mut parts = [Vec::new(), Vec::new()];
        for (i, vertex) in polygon.iter().enumerate() {
            let next = polygon[(i + 1) % polygon.len()];
            let [here, there] = [*vertex, next].map(|vertex| self.along(vertex, axis));
            // A vertex on the border belongs to both parts.
            if here <= at {
                parts[0].push(*vertex);
            }
            if here >= at {
                parts[1].push(*vertex);
            }
            // An edge that crosses the border gets a new vertex, shared by both parts.
            if (here < at && there > at) || (here > at && there < at) {
                let made = self.vertex([*vertex, next], axis, number);
                parts.iter_mut().for_each(|part| part.push(made));
            }
        }
        parts
    }

    /// Returns the vertex at which a line crosses a border. All polygons with this line get the same vertex.
    fn vertex(&mut self, line: [u32; 2], axis: Axis, number: i64) -> u32 {
        // The order of the edge's ends must not matter, so the ends are sorted.
        let between = [line[0].min(line[1]), line[0].max(line[1])];
        if let Some(made) = self.made.get(&(between, axis, number)) {
            return *made;
        }
        let [from, to] = between.map(|vertex| self.vertices[vertex as usize]);
        let at = border(number, self.side_m);
        let share = (at - axis.of(from)) / (axis.of(to) - axis.of(from));
        let mut place = from + (to - from) * share;
        // Set the coordinate exactly to the border, without rounding errors.
        match axis {
            Axis::X => place.x = at,
            Axis::Z => place.z = at,
        }
        let made = self.vertices.len() as u32;
        self.vertices.push(place);
        self.cuts.push(CutVertex { between, share });
        self.made.insert((between, axis, number), made);
        made
    }
}
