//! Drawing of triangles into the six faces of a cube.

use crate::cube_faces::depth::DepthRange;
use crate::cube_faces::edges::{Columns, Crossing, Edges, Linear};
use crate::cube_faces::rows::{OnFace, Shade, draw};
use address_recalculation::{CubeFace, FaceGeometry, FaceSet};
use glam::DVec3;

/// A vertex of a triangle, with its shaded colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Position in the world in metres.
    pub place: DVec3,
    /// Shaded colour, 0x00RRGGBB.
    pub colour: u32,
}

/// Counts of the triangles and texels that were drawn on cube faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DrawCounts {
    /// Number of triangles to draw, visible or not.
    pub triangles: u64,
    /// Number of faces that a triangle can touch, summed over all triangles. A real machine transforms a triangle once
    /// for each of these faces.
    pub on_faces: u64,
    /// Number of texels that triangles cover. A texel counts once for each triangle that covers it, visible or not.
    pub texels: u64,
}

impl DrawCounts {
    pub const fn add(&mut self, other: Self) {
        self.triangles += other.triangles;
        self.on_faces += other.on_faces;
        self.texels += other.texels;
    }
}

/// The geometry and the range of depths of the six faces around the viewer's head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CubeView {
    pub geometry: FaceGeometry,
    pub depth: DepthRange,
}

struct FaceView {
    face: CubeFace,
    axes: [DVec3; 3],
    columns: Columns,
    texels: i64,
    tangent: f64,
    near_m: f64,
    depth: [f64; 2],
}

impl CubeView {
    /// Draws triangles as seen from an eye position. Each texel shows the nearest triangle. If two triangles are
    /// equally near, the first triangle is visible.
    ///
    /// # Panics
    ///
    /// Panics if the number of texels along an edge of the faces differs from the number in `geometry`.
    pub fn draw(
        &self,
        eye: DVec3,
        triangles: impl IntoIterator<Item = [Corner; 3]>,
        faces: &mut FaceSet,
    ) -> DrawCounts {
        assert_eq!(faces.texels(), self.geometry.texels, "faces of another size");
        let views = CubeFace::ALL.map(|face| self.face(face));
        let mut drawing = DrawCounts::default();
        for corners in triangles {
            drawing.triangles += 1;
            let seen = corners.map(|corner| corner.place - eye);
            let colours = corners.map(|corner| corner.colour);
            // Draw the triangle on every face that it may touch.
            for view in &views {
                if let Some(places) = view.in_sight(seen) {
                    drawing.on_faces += 1;
                    drawing.texels += view.triangle(places, colours, faces);
                }
            }
        }
        drawing
    }

    fn face(&self, face: CubeFace) -> FaceView {
        let axis = |axis: [i64; 3]| DVec3::from_array(axis.map(|component| component as f64));
        let inner = f64::from(self.geometry.inner());
        // Texel middles, in tangents from the face's middle.
        let columns = Columns { first: (1.0 - 2.0 * f64::from(self.geometry.guard)) / inner - 1.0, step: 2.0 / inner };
        FaceView {
            face,
            axes: [axis(face.right()), -axis(face.up()), axis(face.forward())],
            columns,
            texels: i64::from(self.geometry.texels),
            tangent: self.geometry.tangent(),
            near_m: self.depth.near_m,
            depth: self.depth.linear(),
        }
    }
}

impl FaceView {
    /// Returns the corners in the axes of the face. Returns `None` if all corners are outside the same side of the
    /// face's pyramid of sight.
    fn in_sight(&self, seen: [DVec3; 3]) -> Option<[DVec3; 3]> {
        let places = seen.map(|v| DVec3::from_array(self.axes.map(|axis| v.dot(axis))));
        let all = |is_out: &dyn Fn(&DVec3) -> bool| places.iter().all(is_out);
        let is_out = all(&|p| p.z < self.near_m)
            || all(&|p| p.x > self.tangent * p.z)
            || all(&|p| -p.x > self.tangent * p.z)
            || all(&|p| p.y > self.tangent * p.z)
            || all(&|p| -p.y > self.tangent * p.z);
        (!is_out && places.iter().all(|p| p.is_finite())).then_some(places)
    }

    /// Returns the range of rows that a triangle can touch. The range covers the triangle's part beyond the near plane,
    /// with one additional row on each side.
    fn rows(&self, places: [DVec3; 3]) -> [i64; 2] {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for (i, place) in places.iter().enumerate() {
            let next = places[(i + 1) % 3];
            // Corners beyond the near plane project directly.
            if place.z >= self.near_m {
                include(&mut range, place.y / place.z);
            }
            // Edges through the near plane contribute their intersection with it.
            if (place.z >= self.near_m) != (next.z >= self.near_m) {
                let share = (self.near_m - place.z) / (next.z - place.z);
                include(&mut range, (place.y + (next.y - place.y) * share) / self.near_m);
            }
        }
        let row = |y: f64| (y - self.columns.first) / self.columns.step;
        let last = self.texels as f64;
        [(row(range[0]) - 1.0).clamp(0.0, last).floor() as i64, (row(range[1]) + 2.0).clamp(0.0, last).ceil() as i64]
    }

    fn triangle(&self, places: [DVec3; 3], colours: [u32; 3], faces: &mut FaceSet) -> u64 {
        let Some(edges) = Edges::new(places) else { return 0 };
        let triangle = OnFace {
            face: self.face,
            columns: self.columns,
            texels: self.texels,
            crossings: edges.edges.map(|edge| Crossing::new(edge, self.columns)),
            reciprocal: edges.reciprocal(),
            depth: self.depth,
            shade: shade(&edges, colours),
        };
        draw(&triangle, self.rows(places), faces)
    }
}

fn include(range: &mut [f64; 2], value: f64) {
    range[0] = range[0].min(value);
    range[1] = range[1].max(value);
}

fn shade(edges: &Edges, colours: [u32; 3]) -> Shade {
    if colours[0] == colours[1] && colours[0] == colours[2] {
        return Shade::Flat(colours[0] & 0x00FF_FFFF);
    }
    let part = |shift: u32| {
        let parts = colours.map(|colour| f64::from(colour >> shift & 0xFF) / edges.determinant);
        Linear::sum(edges.edges, parts)
    };
    Shade::Smooth([16, 8, 0].map(part))
}
