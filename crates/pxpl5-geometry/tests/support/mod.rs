//! Exact geometry, hard cases, and measurements of the pipeline on them.
#![allow(unreachable_pub, reason = "a module of tests")]

pub mod cases;
pub mod exact;
pub mod fighting;
pub mod measure;
pub mod native;
pub mod random;
pub mod report;
pub mod snapped;
pub mod spheres;

use glam::{Mat4, Vec3, Vec4};
use pxpl5_geometry::ViewTransform;

/// Width of the frame in pixels.
pub const WIDTH: i32 = 640;
/// Height of the frame in pixels.
pub const HEIGHT: i32 = 480;

/// Returns a view with exact screen coordinates. The point that [`at_pixel`] returns is at its pixel without rounding.
pub fn pixel_view(near: f32, far: f32) -> ViewTransform {
    let range = near - far;
    ViewTransform {
        model_view: Mat4::IDENTITY,
        projection: Mat4::from_cols(
            Vec4::X,
            Vec4::Y,
            Vec4::new(0.0, 0.0, far / range, -1.0),
            Vec4::new(0.0, 0.0, near * far / range, 0.0),
        ),
    }
}

/// Returns the point at (x, y) px, at distance `960 * scale`. The point is exact if `scale` is a power of two and x, y
/// are short fractions.
pub fn at_pixel(x: f32, y: f32, scale: f32) -> Vec3 {
    Vec3::new((x - 320.0) * 3.0, (240.0 - y) * 4.0, -960.0) * scale
}
