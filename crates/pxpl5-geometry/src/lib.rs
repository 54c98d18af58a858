//! What graphics-processor code computes between the display list and the renderer's commands.
//!
//! Triangles: [`Transform`] gives [`ScreenTriangle`]s with the regions that they touch, these give expressions.

mod bin;
mod clip;
mod conic;
mod input;
mod light;
mod plane;
mod screen;
mod sphere;
mod sphere_setup;
mod stats;
mod transform;
mod view;

pub use bin::RegionMask;
pub use clip::MAX_CLIP;
pub use input::{Light, Mesh, MeshError, Sphere, Triangle};
pub use plane::MAX_SLOPE;
pub use screen::{
    DEPTH_FAR, DEPTH_NEAR, GUARD_PIXELS, GouraudTriangle, LitColours, NORMAL_UNIT, Outline, PhongTriangle,
    ScreenTriangle, SurfaceNormals,
};
pub use sphere::ScreenSphere;
pub use sphere_setup::{GouraudSphere, PhongSphere, SphereSetup};
pub use stats::SetupStats;
pub use transform::{Culling, MeshScratch, Transform};
pub use view::{MAX_PICTURE, ViewError, ViewTransform, Viewport};
