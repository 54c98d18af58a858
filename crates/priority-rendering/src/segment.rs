//! Segmentation: a mesh cut at the borders of cells, once, so that only near parts are drawn often.

use crate::cells::{Cell, Dealing, border, column};
use crate::error::PriorityError;
use glam::DVec3;
use std::collections::BTreeMap;

/// Farthest coordinate of a world that is cut, m.
const FARTHEST_M: f64 = 1e6;

/// Most pieces of triangles that one mesh may be cut into.
const MOST_PIECES: f64 = 1e7;

/// A vertex that a cut made: on the line between two others, which may have been made by cuts themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutVertex {
    /// The ends of the line, the lower number first.
    pub between: [u32; 2],
    /// How far it lies from the first to the second, 0 to 1.
    pub share: f64,
}

/// A mesh cut at the borders of cells.
///
/// A line is cut once for all triangles that share it, and every part that meets a cut holds the same vertex: there are no
/// cracks and no vertices in the middle of another part's edge.
#[derive(Clone, Debug)]
pub struct Segmentation {
    /// The mesh's vertices, then those that cuts made.
    pub vertices: Vec<DVec3>,
    /// What the vertices after the mesh's own lie between, in their order: for colours and normals.
    pub cuts: Vec<CutVertex>,
    /// The triangles in each cell, with corners in the order of the mesh's: the segment that the mesh has there.
    pub segments: BTreeMap<Cell, Vec<[u32; 3]>>,
}

impl Segmentation {
    /// Cuts triangles at x = i a and z = i a, a being the side of a cell.
    ///
    /// # Errors
    ///
    /// [`PriorityError`] for a side that is none, a coordinate beyond 1e6 m, a corner without a vertex, or more than ten million
    /// pieces.
    pub fn new(vertices: &[DVec3], triangles: &[[u32; 3]], side_m: f64) -> Result<Self, PriorityError> {
        check(vertices, triangles, side_m)?;
        let mut cutter = Cutter { side_m, vertices: vertices.to_vec(), cuts: Vec::new(), made: BTreeMap::new() };
        let mut segments: BTreeMap<Cell, Vec<[u32; 3]>> = BTreeMap::new();
        for triangle in triangles {
            for strip in cutter.slabs(triangle.to_vec(), Axis::X) {
                for piece in cutter.slabs(strip, Axis::Z) {
                    let fan = (1..piece.len() - 1).map(|i| [piece[0], piece[i], piece[i + 1]]);
                    segments.entry(cutter.cell(&piece)).or_default().extend(fan);
                }
            }
        }
        Ok(Self { vertices: cutter.vertices, cuts: cutter.cuts, segments })
    }

    /// The memory in which all of the mesh is drawn when its segments are not drawn by themselves: the fastest of any of its
    /// cells; `None` of an empty mesh.
    #[must_use]
    pub fn fastest_memory(&self, dealing: &Dealing) -> Option<usize> {
        self.segments.keys().map(|cell| dealing.memory(*cell)).min()
    }
}

fn check(vertices: &[DVec3], triangles: &[[u32; 3]], side_m: f64) -> Result<(), PriorityError> {
    let refused = |text: String| Err(PriorityError(text));
    if !(side_m > 0.0 && side_m.is_finite()) {
        return refused(format!("priority.cell_m: expected a length above 0, found {side_m}"));
    }
    if let Some(vertex) =
        vertices.iter().find(|vertex| !(vertex.abs().max_element() <= FARTHEST_M && vertex.is_finite()))
    {
        return refused(format!("scene: expected coordinates up to {FARTHEST_M} m, found {vertex}"));
    }
    if let Some(corner) = triangles.iter().flatten().find(|corner| **corner as usize >= vertices.len()) {
        return refused(format!("scene: expected corners below {}, found {corner}", vertices.len()));
    }
    let pieces: f64 =
        triangles.iter().map(|triangle| most_pieces(triangle.map(|i| vertices[i as usize]), side_m)).sum();
    if pieces > MOST_PIECES {
        return refused(format!("priority.cell_m: expected at most {MOST_PIECES} pieces, found up to {pieces:.0}"));
    }
    Ok(())
}

/// Cells of the rectangle around a triangle.
fn most_pieces(corners: [DVec3; 3], side_m: f64) -> f64 {
    let [a, b, c] = corners;
    let size = (a.max(b).max(c) - a.min(b).min(c)) / side_m;
    (size.x.ceil() + 1.0) * (size.z.ceil() + 1.0)
}

/// The direction across cuts.
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
    /// The vertex of each line and border that has been cut.
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

    /// A convex polygon cut at every border that it crosses, in rising order.
    fn slabs(&mut self, polygon: Vec<u32>, axis: Axis) -> Vec<Vec<u32>> {
        let mut pieces = Vec::new();
        let mut rest = polygon;
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

    /// The parts of a polygon below and above a border that it crosses.
    fn cut(&mut self, polygon: &[u32], axis: Axis, number: i64) -> [Vec<u32>; 2] {
        let at = border(number, self.side_m);
        let mut parts = [Vec::new(), Vec::new()];
        for (i, vertex) in polygon.iter().enumerate() {
            let next = polygon[(i + 1) % polygon.len()];
            let [here, there] = [*vertex, next].map(|vertex| self.along(vertex, axis));
            if here <= at {
                parts[0].push(*vertex);
            }
            if here >= at {
                parts[1].push(*vertex);
            }
            if (here < at && there > at) || (here > at && there < at) {
                let made = self.vertex([*vertex, next], axis, number);
                parts.iter_mut().for_each(|part| part.push(made));
            }
        }
        parts
    }

    /// The vertex of a line on a border, the same whichever polygon asks.
    fn vertex(&mut self, line: [u32; 2], axis: Axis, number: i64) -> u32 {
        let between = [line[0].min(line[1]), line[0].max(line[1])];
        if let Some(made) = self.made.get(&(between, axis, number)) {
            return *made;
        }
        let [from, to] = between.map(|vertex| self.vertices[vertex as usize]);
        let at = border(number, self.side_m);
        let share = (at - axis.of(from)) / (axis.of(to) - axis.of(from));
        let mut place = from + (to - from) * share;
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
