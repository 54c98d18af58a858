//! Rendering Control: the pipeline of master and slave graphics processors under PPHIGS.
//!
//! ```text
//!   host:    SEND i   (wait for EDIT i)   SEND i+1 ...
//!   slaves:           EDIT i  TRANSFORM left, TRANSFORM right
//!   slaves, renderers:            RENDER left (token walk), RENDER right
//!   renderers, frame buffers:               COPY left, COPY right          swap at the retrace
//! ```
//!
//! One GP is the [`master`](fn@master); it begins each stage when the [`rules`] of TR94 permit it. The others are
//! slaves, with two programs each: EDIT and TRANSFORM in the foreground, and an interrupt program that receives tokens
//! and sends bins. The [`host`](fn@host) reads the tracker and sends view and edits.
//!
//! RENDER: the master assigns the heaviest regions to the renderers first, and gives the token of each region to
//! another slave. A slave with a token sends its bin of the region and passes the token on. The last slave adds the
//! end-of-frame commands. It also adds the copy command, if the frame buffer was available when the token was first
//! sent. Otherwise the renderer keeps the region until the master sends the copy command. RENDER ends when the last
//! commands are *accepted*.
//!
//! Latency is defined by the observer from the marks. It starts with TRANSFORM of an eye's picture. It ends with its
//! COPY, with the retrace at which the picture is swapped in, or with the light of its first line.
//!
//! **Not modelled:** attribute traversal beyond a cost per edit, loss of messages.
//!
//! Assumed: a finished region goes to the renderer's backing store (51 us). From there it goes to the frame buffer in
//! parallel with the next region's commands, one region at a time. A second finished region waits in pixel memory, and
//! later commands wait in the input FIFO. One software cost covers a chain of messages given to the DMA at once.
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
