//! What all mesh readers end in: positions in double precision, fans, normals, the fit into the view.

use glam::{DVec3, Vec3};

use super::Source;
use crate::config::IMPORT_RADIUS_M;
use crate::error::LoadError;
use crate::motion::{HeadMotion, HeadPath};
use crate::scene::{Lighting, Scene, SceneParts, Sphere, Vertex, bounding_sphere};
use crate::sway::Sway;

/// Where normals come from that the file does not give.
#[derive(Clone, Copy)]
pub(crate) enum Normals {
    /// From the triangles around each vertex.
    OfVertices,
    /// From the triangles around each point (the given one per vertex), where several vertices share one.
    OfPoints,
}

/// A mesh before it is scaled.
#[derive(Default)]
pub(crate) struct Mesh {
    pub(crate) positions: Vec<DVec3>,
    /// Not yet of unit length; zero where the file gives none, and empty as long as it has given none at all.
    pub(crate) normals: Vec<DVec3>,
    pub(crate) colours: Vec<[u8; 3]>,
    /// Which point of the file each vertex lies on.
    pub(crate) points: Vec<u32>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds a vertex that is a point of its own.
    pub(crate) fn push(&mut self, position: DVec3, normal: DVec3, colour: [u8; 3]) -> u32 {
        let index = self.positions.len() as u32;
        self.push_on_point(index, position, normal, colour);
        index
    }

    pub(crate) fn push_on_point(&mut self, point: u32, position: DVec3, normal: DVec3, colour: [u8; 3]) {
        if normal != DVec3::ZERO || !self.normals.is_empty() {
            self.normals.resize(self.positions.len(), DVec3::ZERO);
            self.normals.push(normal);
        }
        self.positions.push(position);
        self.colours.push(colour);
        self.points.push(point);
    }

    /// Cuts a polygon into triangles that share its first corner.
    pub(crate) fn fan(&mut self, corners: &[u32]) {
        if let [first, rest @ ..] = corners {
            let fan = rest.windows(2).map(|pair| [*first, pair[0], pair[1]]);
            self.triangles.extend(fan);
        }
    }

    /// Gives a unit normal to every vertex without one: the mean over its triangles, weighted by area; +z if it has
    /// only triangles without area.
    pub(crate) fn complete_normals(&mut self, normals: Normals) {
        let are_points = self.points.iter().zip(0..).all(|(&point, vertex)| point == vertex);
        let of_vertices = are_points || matches!(normals, Normals::OfVertices);
        let mut sums = self.sums_of_areas(of_vertices);
        if of_vertices && self.normals.is_empty() {
            // Where there are none, nothing is held twice.
            sums.iter_mut().for_each(|sum| *sum = unit(*sum).unwrap_or(DVec3::Z));
            self.normals = sums;
            return;
        }
        self.normals.resize(self.positions.len(), DVec3::ZERO);
        for (vertex, normal) in self.normals.iter_mut().enumerate() {
            let group = if of_vertices { vertex } else { self.points[vertex] as usize };
            *normal = unit(*normal).or_else(|| unit(sums[group])).unwrap_or(DVec3::Z);
        }
    }

    /// The sum of the areas around each vertex, or around each point, as vectors.
    fn sums_of_areas(&self, of_vertices: bool) -> Vec<DVec3> {
        let last_point = self.points.iter().max().map_or(0, |&last| last as usize + 1);
        let mut sums = vec![DVec3::ZERO; if of_vertices { self.positions.len() } else { last_point }];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|corner| self.positions[corner as usize]);
            let area = (b - a).cross(c - a);
            for &corner in triangle {
                let group = if of_vertices { corner } else { self.points[corner as usize] };
                sums[group as usize] += area;
            }
        }
        sums
    }

    /// Keeps the vertices that triangles use: others must not decide on the fit, nor cost time in every frame.
    fn drop_unused(&mut self) {
        let mut used = vec![false; self.positions.len()];
        for &corner in self.triangles.iter().flatten() {
            used[corner as usize] = true;
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
        retain(&mut self.positions, &used);
        retain(&mut self.normals, &used);
        retain(&mut self.colours, &used);
        retain(&mut self.points, &used);
    }

    /// A fitted scene of the mesh.
    pub(crate) fn into_scene(mut self, source: &Source<'_>) -> Result<Scene, LoadError> {
        if self.triangles.is_empty() {
            return Err(LoadError::NothingToDraw { file: source.name.to_owned(), expected: "triangle" });
        }
        self.drop_unused();
        let fit = source.placement.fit(self.positions.iter().map(|&position| (position, 0.0)));
        // Before the normals, whose sums of areas would otherwise leave the range of f64 for the tiniest models.
        for position in &mut self.positions {
            *position = fit.place(*position);
        }
        self.complete_normals(Normals::OfPoints);
        Ok(source.placement.scene(source.name, self, Vec::new()))
    }

    /// The vertices of a scene, rounded to single precision.
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

/// The vector with length 1; `None` of one without length. Its largest component is brought near 1 first, by a power of two that
/// changes no bit: squares of the smallest and the largest numbers of a file would leave the range of f64.
fn unit(v: DVec3) -> Option<DVec3> {
    let (_, exponent) = libm::frexp(v.abs().max_element());
    DVec3::from_array(v.to_array().map(|x| libm::ldexp(x, -exponent))).try_normalize()
}

/// Of an empty list there is nothing to keep.
fn retain<T>(items: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    items.retain(|_| keep.next() == Some(&true));
}

/// The scene of a model already fitted to the default view.
pub(crate) fn fitted_scene(name: &str, mesh: Mesh, spheres: Vec<Sphere>) -> Scene {
    seen_by(HeadMotion::seeing_whole(Vec3::ZERO, IMPORT_RADIUS_M), name, mesh, spheres)
}

/// The scene of a model before a head that stands at the origin of its coordinates.
pub(crate) fn unfitted_scene(name: &str, mesh: Mesh, spheres: Vec<Sphere>) -> Scene {
    let path = HeadPath::Still { eye: Vec3::ZERO, target: Vec3::NEG_Z };
    let motion = HeadMotion::new(path, Sway::none()).expect("pxpl5-scene: constants are in range");
    seen_by(motion, name, mesh, spheres)
}

fn seen_by(motion: HeadMotion, name: &str, mesh: Mesh, spheres: Vec<Sphere>) -> Scene {
    let parts = SceneParts {
        name: name.to_owned(),
        vertices: mesh.vertices(),
        triangles: mesh.triangles,
        spheres,
        structures: Vec::new(),
        lighting: Lighting::over_the_shoulder(),
        motion,
        path: Vec::new(),
    };
    Scene::new(parts).expect("pxpl5-scene: readers check what they make")
}

/// Moves the centre of a model to the origin and scales its radius to [`IMPORT_RADIUS_M`].
pub(crate) struct Fit {
    centre: DVec3,
    pub(crate) scale: f64,
}

impl Fit {
    /// From all balls (centre, radius) of the model. A model without extent is only moved.
    pub(crate) fn new(balls: impl Iterator<Item = (DVec3, f64)> + Clone) -> Self {
        let (centre, radius) = bounding_sphere(balls);
        let scale = IMPORT_RADIUS_M / radius;
        let scale = if scale.is_finite() { scale } else { 1.0 };
        Self { centre, scale }
    }

    /// Everything stays where it is.
    pub(crate) const fn none() -> Self {
        Self { centre: DVec3::ZERO, scale: 1.0 }
    }

    pub(crate) fn place(&self, point: DVec3) -> DVec3 {
        (point - self.centre) * self.scale
    }
}
