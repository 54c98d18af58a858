//! Construction of a scene from the arrays of a triangle mesh.

use crate::config::FIT_DISTANCE_RADII;
use crate::motion::{HeadMotion, HeadPath};
use crate::scene::{Lighting, Scene, SceneParts, Vertex};
use crate::sway::Sway;
use glam::Vec3;
use pxpl5_sim::parameters::SettingError;

const GREY: [u8; 3] = [200, 200, 200];

impl Scene {
    /// Creates a scene from vertices (positions in metres) and triangles. Each triangle has the indices of three
    /// vertices, anticlockwise seen from outside.
    ///
    /// The mesh is light grey. The normal of a vertex is the mean of its triangles' normals, weighted by area. The
    /// viewer stands in front of the scene, on its +z side, far enough away to see all of it. For other colours,
    /// normals and head motions use [`Scene::new`].
    ///
    /// ```
    /// use glam::Vec3;
    /// use pxpl5_scene::Scene;
    ///
    /// let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    /// let scene = Scene::from_triangles(&corners, &[[0, 1, 2]])?;
    /// assert_eq!(scene.vertices()[0].normal, Vec3::Z);
    /// # Ok::<(), pxpl5_sim::parameters::SettingError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if a triangle refers to a missing vertex, a coordinate is not finite, or the mesh
    /// has no triangles.
    pub fn from_triangles(corners: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, SettingError> {
        let mut normals = vec![Vec3::ZERO; corners.len()];
        for triangle in triangles {
            let of = |corner: usize| corners.get(triangle[corner] as usize).copied().unwrap_or(Vec3::ZERO);
            // The cross product is twice the area, so large triangles count more.
            let normal = (of(1) - of(0)).cross(of(2) - of(0));
            for corner in triangle {
                if let Some(sum) = normals.get_mut(*corner as usize) {
                    *sum += normal;
                }
            }
        }
        let vertex = |(position, normal): (&Vec3, Vec3)| Vertex {
            position: *position,
            normal: normal.try_normalize().unwrap_or(Vec3::Z),
            colour: GREY,
        };
        let mut parts = SceneParts {
            name: "triangles".to_owned(),
            vertices: corners.iter().zip(normals).map(vertex).collect(),
            triangles: triangles.to_vec(),
            spheres: Vec::new(),
            structures: Vec::new(),
            lighting: Lighting::over_the_shoulder(),
            motion: standing(Vec3::ZERO, Vec3::Z),
            path: Vec::new(),
        };
        // Use the bounding sphere of the checked scene.
        let (centre, radius) = Self::new(parts.clone())?.bounding_sphere();
        parts.motion = standing(centre, centre + Vec3::Z * (f64::from(radius) * FIT_DISTANCE_RADII) as f32);
        Self::new(parts)
    }
}

fn standing(target: Vec3, eye: Vec3) -> HeadMotion {
    let still = HeadPath::Still { eye, target };
    HeadMotion::new(still, Sway { seed: 1, scale: 0.0 }).expect("pxpl5-scene: no sway is in range")
}
