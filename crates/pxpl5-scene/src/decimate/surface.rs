//! A surface whose edges can be collapsed. Its triangles connect points. A point stands for all vertices at one
//! position.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec3;

use crate::scene::{Scene, Vertex};

#[derive(Clone)]
pub(super) struct Surface {
    vertices: Arc<[Vertex]>,
    pub(super) places: Vec<DVec3>,
    /// Index of the point at which each vertex lies.
    point_of: Vec<u32>,
    vertices_on: Vec<Vec<u32>>,
    /// Indices of the three vertices of each triangle, or `None` for a removed triangle.
    pub(super) triangles: Vec<Option<[u32; 3]>>,
    around: Vec<Vec<u32>>,
    pub(super) left: usize,
}

impl Surface {
    /// Creates a surface of all triangles of a scene. Triangles with two corners at one point have no area and are left
    /// out.
    pub(super) fn new(scene: &Scene) -> Self {
        let vertices: Arc<[Vertex]> = scene.vertices().into();
        let mut surface = Self {
            vertices,
            places: Vec::new(),
            point_of: vec![0; scene.vertices().len()],
            vertices_on: Vec::new(),
            triangles: scene.triangles().iter().copied().map(Some).collect(),
            around: Vec::new(),
            left: scene.triangles().len(),
        };
        // Points are not shared between structures, which can move apart.
        for structure in scene.structures() {
            surface.weld(structure.vertices.clone());
        }
        surface.around = vec![Vec::new(); surface.places.len()];
        for triangle in 0..surface.triangles.len() as u32 {
            surface.enter(triangle);
        }
        surface
    }

    /// Creates a point for every distinct position of the vertices in a range.
    fn weld(&mut self, vertices: std::ops::Range<usize>) {
        let mut points: BTreeMap<[u32; 3], u32> = BTreeMap::new();
        for vertex in vertices {
            let position = self.vertices[vertex].position;
            // Adding zero turns -0 into +0, so both get the same key.
            let key = position.to_array().map(|x| (x + 0.0).to_bits());
            let point = *points.entry(key).or_insert_with(|| {
                self.places.push(position.as_dvec3());
                self.vertices_on.push(Vec::new());
                self.places.len() as u32 - 1
            });
            self.point_of[vertex] = point;
            self.vertices_on[point as usize].push(vertex as u32);
        }
    }

    fn enter(&mut self, triangle: u32) {
        let Some(points) = self.points(triangle) else { return };
        if is_degenerate(points) {
            self.triangles[triangle as usize] = None;
            self.left -= 1;
            return;
        }
        points.iter().for_each(|point| self.around[*point as usize].push(triangle));
    }

    pub(super) fn points(&self, triangle: u32) -> Option<[u32; 3]> {
        let corners = self.triangles[triangle as usize]?;
        Some(corners.map(|vertex| self.point_of[vertex as usize]))
    }

    pub(super) fn all(&self) -> impl Iterator<Item = (u32, [u32; 3])> {
        (0..self.triangles.len() as u32).filter_map(|triangle| Some((triangle, self.points(triangle)?)))
    }

    pub(super) fn round(&self, point: u32) -> impl Iterator<Item = (u32, [u32; 3])> {
        let triangles = self.around[point as usize].iter();
        triangles.filter_map(|triangle| Some((*triangle, self.points(*triangle)?)))
    }

    /// Returns the points that an edge connects to this point, in ascending order.
    pub(super) fn neighbours(&self, point: u32) -> BTreeSet<u32> {
        let joined = self.round(point).flat_map(|(_, points)| points);
        joined.filter(|other| *other != point).collect()
    }

    /// Returns the number of triangles at an edge: two inside a surface, and one at the border of a surface.
    pub(super) fn triangles_at(&self, a: u32, b: u32) -> usize {
        self.round(a).filter(|(_, points)| points.contains(&b)).count()
    }

    /// Returns true if every edge has two triangles.
    pub(super) fn is_closed(&self) -> bool {
        let sides = |[a, b, c]: [u32; 3]| [(a, b), (b, c), (c, a)];
        self.all().all(|(_, points)| sides(points).into_iter().all(|(a, b)| self.triangles_at(a, b) == 2))
    }

    /// Returns the normal of the triangle with these three points. Its length is twice the triangle's area.
    pub(super) fn normal(&self, points: [u32; 3]) -> DVec3 {
        let [a, b, c] = points.map(|point| self.places[point as usize]);
        (b - a).cross(c - a)
    }

    /// Moves the point `from` onto the point `onto`. Triangles at both points are removed. The other triangles at
    /// `from` now end at `onto`.
    pub(super) fn collapse(&mut self, from: u32, onto: u32) {
        let moved: Vec<(u32, [u32; 3])> = self.round(from).collect();
        self.around[from as usize].clear();
        for (triangle, points) in moved {
            // A triangle at both points loses its area and is removed. Other triangles get a vertex at the new point.
            if points.contains(&onto) {
                self.remove(triangle, points);
            } else if let Some(corners) = self.triangles[triangle as usize] {
                let corner = |vertex: u32| self.point_of[vertex as usize] == from;
                let corners =
                    corners.map(|vertex| if corner(vertex) { self.counterpart(vertex, onto) } else { vertex });
                self.triangles[triangle as usize] = Some(corners);
                self.around[onto as usize].push(triangle);
            }
        }
    }

    pub(super) fn remove(&mut self, triangle: u32, points: [u32; 3]) {
        for point in points {
            self.around[point as usize].retain(|other| *other != triangle);
        }
        self.triangles[triangle as usize] = None;
        self.left -= 1;
    }

    /// Returns the vertex at point `onto` that is most similar to `vertex` in normal and colour.
    fn counterpart(&self, vertex: u32, onto: u32) -> u32 {
        let wanted = self.vertices[vertex as usize];
        let likeness = |candidate: &u32| likeness(&wanted, &self.vertices[*candidate as usize]);
        let candidates = self.vertices_on[onto as usize].iter();
        let best = candidates.max_by(|a, b| likeness(a).total_cmp(&likeness(b)).then(b.cmp(a)));
        best.copied().unwrap_or(vertex)
    }

    /// Returns the connected pieces of the surface. Each piece is a list of its triangles in ascending order.
    pub(super) fn pieces(&self) -> Vec<Vec<u32>> {
        let mut pieces: Vec<Vec<u32>> = Vec::new();
        let mut met = vec![false; self.triangles.len()];
        // Collect all triangles that share points with the first triangle, directly or through other triangles.
        for (first, _) in self.all() {
            if std::mem::replace(&mut met[first as usize], true) {
                continue;
            }
            let mut piece = vec![first];
            let mut next = 0;
            while next < piece.len() {
                let points = self.points(piece[next]).unwrap_or_default();
                for (other, _) in points.into_iter().flat_map(|point| self.round(point)) {
                    if !std::mem::replace(&mut met[other as usize], true) {
                        piece.push(other);
                    }
                }
                next += 1;
            }
            piece.sort_unstable();
            pieces.push(piece);
        }
        pieces
    }
}

pub(super) fn is_degenerate([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

fn likeness(one: &Vertex, other: &Vertex) -> f64 {
    let shades = one.colour.iter().zip(other.colour).map(|(a, b)| f64::from(a.abs_diff(b)));
    f64::from(one.normal.dot(other.normal)) - shades.sum::<f64>() / (3.0 * 255.0)
}
