use crate::placed::RecentViews;
use crate::view::DisplayStructure;
use glam::Vec3;
use pxpl5_geometry::kernel::TRIANGLE_WORDS;
use pxpl5_geometry::{Triangle, WorldSphere};
use std::ops::Range;
use std::sync::Arc;

/// A number of triangles and a number of spheres, or of their commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PrimitiveCounts {
    pub triangles: u32,
    pub spheres: u32,
}

impl PrimitiveCounts {
    pub const fn total(self) -> u32 {
        self.triangles + self.spheres
    }

    /// Returns the number of vertices: three corners of each triangle, and the centre of each sphere.
    pub const fn vertices(self) -> u64 {
        3 * self.triangles as u64 + self.spheres as u64
    }
}

/// All primitives to draw, divided into structures.
#[derive(Clone, Debug, Default)]
pub struct DisplayList {
    /// Positions of the vertices, in the coordinates of their structure.
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    /// Colours of the vertices: red, green and blue.
    pub colours: Vec<[u8; 3]>,
    /// Corners of each triangle, as indices of `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// Spheres, in the coordinates of their structure.
    pub spheres: Vec<WorldSphere>,
    /// Structures. The ranges of triangles and of spheres of successive structures follow each other without gaps.
    pub structures: Vec<DisplayStructure>,
    /// Unit vector towards the light source: in head coordinates for structures that move with the head, otherwise in
    /// room coordinates.
    pub towards_light: Vec3,
    /// Fraction of the colour that is visible without the light, 0 to 1.
    pub ambient: f32,
    /// Fraction of the colour that light perpendicular to the surface adds, 0 to 1.
    pub diffuse: f32,
    /// Background colour: red, green and blue.
    pub background: [u8; 3],
    /// True if surfaces have no highlight. A highlight needs one direction to the eye for the whole picture, which the
    /// face of a cube does not have.
    pub is_matte: bool,
    /// True if the compiled program of Slats draws the list, with planes in single precision.
    pub is_single: bool,
    /// Cache of placed structures, which all graphics processors share. Code that changes the list must empty this
    /// cache.
    pub recent: RecentViews,
}

impl DisplayList {
    /// Sorts each structure's vertices by their first use in its triangles. Vertices of the same triangles are then
    /// near each other in memory.
    ///
    /// A vertex that several structures use is duplicated. A vertex that no triangle uses is removed.
    ///
    /// # Panics
    ///
    /// Panics if a structure refers to a missing triangle, or a triangle to a missing vertex.
    #[must_use]
    pub fn with_vertices_in_order(mut self) -> Self {
        let mut order: Vec<usize> = Vec::with_capacity(self.positions.len());
        // For each old index: the new index in the last structure that used the vertex.
        let mut renumbered = vec![0; self.positions.len()];
        // Give every vertex a new number at its first use in each structure.
        for structure in &self.structures {
            let first = order.len();
            for corner in self.triangles[structure.triangles.clone()].as_flattened_mut() {
                let old = *corner as usize;
                let is_known = renumbered[old] >= first && order.get(renumbered[old]) == Some(&old);
                if !is_known {
                    renumbered[old] = order.len();
                    order.push(old);
                }
                *corner = renumbered[old] as u32;
            }
        }
        self.positions = order.iter().map(|old| self.positions[*old]).collect();
        self.normals = order.iter().map(|old| self.normals[*old]).collect();
        self.colours = order.iter().map(|old| self.colours[*old]).collect();
        self.recent = RecentViews::default();
        self
    }

    /// Replaces the colours by lit colours, for [`Shading::Precomputed`](crate::Shading::Precomputed).
    ///
    /// A vertex gets ambient light, and diffuse light if its normal points towards the light. Structures are lit at
    /// their original positions, before edits. Spheres keep their colours.
    #[must_use]
    pub fn with_precomputed_colours(mut self) -> Self {
        let towards_light = self.towards_light.to_array().map(f64::from);
        for (colour, normal) in self.colours.iter_mut().zip(&self.normals) {
            // A normal of length zero counts as a normal towards the light.
            let [x, y, z] = normal.to_array().map(f64::from);
            let length = (x * x + y * y + z * z).sqrt();
            let along = x * towards_light[0] + y * towards_light[1] + z * towards_light[2];
            let cosine = if length > 0.0 { along / length } else { 1.0 };
            let lit = f64::from(self.ambient) + f64::from(self.diffuse) * cosine.max(0.0);
            *colour = colour.map(|part| (f64::from(part) * lit.clamp(0.0, 1.0)).round() as u8);
        }
        self.recent = RecentViews::default();
        self
    }

    /// Returns a triangle with the positions, normals and colours of its corners.
    ///
    /// # Panics
    ///
    /// Panics if there is no triangle with index `number`, or if the triangle refers to a missing vertex.
    pub fn triangle(&self, number: usize) -> Triangle {
        let corners = self.triangles[number].map(|i| i as usize);
        Triangle {
            positions: corners.map(|i| self.positions[i]),
            normals: corners.map(|i| self.normals[i]),
            colours: corners.map(|i| self.colours[i]),
        }
    }

    /// Returns the positions of a triangle's corners.
    ///
    /// # Panics
    ///
    /// Panics if there is no triangle with index `number`, or if the triangle refers to a missing vertex.
    pub fn corners(&self, number: usize) -> [Vec3; 3] {
        self.triangles[number].map(|i| self.positions[i as usize])
    }
}

/// The primitives of one graphics processor (GP), or a clump of these primitives.
///
/// The GP holds the triangles and the spheres with the indices `first`, `first + step`, `first + 2 step` and so on.
#[derive(Clone, Debug)]
pub struct Share {
    pub(crate) list: Arc<DisplayList>,
    first: usize,
    step: usize,
    triangles: Range<usize>,
    spheres: Range<usize>,
}

impl Share {
    /// Bytes of a triangle in a graphics processor's memory: three corners of position, normal and colour, 32 bytes
    /// each (assumed).
    pub const TRIANGLE_BYTES: u64 = 4 * TRIANGLE_WORDS as u64;

    /// Bytes of a sphere in a graphics processor's memory: centre, radius, colour and header (assumed).
    pub const SPHERE_BYTES: u64 = 32;

    /// Returns the share of graphics processor `index` among `of` graphics processors. Primitives are distributed in
    /// turn.
    ///
    /// # Panics
    ///
    /// Panics if `of` is zero. A valid configuration has at least one graphics processor.
    pub fn new(list: Arc<DisplayList>, index: usize, of: usize) -> Self {
        assert!(of > 0, "primitives need a graphics processor");
        let triangles = 0..dealt(list.triangles.len(), index, of);
        let spheres = 0..dealt(list.spheres.len(), index, of);
        Self { list, first: index, step: of, triangles, spheres }
    }

    pub fn list(&self) -> &Arc<DisplayList> {
        &self.list
    }

    /// Returns a share with the same indices of primitives in the display list `list`. This list must have the same
    /// structures as the current list, but its vertices may be in a different order.
    #[must_use]
    pub fn with_list(&self, list: Arc<DisplayList>) -> Self {
        Self { list, ..self.clone() }
    }

    pub fn counts(&self) -> PrimitiveCounts {
        PrimitiveCounts { triangles: self.triangles.len() as u32, spheres: self.spheres.len() as u32 }
    }

    /// Returns the numbers of primitives in the chosen structures. `chosen` has one entry for each structure.
    pub fn chosen_counts(&self, chosen: &[bool]) -> PrimitiveCounts {
        let mut counts = PrimitiveCounts::default();
        for (structure, _) in self.list.structures.iter().zip(chosen).filter(|(_, chosen)| **chosen) {
            counts.triangles += self.held_triangles(&structure.triangles).len() as u32;
            counts.spheres += self.held_spheres(&structure.spheres).len() as u32;
        }
        counts
    }

    /// Divides the share into clumps of at most `size` primitives. Triangles come first, then spheres.
    ///
    /// # Panics
    ///
    /// Panics if `size` is zero.
    pub fn clumps(&self, size: usize) -> impl Iterator<Item = Self> {
        let share = self.clone();
        let n_triangles = self.triangles.len();
        let all = n_triangles + self.spheres.len();
        (0..all).step_by(size).map(move |from| {
            let to = from + size;
            let triangles = part(&share.triangles, from, to);
            let spheres = part(&share.spheres, from.saturating_sub(n_triangles), to.saturating_sub(n_triangles));
            Self { triangles, spheres, ..share.clone() }
        })
    }

    #[must_use]
    pub fn nothing(&self) -> Self {
        Self { triangles: 0..0, spheres: 0..0, ..self.clone() }
    }

    /// Returns the size of the primitives in the graphics processor's memory, in bytes.
    pub fn bytes(&self) -> u64 {
        let PrimitiveCounts { triangles, spheres } = self.counts();
        u64::from(triangles) * Self::TRIANGLE_BYTES + u64::from(spheres) * Self::SPHERE_BYTES
    }

    /// Returns the indices of the graphics processor's triangles in the display list, also for a clump.
    pub(crate) fn all_triangles(&self) -> impl ExactSizeIterator<Item = usize> + use<> {
        (self.first..self.list.triangles.len()).step_by(self.step)
    }

    /// Returns the indices of the graphics processor's spheres in the display list, also for a clump.
    pub(crate) fn all_spheres(&self) -> impl ExactSizeIterator<Item = usize> + use<> {
        (self.first..self.list.spheres.len()).step_by(self.step)
    }

    /// Returns the range of a structure's triangles among the triangles of the graphics processor. `of` is the
    /// structure's range in the display list.
    pub(crate) fn held_places(&self, of: &Range<usize>) -> Range<usize> {
        self.places(&self.triangles, of)
    }

    /// Returns the range of a structure's spheres among the spheres of the graphics processor. `of` is the structure's
    /// range in the display list.
    pub(crate) fn held_places_of_spheres(&self, of: &Range<usize>) -> Range<usize> {
        self.places(&self.spheres, of)
    }

    pub(crate) fn held_triangles(&self, of: &Range<usize>) -> impl ExactSizeIterator<Item = usize> + use<> {
        self.held(&self.triangles, of)
    }

    pub(crate) fn held_spheres(&self, of: &Range<usize>) -> impl ExactSizeIterator<Item = usize> + use<> {
        self.held(&self.spheres, of)
    }

    /// Returns the indices of a structure's primitives that belong to this share. `of` is the structure's range in the
    /// display list, and `positions` the range of the share.
    fn held(&self, positions: &Range<usize>, of: &Range<usize>) -> impl ExactSizeIterator<Item = usize> + use<> {
        let first = self.first;
        let step = self.step;
        self.places(positions, of).map(move |k| first + k * step)
    }

    fn places(&self, positions: &Range<usize>, of: &Range<usize>) -> Range<usize> {
        let from = dealt(of.start, self.first, self.step).max(positions.start);
        let to = dealt(of.end, self.first, self.step).min(positions.end);
        from..to.max(from)
    }
}

/// Returns how many of the first `all` primitives belong to graphics processor `index` of `gps`.
fn dealt(all: usize, index: usize, gps: usize) -> usize {
    all.saturating_sub(index).div_ceil(gps)
}

fn part(range: &Range<usize>, from: usize, to: usize) -> Range<usize> {
    (range.start + from).min(range.end)..(range.start + to).min(range.end)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::ModelFrame;
    use pxpl5_geometry::Culling;

    #[test]
    fn shares_have_each_primitive_once() {
        let list = Arc::new(DisplayList { triangles: vec![[0; 3]; 417], ..DisplayList::default() });
        let shares: Vec<_> = (0..12).map(|i| Share::new(Arc::clone(&list), i, 12)).collect();
        for range in [0..417, 5..17, 100..101, 416..417, 3..3] {
            let mut held: Vec<_> = shares.iter().flat_map(|share| share.held_triangles(&range)).collect();
            held.sort_unstable();
            assert_eq!(held, range.collect::<Vec<_>>());
        }
        assert_eq!(shares.iter().map(|share| share.counts().triangles).sum::<u32>(), 417);
    }

    #[test]
    fn sorting_vertices_changes_no_triangle() {
        let structure =
            |triangles| DisplayStructure { triangles, spheres: 0..0, frame: ModelFrame::World, culling: Culling::None };
        // Vertex 0 is used last, vertices 3 and 4 are used by both structures, and vertex 5 is used by no structure.
        let list = DisplayList {
            positions: (0..7).map(|i| Vec3::splat(i as f32)).collect(),
            normals: (0..7).map(|i| Vec3::splat(-i as f32)).collect(),
            colours: (0..7).map(|i| [i; 3]).collect(),
            triangles: vec![[6, 3, 4], [4, 3, 1], [3, 2, 4], [2, 0, 3]],
            structures: vec![structure(0..2), structure(2..4)],
            ..DisplayList::default()
        };
        let ordered = list.clone().with_vertices_in_order();
        assert!((0..4).all(|number| ordered.triangle(number) == list.triangle(number)));
        assert_eq!(ordered.triangles, [[0, 1, 2], [2, 1, 3], [4, 5, 6], [5, 7, 4]]);
        assert_eq!((ordered.positions.len(), ordered.normals.len(), ordered.colours.len()), (8, 8, 8));
    }

    #[test]
    fn clumps_have_each_primitive_of_a_share_once_and_begin_with_the_triangles() {
        let sphere = WorldSphere { centre: Vec3::ZERO, radius: 1.0, colour: [0; 3] };
        let list = DisplayList { triangles: vec![[0; 3]; 70], spheres: vec![sphere; 25], ..DisplayList::default() };
        let clumps: Vec<_> = Share::new(Arc::new(list), 0, 1).clumps(30).collect();
        let counts: Vec<_> = clumps.iter().map(|c| (c.counts().triangles, c.counts().spheres)).collect();
        assert_eq!(counts, [(30, 0), (30, 0), (10, 20), (0, 5)]);
        let triangles: Vec<_> = clumps.iter().flat_map(|c| c.held_triangles(&(0..70))).collect();
        assert_eq!(triangles, (0..70).collect::<Vec<_>>());
        let spheres: Vec<_> = clumps.iter().flat_map(|c| c.held_spheres(&(0..25))).collect();
        assert_eq!(spheres, (0..25).collect::<Vec<_>>());
    }
}
