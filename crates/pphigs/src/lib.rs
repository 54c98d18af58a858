//! Display list, primitives and TRANSFORM of the graphics processors.
//!
//! PPHIGS was the graphics library of Pixel-Planes 5. This crate models the part of PPHIGS that all pipelines need:
//!
//! ```text
//!   DisplayList --deal--> Share --transform(FrameView, eye)--> Pass --command_list(region)--> CommandList
//!   (all of it)    (one GP's)                             (bins: counts now,           (kinds now,
//!                                                          pixels' words on demand)     words on demand)
//! ```
//!
//! - [`DisplayList`]: triangles, spheres, and structures with a model matrix each.
//! - [`Share`]: every n-th primitive. The graphics processors get primitives round-robin (TR94).
//! - [`FrameView`]: the host's message for a frame: viewing transforms and edits, as words.
//! - [`send_as_tracked`]: the host program of a pipeline that uses the newest view whenever the pipeline needs a view.
//! - [`Pass`]: the result of one TRANSFORM. The numbers of primitives in each region are computed immediately. The
//!   words of the commands are computed on demand, from the same transformed vertices.
//! - [`TransformCost`]: the work of a TRANSFORM as counts, and its time according to the timing table.
//! - [`TransformWork`]: the CPU work of TRANSFORM. The time comes from the table or from i860 code. Both ways give the
//!   same words of commands.
//! - [`CubeTransform`]: TRANSFORM of six views around an eye, as i860 code.
//! - [`BinHandoffWork`]: the CPU work of sending a region's bin to its renderer.
//! - [`WindowSearchWork`]: the CPU work of searching for the primitives in rectangles of the screen, without bins.
//! - [`TriangleEndsRecorder`] and [`StripInterpolation`]: positions of triangles in two views, and commands of a strip
//!   of lines for a view between these views, as i860 code.
//! - [`assemble_order`]: assembly of an order, the message of a master to its slaves, as i860 code.
//!
//! **Not modelled:** traversal of nested structures, picking, text, and PPHIGS's other primitives.
//!
//! Sources: TR94 (round-robin assignment of primitives, bins that hold pointers to shared commands).

mod begin;
mod bin_handoff;
mod code;
mod commands;
mod cost;
mod cube_transform;
mod interpolating;
mod layout;
mod list;
pub mod oracle;
mod ordering;
mod pass;
mod picture;
mod placed;
mod placing;
mod programs;
mod sending;
mod view;
mod windows;

pub use begin::{EditWork, PassStartWork};
pub use bin_handoff::{BinHandoffWork, MessagePieces};
pub use code::{KernelOutput, TransformWork};
pub use commands::{
    BIN_ENTRY_BYTES, PROGRAM_BYTES, RegionEnvelope, copy_message, gouraud_sphere, region_messages, shade,
};
pub use cost::TransformCost;
pub use cube_transform::{CubeTransform, CubeTransformOutput};
pub use interpolating::{StripInterpolation, TriangleEndsRecorder};
pub use list::{DisplayList, PrimitiveCounts, Share};
pub use ordering::assemble_order;
pub use pass::Pass;
pub use picture::{Picture, RegionBinning, Shading};
pub use placed::{PlacedStructure, RecentViews};
pub use placing::place_all;
pub use sending::send_as_tracked;
pub use view::{DisplayStructure, EyeView, FrameView, MAX_EDITS, ModelEdit, ModelFrame};
pub use windows::{MemoryPart, SearchOutput, WindowSearchWork};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
