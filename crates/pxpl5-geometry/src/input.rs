//! Primitives in the form of the display list.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A triangle in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Positions of the corners in world coordinates. The corners can run clockwise or counterclockwise.
    pub positions: [Vec3; 3],
    /// Normals at the corners. The normals can have any length. A zero normal counts as a normal that faces the eye.
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

/// A directional light. A surface shows this fraction of its colour: `ambient + diffuse * max(0, n . l)`, limited to 1.
/// Here n is the surface's unit normal and l is `direction`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// Unit vector towards the light, in eye coordinates.
    pub direction: [f32; 3],
    /// Fraction of the colour that is visible without the light, 0 to 1.
    pub ambient: f32,
    /// Fraction of the colour that light perpendicular to the surface adds to the ambient light, 0 to 1.
    pub diffuse: f32,
}

impl Light {
    /// A light at the eye, in the direction of the view, with `ambient` 0.25 and `diffuse` 0.75.
    pub const HEADLIGHT: Self = Self { direction: [0.0, 0.0, 1.0], ambient: 0.25, diffuse: 0.75 };

    /// Full ambient light, which leaves every colour unchanged for any normal.
    pub const NONE: Self = Self { direction: [0.0, 0.0, 1.0], ambient: 1.0, diffuse: 0.0 };
}
