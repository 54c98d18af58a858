//! Vertices that many triangles share, each transformed once.
//!
//! Triangles that need no clipping are [binned](Transform::touched) and set up [together](crate::Together) from them, exactly as by
//! [`Transform::bin`], [`Transform::gouraud`] and [`Transform::phong`]. The others are left to those.

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
    /// Where it is known.
    pub(crate) colour: [u8; 3],
}

/// A vertex with what a surface needs there: its lit colour, or its normal as an eye sees it. Of such a size that it lies in
/// one cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct SeenCorner {
    pub(crate) vertex: SeenVertex,
    /// In the expressions' units; normals without the half unit that rounds.
    pub(crate) values: [f32; 3],
    /// How far a normal turns towards the eye; 0 for colours.
    pub(crate) facing: f32,
}

const _: () = assert!(size_of::<SeenCorner>() == 32);

impl SeenCorner {
    /// Whether no triangle needs clipping for its sake.
    #[inline(always)]
    #[must_use]
    pub const fn is_inside(&self) -> bool {
        self.vertex.inside
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
        SeenVertex { snapped, inside, colour: [0; 3] }
    }

    /// A vertex, seen from here, with its normal and its colour as it is.
    #[inline]
    #[must_use]
    pub fn with_normal(&self, vertex: SeenVertex, position: Vec3, normal: Vec3, colour: [u8; 3]) -> SeenCorner {
        let (unit, facing) = light::unit_and_facing(&self.to_eye, position, normal);
        let value = |v| screen::normal_value(screen::normal_fixed(v)) - screen::NORMAL_HALF;
        SeenCorner { vertex: SeenVertex { colour, ..vertex }, values: unit.map(value), facing }
    }

    /// A vertex, seen from here, with its lit colour.
    #[inline]
    #[must_use]
    pub fn with_light(
        &self,
        vertex: SeenVertex,
        light: &Light,
        position: Vec3,
        normal: Vec3,
        colour: [u8; 3],
    ) -> SeenCorner {
        let lit = Lighting::new(&self.to_eye, light).colour(position, normal, colour);
        let values = lit.map(|v| screen::colour_value(screen::colour_fixed(v)));
        SeenCorner { vertex: SeenVertex { colour, ..vertex }, values, facing: 0.0 }
    }
}
