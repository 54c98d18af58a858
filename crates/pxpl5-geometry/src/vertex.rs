//! Vertices that several triangles share, each transformed only once.
//!
//! Triangles of shared vertices are [binned](Transform::touched) and set up in [groups](crate::TriangleLanes), unless
//! they need clipping. The results equal the results of [`Transform::bin`], [`Transform::gouraud`] and
//! [`Transform::phong`], which also handle triangles that need clipping.

use crate::clip::Guard;
use crate::light::{self, ModelLight, NormalRows};
use crate::outline::SUBPIXELS;
use crate::screen;
use crate::transform::{Snapped, ToScreen};
use crate::view::FromWorld;
use crate::{Light, Transform};
use glam::Vec3;
use multiversion::multiversion;
use pxpl5_wire::LANES;

/// A vertex on the screen in one view, which several triangles can share.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScreenVertex(pub(crate) Snapped);

/// The x of a vertex outside the guard band. This x is greater than any x inside the band. Its differences from x
/// inside the band are still exact.
pub(crate) const OUTSIDE: i32 = 2 * screen::GUARD_PIXELS * SUBPIXELS;

const NOT_INSIDE: Snapped = Snapped { x: OUTSIDE, y: 0, z: 0 };

/// A vertex on the screen, with its lit colour or with its normal in eye coordinates.
///
/// The struct has 32 bytes and is aligned to 32 bytes, so it never crosses a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct SurfaceVertex {
    pub(crate) screen: ScreenVertex,
    /// A positive number if the normal faces the eye, a negative number if it faces away, and 0 for vertices with
    /// colours.
    pub(crate) facing: f32,
    /// Colour or normal, in the fixed-point units of planes. Colours include half a unit for rounding, and normals do
    /// not.
    pub(crate) values: [f32; 3],
}

impl SurfaceVertex {
    pub(crate) const NOWHERE: Self =
        Self { screen: ScreenVertex(Snapped { x: 0, y: 0, z: 0 }), facing: 0.0, values: [0.0; 3] };
}

impl ScreenVertex {
    #[inline(always)]
    pub(crate) const fn is_inside(&self) -> bool {
        self.0.x != OUTSIDE
    }
}

/// Rounds a component of a normal like [`screen::normal_fixed`], and converts it to the fixed-point units of planes.
#[inline(always)]
fn snapped_component(component: f32) -> f32 {
    screen::normal_value(screen::normal_fixed(component)) - screen::NORMAL_HALF
}

/// Rounds a component of a lit colour like [`screen::colour_fixed`], and converts it to the fixed-point units of
/// planes.
#[inline(always)]
fn snapped_colour(component: f32) -> f32 {
    screen::colour_value(screen::colour_fixed(component))
}

impl Transform {
    /// Transforms a vertex from its world position to the screen.
    #[inline(always)]
    pub fn screen_vertex(&self, position: Vec3) -> ScreenVertex {
        if self.is_single {
            return ScreenVertex(self.single_vertex(position).unwrap_or(NOT_INSIDE));
        }
        let clip = self.to_clip.point(position);
        ScreenVertex(if self.guard.contains(clip) { self.to_screen.snap(clip) } else { NOT_INSIDE })
    }

    /// Transforms many vertices from their world positions to the screen, several at a time.
    pub fn screen_vertices(&self, positions: &[Vec3]) -> Vec<ScreenVertex> {
        let mut out = Vec::with_capacity(positions.len());
        let (lanes, rest) = if self.is_single { (&[][..], positions) } else { positions.as_chunks() };
        append_lanes(lanes, &self.to_clip, self.guard, &self.to_screen, &mut out);
        out.extend(rest.iter().map(|position| self.screen_vertex(*position)));
        out
    }

    /// Returns vertices with normals in eye coordinates, for Phong shading.
    ///
    /// The slices have one element for each vertex: its position on the screen, its position in the world, and its
    /// normal in the world. The shortest slice determines the number of vertices.
    pub fn vertex_normals(
        &self,
        on_screen: &[ScreenVertex],
        positions: &[Vec3],
        normals: &[Vec3],
    ) -> Vec<SurfaceVertex> {
        let n = on_screen.len().min(positions.len()).min(normals.len());
        let mut out = without_surface(&on_screen[..n]);
        set_normals(&self.normals, &positions[..n], &normals[..n], &mut out);
        out
    }

    /// Returns vertices with lit colours, for Gouraud shading.
    ///
    /// The slices have one element for each vertex: its position on the screen, its position in the world, its normal
    /// in the world, and its colour. The shortest slice determines the number of vertices.
    pub fn vertex_colours(
        &self,
        light: &Light,
        on_screen: &[ScreenVertex],
        positions: &[Vec3],
        normals: &[Vec3],
        colours: &[[u8; 3]],
    ) -> Vec<SurfaceVertex> {
        let light = ModelLight::new(&self.normals, light);
        let n = on_screen.len().min(positions.len()).min(normals.len()).min(colours.len());
        let mut out = without_surface(&on_screen[..n]);
        set_colours(&light, &positions[..n], &normals[..n], &colours[..n], &mut out);
        out
    }
}

fn without_surface(on_screen: &[ScreenVertex]) -> Vec<SurfaceVertex> {
    on_screen.iter().map(|screen| SurfaceVertex { screen: *screen, ..SurfaceVertex::NOWHERE }).collect()
}

/// Transforms vertices like [`Transform::screen_vertex`] and appends them to `out`. The loops are plain Rust, compiled
/// once for each kind of vector unit (see [`crate::lanes`]).
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn append_lanes(
    positions: &[[Vec3; LANES]],
    to_clip: &FromWorld,
    guard: Guard,
    to_screen: &ToScreen,
    out: &mut Vec<ScreenVertex>,
) {
    for some in positions {
        // Transform all vertices of the chunk.
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
        // Divide and snap all vertices, including vertices outside the guard band, because only a loop without branches
        // is vectorized.
        for i in 0..LANES {
            let point = [clip[0][i], clip[1][i], clip[2][i], clip[3][i]];
            let inside = guard.contains(point);
            let snapped = to_screen.snap(point);
            x[i] = if inside { snapped.x } else { NOT_INSIDE.x };
            y[i] = if inside { snapped.y } else { NOT_INSIDE.y };
            z[i] = if inside { snapped.z } else { NOT_INSIDE.z };
        }
        let mut all = [ScreenVertex::default(); LANES];
        for i in 0..LANES {
            all[i] = ScreenVertex(Snapped { x: x[i], y: y[i], z: z[i] });
        }
        out.extend_from_slice(&all);
    }
}

#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn set_normals(rows: &NormalRows, positions: &[Vec3], normals: &[Vec3], out: &mut [SurfaceVertex]) {
    let (chunks, rest) = out.as_chunks_mut::<LANES>();
    let whole = chunks.len() * LANES;
    let given = positions.as_chunks::<LANES>().0.iter().zip(normals.as_chunks::<LANES>().0);
    // Whole chunks are computed lane by lane.
    for (out, (position, normal)) in chunks.iter_mut().zip(given) {
        let mut found = [[0.0; LANES]; 4];
        for i in 0..LANES {
            let ([x, y, z], facing) = light::normal_and_facing(rows, position[i], normal[i]);
            found[0][i] = snapped_component(x);
            found[1][i] = snapped_component(y);
            found[2][i] = snapped_component(z);
            found[3][i] = facing;
        }
        for i in 0..LANES {
            out[i].values = [found[0][i], found[1][i], found[2][i]];
            out[i].facing = found[3][i];
        }
    }
    // The remaining vertices are computed one by one.
    for ((out, position), normal) in rest.iter_mut().zip(&positions[whole..]).zip(&normals[whole..]) {
        let (normal, facing) = light::normal_and_facing(rows, *position, *normal);
        out.values = normal.map(snapped_component);
        out.facing = facing;
    }
}

#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn set_colours(
    light: &ModelLight<'_>,
    positions: &[Vec3],
    normals: &[Vec3],
    colours: &[[u8; 3]],
    out: &mut [SurfaceVertex],
) {
    let (chunks, rest) = out.as_chunks_mut::<LANES>();
    let whole = chunks.len() * LANES;
    let given = positions.as_chunks::<LANES>().0.iter().zip(normals.as_chunks::<LANES>().0);
    // Whole chunks are computed lane by lane.
    for ((out, (position, normal)), colour) in chunks.iter_mut().zip(given).zip(colours.as_chunks::<LANES>().0) {
        let mut lit = [[0.0; LANES]; 3];
        for i in 0..LANES {
            let [red, green, blue] = light.colour(position[i], normal[i], colour[i]);
            lit[0][i] = snapped_colour(red);
            lit[1][i] = snapped_colour(green);
            lit[2][i] = snapped_colour(blue);
        }
        for i in 0..LANES {
            out[i].values = [lit[0][i], lit[1][i], lit[2][i]];
        }
    }
    // The remaining vertices are computed one by one.
    for (i, out) in rest.iter_mut().enumerate() {
        let i = whole + i;
        out.values = light.colour(positions[i], normals[i], colours[i]).map(snapped_colour);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Culling, ViewTransform, Viewport};
    use glam::Mat4;

    #[test]
    fn vertices_computed_side_by_side_equal_vertices_computed_singly() {
        let view = ViewTransform {
            model_view: Mat4::from_rotation_y(0.3),
            projection: Mat4::perspective_rh(1.0, 4.0 / 3.0, 0.1, 50.0),
        };
        let transform = Transform::new(&view, Viewport::FRAME, Culling::None).expect("finite");
        // Positions in front of the eye, behind it, beside it and in its plane, and positions that are not finite.
        let place = |i: i32| Vec3::new((i % 23 - 11) as f32, (i % 7 - 3) as f32 * 0.7, (i % 41 - 30) as f32 * 0.8);
        let mut positions: Vec<_> = (0..2_003).map(place).collect();
        positions.extend([Vec3::ZERO, Vec3::NAN, Vec3::splat(f32::MAX), Vec3::new(0.0, 0.0, f32::NEG_INFINITY)]);
        let alone: Vec<_> = positions.iter().map(|position| transform.screen_vertex(*position)).collect();
        assert!(alone.iter().any(ScreenVertex::is_inside) && !alone.iter().all(ScreenVertex::is_inside));
        assert_eq!(transform.screen_vertices(&positions), alone);
    }

    #[test]
    fn surfaces_computed_side_by_side_equal_surfaces_computed_singly() {
        let view = ViewTransform {
            model_view: Mat4::from_rotation_y(0.3),
            projection: Mat4::perspective_rh(1.0, 4.0 / 3.0, 0.1, 50.0),
        };
        let transform = Transform::new(&view, Viewport::FRAME, Culling::None).expect("finite");
        let light = Light { direction: [0.6, 0.0, 0.8], ambient: 0.2, diffuse: 0.7 };
        // Normals in all directions, and some normals of length 0 or with numbers that are not finite.
        let direction = |i: i32| match i % 40 {
            38 => Vec3::ZERO,
            39 => Vec3::NAN,
            _ => Vec3::new((i % 7 - 3) as f32, (i % 5 - 2) as f32 * 0.4, (i % 11 - 5) as f32 * 1e-3),
        };
        let positions: Vec<_> = (0..803).map(|i| Vec3::new((i % 9 - 4) as f32, (i % 4) as f32, -5.0)).collect();
        let normals: Vec<_> = (0..803).map(direction).collect();
        let colours: Vec<_> = (0..803).map(|i: u32| [i as u8, (i * 7) as u8, (i * 31) as u8]).collect();
        let on_screen = transform.screen_vertices(&positions);
        let bits = |v: &SurfaceVertex| (v.screen, v.facing.to_bits(), v.values.map(f32::to_bits));
        let lit = transform.vertex_colours(&light, &on_screen, &positions, &normals, &colours);
        let turned = transform.vertex_normals(&on_screen, &positions, &normals);
        for (i, (lit, turned)) in lit.iter().zip(&turned).enumerate() {
            let one = i..i + 1;
            let (screen, position, normal) = (&on_screen[one.clone()], &positions[one.clone()], &normals[one.clone()]);
            let lit_alone = transform.vertex_colours(&light, screen, position, normal, &colours[one]);
            assert_eq!(bits(lit), bits(&lit_alone[0]), "{i}");
            assert_eq!(bits(turned), bits(&transform.vertex_normals(screen, position, normal)[0]), "{i}");
        }
        let bright = lit.iter().filter(|vertex| vertex.values[0] > 0.0).count();
        let away = turned.iter().filter(|vertex| vertex.facing < 0.0).count();
        assert!(lit.len() == 803 && turned.len() == 803 && bright > 500 && away > 100, "{bright} {away}");
    }
}
