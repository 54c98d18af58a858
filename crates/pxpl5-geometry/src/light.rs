//! Lighting of vertices, and normals for deferred shading.

use crate::view::FromWorld;
use crate::{Light, Triangle};
use glam::Vec3;

/// A light seen from one eye.
pub(crate) struct EyeLighting<'a> {
    to_eye: &'a FromWorld,
    light: &'a Light,
}

#[inline(always)]
fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

/// The eye-space normal of unit length; towards +Z if it has no direction.
#[inline(always)]
fn unit_normal(to_eye: &FromWorld, normal: Vec3) -> [f32; 3] {
    let n = to_eye.direction(normal);
    let square = dot(n, n);
    if (f32::MIN_POSITIVE..=f32::MAX).contains(&square) {
        let inverse = 1.0 / square.sqrt();
        n.map(|v| v * inverse)
    } else {
        [0.0, 0.0, 1.0]
    }
}

/// How far a normal at `position` turns towards the eye.
#[inline(always)]
fn towards_eye(to_eye: &FromWorld, position: Vec3, normal: [f32; 3]) -> f32 {
    let [x, y, z, _] = to_eye.point(position);
    -dot([x, y, z], normal)
}

impl<'a> EyeLighting<'a> {
    pub(crate) fn new(to_eye: &'a FromWorld, light: &'a Light) -> Self {
        Self { to_eye, light }
    }

    /// Lit colour in 1/256 of a unit, 0 to 255 * 256. Two-sided: the normal counts as the one that faces the eye.
    #[inline(always)]
    pub(crate) fn colour(&self, position: Vec3, normal: Vec3, colour: [u8; 3]) -> [f32; 3] {
        let n = unit_normal(self.to_eye, normal);
        let toward_light = dot(n, self.light.direction);
        let facing = towards_eye(self.to_eye, position, n);
        let cosine = if facing < 0.0 { -toward_light } else { toward_light };
        let intensity = self.intensity(cosine);
        colour.map(|c| f32::from(c) * 256.0 * intensity)
    }

    /// [`Self::colour`] at a corner of a triangle.
    #[inline(always)]
    pub(crate) fn corner_colour(&self, triangle: &Triangle, corner: usize) -> [f32; 3] {
        self.colour(triangle.positions[corner], triangle.normals[corner], triangle.colours[corner])
    }

    /// Part of the colour seen, 0 to 1; 0 for NaN.
    #[inline(always)]
    fn intensity(&self, cosine: f32) -> f32 {
        let sum = self.light.ambient + self.light.diffuse * cosine.max(0.0);
        if sum >= 0.0 { sum.min(1.0) } else { 0.0 }
    }
}

/// Unit normals in eye coordinates, all three turned over if the surface faces away.
pub(crate) fn facing_normals(to_eye: &FromWorld, positions: &[Vec3; 3], normals: &[Vec3; 3]) -> [[f32; 3]; 3] {
    let [a, b, c] = [0, 1, 2].map(|i| unit_and_facing(to_eye, positions[i], normals[i]));
    turned([a.0, b.0, c.0], [a.1, b.1, c.1])
}

/// A unit normal in eye coordinates, and how far it turns towards the eye.
#[inline(always)]
pub(crate) fn unit_and_facing(to_eye: &FromWorld, position: Vec3, normal: Vec3) -> ([f32; 3], f32) {
    let n = unit_normal(to_eye, normal);
    (n, towards_eye(to_eye, position, n))
}

/// The normals of three corners, all turned over if they face away from the eye on the whole.
#[inline(always)]
pub(crate) fn turned([a, b, c]: [[f32; 3]; 3], facing: [f32; 3]) -> [[f32; 3]; 3] {
    let away = (facing[0] + facing[1]) + facing[2] < 0.0;
    [turned_over_if(away, a), turned_over_if(away, b), turned_over_if(away, c)]
}

#[inline(always)]
fn turned_over_if(away: bool, [x, y, z]: [f32; 3]) -> [f32; 3] {
    if away { [-x, -y, -z] } else { [x, y, z] }
}
