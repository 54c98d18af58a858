//! Display list and primitives as the code of the graphics processors holds them.
//!
//! PPHIGS was the graphics library of Pixel-Planes 5. This crate is the part of it that both pipelines need:
//!
//! ```text
//!   DisplayList --deal--> Share --transform(FrameView, eye)--> Pass --command_list(region)--> CommandList
//!   (all of it)    (one GP's)                             (bins: counts now,           (kinds now,
//!                                                          pixels' words on demand)     words on demand)
//! ```
//!
//! - [`DisplayList`]: triangles, spheres, and structures with a model matrix each.
//! - [`Share`]: every n-th primitive, as primitives are dealt to the GPs round-robin (TR94).
//! - [`FrameView`]: what the host sends for a frame: viewing transforms and edits, as words.
//! - [`send_as_tracked`]: the host of a pipeline that takes the newest view when it needs one.
//! - [`Pass`]: one TRANSFORM: which primitives touch which regions, counted at once; command words are made when somebody
//!   wants pixels, from the same transformed vertices.
//! - [`TransformCost`]: what a TRANSFORM does, counted, and its time by table.
//! - [`Transforming`]: the same as work of a board, in time by table or by i860 code that makes the same words.
//! - [`Surrounding`]: six of them around an eye, as code.
//! - [`Handing`]: a region's bin handed over to the ring, as such work.
//! - [`Searching`]: what meets rectangles of the screen that no bin was made for, found and handed over, as such work.
//! - [`KeepingEnds`] and [`Interpolating`]: triangles in two views, and their commands for a strip between these, as code.
//! - [`put_together`]: an order of a master, as code.
//!
//! **Not modelled:** traversal of nested structures, picking, text, and PPHIGS's other primitives.
//!
//! Sources: TR94 (round-robin dealing, bins that hold pointers to shared commands).

mod begin;
mod code;
mod commands;
mod cost;
mod counts;
mod encoder;
mod handing;
mod interpolating;
mod layout;
mod list;
mod ordering;
mod pass;
mod picture;
mod placed;
mod placing;
mod sending;
mod structure;
mod surrounding;
mod view;
mod windows;

pub use begin::{Beginning, Editing};
pub use code::{KernelOutput, Transforming};
pub use commands::{
    BIN_ENTRY_BYTES, PROGRAM_BYTES, RegionEnvelope, copy_message, gouraud_sphere, region_messages, shade,
};
pub use cost::TransformCost;
pub use counts::PrimitiveCounts;
pub use handing::{Handing, MessagePieces};
pub use interpolating::{Interpolating, KeepingEnds};
pub use list::{DisplayList, Share};
pub use ordering::put_together;
pub use pass::Pass;
pub use picture::{Picture, RegionBinning, Shading};
pub use placed::{PlacedStructure, RecentViews};
pub use placing::place_all;
pub use sending::send_as_tracked;
pub use structure::{DisplayStructure, ModelFrame};
pub use surrounding::{Surrounding, SurroundingOutput};
pub use view::{EyeView, FrameView, MAX_EDITS, ModelEdit, ViewWordsError};
pub use windows::{MemoryPart, SearchOutput, Searching};
