//! Geometry of the graphics processors: the computation from the display list to the renderer's commands.
//!
//! ```text
//! Triangle --> Transform ---> ScreenTriangle ---> GouraudTriangle, PhongTriangle   (expressions)
//!                   |              | outline.regions  ^
//!                   +--> ScreenVertex --> TriangleLanes -+   (shared vertices once, several triangles together)
//! Sphere ----> Transform ---> ScreenSphere -----> GouraudSphere, PhongSphere
//!                   |
//!              SetupStats: counts of dropped, cut and limited primitives
//! ```
//!
//! # Behaviour, in the order of the steps
//!
//! 1. **Transform** in 32-bit floating point to clip coordinates: right-handed, looking along -Z, depth 0 to 1.
//!    Positions are relative to the eye, so models far from the origin lose no precision.
//! 2. **Light**: Gouraud shading lights each vertex by a directional, two-sided [`Light`]. Phong shading keeps normals
//!    in eye coordinates. Normals get unit length once, when they enter the display list. A matrix then rotates the
//!    normals without a new normalization, as in the processors' code.
//! 3. **Clip** by the near and far planes and a guard band of [`GUARD_PIXELS`], before the division. Triangles are not
//!    clipped at the sides of the picture. A shared edge is cut at the same point for both of its triangles.
//! 4. **Divide** by w without a division instruction: a first approximation of 8 bits (seed) and two Newton steps in
//!    single precision. **Snap** to 1/16 px of the *video frame*. A field is exactly the even or odd lines of its video
//!    frame. The vertices are the same, and the expressions are converted to every second line.
//! 5. **Drop** triangles without area and, on request, back faces ([`Culling`]).
//! 6. **Bin**: the edges give the exact set of touched regions ([`RegionMask`]). Most triangles lie inside one region
//!    and need only one comparison per side. [`Transform::bin`] and [`Transform::touched`] end with this step.
//! 7. **Set up** on demand. Edge values are exact integers, and are at least 0 inside the triangle. The edges include
//!    the tie rule, so that each pixel of a shared edge is drawn once. Planes give depth, colour or normal. A sphere is
//!    one quadratic, with a root for depth.
//!
//! # Formats and limits
//!
//! | quantity | range | where proved |
//! |---|---|---|
//! | vertex | 2^16 subpixels from pixel (0, 0) | [`GUARD_PIXELS`] |
//! | edge at any pixel | 2^30 | tests/setup.rs |
//! | depth plane | error up to `(abs dx + abs dy) / 2 + 1` units of 2^-8; no wrap at covered pixels | tests/setup.rs |
//! | colour plane | the same error in units of 2^-12; no wrap at covered pixels | tests/setup.rs |
//! | slope | up to [`MAX_SLOPE`], kept modulo 2^32; steeper planes are made flat and counted | tests/setup.rs |
//! | sphere | silhouette below 2^47 in its regions, root of 12 bits | tests/input.rs |
//!
//! docs/numerics.md compares these formats with exact geometry on hard cases. All results are the same on every
//! computer: the code uses only additions, multiplications, divisions and square roots, in a fixed order. Loops over
//! several triangles are compiled for each vector unit and give the same bits.
//!
//! # Example
//!
//! ```
//! use glam::{Mat4, Vec3};
//! use pxpl5_geometry::{Culling, Light, SetupStats, Transform, Triangle, ViewTransform, Viewport};
//!
//! let view = ViewTransform {
//!     model_view: Mat4::from_translation(Vec3::new(0.0, 0.0, -3.0)),
//!     projection: Mat4::perspective_rh(0.8, 4.0 / 3.0, 0.1, 10.0),
//! };
//! let transform = Transform::new(&view, Viewport::FRAME, Culling::None)?;
//! let triangle = Triangle {
//!     positions: [Vec3::new(-0.5, -0.5, 0.0), Vec3::new(0.5, -0.5, 0.0), Vec3::new(0.0, 0.5, 0.0)],
//!     normals: [Vec3::Z; 3],
//!     colours: [[255, 0, 0]; 3],
//! };
//! let mut stats = SetupStats::default();
//! let mut commands = Vec::new();
//! transform.gouraud(&triangle, &Light::HEADLIGHT, &mut stats, |t| commands.push(t));
//! let regions: Vec<u16> = commands[0].outline.regions.iter().map(|r| r.0).collect();
//! let planes = commands[0].gouraud(transform.viewport(), &mut stats);
//! assert_eq!(regions, [7, 11, 12, 13]);
//! assert!(planes.edges.iter().all(|e| e.at(320, 240) >= 0));
//! # Ok::<(), pxpl5_sim::parameters::SettingError>(())
//! ```
//!
//! # Not modelled
//!
//! - Perspective-correct colour: planes are linear on the screen, as on the machine.
//! - Spheres that the near or far plane cuts (these spheres are counted but not drawn), shadows, and specular light on
//!   vertices.
//! - The time of this work on an i860. [`kernel`] and [`sphere_kernel`] provide the same computation as i860 code for
//!   other crates to run.
//!
//! # Sources
//!
//! TR94 (steps of triangle set-up, regions, fields), F89 (quadratic expressions). The formats are assumed (see
//! `pxpl5_wire::format`).

mod bin;
mod clip;
mod conic;
mod input;
pub mod kernel;
mod lanes;
mod lens;
mod light;
mod newton;
mod outline;
mod plane;
mod regions;
mod screen;
mod single;
mod sphere;
pub mod sphere_kernel;
mod sphere_setup;
mod stats;
mod touch;
mod touched;
mod transform;
mod vertex;
mod view;

pub use clip::MAX_CLIP;
pub use input::{Light, Triangle, WorldSphere};
pub use lanes::{GouraudLanes, LANES, PhongLanes, TriangleLanes};
pub use outline::Outline;
pub use plane::MAX_SLOPE;
pub use regions::RegionMask;
pub use screen::{
    DEPTH_FAR, DEPTH_NEAR, GUARD_PIXELS, GouraudTriangle, NORMAL_UNIT, PhongTriangle, ScreenTriangle, SurfaceNormals,
    VertexColours,
};
pub use sphere::ScreenSphere;
pub use sphere_setup::{GouraudSphere, PhongSphere, SphereSetup};
pub use stats::SetupStats;
pub use touch::Touch;
pub use touched::Touched;
pub use transform::{Culling, Transform, TriangleEnds};
pub use vertex::{ScreenVertex, SurfaceVertex};
pub use view::{MAX_PICTURE, ViewTransform, Viewport};

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
