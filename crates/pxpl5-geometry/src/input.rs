//! Primitives as the display list holds them.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A triangle in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Corners in world coordinates, in either winding.
    pub positions: [Vec3; 3],
    /// Normals at the corners, of any length. A zero normal counts as facing the eye.
    pub normals: [Vec3; 3],
    /// Red, green and blue at the corners, 0 to 255 each.
    pub colours: [[u8; 3]; 3],
}

/// A sphere in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldSphere {
    /// Centre in world coordinates.
    pub centre: Vec3,
    /// Radius in world units, not negative.
    pub radius: f32,
    /// Red, green and blue, 0 to 255 each.
    pub colour: [u8; 3],
}

/// A directional light. It shows the share `ambient + diffuse * max(0, n . l)`, at most 1, of a surface's colour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// Unit vector towards the light, in eye coordinates.
    pub direction: [f32; 3],
    /// Share of the colour that is visible without the light, 0 to 1.
    pub ambient: f32,
    /// Share of the colour that perpendicular light adds, 0 to 1.
    pub diffuse: f32,
}

impl Light {
    /// A light at the eye that shines in the view direction: 0.25 ambient, 0.75 diffuse.
    pub const HEADLIGHT: Self = Self { direction: [0.0, 0.0, 1.0], ambient: 0.25, diffuse: 0.75 };

    /// A light that leaves colours unchanged for any normal.
    pub const NONE: Self = Self { direction: [0.0, 0.0, 1.0], ambient: 1.0, diffuse: 0.0 };
}
