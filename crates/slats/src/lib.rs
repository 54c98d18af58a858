//! Slats: a new image every NTSC field on one graphics processor (or, beyond the prototype, on several).
//!
//! ```text
//!   retrace n                                                    retrace n+1
//!      | TRANSFORM both eyes, clump by clump ..........| COPY       |  light
//!      |    RENDER from the first clump on .............| (top half) | (bottom half)
//! ```
//!
//! Everything that is shown from retrace n+1 on is done between the retraces n and n+1, so the latency is one field.
//!
//! - SEND: the host sends the viewing transforms whenever the tracker has new ones; at the start of a field the newest
//!   is taken, and the same again if none came. Primitives are there from the start.
//! - TRANSFORM: every 30 primitives make a *clump*, which goes to all regions of both eyes
//!   ([`pphigs::RegionBinning::All`], the prototype) or to those that it touches. There is one clump buffer.
//! - RENDER: regions are bound to renderers; only the lines of the coming field are drawn. A renderer keeps up to four
//!   region contexts in its 208 bits, hence Gouraud shading.
//! - COPY: whole ([`CopySchedule::Whole`]): all regions before the retrace. Split ([`CopySchedule::Split`]): the top regions before the
//!   retrace, the bottom ones right after it.
//!   Each renderer acknowledges its last top region, and the bottom ones are ordered when all have (TR94: the GP makes sure that all top
//!   regions go before any bottom one). An acknowledgement is a message, whose software takes time.
//!   Backup ([`CopySchedule::Backup`], beyond the prototype): as split, into the other buffer; of a field whose top regions are not there at
//!   its retrace the last complete one of the same lines is shown again, and the late one at the next retrace of its lines.
//! - Without a backup a field that misses its retrace is shown as far as it has come; the GPs go on with the next whole field.
//!
//! Several GPs: each holds every n-th primitive; the first one sends the copy commands when the others have told it
//! that their last clump was accepted.
//!
//! **Not modelled:** loading of the primitives at initialisation.
//!
//! Assumed: the odd renderers begin a split copy with the right eye, so that both frame buffers start at once (with
//! all beginning left, ten regions would take six region times instead of the published five); a whole copy begins
//! left everywhere, which gives the published 11 for 20 regions.
//!
//! Sources: TR94, I3D95.

mod bind;
mod config;
mod error;
mod host;
mod processor;
mod schedule;

pub use bind::{Binding, BoundRegion};
pub use config::SlatsConfig;
pub use error::SlatsConfigError;
pub use host::host;
pub use processor::{CLUMP, processor};
pub use schedule::CopySchedule;
