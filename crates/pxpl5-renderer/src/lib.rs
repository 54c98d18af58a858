//! Renderer of Pixel-Planes 5: a 128 x 128 SIMD array of one-bit processors with an input FIFO at the ring.
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
//! # Behaviour, in the order of processing
//!
//! 1. Messages bring commands. All pixels execute the same instruction, so a command's time depends only on its kind
//!    ([`RendererTiming`], [`Renderer`]).
//! 2. A command is a fixed-length program of instructions ([`Command`], [`CommandKind`]), whose words, clocks and
//!    effects [`isa`] defines. A [`Layout`] places the bit fields in pixel memory.
//! 3. A triangle enables all pixels, then disables those at which one of three edge expressions is negative. The depth
//!    test disables pixels where the triangle is not nearer than the stored depth, and stores Z in the others. Colours
//!    (Gouraud) or normals (Phong) follow. A sphere's silhouette is a quadratic expression, whose square root gives
//!    depth, normal and light. [`Shade`] computes colours from normals once, after the last primitive of a region.
//! 4. Pixels are computed separately from time. The reference model [`BitSerial`] moves bit planes like the hardware,
//!    and defines every bit. [`BitSerial::skipping`] leaves out work that changes nothing. [`Lanes`] computes with
//!    whole numbers, and only at pixels that a command can change. [`conformance`] tests that all three agree in the
//!    208 bits of all pixels, Enable, clocks and faults.
//!
//! # Numbers
//!
//! A triangle takes 258 clocks with interpolated colour and 292 with normals. The design rate is 150,000 Phong triangles
//! per second (F89), which is 267 clocks per triangle. Each bit of the number formats takes one clock: 220 of the 258
//! clocks, and 250 of the 292 clocks. [`isa::timing`] derives the numbers, and [`command`] lists the other commands.
//!
//! # Faults
//!
//! An instruction with an illegal word or operand has no effect. It ends the list of commands and is counted
//! ([`ArrayFault`], [`PixelArray::faults`]).
//!
//! # Not modelled
//!
//! - The real instruction set, which is lost. Ours is **assumed**: the smallest one that can run the published
//!   programs.
//! - The split of the array into 64 chips.
//! - The time to fill the pipeline of the evaluator, except for a constant number of clocks for each instruction.
//! - A block of the backing store during its transfer. The whole block moves at the start, although the store stays
//!   busy for the time of the transfer.
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
mod simd;
mod snapshot;

pub use array::{ArrayFault, EMPTY_PLANE, Executed, FaultKind, OutputRegion, PIXELS, PixelArray, Plane};
pub use bit_serial::BitSerial;
pub use board::{DrawnRegion, Renderer, RendererEvent, RendererOutput, RendererStats};
pub use command::{
    Clear, Command, CommandKind, CopyRegion, LoadBacking, PhongSphereCommand, PhongTriangleCommand,
    PhongTriangleEncoder, SPECULAR_SQUARINGS, SelectRegion, Shade, SphereBody, SphereCommand, StoreBacking,
    TriangleCommand, TriangleEncoder, Unsupported,
};
pub use contents::MAX_CONTEXTS;
pub use job::ArrayPool;
pub use lanes::Lanes;
pub use layout::{ContextPlan, FieldRange, Layout};
pub use simd::Vectors;
pub use snapshot::RendererSnapshot;
pub use timing::RendererTiming;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
