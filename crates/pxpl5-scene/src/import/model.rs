//! What the readers of meshes end in: columns that hold no more than the file says, so that a model takes at most seven times its file.

use glam::{DVec3, Vec3};

use super::mesh::{Fit, area, seen_by, unit};
use super::{Placement, Source};
use crate::config::{DEFAULT_COLOUR, MEMORY_FLOOR_BYTES, MEMORY_TIMES_FILE};
use crate::error::LoadError;
use crate::scene::{Scene, Vertex};

/// Places of points, in the least precision that holds them exactly.
pub(super) enum Places {
    Single(Vec<Vec3>),
    Double(Vec<DVec3>),
}

impl Places {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Single(places) => places.len(),
            Self::Double(places) => places.len(),
        }
    }

    pub(super) fn push(&mut self, place: DVec3) {
        match self {
            Self::Single(places) => places.push(place.as_vec3()),
            Self::Double(places) => places.push(place),
        }
    }

    pub(super) fn reserve_exact(&mut self, count: usize) {
        match self {
            Self::Single(places) => places.reserve_exact(count),
            Self::Double(places) => places.reserve_exact(count),
        }
    }

    fn at(&self, point: usize) -> DVec3 {
        match self {
            Self::Single(places) => places[point].as_dvec3(),
            Self::Double(places) => places[point],
        }
    }

    fn retain(&mut self, keep: &[bool]) {
        match self {
            Self::Single(places) => retain(places, keep),
            Self::Double(places) => retain(places, keep),
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Single(places) => size_of_val(places.as_slice()),
            Self::Double(places) => size_of_val(places.as_slice()),
        }
    }
}

/// A point, and its normal counted from 1; 0 for none. Short, since a file can have many times more of them than points.
pub(super) type Corner = (u32, u32);

/// A mesh as its file has it.
pub(super) struct Model {
    pub(super) places: Places,
    /// Of unit length; zero where the file gives none; empty as long as it has given none at all.
    pub(super) normals: Vec<Vec3>,
    /// Of each vertex; empty where all have [`DEFAULT_COLOUR`].
    pub(super) colours: Vec<[u8; 3]>,
    /// The vertices; empty where each point is a vertex, with the normal of its number.
    pub(super) corners: Vec<Corner>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// A direction of a file with length 1, as a vertex has it; zero for one without length.
pub(super) fn direction(v: DVec3) -> Vec3 {
    unit(v).map_or(Vec3::ZERO, |unit| unit.as_vec3())
}

impl Model {
    pub(super) fn new(places: Places) -> Self {
        Self { places, normals: Vec::new(), colours: Vec::new(), corners: Vec::new(), triangles: Vec::new() }
    }

    /// A fitted scene of the mesh. The file's own bytes are not needed any more.
    pub(super) fn into_scene(
        mut self,
        name: &str,
        file_bytes: usize,
        placement: Placement,
    ) -> Result<Scene, LoadError> {
        if self.triangles.is_empty() {
            return Err(LoadError::NothingToDraw { file: name.to_owned(), expected: "triangle" });
        }
        if self.corners.is_empty() {
            self.drop_unused();
        }
        self.check_memory(name, file_bytes)?;
        let points = (0..self.vertices()).map(|vertex| (self.places.at(self.point(vertex)), 0.0));
        let fit = placement.fit(points);
        let vertices = self.fitted_vertices(&fit);
        Ok(seen_by(placement.motion(), name, vertices, self.triangles, Vec::new()))
    }

    fn vertices(&self) -> usize {
        if self.corners.is_empty() { self.places.len() } else { self.corners.len() }
    }

    /// The point of a vertex.
    fn point(&self, vertex: usize) -> usize {
        self.corners.get(vertex).map_or(vertex, |corner| corner.0 as usize)
    }

    /// The normal that the file gives a vertex; zero where it gives none.
    fn given_normal(&self, vertex: usize) -> Vec3 {
        let number = self.corners.get(vertex).map_or(vertex + 1, |corner| corner.1 as usize);
        number.checked_sub(1).and_then(|index| self.normals.get(index)).copied().unwrap_or(Vec3::ZERO)
    }

    /// The vertices of a scene, rounded to single precision. Where the file gives no normal it is the mean over the triangles around
    /// the point, weighted by area; +z if there are only triangles without area.
    fn fitted_vertices(&self, fit: &Fit) -> Vec<Vertex> {
        let mut vertices = Vec::with_capacity(self.vertices());
        vertices.extend((0..self.vertices()).map(|vertex| Vertex {
            position: fit.place(self.places.at(self.point(vertex))).as_vec3(),
            normal: self.given_normal(vertex),
            colour: self.colours.get(vertex).copied().unwrap_or(DEFAULT_COLOUR),
        }));
        if vertices.iter().all(|vertex| vertex.normal != Vec3::ZERO) {
            return vertices;
        }
        let step = self.summed_at_once();
        for first in (0..self.places.len()).step_by(step) {
            self.complete_normals(&mut vertices, fit, first, step);
        }
        vertices
    }

    /// Points whose areas are summed up at a time: sums are in double precision, and all at once would be as much as the places.
    fn summed_at_once(&self) -> usize {
        (self.places.len() / 8).max(1 << 16)
    }

    /// Gives a normal to every vertex without one on `count` points from `first` on.
    fn complete_normals(&self, vertices: &mut [Vertex], fit: &Fit, first: usize, count: usize) {
        let mut sums = vec![DVec3::ZERO; count.min(self.places.len() - first)];
        for triangle in &self.triangles {
            let points = triangle.map(|corner| self.point(corner as usize));
            if points.iter().all(|point| point.wrapping_sub(first) >= sums.len()) {
                continue;
            }
            // Of places that are fitted already: the areas of the tiniest models would leave the range of f64.
            let area = area(points.map(|point| fit.place(self.places.at(point))));
            for point in points {
                if let Some(sum) = sums.get_mut(point.wrapping_sub(first)) {
                    *sum += area;
                }
            }
        }
        for (number, vertex) in vertices.iter_mut().enumerate() {
            if let (Some(sum), Vec3::ZERO) = (sums.get(self.point(number).wrapping_sub(first)), vertex.normal) {
                vertex.normal = unit(*sum).unwrap_or(DVec3::Z).as_vec3();
            }
        }
    }

    /// Keeps the vertices that triangles use: others must not decide on the fit, nor cost time in every frame.
    fn drop_unused(&mut self) {
        let mut used = vec![false; self.places.len()];
        for &corner in self.triangles.iter().flatten() {
            used[corner as usize] = true;
        }
        if used.iter().all(|&used| used) {
            return;
        }
        let mut moved = Vec::with_capacity(used.len());
        let mut kept = 0;
        for &is_used in &used {
            moved.push(kept);
            kept += u32::from(is_used);
        }
        for corner in self.triangles.iter_mut().flatten() {
            *corner = moved[*corner as usize];
        }
        drop(moved);
        self.places.retain(&used);
        retain(&mut self.normals, &used);
        retain(&mut self.colours, &used);
    }

    /// What the model takes while its scene is made, besides the file.
    fn check_memory(&self, name: &str, file_bytes: usize) -> Result<(), LoadError> {
        let lists = self.places.bytes()
            + size_of_val(self.normals.as_slice())
            + size_of_val(self.colours.as_slice())
            + size_of_val(self.corners.as_slice())
            + size_of_val(self.triangles.as_slice());
        let sums = self.summed_at_once().min(self.places.len()) * size_of::<DVec3>();
        check_memory(name, lists + sums + self.vertices() * size_of::<Vertex>(), file_bytes)
    }
}

/// Refuses what takes more than [`MEMORY_TIMES_FILE`] times its file.
fn check_memory(name: &str, found: usize, file_bytes: usize) -> Result<(), LoadError> {
    let expected = MEMORY_TIMES_FILE * file_bytes as u64 + MEMORY_FLOOR_BYTES;
    let found = found as u64;
    if found <= expected { Ok(()) } else { Err(LoadError::TooMuchMemory { file: name.to_owned(), expected, found }) }
}

/// Refuses triangles, before they are made, that no file of this size needs: of some that come on top of others.
pub(super) fn check_triangles(source: &Source<'_>, others: usize, more: usize) -> Result<(), LoadError> {
    check_memory(source.name, (others + more) * size_of::<[u32; 3]>() + source.bytes.len(), source.bytes.len())
}

/// Keeps what is to be kept, and no room for the rest; of an empty list there is nothing to keep.
fn retain<T>(items: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    items.retain(|_| keep.next() == Some(&true));
    items.shrink_to_fit();
}
