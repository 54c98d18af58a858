//! SpatialGL: the triangle pipeline of 2-D graphics, run once for every slice of a volumetric display.
//!
//! ```text
//!  Context --present()--> CommandBuffer            (vertices transformed and lit once)
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
//! - A display is views and slice volumes ([`SpatialDisplay`]); the pipeline knows no more of it, and a recording nothing.
//!   [`SweptDisplay`] is the screen of the paper that spins, [`PlaneStack`] and [`FlatDisplay`] show the same recordings.
//! - The boundary planes of a swept slice come from one table, opposite ones exact negatives, so that neighbouring slices
//!   compute the same number for a point between them; [`TieRule`] says which of them has it.
//! - Samples are at pixel centres, with the top-left rule on edges; there is no depth test (but on the flat screen) and no
//!   culling. Edges, near and far plane and the slice's volume are linear or quadratic in homogeneous window coordinates,
//!   so nothing is clipped geometrically and nothing divided before a fragment has been accepted.
//! - [`OracleRenderer`] is the definition; [`HostRenderer`] draws the same voxels and counts the same with eight pixels at a
//!   time, [`Workers`] run batches on several threads. A volume's hash depends on none of this.
//! - Lines have round ends that overlap them: under [`Combine::Add`] those pixels get the colour twice.
//!
//! # Numbers
//!
//! Counts are exact; times are a stated model ([`TimeModel`]) with [`GpuTiming`] as its table.
//!
//! # Units
//!
//! Pixels of the slice image; right-handed, y up, the axis of rotation is y. Depth runs from 0 (near, +s) to 1 (far).
//!
//! # Not modelled
//!
//! Textures, programmable shaders, the numerical formats of a GPU except the fraction bits of evaluated boundary planes,
//! snapping of vertices to a sub-pixel grid.
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
mod error;
mod frame;
mod halftone;
mod image;
mod measure;
mod pack;
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
pub use clip::{DEFAULT_BIAS_PX2, DEFAULT_OFFSET_PX, HalfWedge, SliceClip};
pub use command::{Combine, CommandBuffer, CommandTriangle};
pub use context::{Context, Light, Topology, Vertex, VertexBuffer};
pub use displays::{FlatDisplay, PlaneStack, Rotation, SweptConfig, SweptDisplay};
pub use error::SpatialError;
pub use frame::{BitPlanes, ColourSample, VolumeFrame};
pub use halftone::Halftone;
pub use image::SliceImage;
pub use measure::{
    Connected, brightness_by_radius, connected, dead_zone_radius, gap_correlation, innermost_lit_radius,
};
pub use pack::{
    BitOrder, DENSE_PIXELS, PIXELS_PER_WORD, in_bit_order, pack_dense, packed_word, pixel_of_word, unpack_dense,
};
pub use projection::{Jitter, Projection, Size, SliceEye};
pub use quadratic::ClipQuadratic;
pub use raster::{Bin, Coverage, HostRenderer, OracleRenderer, SliceRenderer, SliceStats, SliceWork, Supersampled};
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
