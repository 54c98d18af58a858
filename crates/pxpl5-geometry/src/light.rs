//! Lighting of vertices, and rotation of normals for Phong shading.

use crate::view::{self, FromWorld};
use crate::{Light, Triangle};
use glam::Vec3;

/// A light with its direction in world coordinates, in which the display list stores normals.
pub(crate) struct ModelLight<'a> {
    normals: &'a NormalRows,
    direction: [f32; 3],
    light: &'a Light,
}

/// A matrix that rotates unit normals from world to eye coordinates.
///
/// The matrix for points is divided by the length of its longest row. With a uniform scale, normals keep unit length.
/// With any other matrix, no component exceeds 1. The renderer normalizes the normal at each pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NormalRows {
    pub(crate) rows: [[f32; 3]; 3],
    origin: Vec3,
}

impl NormalRows {
    pub(crate) fn new(to_eye: &FromWorld) -> Self {
        let rows = to_eye.rows();
        let [x, y, z] = [rows[0], rows[1], rows[2]].map(|[a, b, c, _]| [a, b, c].map(f64::from));
        let longest = [x, y, z].map(|row| view::dot(row, row)).into_iter().fold(0.0, f64::max).sqrt();
        let scale = if longest > 0.0 { 1.0 / longest } else { 0.0 };
        Self { rows: [x, y, z].map(|row| row.map(|v| (v * scale) as f32)), origin: to_eye.origin() }
    }

    pub(crate) fn to_world(self, direction: [f32; 3]) -> [f32; 3] {
        let rows = self.rows.map(|row| row.map(f64::from));
        let [x, y, z] = direction.map(f64::from);
        [0, 1, 2].map(|axis| view::dot([rows[0][axis], rows[1][axis], rows[2][axis]], [x, y, z]) as f32)
    }

    #[inline(always)]
    fn apply(&self, normal: [f32; 3]) -> [f32; 3] {
        let [x, y, z] = self.rows;
        [dot(x, normal), dot(y, normal), dot(z, normal)]
    }

    /// Returns a number that is negative if the unit normal at `position` faces away from the eye.
    #[inline(always)]
    fn towards_eye(&self, position: Vec3, normal: [f32; 3]) -> f32 {
        let relative = [position.x - self.origin.x, position.y - self.origin.y, position.z - self.origin.z];
        -dot(relative, normal)
    }
}

#[inline(always)]
fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

/// Returns a normal scaled to unit length, or +Z for a zero normal.
#[inline(always)]
pub(crate) fn unit_normal(normal: Vec3) -> [f32; 3] {
    let [x, y, z] = [f64::from(normal.x), f64::from(normal.y), f64::from(normal.z)];
    let square = view::dot([x, y, z], [x, y, z]);
    // Compute the root for all inputs, because a branch would prevent vectorization.
    let inverse = 1.0 / square.sqrt();
    let unit = [(x * inverse) as f32, (y * inverse) as f32, (z * inverse) as f32];
    if (square > 0.0) & (square < f64::INFINITY) { unit } else { [0.0, 0.0, 1.0] }
}

impl<'a> ModelLight<'a> {
    pub(crate) fn new(normals: &'a NormalRows, light: &'a Light) -> Self {
        Self { normals, direction: normals.to_world(light.direction), light }
    }

    /// Returns the lit colour, 0 to 255 * 256. A normal that faces away from the eye is reversed first.
    #[inline(always)]
    pub(crate) fn colour(&self, position: Vec3, normal: Vec3, colour: [u8; 3]) -> [f32; 3] {
        let n = unit_normal(normal);
        let toward_light = dot(n, self.direction);
        let facing = self.normals.towards_eye(position, n);
        let cosine = if facing < 0.0 { -toward_light } else { toward_light };
        let intensity = self.intensity(cosine);
        let [red, green, blue] = colour;
        [f32::from(red) * 256.0 * intensity, f32::from(green) * 256.0 * intensity, f32::from(blue) * 256.0 * intensity]
    }

    #[inline(always)]
    pub(crate) fn corner_colour(&self, triangle: &Triangle, corner: usize) -> [f32; 3] {
        self.colour(triangle.positions[corner], triangle.normals[corner], triangle.colours[corner])
    }

    #[inline(always)]
    fn intensity(&self, cosine: f32) -> f32 {
        let sum = self.light.ambient + self.light.diffuse * cosine.max(0.0);
        if sum >= 0.0 { sum.min(1.0) } else { 0.0 }
    }
}

pub(crate) fn facing_normals(rows: &NormalRows, positions: &[Vec3; 3], normals: &[Vec3; 3]) -> [[f32; 3]; 3] {
    let [a, b, c] = [0, 1, 2].map(|i| normal_and_facing(rows, positions[i], normals[i]));
    turned([a.0, b.0, c.0], [a.1, b.1, c.1])
}

/// Returns a normal in eye coordinates, and a number that is positive if the normal faces the eye.
#[inline(always)]
pub(crate) fn normal_and_facing(rows: &NormalRows, position: Vec3, normal: Vec3) -> ([f32; 3], f32) {
    let n = unit_normal(normal);
    (rows.apply(n), rows.towards_eye(position, n))
}

/// Returns the normals of three corners. The normals are reversed if they face away from the eye on average.
#[inline(always)]
pub(crate) fn turned([a, b, c]: [[f32; 3]; 3], facing: [f32; 3]) -> [[f32; 3]; 3] {
    let away = (facing[0] + facing[1]) + facing[2] < 0.0;
    [turned_over_if(away, a), turned_over_if(away, b), turned_over_if(away, c)]
}

#[inline(always)]
fn turned_over_if(away: bool, [x, y, z]: [f32; 3]) -> [f32; 3] {
    if away { [-x, -y, -z] } else { [x, y, z] }
}
