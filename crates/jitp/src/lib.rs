//! Just-in-time pixels: pictures whose every line is drawn for its own moment, and frameless rendering.
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
//! - One GP is the [`master`](fn@master): it synchronises with the beam, keeps the newest tracking data and orders the
//!   strips. Slave k of n computes strips k, k + n, k + 2n, ...; so it has n strip times for each. Every slave holds
//!   the whole display list.
//! - A *strip* is one line of a field or a few ([`DrawingSchedule::Beam`]); its regions are 128 pixels wide and go through
//!   the renderers in turn to the frame buffer, which needs no second buffer: one field is written while the other
//!   one is scanned, or each line just before the beam.
//! - Which moment a strip is drawn for is the [`Viewpoint`]: one for the whole field (a conventional picture), one for
//!   each strip, or the *dual display list*: every vertex is transformed for the begin T0 and the end T1 of the field
//!   and interpolated, on the screen or in the view before the divide ([`Interpolation`]).
//! - *Racing the beam* is independent of that: a strip is ordered just in time for the beam, or else one field
//!   earlier, so that the whole field is there before its retrace.
//! - All slaves draw in the same region context of a renderer. A region's commands may need several messages; they keep the
//!   renderer's port until the last one, which copies the region, so that no other slave draws into it.
//! - A strip is never ordered before its lines of the field two before have been scanned, however many slaves there are:
//!   their place in the frame buffer is the same.
//! - A strip whose beam has passed when a slave could begin it is left out; the lines of the field before stay.
//! - *Frameless* ([`DrawingSchedule::Roam`]): blocks in a random order, each order with the newest view, shown at once.
//!
//! The reference that evaluates the view at each pixel's own moment is mathematics, not firmware.
//!
//! At the cycle level all of that is i860 code ([`pphigs`]): TRANSFORM of the whole list, which keeps commands and their boxes, or the places
//! of triangles in the views of the begin and the end; the triangles of a strip between these; what meets a strip or a block, found
//! among the boxes and handed over as a bin is; the orders that the master puts together. A strip between two views begins a pass of its
//! own, with the interpolated matrices. When slaves begin with a field, and how many blocks are a batch, are constants there.
//!
//! **Not modelled:** culling of the display list by line (a slave transforms every primitive for each strip), transforms
//! shared among slaves, Phong shading. Frameless pixels come in square blocks: one pixel alone would pay 16 words of
//! overhead on the ring. A triangle that a corner takes out of the guard band has no place on the screen at T0 or T1;
//! it is interpolated in the view, and so are spheres.
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
