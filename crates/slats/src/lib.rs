//! Slats: a pipeline that draws a new image for every NTSC field. The pipeline runs on one graphics processor (GP). The
//! model also supports several GPs, although the prototype had only one.
//!
//! ```text
//!   retrace n                                                    retrace n+1
//!      | TRANSFORM both eyes, clump by clump ..........| COPY       |  light
//!      |    RENDER from the first clump on .............| (top half) | (bottom half)
//! ```
//!
//! A field that is shown from retrace n+1 on is drawn between the retraces n and n+1. The latency is therefore one
//! field.
//!
//! - SEND: the host sends viewing transforms for every new report of the tracker. Each field uses the newest transforms
//!   that have arrived at its start. If no new transforms have arrived, the field uses the transforms of the previous
//!   field. Primitives are in memory from the start.
//! - TRANSFORM: one pass of compiled code makes the commands of both eyes, with planes in single precision
//!   (crates/pxpl5-geometry/kernels/slats_rules.md). The primitives are divided into *clumps* of 30. A clump goes to
//!   all regions of both eyes ([`pphigs::RegionBinning::All`], as in the prototype) or only to the regions that it
//!   touches. Each GP has one clump buffer.
//! - RENDER: every region has a fixed renderer, and only the lines of the coming field are drawn. A renderer holds up
//!   to four region contexts in the 208 bits of its pixels. This memory is sufficient only for Gouraud shading.
//! - COPY, whole ([`CopySchedule::Whole`]): all regions are copied before the retrace.
//! - COPY, split ([`CopySchedule::Split`]): the top regions are copied before the retrace, and the bottom regions
//!   directly after the retrace. Each renderer acknowledges its last top region by a message, which takes software
//!   time. After all acknowledgements, the GP orders the copies of the bottom regions. In TR94, the GP also ensures
//!   that all top regions are copied first.
//! - COPY, backup ([`CopySchedule::Backup`], not in the prototype): like split, but into the buffer that is not shown.
//!   If a field's top regions are not ready at its retrace, the last complete field of the same lines is shown again.
//!   The late field is shown at the next retrace of its lines.
//! - Without a backup buffer (schedules whole and split), a late field is shown at its retrace with the regions that
//!   are ready. The GPs continue with the field that begins at the next retrace.
//!
//! If there are n GPs, each GP holds every n-th primitive. The first GP sends the copy commands when all other GPs have
//! reported that their last clump was accepted.
//!
//! **Not modelled:** loading of the primitives at initialization.
//!
//! Assumed: renderers with an odd index begin a split copy with the right eye. Copies to both frame buffers then start
//! at the same time. If all renderers began with the left eye, ten regions would take the time of six regions instead
//! of the published five. A whole copy begins with the left eye on every renderer. Then 20 regions take the time of 11
//! regions, as published.
//!
//! Sources: TR94, I3D95.

mod bind;
mod config;
mod host;
mod processor;

pub use bind::{Binding, BoundRegion, CopySchedule};
pub use config::SlatsConfig;
pub use host::host;
pub use processor::{CLUMP, processor};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
