//! Slats: a new image every NTSC field on one graphics processor (GP), or on several, which the prototype did not
//! support.
//!
//! ```text
//!   retrace n                                                    retrace n+1
//!      | TRANSFORM both eyes, clump by clump ..........| COPY       |  light
//!      |    RENDER from the first clump on .............| (top half) | (bottom half)
//! ```
//!
//! A field that is shown from retrace n+1 on is drawn between the retraces n and n+1, so the latency is one field.
//!
//! - SEND: the host sends the viewing transforms whenever the tracker has new ones. At the start of a field the newest
//!   one is used, or the last one again if none has come. Primitives are in memory from the start.
//! - TRANSFORM: every 30 primitives make a *clump*. The clump goes to all regions of both eyes
//!   ([`pphigs::RegionBinning::All`], the prototype) or to the regions that it touches. There is one clump buffer.
//! - RENDER: regions are bound to renderers, and only the lines of the coming field are drawn. A renderer keeps up to
//!   four region contexts in its 208 bits, which leaves room only for Gouraud shading.
//! - COPY, whole ([`CopySchedule::Whole`]): all regions are copied before the retrace.
//! - COPY, split ([`CopySchedule::Split`]): the top regions are copied before the retrace, the bottom regions right
//!   after it. Each renderer acknowledges its last top region. The bottom regions are ordered when all renderers have
//!   done so, since TR94's GP makes sure that all top regions go first. An acknowledgement is a message, whose software
//!   takes time.
//! - COPY, backup ([`CopySchedule::Backup`], not in the prototype): as split, but into the other buffer. If a field's
//!   top regions are not ready at its retrace, the last complete field of the same lines is shown again. The late field
//!   is shown at the next retrace of its lines.
//! - Without a backup, a field that misses its retrace is shown as far as it is complete. The GPs continue with the
//!   next whole field.
//!
//! If there are several GPs, each holds every n-th primitive. The first GP sends the copy commands when the others have
//! reported that their last clump was accepted.
//!
//! **Not modelled:** loading of the primitives at initialization.
//!
//! Assumed: the odd renderers begin a split copy with the right eye, so that both frame buffers start at once. If all
//! began with the left eye, ten regions would take six region times instead of the published five. A whole copy begins
//! with the left eye everywhere, which gives the published 11 for 20 regions.
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
