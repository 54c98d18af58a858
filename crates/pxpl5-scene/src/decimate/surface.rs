//! A surface whose edges can be collapsed: triangles between points, where vertices of one place are one point.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::scene::{Scene, Vertex};

/// Triangles of a scene, some of them gone. Points are the different places of the vertices of one structure.
pub(super) struct Surface<'a> {
    vertices: &'a [Vertex],
    /// Place of each point.
    pub(super) places: Vec<DVec3>,
    /// The point on which each vertex lies.
    point_of: Vec<u32>,
    /// The vertices that lie on each point.
    vertices_on: Vec<Vec<u32>>,
    /// Corners as vertices; nothing where a triangle is gone.
    pub(super) triangles: Vec<Option<[u32; 3]>>,
    /// The triangles that are left round each point, by index.
    around: Vec<Vec<u32>>,
    /// How many triangles are left.
    pub(super) left: usize,
}

impl<'a> Surface<'a> {
    /// All triangles of a scene but those that join a point with itself, which cover nothing.
    pub(super) fn new(scene: &'a Scene) -> Self {
        let vertices = scene.vertices();
        let mut surface = Self {
            vertices,
            places: Vec::new(),
            point_of: vec![0; vertices.len()],
            vertices_on: Vec::new(),
            triangles: scene.triangles().iter().copied().map(Some).collect(),
            around: Vec::new(),
            left: scene.triangles().len(),
        };
        for structure in scene.structures() {
            surface.weld(structure.vertices.clone());
        }
        surface.around = vec![Vec::new(); surface.places.len()];
        for triangle in 0..surface.triangles.len() as u32 {
            surface.enter(triangle);
        }
        surface
    }

    /// Makes a point of every place among these vertices.
    fn weld(&mut self, vertices: std::ops::Range<usize>) {
        let mut points: BTreeMap<[u32; 3], u32> = BTreeMap::new();
        for vertex in vertices {
            let position = self.vertices[vertex].position;
            // Adding zero makes one zero of both.
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

    /// The points of a triangle that is left.
    pub(super) fn points(&self, triangle: u32) -> Option<[u32; 3]> {
        let corners = self.triangles[triangle as usize]?;
        Some(corners.map(|vertex| self.point_of[vertex as usize]))
    }

    /// Every triangle that is left, with its points.
    pub(super) fn all(&self) -> impl Iterator<Item = (u32, [u32; 3])> {
        (0..self.triangles.len() as u32).filter_map(|triangle| Some((triangle, self.points(triangle)?)))
    }

    /// The triangles round a point, with their points.
    pub(super) fn round(&self, point: u32) -> impl Iterator<Item = (u32, [u32; 3])> {
        let triangles = self.around[point as usize].iter();
        triangles.filter_map(|triangle| Some((*triangle, self.points(*triangle)?)))
    }

    /// The points joined with a point by an edge, in order.
    pub(super) fn neighbours(&self, point: u32) -> BTreeSet<u32> {
        let joined = self.round(point).flat_map(|(_, points)| points);
        joined.filter(|other| *other != point).collect()
    }

    /// How many triangles an edge has: two inside a surface, one at its border.
    pub(super) fn triangles_at(&self, a: u32, b: u32) -> usize {
        self.round(a).filter(|(_, points)| points.contains(&b)).count()
    }

    /// Normal of three points, its length twice their area.
    pub(super) fn normal(&self, points: [u32; 3]) -> DVec3 {
        let [a, b, c] = points.map(|point| self.places[point as usize]);
        (b - a).cross(c - a)
    }

    /// Moves one point onto another: the triangles with both go, the others follow.
    pub(super) fn collapse(&mut self, from: u32, onto: u32) {
        let moved: Vec<(u32, [u32; 3])> = self.round(from).collect();
        self.around[from as usize].clear();
        for (triangle, points) in moved {
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

    /// Takes a triangle away.
    pub(super) fn remove(&mut self, triangle: u32, points: [u32; 3]) {
        for point in points {
            self.around[point as usize].retain(|other| *other != triangle);
        }
        self.triangles[triangle as usize] = None;
        self.left -= 1;
    }

    /// Of the vertices on a point the one most like a vertex: in normal, then in colour.
    fn counterpart(&self, vertex: u32, onto: u32) -> u32 {
        let wanted = self.vertices[vertex as usize];
        let likeness = |candidate: &u32| likeness(&wanted, &self.vertices[*candidate as usize]);
        let candidates = self.vertices_on[onto as usize].iter();
        let best = candidates.max_by(|a, b| likeness(a).total_cmp(&likeness(b)).then(b.cmp(a)));
        best.copied().unwrap_or(vertex)
    }

    /// The pieces that hang together, each as its triangles in order.
    pub(super) fn pieces(&self) -> Vec<Vec<u32>> {
        let mut pieces: Vec<Vec<u32>> = Vec::new();
        let mut met = vec![false; self.triangles.len()];
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

/// Whether a triangle joins a point with itself.
pub(super) fn is_degenerate([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// How alike two vertices are: in normal, then in colour.
fn likeness(one: &Vertex, other: &Vertex) -> f64 {
    let shades = one.colour.iter().zip(other.colour).map(|(a, b)| f64::from(a.abs_diff(b)));
    f64::from(one.normal.dot(other.normal)) - shades.sum::<f64>() / (3.0 * 255.0)
}
