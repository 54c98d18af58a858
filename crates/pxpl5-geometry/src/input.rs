//! Triangles, spheres and lights, as the display list stores them.

use glam::Vec3;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Positions of the corners. The corners can run clockwise or counterclockwise.
    pub positions: [Vec3; 3],
    /// Normals at the corners, of any length. A zero normal faces the eye.
    pub normals: [Vec3; 3],
    /// Red, green and blue at the corners, 0 to 255 each.
    pub colours: [[u8; 3]; 3],
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldSphere {
    pub centre: Vec3,
    /// Radius in world units, not negative.
    pub radius: f32,
    /// Red, green and blue, 0 to 255 each.
    pub colour: [u8; 3],
}

/// A light from one direction. A surface shows the fraction `ambient + diffuse * max(0, n . l)` of its colour, at most
/// 1. Here n is the surface's unit normal and l is `direction`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// Unit vector towards the light, in eye coordinates.
    pub direction: [f32; 3],
    /// Fraction of the colour that is visible without the light, 0 to 1.
    pub ambient: f32,
    /// Fraction of the colour that light perpendicular to the surface adds, 0 to 1.
    pub diffuse: f32,
}

impl Light {
    /// A light at the eye, in the direction of the view, with `ambient` 0.25 and `diffuse` 0.75.
    pub const HEADLIGHT: Self = Self { direction: [0.0, 0.0, 1.0], ambient: 0.25, diffuse: 0.75 };

    /// Ambient light alone, which leaves every colour unchanged.
    pub const NONE: Self = Self { direction: [0.0, 0.0, 1.0], ambient: 1.0, diffuse: 0.0 };
}
