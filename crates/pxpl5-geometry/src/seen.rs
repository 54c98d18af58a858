//! Vertices that many triangles share, each transformed once.
//!
//! For triangles that need no clipping, every function gives exactly what [`Transform::bin`], [`Transform::gouraud`] and
//! [`Transform::phong`] give for the same corners. The others are left to those.

use crate::light::{self, Lighting};
use crate::screen;
use crate::transform::{Assembled, Snapped};
use crate::{GouraudTriangle, Light, PhongTriangle, RegionMask, SetupStats, Transform};
use glam::Vec3;

/// A vertex as a view sees it.
#[derive(Clone, Copy, Debug)]
pub struct SeenVertex {
    /// Of no meaning outside.
    snapped: Snapped,
    /// Inside the guard band, so that it needs no clipping.
    inside: bool,
}

/// A vertex's normal as an eye sees it.
#[derive(Clone, Copy, Debug)]
pub struct SeenNormal {
    /// In the expressions' units, but for the half unit that rounds.
    unit: [f32; 3],
    /// How far it turns towards the eye.
    facing: f32,
}

/// A vertex's lit colour, in the expressions' units.
#[derive(Clone, Copy, Debug)]
pub struct SeenColour([f32; 3]);

/// The corners on the screen of a triangle that needs no clipping.
#[derive(Clone, Copy, Debug)]
pub struct SeenTriangle([Snapped; 3]);

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
    pub fn see_normal(&self, position: Vec3, normal: Vec3) -> SeenNormal {
        let (unit, facing) = light::unit_and_facing(&self.to_eye, position, normal);
        SeenNormal { unit: unit.map(|v| screen::normal_value(screen::normal_fixed(v)) - screen::NORMAL_HALF), facing }
    }

    /// The lit colour of a vertex.
    #[inline]
    #[must_use]
    pub fn see_colour(&self, light: &Light, position: Vec3, normal: Vec3, colour: [u8; 3]) -> SeenColour {
        let lit = Lighting::new(&self.to_eye, light).colour(position, normal, colour);
        SeenColour(lit.map(|v| screen::colour_value(screen::colour_fixed(v))))
    }

    /// As [`Self::bin`]: the regions touched; `None`, counted, if there are none.
    #[inline(always)]
    pub fn bin_seen(&self, triangle: &SeenTriangle, stats: &mut SetupStats) -> Option<RegionMask> {
        stats.triangles += 1;
        Some(self.assemble(triangle.0, stats)?.outline.regions)
    }

    /// As [`Self::gouraud`] and set-up of what it gives; `None` without area. It does not ask whether any region is
    /// touched.
    #[inline(always)]
    pub fn gouraud_seen(
        &self,
        triangle: &SeenTriangle,
        [a, b, c]: [&SeenColour; 3],
        stats: &mut SetupStats,
    ) -> Option<GouraudTriangle> {
        let whole = Assembled::clockwise(triangle.0)?;
        Some(whole.outline.gouraud(whole.order([a.0, b.0, c.0]), &self.viewport, stats))
    }

    /// As [`Self::phong`] and set-up of what it gives; `colour` is the first corner's. `None` without area. It does not
    /// ask whether any region is touched.
    #[inline(always)]
    pub fn phong_seen(
        &self,
        triangle: &SeenTriangle,
        [a, b, c]: [&SeenNormal; 3],
        colour: [u8; 3],
        stats: &mut SetupStats,
    ) -> Option<PhongTriangle> {
        let whole = Assembled::clockwise(triangle.0)?;
        let [p, q, r] = light::turned([a.unit, b.unit, c.unit], [a.facing, b.facing, c.facing]);
        let rounding =
            |[x, y, z]: [f32; 3]| [x + screen::NORMAL_HALF, y + screen::NORMAL_HALF, z + screen::NORMAL_HALF];
        let normals = whole.order([rounding(p), rounding(q), rounding(r)]);
        Some(whole.outline.phong(normals, colour, &self.viewport, stats))
    }
}
