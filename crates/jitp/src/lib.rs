//! Just-in-time pixels and frameless rendering. With just-in-time pixels, every strip of lines is drawn for the time at
//! which the beam scans the strip.
//!
//! ```text
//!   host:     report ...... report ......                      as the tracker delivers them
//!   master:   view, order | view, order | view, order ...      one strip of lines after the other, or random blocks
//!   slave 0:  strip 0, transform, bin, send ......... strip n
//!   slave 1:       strip 1, transform, bin, send ......... strip n + 1
//!   renderers:          commands of strip 0 | strip 1 ...      one column of 128 pixels each
//!   frame buffer:             strip 0 | strip 1 ...            just before the beam
//! ```
//!
//! - One graphics processor is the [`master`](fn@master). The master synchronizes with the beam, stores the newest
//!   tracking data and orders the strips. Slave k of n draws strips k, k + n, k + 2n and so on. For each strip, a slave
//!   has the time that the beam needs for n strips. Every slave holds the whole display list.
//! - A *strip* consists of one line or a few lines of a field ([`DrawingSchedule::Beam`]). The regions of a strip are
//!   128 pixels wide. Successive regions use the renderers in turn. No second buffer is needed, because a field is
//!   written while the beam scans the other field. If strips race the beam, each line is written just before the beam
//!   reaches this line.
//! - The [`Viewpoint`] sets the time for which a strip is drawn. The time can be the same for the whole field (a
//!   conventional picture), or different for each strip. With a *dual display list*, every vertex is transformed for
//!   the start T0 and the end T1 of the field. Strips are interpolated between T0 and T1, on the screen or in eye space
//!   before the division by depth ([`Interpolation`]).
//! - *Racing the beam* is a separate choice. A strip is ordered either just in time for the beam, or one field earlier.
//!   If strips are ordered one field earlier, the whole field is complete before its retrace.
//! - All slaves draw in the same region context of a renderer. A region's commands may need several messages. These
//!   messages reserve the renderer's port until the last message, which copies the region. No other slave can therefore
//!   draw into the region.
//! - Every second field uses the same lines of the frame buffer. For any number of slaves, a strip of field n is
//!   therefore ordered only after the beam has scanned the same lines in field n - 2.
//! - A strip is skipped if the beam reaches the strip before a slave can begin to draw it. The lines of field n - 2
//!   then stay on the screen.
//! - *Frameless* rendering ([`DrawingSchedule::Roam`]) draws blocks in a random order. Each order to a slave contains
//!   the newest view. The blocks go directly into the visible buffer.
//!
//! The reference picture, in which each pixel is drawn for its own time, is not part of this firmware.
//!
//! If the boards run i860 code, every step has its own code ([`pphigs`]):
//!
//! - For one view, TRANSFORM of the whole list stores commands with their bounding boxes. For two views, TRANSFORM
//!   stores the positions of triangles at the start and at the end of the field.
//! - For a strip between two views, code interpolates the triangles between these two positions. First, code computes
//!   the data of each structure (such as the direction of its light) with interpolated matrices.
//! - Code finds the primitives in a strip or block by their bounding boxes, and sends the primitives' commands like the
//!   bin of a region.
//! - Code assembles the master's orders.
//!
//! With i860 code, the time from the order of a field to the field's first strip is a constant. The number of blocks in
//! a batch is a constant, too.
//!
//! **Not modelled:** culling of the display list by line (a slave transforms every primitive for each strip),
//! transforms shared among slaves, Phong shading. Frameless rendering draws square blocks, because a message for a
//! single pixel would cost 16 words of overhead on the ring. A triangle with a corner outside the guard band has no
//! screen position at T0 or T1. Such a triangle is interpolated in eye space, like the spheres.
//!
//! Sources: Mine and Bishop, UNC TR93-005 (just-in-time pixels); Bishop et al. 1994 (frameless rendering); I3D95.

mod config;
mod drawing;
mod finding;
mod host;
mod master;
mod ordering;
mod pieces;
mod protocol;
#[cfg(test)]
mod rig;
mod slave;
pub mod timing;
mod whole;

pub use config::{Beam, BlockOrder, DrawingSchedule, Interpolation, JitpConfig, Viewpoint, Wanted};
pub use host::host;
pub use master::master;
pub use slave::{Transforms, slave};
pub use timing::JitpTiming;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
