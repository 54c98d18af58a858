//! SpatialGL: a rendering pipeline for triangles, as for flat screens, executed once for every slice of a volumetric
//! display.
//!
//! ```text
//!  DrawContext --present()--> CommandBuffer            (vertices transformed and lit once)
//!                              |
//!   SpatialDisplay --bins()--> bin  ------------>  which primitives each group of slices draws
//!        |                     |
//!        +------views()------> for each batch of 4 slices:
//!                                for each slice, 1 or 2 passes: clip to its volume, rasterise, mark the stencil
//!                                query tiles; halftone and pack those that are occupied
//!                              |
//!                              v
//!                         VolumeFrame --BitPlanes--> projector            VolumeStats --TimeModel--> volumes a second
//! ```
//!
//! # Behaviour
//!
//! - A display consists of views and slice volumes ([`SpatialDisplay`]). Nothing else about it matters, and the
//!   recorded draw calls do not depend on it: [`SweptDisplay`], the spinning screen of the SpatialGL paper, and
//!   [`FlatDisplay`] show the same ones.
//! - The boundary planes of swept slices come from one table in which opposite planes are exact negatives. Neighbouring
//!   slices therefore compute the same number for a point between them, and [`TieRule`] assigns it to one of the two.
//! - Samples are at pixel centres, with the top-left rule on edges. There is no culling, and only the flat screen has a
//!   depth test. Since edges, near and far plane and slice volume are linear or quadratic in homogeneous window
//!   coordinates, fragments are accepted without geometric clipping or a division.
//! - [`ReferenceRenderer`] is the reference model. [`HostRenderer`] draws the same voxels with the same counts, eight
//!   pixels at a time, and [`Workers`] execute batches on several threads. A volume's hash depends on neither.
//! - A line has round ends that overlap the line. Under [`Combine::Add`] the overlapping pixels get the colour twice.
//!
//! # Numbers
//!
//! Counts are exact. Times come from a model ([`TimeModel`]) with [`GpuTiming`] as its table.
//!
//! # Units
//!
//! Lengths are pixels of the slice image. Axes are right-handed with y up, and y is the axis of rotation. Depth runs
//! from 0 (near) to 1 (far). In a slice, u is the horizontal distance from the axis, v the height, and s the distance
//! from the slice towards the near plane.
//!
//! # Not modelled
//!
//! Textures, programmable shaders, and the snapping of vertices to a sub-pixel grid. Of the numerical formats of a GPU,
//! only the fraction bits of evaluated boundary planes are modelled.
//!
//! # Source
//!
//! The SpatialGL paper: W.-S. Chun, T. J. Purtell II, O. S. Cossairt, *Technical Introduction to the Basic SpatialGL
//! Rendering Pipeline for Perspecta 1.9/2.0*, Actuality Systems, ASI-0110, 2005.

mod angle;
mod bin;
mod clip;
mod command;
mod context;
mod curve;
mod displays;
mod frame;
mod halftone;
mod image;
mod measure;
mod pack;
pub mod perspecta;
mod projection;
mod quadratic;
mod raster;
mod render;
mod scene;
mod slice_volume;
mod stats;
#[cfg(feature = "threads")]
mod threads;
mod tile;
mod timing;
mod view;
mod workers;

pub use angle::sin_cos_of_turn;
pub use bin::{BinLayout, BinRegion, BinTolerance, Binning};
pub use clip::{DEFAULT_HYPERBOLIC_BIAS_PX2, DEFAULT_OFFSET_PX, HalfWedge, SliceClip};
pub use command::{Combine, CommandBuffer, CommandTriangle};
pub use context::{ColouredVertex, DrawContext, Topology, TwoSidedLight, VertexBuffer};
pub use displays::{FlatDisplay, Rotation, SweptConfig, SweptDisplay};
pub use frame::{BitPlanes, ColourSample, VolumeFrame};
pub use halftone::Halftone;
pub use image::SliceImage;
pub use measure::{
    Connected, brightness_by_radius, connected, dead_zone_radius, gap_correlation, innermost_lit_radius,
};
pub use pack::{DENSE_PIXELS, PIXELS_PER_WORD, pack_dense, packed_word, pixel_of_word};
pub use projection::{Jitter, Projection, Size, SliceEye};
pub use quadratic::ClipQuadratic;
pub use raster::{Bin, Coverage, HostRenderer, ReferenceRenderer, SliceRenderer, SliceStats, SliceWork, Supersampled};
pub use render::{Strobes, VolumeConfig, render_volume};
pub use scene::{SCENE_REACH, record_scene, tessellated_sphere};
pub use slice_volume::{SliceVolume, TieRule, WedgePlanes, WedgeTest};
pub use stats::VolumeStats;
#[cfg(feature = "threads")]
pub use threads::Threads;
pub use tile::{TileGrid, Tiling};
pub use timing::{GpuTiming, TimeModel, VolumeTime};
pub use view::{PixelFormat, SliceView, SpatialDisplay};
pub use workers::{OneThread, Task, Workers};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
