//! Vertices that many triangles share, each transformed once.
//!
//! Every function gives exactly what [`Transform::bin`], [`Transform::gouraud`] and [`Transform::phong`] give for the
//! same corners.

use crate::light::{self, Lighting};
use crate::screen::{LitColours, ScreenTriangle, SurfaceNormals};
use crate::transform::{Snapped, lit_triangle, normal_triangle};
use crate::{Light, RegionMask, SetupStats, Transform};
use glam::Vec3;

/// A vertex as a view sees it.
#[derive(Clone, Copy, Debug)]
pub struct SeenVertex {
    pub(crate) clip: [f32; 4],
    pub(crate) snapped: Snapped,
    /// Inside the guard band, so that it needs no clipping.
    pub(crate) inside: bool,
}

/// A vertex's normal as an eye sees it.
#[derive(Clone, Copy, Debug)]
pub struct SeenNormal {
    unit: [f32; 3],
    /// How far it turns towards the eye.
    facing: f32,
}

/// A vertex's lit colour.
#[derive(Clone, Copy, Debug)]
pub struct SeenColour([f32; 3]);

impl Transform {
    /// The normal of a vertex.
    #[inline]
    #[must_use]
    pub fn see_normal(&self, position: Vec3, normal: Vec3) -> SeenNormal {
        let (unit, facing) = light::unit_and_facing(&self.to_eye, position, normal);
        SeenNormal { unit, facing }
    }

    /// The lit colour of a vertex.
    #[inline]
    #[must_use]
    pub fn see_colour(&self, light: &Light, position: Vec3, normal: Vec3, colour: [u8; 3]) -> SeenColour {
        SeenColour(Lighting::new(&self.to_eye, light).colour(position, normal, colour))
    }

    /// As [`Self::bin`].
    #[inline]
    pub fn bin_seen(&self, corners: [&SeenVertex; 3], stats: &mut SetupStats, sink: impl FnMut(RegionMask)) {
        self.bin_corners(corners, stats, sink);
    }

    /// As [`Self::gouraud`].
    #[inline]
    pub fn gouraud_seen(
        &self,
        corners: [&SeenVertex; 3],
        [a, b, c]: [SeenColour; 3],
        stats: &mut SetupStats,
        mut sink: impl FnMut(ScreenTriangle<LitColours>),
    ) {
        self.corners(corners, [a.0, b.0, c.0], stats, |outline, colours| sink(lit_triangle(outline, colours)));
    }

    /// As [`Self::phong`]; `colour` is the first corner's.
    #[inline]
    pub fn phong_seen(
        &self,
        corners: [&SeenVertex; 3],
        [a, b, c]: [SeenNormal; 3],
        colour: [u8; 3],
        stats: &mut SetupStats,
        mut sink: impl FnMut(ScreenTriangle<SurfaceNormals>),
    ) {
        let normals = light::turned([a.unit, b.unit, c.unit], [a.facing, b.facing, c.facing]);
        self.corners(corners, normals, stats, |outline, n| sink(normal_triangle(outline, n, colour)));
    }
}
