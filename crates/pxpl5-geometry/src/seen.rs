//! Vertices that many triangles share, each transformed once.
//!
//! Triangles that need no clipping are [binned](Transform::touched) and set up [together](crate::Together) from them,
//! exactly as by [`Transform::bin`], [`Transform::gouraud`] and [`Transform::phong`]. The others are left to those.

use crate::light::{self, Lighting};
use crate::screen;
use crate::transform::Snapped;
use crate::{Light, Transform};
use glam::Vec3;

/// A vertex as a view sees it.
#[derive(Clone, Copy, Debug)]
pub struct SeenVertex {
    /// Of no meaning outside.
    pub(crate) snapped: Snapped,
    /// Inside the guard band, so that it needs no clipping.
    pub(crate) inside: bool,
}

/// What the surface needs at a vertex: its lit colour, or its normal as an eye sees it.
#[derive(Clone, Copy, Debug)]
pub struct SeenSurface {
    /// In the expressions' units; normals without the half unit that rounds.
    pub(crate) values: [f32; 3],
    /// How far a normal turns towards the eye; 0 for colours.
    pub(crate) facing: f32,
}

/// The corners on the screen of a triangle that needs no clipping.
#[derive(Clone, Copy, Debug)]
pub struct SeenTriangle(pub(crate) [Snapped; 3]);

impl SeenTriangle {
    /// `None` where the triangle needs clipping.
    #[inline(always)]
    #[must_use]
    pub const fn of([a, b, c]: [&SeenVertex; 3]) -> Option<Self> {
        if a.inside & b.inside & c.inside { Some(Self([a.snapped, b.snapped, c.snapped])) } else { None }
    }
}

impl Transform {
    /// Transforms a vertex.
    #[inline(always)]
    #[must_use]
    pub fn see(&self, position: Vec3) -> SeenVertex {
        let clip = self.to_clip.point(position);
        let inside = self.guard.contains(clip);
        let snapped = if inside { self.to_screen.snap(clip) } else { Snapped::default() };
        SeenVertex { snapped, inside }
    }

    /// The normal of a vertex.
    #[inline]
    #[must_use]
    pub fn see_normal(&self, position: Vec3, normal: Vec3) -> SeenSurface {
        let (unit, facing) = light::unit_and_facing(&self.to_eye, position, normal);
        let value = |v| screen::normal_value(screen::normal_fixed(v)) - screen::NORMAL_HALF;
        SeenSurface { values: unit.map(value), facing }
    }

    /// The lit colour of a vertex.
    #[inline]
    #[must_use]
    pub fn see_colour(&self, light: &Light, position: Vec3, normal: Vec3, colour: [u8; 3]) -> SeenSurface {
        let lit = Lighting::new(&self.to_eye, light).colour(position, normal, colour);
        SeenSurface { values: lit.map(|v| screen::colour_value(screen::colour_fixed(v))), facing: 0.0 }
    }
}
