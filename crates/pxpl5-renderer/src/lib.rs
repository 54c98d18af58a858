//! Renderer of Pixel-Planes 5: a 128 x 128 SIMD array of one-bit processors behind an input FIFO on the ring.
//!
//! ```text
//!  ring --> port --> input FIFO --> controller --> expression evaluator (trees) --+
//!                                   |  select: context base, region's origin      | one bit a clock, every pixel
//!                                   v                                             v
//!                                 Enable ----> 16,384 one-bit processors, 208 bits of pixel memory each
//!                                              |            |
//!           backing store, 128 blocks of 32 bits <----------+----> colour of a region --> port --> frame buffer
//! ```
//!
//! # Behaviour, in the order of the signal
//!
//! 1. Messages bring commands; time follows from the kinds of the commands alone ([`RendererTiming`], [`Renderer`]),
//!    since the array is SIMD.
//! 2. A command is a fixed-length program of instructions ([`Command`], [`CommandKind`]); the instructions, their words,
//!    clocks and effects are those of [`isa`]. Where fields lie in pixel memory is a [`Layout`].
//! 3. A triangle: enable all; three edges, each disabling where it is negative; Z, disabling where not nearer, stored;
//!    then colours (Gouraud) or normals (Phong). A sphere: the silhouette is a quadratic, its square root gives depth,
//!    normal and light. [`Shade`] turns normals into colour once, at the end of the frame.
//! 4. Pixels are computed apart from time. [`BitSerial`] moves bit planes as the hardware did, and defines every bit;
//!    [`BitSerial::skipping`] leaves out what cannot change anything; [`Lanes`] works on values, only where a command
//!    can change something. The suite in [`conformance`] holds them to the same 208 bits of all pixels, Enable, clocks
//!    and faults.
//!
//! # Numbers
//!
//! A triangle takes 258 clocks with interpolated colour, 292 with normals (published: 150,000 a second, TR94, which is
//! 267), of which 220 and 250 are bits of the wire's formats; see [`isa::timing`], and [`command`] for the others.
//!
//! # Faults
//!
//! An illegal word or operand ends its list, without effect, and is counted ([`ArrayFault`], [`PixelArray::faults`]).
//!
//! # Not modelled
//!
//! - The real instruction set: none survives. Ours is the least that runs the published recipes, and is **assumed**.
//! - The split of the array into 64 chips, and the fill of the evaluator's pipeline beyond a constant for each
//!   instruction.
//! - What a program sees that touches a block of the backing store before its transfer has ended: the array moves the
//!   block at once, only time passes later.
//! - Antialiasing, texture, transparency.
//!
//! Sources: F89 (array, evaluator, memory, backing store), TR94 (recipe, rates, regions, Slats' four contexts), LK
//! (bit-serial instructions, Enable).

mod board;
mod contents;
mod fifo;
mod job;
pub mod timing;

mod array;
mod bit_serial;
pub mod command;
pub mod conformance;
mod controller;
pub mod isa;
mod lanes;
mod layout;
mod look;
mod simd;

pub use array::{ArrayFault, EMPTY_PLANE, Executed, FaultKind, OutputRegion, PIXELS, PixelArray, Plane};
pub use bit_serial::BitSerial;
pub use board::{Renderer, RendererEvent, RendererOutput, RendererStats};
pub use command::{
    Clear, Command, CommandKind, CopyRegion, LoadBacking, PhongSphereCommand, PhongTriangleCommand,
    PhongTriangleEncoder, SPECULAR_SQUARINGS, SelectRegion, Shade, SphereBody, SphereCommand, StoreBacking,
    TriangleCommand, TriangleEncoder, Unsupported,
};
pub use contents::MAX_CONTEXTS;
pub use job::ArrayPool;
pub use lanes::Lanes;
pub use layout::{ContextPlan, FieldRange, Layout, LayoutError};
pub use look::RendererLook;
pub use simd::Vectors;
pub use timing::RendererTiming;
