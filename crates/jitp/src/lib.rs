//! Just-in-time pixels: pictures in which every line is drawn for its own moment. Also frameless rendering.
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
//! - One GP is the [`master`](fn@master): it synchronizes with the beam, keeps the newest tracking data and orders the
//!   strips. Slave k of n computes strips k, k + n, k + 2n and so on, so it has n strip times for each. Every slave
//!   holds the whole display list.
//! - A *strip* is one line of a field or a few ([`DrawingSchedule::Beam`]). Its regions are 128 pixels wide, and go
//!   through the renderers in turn to the frame buffer. No second buffer is needed: one field is written while the
//!   other one is scanned, or each line is written just before the beam.
//! - The [`Viewpoint`] is the moment for which a strip is drawn. It is one moment for the whole field (a conventional
//!   picture), or one for each strip, or it follows the *dual display list*. A dual list has every vertex transformed
//!   for the start T0 and the end T1 of the field. It is interpolated on the screen, or in eye space before the divide
//!   ([`Interpolation`]).
//! - *Racing the beam* is a separate choice: a strip is ordered either just in time for the beam, or one field earlier,
//!   so that the whole field is complete before its retrace.
//! - All slaves draw in the same region context of a renderer. A region's commands may need several messages. They
//!   reserve the renderer's port until the last message, which copies the region, so that no other slave draws into it.
//! - A strip is never ordered before its lines of the field two before have been scanned, for any number of slaves.
//!   Both fields share the same place in the frame buffer.
//! - A strip is left out if the beam has passed before a slave can begin it. The lines of the earlier field stay on the
//!   screen.
//! - *Frameless* rendering ([`DrawingSchedule::Roam`]) draws blocks in a random order. Each order has the newest view,
//!   and the blocks are shown at once.
//!
//! The reference model, which evaluates the view at each pixel's own moment, is not part of the firmware.
//!
//! At the cycle level all steps are i860 code ([`pphigs`]):
//!
//! - TRANSFORM of the whole list keeps commands and their boxes, or the positions of triangles at the start and the
//!   end.
//! - The triangles of a strip are interpolated between both positions. Such a strip begins a pass of its own, with the
//!   interpolated matrices.
//! - The primitives in a strip or block are found by their boxes, and handed over like a bin.
//! - The master's orders are assembled by code.
//!
//! The start time of a field and the number of blocks in a batch are constants at the cycle level.
//!
//! **Not modelled:** culling of the display list by line (a slave transforms every primitive for each strip),
//! transforms shared among slaves, Phong shading. Frameless pixels come in square blocks, since a single pixel would
//! pay 16 words of overhead on the ring. A triangle with a corner outside the guard band has no screen position at T0
//! or T1; it is interpolated in eye space, like the spheres.
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

pub use config::{Beam, BlockOrder, DrawingSchedule, Interpolation, JitpConfig, JitpConfigError, Viewpoint, Wanted};
pub use host::host;
pub use master::master;
pub use slave::{Transforms, slave};
pub use timing::JitpTiming;
