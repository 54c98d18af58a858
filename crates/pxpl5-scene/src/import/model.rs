//! The common result of the readers of mesh formats. A model has lists only for data that its file contains. A model
//! therefore needs at most seven times the memory of the file.

use pxpl5_sim::parameters::{FileError, FileErrorKind};
use std::hash::{BuildHasher, RandomState};

use glam::{DVec3, Vec3};
use hashbrown::HashTable;

use super::mesh::{Fit, area, seen_by, unit};
use super::polygon::{self, Cut, MAX_CORNERS, has_area};
use super::{Placement, Source};
use crate::config::{DEFAULT_COLOUR, MEMORY_FLOOR_BYTES, MEMORY_TIMES_FILE};
use crate::error::FilePlace;
use crate::scene::{Scene, Vertex};

/// Positions of points. The positions are in single precision if this precision is exact for the file, and otherwise in
/// double precision.
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

    pub(super) fn at(&self, point: usize) -> DVec3 {
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

    /// Returns the least height of a valid triangle, relative to its longest edge. The area of a flatter triangle may
    /// come from rounding alone.
    const fn least_height(&self) -> f64 {
        match self {
            Self::Single(_) => 1e-6,
            Self::Double(_) => 1e-12,
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Single(places) => size_of_val(places.as_slice()),
            Self::Double(places) => size_of_val(places.as_slice()),
        }
    }
}

/// Index of a point, and a number ([`Detail`]) that distinguishes the vertices at this point. The type has only 8
/// bytes, because a file can have many times more corners than points.
pub(super) type Corner = (u32, u32);

/// The two meanings that the second number of a [`Corner`] can have.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Detail {
    /// The index of a normal, counted from 1: a normal of the file, or the computed normal of a flat face. A corner
    /// without a normal in a smoothing group has a number of at least 2^31 instead. This number stands for the
    /// smoothing group.
    Normal,
    /// The colour of a face: red, green and blue, packed with red in the lowest byte.
    Colour,
}

/// A hash table from corners to vertices, with 5 bytes per slot. The model stores the corners themselves. The table is
/// only searched and never iterated, so its order has no effect.
#[derive(Default)]
pub(super) struct Vertices {
    table: HashTable<u32>,
    hasher: RandomState,
}

impl Vertices {
    pub(super) fn of(&mut self, corners: &mut Vec<Corner>, corner: Corner) -> u32 {
        let hash = self.hasher.hash_one(corner);
        if let Some(&existing) = self.table.find(hash, |&vertex| corners[vertex as usize] == corner) {
            return existing;
        }
        let next = corners.len() as u32;
        push_with_slow_growth(corners, corner);
        let hasher = &self.hasher;
        self.table.insert_unique(hash, next, |&vertex| hasher.hash_one(corners[vertex as usize]));
        next
    }
}

/// Adds an item to a list. The list grows by an eighth instead of doubling, because the list may contain most of a file
/// and must not waste memory.
pub(super) fn push_with_slow_growth<T>(list: &mut Vec<T>, item: T) {
    if list.len() == list.capacity() {
        list.reserve_exact(list.len() / 8 + 1024);
    }
    list.push(item);
}

pub(super) struct Model {
    pub(super) places: Places,
    /// Unit normals from the file. A zero vector stands for a missing normal. The list is empty until the first
    /// normal is read.
    pub(super) normals: Vec<Vec3>,
    /// Colours of the points. The list is empty if all points have [`DEFAULT_COLOUR`].
    pub(super) colours: Vec<[u8; 3]>,
    /// Corners of the vertices. The list is empty if each point is exactly one vertex, whose normal has the same index.
    pub(super) corners: Vec<Corner>,
    pub(super) detail: Detail,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Warnings about content of the file that is ignored or may be misinterpreted.
    pub(super) warnings: Vec<String>,
    /// Number of bytes of other files that belong to the model, for example glTF buffers beside the model's file. These
    /// bytes count as part of the model's file.
    pub(super) more_file_bytes: usize,
    /// Number of normals in the file that are NaN, and the position of the first such normal.
    not_numbers: Option<(usize, FilePlace)>,
    /// Number of concave polygons with too many corners for correct triangles.
    too_long: usize,
}

/// Returns a direction from a file scaled to length 1, or a zero vector if the direction has no length.
pub(super) fn direction(v: DVec3) -> Vec3 {
    unit(v).map_or(Vec3::ZERO, |unit| unit.as_vec3())
}

impl Model {
    pub(super) fn new(places: Places) -> Self {
        Self {
            places,
            normals: Vec::new(),
            colours: Vec::new(),
            corners: Vec::new(),
            detail: Detail::Normal,
            triangles: Vec::new(),
            warnings: Vec::new(),
            more_file_bytes: 0,
            not_numbers: None,
            too_long: 0,
        }
    }

    /// Adds a normal of the file. NaN gives a zero vector, so that the normal is computed as if the file had none.
    pub(super) fn push_normal(&mut self, at: FilePlace, normal: DVec3) {
        if !normal.is_finite() {
            self.not_numbers.get_or_insert((0, at)).0 += 1;
        }
        self.normals.push(if normal.is_finite() { direction(normal) } else { Vec3::ZERO });
    }

    /// Replaces the triangles of a concave polygon, which begin at index `first`. The old triangles all share the
    /// polygon's first corner and also cover areas outside the polygon. The new triangles cover only the polygon.
    pub(super) fn cut_polygon(&mut self, first: usize) {
        match polygon::cut(&self.triangles[first..], |vertex| self.places.at(self.point(vertex as usize))) {
            Cut::Fan => {}
            Cut::Ears(ears) => {
                self.triangles.truncate(first);
                self.triangles.extend(ears);
            }
            Cut::TooLong => self.too_long += 1,
        }
    }

    /// Returns the normal of a polygon, or zero for a polygon without area. The triangles from index `first` on form
    /// the polygon and share its first corner.
    pub(super) fn polygon_normal(&self, first: usize) -> Vec3 {
        direction(polygon::normal(&self.triangles[first..], |vertex| self.places.at(self.point(vertex as usize))))
    }

    /// Returns an error if the model needs too much memory for the size of its file. `more_triangles` is the number of
    /// triangles still to be read.
    pub(super) fn check_reading(&self, source: &Source<'_>, more_triangles: usize) -> Result<(), FileError> {
        self.check_reading_bytes(source, more_triangles.saturating_mul(size_of::<[u32; 3]>()))
    }

    /// Returns an error if the model needs too much memory for the size of its files. `more` is the number of bytes
    /// that the reader needs in addition to the model.
    pub(super) fn check_reading_bytes(&self, source: &Source<'_>, more: usize) -> Result<(), FileError> {
        let of_files = source.bytes.len() + self.more_file_bytes;
        let found = of_files + self.lists_bytes() + self.corners.len() * TABLE_BYTES;
        check_memory(source.name, found.saturating_add(more), of_files)
    }

    fn lists_bytes(&self) -> usize {
        self.places.bytes()
            + size_of_val(self.normals.as_slice())
            + size_of_val(self.colours.as_slice())
            + size_of_val(self.corners.as_slice())
            + size_of_val(self.triangles.as_slice())
    }

    fn corner_places(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|vertex| self.places.at(self.point(vertex as usize)))
    }

    fn check_areas(&self, name: &str) -> Result<(), FileError> {
        let least = self.places.least_height();
        if self.triangles.iter().any(|&t| has_area(self.corner_places(t), least)) {
            return Ok(());
        }
        let expected = if self.triangles.is_empty() { "triangle" } else { "triangle with an area" };
        Err(crate::error::nothing_to_draw(name, expected))
    }

    /// Makes a scene from the mesh. The bytes of the file may be freed before this call.
    pub(super) fn into_scene(
        mut self,
        name: &str,
        file_bytes: usize,
        placement: Placement,
    ) -> Result<Scene, FileError> {
        if let Some((count, first)) = self.not_numbers {
            let what = counted(count, "normal");
            let how = "computed from the faces instead";
            self.warnings.insert(0, format!("{what} without numbers, first in {first}: {how}"));
        }
        if self.too_long > 0 {
            self.warnings.push(format!(
                "{} with a notch and more than {MAX_CORNERS} corners: the notch is filled",
                counted(self.too_long, "polygon")
            ));
        }
        let warnings = std::mem::take(&mut self.warnings);
        let file_bytes = file_bytes + self.more_file_bytes;
        // Remove unused vertices, because they would change the size and position of the model.
        if self.corners.is_empty() {
            self.remove_unused_points();
        }
        // Check memory and content before the scene is made.
        self.check_memory(name, file_bytes)?;
        self.check_areas(name)?;
        let points = (0..self.vertices()).map(|vertex| (self.places.at(self.point(vertex)), 0.0));
        let fit = placement.fit(points);
        let vertices = self.fitted_vertices(&fit);
        Ok(seen_by(placement.motion(), name, vertices, self.triangles, Vec::new()).with_warnings(warnings))
    }

    fn vertices(&self) -> usize {
        if self.corners.is_empty() { self.places.len() } else { self.corners.len() }
    }

    fn point(&self, vertex: usize) -> usize {
        self.corners.get(vertex).map_or(vertex, |corner| corner.0 as usize)
    }

    /// Returns the normal that the file contains for a vertex, or zero if the file has none.
    fn given_normal(&self, vertex: usize) -> Vec3 {
        let number = match (self.corners.get(vertex), self.detail) {
            (Some(corner), Detail::Normal) => corner.1 as usize,
            _ => self.point(vertex) + 1,
        };
        number.checked_sub(1).and_then(|index| self.normals.get(index)).copied().unwrap_or(Vec3::ZERO)
    }

    fn colour(&self, vertex: usize) -> [u8; 3] {
        match (self.corners.get(vertex), self.detail) {
            (Some(corner), Detail::Colour) => packed_colour(corner.1),
            _ => self.colours.get(self.point(vertex)).copied().unwrap_or(DEFAULT_COLOUR),
        }
    }

    /// Returns the vertices of the scene, rounded to single precision. A missing normal becomes the mean of the normals
    /// of the vertex's triangles, weighted by area. If these triangles have no area, the normal is +z.
    fn fitted_vertices(&self, fit: &Fit) -> Vec<Vertex> {
        let mut vertices = Vec::with_capacity(self.vertices());
        vertices.extend((0..self.vertices()).map(|vertex| Vertex {
            position: fit.place(self.places.at(self.point(vertex))).as_vec3(),
            normal: self.given_normal(vertex),
            colour: self.colour(vertex),
        }));
        if vertices.iter().all(|vertex| vertex.normal != Vec3::ZERO) {
            return vertices;
        }
        // Compute missing normals in parts, to limit the memory for the sums.
        let step = self.shadings_per_pass();
        for first in (0..self.shaded()).step_by(step) {
            self.complete_normals(&mut vertices, fit, first, step);
        }
        vertices
    }

    /// Returns the index of this vertex's group. All vertices of a group share one mean normal. Faces of different
    /// colours share groups at their common points. Faces of different smoothing groups share no group.
    fn shading(&self, vertex: usize) -> usize {
        if self.detail == Detail::Colour { self.point(vertex) } else { vertex }
    }

    fn shaded(&self) -> usize {
        if self.detail == Detail::Colour { self.places.len() } else { self.vertices() }
    }

    /// Returns the number of groups of vertices whose mean normals are computed in one pass. If one pass computed all
    /// groups, its sums in double precision would need as much memory as the positions.
    fn shadings_per_pass(&self) -> usize {
        (self.shaded() / 8).max(1 << 16)
    }

    /// Computes the mean normals of `count` groups of vertices, from group `first` on. Each vertex without a normal
    /// gets the mean normal of its group.
    fn complete_normals(&self, vertices: &mut [Vertex], fit: &Fit, first: usize, count: usize) {
        let mut sums = vec![DVec3::ZERO; count.min(self.shaded() - first)];
        for triangle in &self.triangles {
            let shadings = triangle.map(|corner| self.shading(corner as usize));
            if shadings.iter().all(|shading| shading.wrapping_sub(first) >= sums.len()) {
                continue;
            }
            // Areas are computed after scaling. The areas of very small models would otherwise leave the range of f64.
            let area = area(self.corner_places(*triangle).map(|place| fit.place(place)));
            for shading in shadings {
                if let Some(sum) = sums.get_mut(shading.wrapping_sub(first)) {
                    *sum += area;
                }
            }
        }
        for (number, vertex) in vertices.iter_mut().enumerate() {
            if let (Some(sum), Vec3::ZERO) = (sums.get(self.shading(number).wrapping_sub(first)), vertex.normal) {
                vertex.normal = unit(*sum).unwrap_or(DVec3::Z).as_vec3();
            }
        }
    }

    /// Removes the vertices that no triangle uses. Unused vertices would change the model's position and size, and
    /// would cost time in every frame.
    fn remove_unused_points(&mut self) {
        let mut used = vec![false; self.places.len()];
        for &corner in self.triangles.iter().flatten() {
            used[corner as usize] = true;
        }
        if used.iter().all(|&used| used) {
            return;
        }
        // Compute the new index of each point, and renumber the corners.
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

    /// Returns an error if making the scene needs too much memory. The bytes of the file are not counted.
    fn check_memory(&self, name: &str, file_bytes: usize) -> Result<(), FileError> {
        let sums = self.shadings_per_pass().min(self.shaded()) * size_of::<DVec3>();
        check_memory(name, self.lists_bytes() + sums + self.vertices() * size_of::<Vertex>(), file_bytes)
    }
}

fn packed_colour(packed: u32) -> [u8; 3] {
    let [red, green, blue, _] = packed.to_le_bytes();
    [red, green, blue]
}

/// Returns a number with its noun in singular or plural, for example "3 normals".
pub(super) fn counted(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

/// Returns an error if a model needs more than [`MEMORY_TIMES_FILE`] times the size of its file plus
/// [`MEMORY_FLOOR_BYTES`].
fn check_memory(name: &str, found: usize, file_bytes: usize) -> Result<(), FileError> {
    let expected = MEMORY_TIMES_FILE * file_bytes as u64 + MEMORY_FLOOR_BYTES;
    if found as u64 <= expected {
        return Ok(());
    }
    let expected = format_args!("a model that takes at most {expected} bytes, as its size allows");
    Err(FileError::new(FileErrorKind::TooLarge, expected, found).in_file(name))
}

/// Greatest number of bytes per vertex in the hash table. A slot has five bytes, and between 7/16 and 7/8 of the slots
/// are used. A growing table takes 1.5 times its memory.
const TABLE_BYTES: usize = 17;

/// Keeps the items whose element in `keep` is true, and frees the unused memory. An empty list stays empty.
fn retain<T>(items: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    items.retain(|_| keep.next() == Some(&true));
    items.shrink_to_fit();
}
