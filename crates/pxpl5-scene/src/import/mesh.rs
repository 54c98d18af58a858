//! Meshes in double precision, and functions for all models: cutting polygons into triangles, computing normals, and
//! fitting a model into the view.

use glam::{DVec3, Vec3};

use crate::config::IMPORT_RADIUS_M;
use crate::motion::{HeadMotion, HeadPath};
use crate::scene::{Lighting, Scene, SceneParts, Sphere, Vertex, bounding_sphere};
use crate::sway::Sway;

/// A mesh in the coordinates of a file, before the mesh is scaled.
#[derive(Default)]
pub(crate) struct Mesh {
    pub(crate) positions: Vec<DVec3>,
    /// Normals of the vertices, of any length. A zero vector stands for a missing normal. The list is empty until a
    /// vertex with a normal is added.
    pub(crate) normals: Vec<DVec3>,
    pub(crate) colours: Vec<[u8; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds a vertex and returns its index. A zero vector as `normal` stands for a missing normal.
    pub(crate) fn push(&mut self, position: DVec3, normal: DVec3, colour: [u8; 3]) -> u32 {
        let index = self.positions.len() as u32;
        if normal != DVec3::ZERO || !self.normals.is_empty() {
            self.normals.resize(self.positions.len(), DVec3::ZERO);
            self.normals.push(normal);
        }
        self.positions.push(position);
        self.colours.push(colour);
        index
    }

    pub(crate) fn fan(&mut self, corners: &[u32]) {
        if let [first, rest @ ..] = corners {
            let fan = rest.windows(2).map(|pair| [*first, pair[0], pair[1]]);
            self.triangles.extend(fan);
        }
    }

    /// Computes a unit normal for every vertex that has none. The computed normal is the mean of the normals of the
    /// vertex's triangles, weighted by area. If these triangles have no area, the normal is +z.
    pub(crate) fn complete_normals(&mut self) {
        let sums = self.sums_of_areas();
        self.normals.resize(self.positions.len(), DVec3::ZERO);
        for (normal, sum) in self.normals.iter_mut().zip(sums) {
            *normal = unit(*normal).or_else(|| unit(sum)).unwrap_or(DVec3::Z);
        }
    }

    /// Returns, for each vertex, the sum of the area vectors of its triangles. An area vector points along the normal
    /// and has twice the area as its length.
    fn sums_of_areas(&self) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for triangle in &self.triangles {
            let area = area(triangle.map(|corner| self.positions[corner as usize]));
            triangle.iter().for_each(|&corner| sums[corner as usize] += area);
        }
        sums
    }

    pub(crate) fn vertices(&self) -> Vec<Vertex> {
        let positions = self.positions.iter().zip(&self.normals).zip(&self.colours);
        positions
            .map(|((position, normal), &colour)| Vertex {
                position: position.as_vec3(),
                normal: normal.as_vec3(),
                colour,
            })
            .collect()
    }
}

/// Returns the vector scaled to length 1, or `None` for a zero vector. The vector is first scaled by a power of two,
/// which brings its largest component near 1 without rounding. Otherwise squares of very small or large numbers would
/// leave the range of f64.
pub(super) fn unit(v: DVec3) -> Option<DVec3> {
    let (_, exponent) = libm::frexp(v.abs().max_element());
    DVec3::from_array(v.to_array().map(|x| libm::ldexp(x, -exponent))).try_normalize()
}

/// Returns the area vector of a triangle. The vector has the direction of the normal, and twice the triangle's area as
/// its length.
pub(super) fn area([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

pub(crate) fn fitted_scene(name: &str, mesh: Mesh, spheres: Vec<Sphere>) -> Scene {
    seen_by(motion_for_fitted(), name, mesh.vertices(), mesh.triangles, spheres)
}

pub(super) fn motion_for_fitted() -> HeadMotion {
    HeadMotion::always_visible(Vec3::ZERO, IMPORT_RADIUS_M)
}

/// Returns the motion of a head that stands still at the origin of a model's coordinates.
pub(super) fn still_at_origin() -> HeadMotion {
    let path = HeadPath::Still { eye: Vec3::ZERO, target: Vec3::NEG_Z };
    HeadMotion::new(path, Sway::none()).expect("pxpl5-scene: constants are in range")
}

/// Makes a scene of one structure from the vertices, triangles and spheres of a model. `motion` is the head's motion.
pub(super) fn seen_by(
    motion: HeadMotion,
    name: &str,
    vertices: Vec<Vertex>,
    triangles: Vec<[u32; 3]>,
    spheres: Vec<Sphere>,
) -> Scene {
    let parts = SceneParts {
        name: name.to_owned(),
        vertices,
        triangles,
        spheres,
        structures: Vec::new(),
        lighting: Lighting::over_the_shoulder(),
        motion,
        path: Vec::new(),
    };
    Scene::new(parts).expect("pxpl5-scene: readers check what they make")
}

/// A transformation that fits a model into the default view. The transformation moves the model's centre to the origin
/// and scales the model's radius to [`IMPORT_RADIUS_M`].
pub(crate) struct Fit {
    centre: DVec3,
    pub(crate) scale: f64,
}

impl Fit {
    /// Creates the transformation for a model that consists of balls (centre, radius). A model of a single point is
    /// moved but not scaled.
    pub(crate) fn new(balls: impl Iterator<Item = (DVec3, f64)> + Clone) -> Self {
        let (centre, radius) = bounding_sphere(balls);
        let scale = IMPORT_RADIUS_M / radius;
        let scale = if scale.is_finite() { scale } else { 1.0 };
        Self { centre, scale }
    }

    pub(crate) const fn none() -> Self {
        Self { centre: DVec3::ZERO, scale: 1.0 }
    }

    pub(crate) fn place(&self, point: DVec3) -> DVec3 {
        (point - self.centre) * self.scale
    }
}
