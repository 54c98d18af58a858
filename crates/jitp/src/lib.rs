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
//! - One GP is the [`master`](fn@master): it synchronizes with the beam, stores the newest tracking data and orders the
//!   strips. Slave k of n draws strips k, k + n, k + 2n and so on. It has the time of n strips for each strip. Every
//!   slave holds the whole display list.
//! - A *strip* consists of one line or a few lines of a field ([`DrawingSchedule::Beam`]). Its regions are 128 pixels
//!   wide. They use the renderers in turn. No second buffer is needed: one field is written while the other one is
//!   scanned, or each line is written just before the beam.
//! - The [`Viewpoint`] sets the time for which a strip is drawn. This can be one time for the whole field (a
//!   conventional picture), or one for each strip. With a *dual display list*, every vertex is transformed for the
//!   start T0 and the end T1 of the field. Strips are interpolated between both, on the screen or in eye space before
//!   the division by depth ([`Interpolation`]).
//! - *Racing the beam* is a separate choice. A strip is ordered either just in time for the beam, or one field earlier.
//!   In the second case the whole field is complete before its retrace.
//! - All slaves draw in the same region context of a renderer. A region's commands may need several messages. These
//!   messages reserve the renderer's port until the last one, which copies the region, so that no other slave draws
//!   into it.
//! - A field and the field two before it use the same lines of the frame buffer. A strip is therefore never ordered
//!   before its lines of the earlier field have been scanned, for any number of slaves.
//! - A strip is skipped if the beam passes it before a slave can begin it. The lines of the earlier field then stay on
//!   the screen.
//! - *Frameless* rendering ([`DrawingSchedule::Roam`]) draws blocks in a random order. Each order to a slave contains
//!   the newest view, and the blocks are shown at once.
//!
//! The reference picture, in which each pixel is drawn for its own time, is not part of this firmware.
//!
//! If the boards run i860 code, all steps are such code ([`pphigs`]):
//!
//! - TRANSFORM of the whole list stores commands and their bounding boxes, or the positions of triangles at the start
//!   and the end of the field.
//! - The triangles of a strip are interpolated between both positions. Such a strip begins a pass of its own, with the
//!   interpolated matrices.
//! - The primitives in a strip or block are found by their bounding boxes, and sent like the bin of a region.
//! - The master's orders are assembled by code.
//!
//! With i860 code, the start time of a field and the number of blocks in a batch are constants.
//!
//! **Not modelled:** culling of the display list by line (a slave transforms every primitive for each strip),
//! transforms shared among slaves, Phong shading. Frameless rendering draws square blocks, since a message for a single
//! pixel would cost 16 words of overhead on the ring. A triangle with a corner outside the guard band has no screen
//! position at T0 or T1. It is interpolated in eye space, like the spheres.
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

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
