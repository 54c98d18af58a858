//! Vertices that many triangles share, each transformed once.
//!
//! Triangles that need no clipping are [binned](Transform::touched) and set up [together](crate::TriangleLanes) from them,
//! exactly as by [`Transform::bin`], [`Transform::gouraud`] and [`Transform::phong`]. The others are left to those.

use crate::light::{self, ModelLight};
use crate::screen;
use crate::transform::Snapped;
use crate::{Light, Transform};
use glam::Vec3;

/// A vertex on the screen, as a view shows it to all triangles that share it.
#[derive(Clone, Copy, Debug)]
pub struct ScreenVertex {
    /// Of no meaning outside.
    pub(crate) snapped: Snapped,
    /// Inside the guard band, so that it needs no clipping.
    pub(crate) inside: bool,
}

/// What the surface needs at a vertex: its lit colour, or its normal as an eye sees it.
#[derive(Clone, Copy, Debug)]
pub struct VertexSurface {
    /// In the expressions' units; normals without the half unit that rounds.
    pub(crate) values: [f32; 3],
    /// How far a normal turns towards the eye; 0 for colours.
    pub(crate) facing: f32,
}

/// The corners on the screen of a triangle that needs no clipping.
#[derive(Clone, Copy, Debug)]
pub struct UnclippedTriangle(pub(crate) [Snapped; 3]);

impl UnclippedTriangle {
    /// `None` where the triangle needs clipping.
    #[inline(always)]
    #[must_use]
    pub const fn new([a, b, c]: [&ScreenVertex; 3]) -> Option<Self> {
        if a.inside & b.inside & c.inside { Some(Self([a.snapped, b.snapped, c.snapped])) } else { None }
    }
}

/// A component of a normal on the grid of [`screen::normal_fixed`], in the expressions' units.
#[inline(always)]
fn snapped_component(component: f32) -> f32 {
    screen::normal_value(screen::normal_fixed(component)) - screen::NORMAL_HALF
}

impl Transform {
    /// Transforms a vertex, given by its position in the world, to the screen.
    #[inline(always)]
    #[must_use]
    pub fn screen_vertex(&self, position: Vec3) -> ScreenVertex {
        let clip = self.to_clip.point(position);
        let inside = self.guard.contains(clip);
        let snapped = if inside { self.to_screen.snap(clip) } else { Snapped::default() };
        ScreenVertex { snapped, inside }
    }

    /// The normal of a vertex in eye coordinates, for Phong shading.
    #[inline]
    #[must_use]
    pub fn vertex_normal(&self, position: Vec3, normal: Vec3) -> VertexSurface {
        let (normal, facing) = light::normal_and_facing(&self.normals, position, normal);
        VertexSurface { values: normal.map(snapped_component), facing }
    }

    /// The lit colour of a vertex, for Gouraud shading.
    #[inline]
    #[must_use]
    pub fn vertex_colour(&self, light: &Light, position: Vec3, normal: Vec3, colour: [u8; 3]) -> VertexSurface {
        let lit = ModelLight::new(&self.normals, light).colour(position, normal, colour);
        VertexSurface { values: lit.map(|v| screen::colour_value(screen::colour_fixed(v))), facing: 0.0 }
    }
}
