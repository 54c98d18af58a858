//! Rendering Control: the pipeline of master and slave graphics processors under PPHIGS.
//!
//! ```text
//!   host:    SEND i   (wait for EDIT i)   SEND i+1 ...
//!   slaves:           EDIT i  TRANSFORM left, TRANSFORM right
//!   slaves, renderers:            RENDER left (token walk), RENDER right
//!   renderers, frame buffers:               COPY left, COPY right          swap at the retrace
//! ```
//!
//! One GP is the [`master`](fn@master); it begins each stage when the [`rules`] of TR94 allow it. The others are
//! slaves, with two programs each: EDIT and TRANSFORM in the foreground, and a background program that takes tokens
//! and sends bins. The [`host`](fn@host) reads the tracker and sends view and edits.
//!
//! RENDER: the master gives the heaviest regions to the renderers first, and the token of each region to another
//! slave. A slave with a token sends its bin of that region and passes the token on; the last one adds the
//! end-of-frame commands, and the copy command if the frame buffer was available when the token was first sent.
//! Otherwise the renderer holds the region until the master sends the copy command. RENDER ends when the last
//! commands are *accepted*.
//!
//! Latency (defined by the observer from the marks): from the start of TRANSFORM of an eye's picture to the end of
//! its COPY, to the retrace at which it is swapped in, and to the light of its first line.
//!
//! **Not modelled:** attribute traversal beyond a cost per edit, loss of messages.
//!
//! Assumed: a finished region goes to the renderer's backing store (51 us) and from there to the frame buffer beside the
//! next region's commands, one region at a time; a second finished region waits in pixel memory, and commands behind it
//! in the input FIFO; one software cost covers a chain of messages given to the DMA at once.
//!
//! Sources: TR94, I3D95.

mod config;
mod host;
mod master;
mod protocol;
pub mod rules;
mod slave;

pub use config::RenderingControlConfig;
pub use host::host;
pub use master::master;
pub use slave::slave;
