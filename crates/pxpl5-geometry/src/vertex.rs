//! Vertices that many triangles share, each transformed once.
//!
//! Triangles that need no clipping are [binned](Transform::touched) and set up [together](crate::TriangleLanes) from them,
//! exactly as by [`Transform::bin`], [`Transform::gouraud`] and [`Transform::phong`]. The others are left to those.

use crate::clip::Guard;
use crate::light::{self, ModelLight};
use crate::screen;
use crate::transform::{Snapped, ToScreen};
use crate::view::FromWorld;
use crate::{Light, Transform};
use glam::Vec3;
use multiversion::multiversion;
use pxpl5_wire::LANES;

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

    /// The same of many, several side by side.
    #[must_use]
    pub fn screen_vertices(&self, positions: &[Vec3]) -> Vec<ScreenVertex> {
        let mut out = Vec::with_capacity(positions.len());
        let (lanes, rest) = positions.as_chunks();
        append_lanes(lanes, &self.to_clip, self.guard, &self.to_screen, &mut out);
        out.extend(rest.iter().map(|position| self.screen_vertex(*position)));
        out
    }

    /// The normal of a vertex in eye coordinates, for Phong shading.
    #[inline]
    #[must_use]
    pub fn vertex_normal(&self, position: Vec3, normal: Vec3) -> VertexSurface {
        let (normal, facing) = light::normal_and_facing(&self.normals, position, normal);
        VertexSurface { values: normal.map(snapped_component), facing }
    }

    /// The lit colours of vertices, for Gouraud shading; of each its position, normal and colour in the world.
    pub fn vertex_colours(
        &self,
        light: &Light,
        vertices: impl Iterator<Item = (Vec3, Vec3, [u8; 3])>,
    ) -> Vec<VertexSurface> {
        let light = ModelLight::new(&self.normals, light);
        let colour = |(position, normal, colour)| {
            let lit = light.colour(position, normal, colour);
            VertexSurface { values: lit.map(|v| screen::colour_value(screen::colour_fixed(v))), facing: 0.0 }
        };
        vertices.map(colour).collect()
    }
}

/// Appends what [`Transform::screen_vertex`] gives of each. Plain loops, compiled once for each vector unit: see [`crate::lanes`].
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn append_lanes(
    positions: &[[Vec3; LANES]],
    to_clip: &FromWorld,
    guard: Guard,
    to_screen: &ToScreen,
    out: &mut Vec<ScreenVertex>,
) {
    for some in positions {
        let mut clip = [[0.0; LANES]; 4];
        for i in 0..LANES {
            let [x, y, z, w] = to_clip.point(some[i]);
            clip[0][i] = x;
            clip[1][i] = y;
            clip[2][i] = z;
            clip[3][i] = w;
        }
        let mut x = [0; LANES];
        let mut y = [0; LANES];
        let mut z = [0; LANES];
        let mut inside = [false; LANES];
        for i in 0..LANES {
            let point = [clip[0][i], clip[1][i], clip[2][i], clip[3][i]];
            inside[i] = guard.contains(point);
            let snapped = to_screen.snap(point);
            x[i] = if inside[i] { snapped.x } else { 0 };
            y[i] = if inside[i] { snapped.y } else { 0 };
            z[i] = if inside[i] { snapped.z } else { 0 };
        }
        for i in 0..LANES {
            out.push(ScreenVertex { snapped: Snapped { x: x[i], y: y[i], z: z[i] }, inside: inside[i] });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Culling, ViewTransform, Viewport};
    use glam::Mat4;

    #[test]
    fn vertices_side_by_side_are_those_of_one_after_the_other() {
        let view = ViewTransform {
            model_view: Mat4::from_rotation_y(0.3),
            projection: Mat4::perspective_rh(1.0, 4.0 / 3.0, 0.1, 50.0),
        };
        let transform = Transform::new(&view, Viewport::FRAME, Culling::None).expect("finite");
        // In front, behind, beside, in the plane of the eye, and what is no number.
        let place = |i: i32| Vec3::new((i % 23 - 11) as f32, (i % 7 - 3) as f32 * 0.7, (i % 41 - 30) as f32 * 0.8);
        let mut positions: Vec<_> = (0..2_003).map(place).collect();
        positions.extend([Vec3::ZERO, Vec3::NAN, Vec3::splat(f32::MAX), Vec3::new(0.0, 0.0, f32::NEG_INFINITY)]);
        let alone: Vec<_> = positions.iter().map(|position| transform.screen_vertex(*position)).collect();
        assert!(alone.iter().any(|vertex| vertex.inside) && alone.iter().any(|vertex| !vertex.inside));
        let seen = |vertices: &[ScreenVertex]| -> Vec<_> { vertices.iter().map(|v| (v.inside, v.snapped)).collect() };
        assert_eq!(seen(&transform.screen_vertices(&positions)), seen(&alone));
    }
}
