//! Primitives as the display list holds them.

use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A triangle in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Corners; either winding.
    pub positions: [Vec3; 3],
    /// Normals at the corners, of any length (zero counts as facing the eye).
    pub normals: [Vec3; 3],
    /// Red, green and blue at the corners.
    pub colours: [[u8; 3]; 3],
}

/// A sphere in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre.
    pub centre: Vec3,
    /// Radius, not negative.
    pub radius: f32,
    /// Red, green and blue.
    pub colour: [u8; 3],
}

/// Triangles that share vertices. All vertex arrays have one length and every index is inside.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    positions: &'a [Vec3],
    normals: &'a [Vec3],
    colours: &'a [[u8; 3]],
    triangles: &'a [[u32; 3]],
}

/// Why arrays are not a [`Mesh`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshError {
    /// The vertex arrays differ in length.
    Lengths {
        /// Number of positions.
        positions: usize,
        /// Number of normals.
        normals: usize,
        /// Number of colours.
        colours: usize,
    },
    /// A triangle names a vertex that does not exist.
    Index {
        /// Number of the triangle.
        triangle: usize,
        /// The index found.
        found: u32,
        /// Number of vertices.
        vertices: usize,
    },
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lengths { positions, normals, colours } => write!(
                f,
                "mesh: expected as many normals and colours as positions ({positions}), \
                 found {normals} and {colours}"
            ),
            Self::Index { triangle, found, vertices } => {
                write!(f, "mesh: triangle {triangle} names vertex {found}, expected less than {vertices}")
            }
        }
    }
}

impl std::error::Error for MeshError {}

impl<'a> Mesh<'a> {
    /// Checks lengths and indices once, so that nothing later needs to.
    ///
    /// # Errors
    /// [`MeshError`] if the arrays differ in length or an index is too large.
    pub fn new(
        positions: &'a [Vec3],
        normals: &'a [Vec3],
        colours: &'a [[u8; 3]],
        triangles: &'a [[u32; 3]],
    ) -> Result<Self, MeshError> {
        let vertices = positions.len();
        if normals.len() != vertices || colours.len() != vertices {
            return Err(MeshError::Lengths { positions: vertices, normals: normals.len(), colours: colours.len() });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&found) = corners.iter().find(|&&i| i as usize >= vertices) {
                return Err(MeshError::Index { triangle, found, vertices });
            }
        }
        Ok(Self { positions, normals, colours, triangles })
    }

    /// Vertex positions.
    #[must_use]
    pub const fn positions(&self) -> &'a [Vec3] {
        self.positions
    }

    /// Vertex normals.
    #[must_use]
    pub const fn normals(&self) -> &'a [Vec3] {
        self.normals
    }

    /// Vertex colours.
    #[must_use]
    pub const fn colours(&self) -> &'a [[u8; 3]] {
        self.colours
    }

    /// Corner indices of the triangles.
    #[must_use]
    pub const fn triangles(&self) -> &'a [[u32; 3]] {
        self.triangles
    }

    /// Triangle `n` on its own; `None` past the end.
    #[must_use]
    pub fn triangle(&self, n: usize) -> Option<Triangle> {
        let corners = self.triangles.get(n)?.map(|i| i as usize);
        Some(Triangle {
            positions: corners.map(|i| self.positions[i]),
            normals: corners.map(|i| self.normals[i]),
            colours: corners.map(|i| self.colours[i]),
        })
    }
}

/// A directional light and the surface's answer to it: `ambient + diffuse * max(0, n . l)`, at most 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// Towards the light, in eye coordinates, unit length.
    pub direction: [f32; 3],
    /// Part of the colour seen without the light, 0 to 1.
    pub ambient: f32,
    /// Part of the colour added where the light falls at a right angle, 0 to 1.
    pub diffuse: f32,
}

impl Light {
    /// At the eye, looking where it looks: 0.25 ambient, 0.75 diffuse.
    pub const HEADLIGHT: Self = Self { direction: [0.0, 0.0, 1.0], ambient: 0.25, diffuse: 0.75 };

    /// Colours as they are, whatever the normals.
    pub const NONE: Self = Self { direction: [0.0, 0.0, 1.0], ambient: 1.0, diffuse: 0.0 };
}
