//! Vertices that many triangles share, each transformed once.
//!
//! Triangles that need no clipping are [binned](Transform::touched) and set up [together](crate::Together) from them, exactly as by
//! [`Transform::bin`], [`Transform::gouraud`] and [`Transform::phong`]. The others are left to those.

use crate::light::{self, Lighting};
use crate::screen;
use crate::transform::Snapped;
use crate::{Light, Transform};
use glam::Vec3;
use multiversion::multiversion;

/// A vertex as a view sees it.
#[derive(Clone, Copy, Debug)]
pub struct SeenVertex {
    /// Of no meaning where it is not inside.
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
    /// Transforms vertices.
    #[must_use]
    pub fn see(&self, positions: &[Vec3]) -> Vec<SeenVertex> {
        let mut out = Vec::with_capacity(positions.len());
        for some in positions.chunks(TOGETHER) {
            let (place, inside) = see_together(self, &Points::of(some));
            let vertex = |i: usize| SeenVertex { snapped: place[i], inside: inside[i], colour: [0; 3] };
            out.extend((0..some.len()).map(vertex));
        }
        out
    }

    /// Vertices that are seen from here with their normals, and their colours as they are. As many as there are of each.
    #[must_use]
    pub fn with_normals(
        &self,
        vertices: &[SeenVertex],
        positions: &[Vec3],
        normals: &[Vec3],
        colours: &[[u8; 3]],
    ) -> Vec<SeenCorner> {
        let mut out = Vec::with_capacity(vertices.len());
        let places = positions.chunks(TOGETHER).zip(normals.chunks(TOGETHER));
        let looks = vertices.chunks(TOGETHER).zip(colours.chunks(TOGETHER));
        for ((positions, normals), (vertices, colours)) in places.zip(looks) {
            let (values, facing) = turn_together(self, &Points::of(positions), &Points::of(normals));
            let [x, y, z] = &values;
            out.extend(vertices.iter().zip(colours).enumerate().map(|(i, (vertex, colour))| SeenCorner {
                vertex: SeenVertex { colour: *colour, ..*vertex },
                values: [x[i], y[i], z[i]],
                facing: facing[i],
            }));
        }
        out
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

/// Vertices that are transformed together.
const TOGETHER: usize = 16;

type Lanes<T> = [T; TOGETHER];

/// Some points or directions.
struct Points {
    x: Lanes<f32>,
    y: Lanes<f32>,
    z: Lanes<f32>,
}

impl Points {
    /// Zeros where there are fewer.
    #[inline(always)]
    fn of(some: &[Vec3]) -> Self {
        let mut out = Self { x: [0.0; TOGETHER], y: [0.0; TOGETHER], z: [0.0; TOGETHER] };
        for (i, v) in some.iter().enumerate().take(TOGETHER) {
            (out.x[i], out.y[i], out.z[i]) = (v.x, v.y, v.z);
        }
        out
    }

    #[inline(always)]
    const fn get(&self, i: usize) -> Vec3 {
        Vec3::new(self.x[i], self.y[i], self.z[i])
    }
}

/// Places on the screen, and whether they are inside the guard band.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn see_together(view: &Transform, points: &Points) -> (Lanes<Snapped>, Lanes<bool>) {
    let (mut x, mut y, mut z) = ([0; TOGETHER], [0; TOGETHER], [0; TOGETHER]);
    let mut inside = [false; TOGETHER];
    for i in 0..TOGETHER {
        let clip = view.to_clip.point(points.get(i));
        inside[i] = view.guard.contains(clip);
        let snapped = view.to_screen.snap(clip);
        (x[i], y[i], z[i]) = (snapped.x, snapped.y, snapped.z);
    }
    let mut places = [Snapped::default(); TOGETHER];
    for i in 0..TOGETHER {
        places[i] = Snapped { x: x[i], y: y[i], z: z[i] };
    }
    (places, inside)
}

/// Normals in the expressions' units, and how far they turn towards the eye.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn turn_together(view: &Transform, points: &Points, normals: &Points) -> ([Lanes<f32>; 3], Lanes<f32>) {
    let (mut x, mut y, mut z) = ([0.0; TOGETHER], [0.0; TOGETHER], [0.0; TOGETHER]);
    let mut facing = [0.0; TOGETHER];
    for i in 0..TOGETHER {
        let (unit, towards) = light::unit_and_facing(&view.to_eye, points.get(i), normals.get(i));
        (x[i], y[i], z[i], facing[i]) = (normal_value(unit[0]), normal_value(unit[1]), normal_value(unit[2]), towards);
    }
    ([x, y, z], facing)
}

#[inline(always)]
fn normal_value(component: f32) -> f32 {
    screen::normal_value(screen::normal_fixed(component)) - screen::NORMAL_HALF
}
