//! Rendering Control: the pipeline of PPHIGS with a master and several slave graphics processors.
//!
//! ```text
//!   host:    SEND i   (wait for EDIT i)   SEND i+1 ...
//!   slaves:           EDIT i  TRANSFORM left, TRANSFORM right
//!   slaves, renderers:            RENDER left (token walk), RENDER right
//!   renderers, frame buffers:               COPY left, COPY right          swap at the retrace
//! ```
//!
//! One GP is the [`master`](fn@master); it begins each stage when the [`rules`] of TR94 permit it. The other GPs are
//! slaves. Each slave runs two programs: EDIT and TRANSFORM in the foreground, and an interrupt program that receives
//! tokens and sends bins. The [`host`](fn@host) reads the tracker and sends view and edits.
//!
//! RENDER: the master assigns the heaviest regions to the renderers first. It creates a token for each region and sends
//! it to a slave, each time to another one. A slave with a token sends its bin of the region and passes the token on.
//! The last slave adds the end-of-frame commands. It also adds the copy command, if the frame buffer was available when
//! the master sent the token. Otherwise the renderer keeps the region until the master sends the copy command. RENDER
//! ends when the last commands are *accepted*.
//!
//! An observer measures the latency from events in the trace. It starts with TRANSFORM of an eye's picture. It ends
//! with COPY of this picture, with the retrace at which the picture becomes visible, or with the display of its first
//! line.
//!
//! **Not modelled:** traversal of attributes (each edit has a fixed cost instead), loss of messages.
//!
//! Assumed: a finished region goes to the renderer's backing store (51 us). From there it goes to the frame buffer in
//! parallel with the next region's commands, one region at a time. A second finished region waits in pixel memory, and
//! later commands wait in the input FIFO. One software cost covers a chain of messages given to the DMA at once.
//!
//! Sources: TR94, I3D95.

mod config;
pub mod cube;
mod host;
mod master;
mod protocol;
pub mod rules;
mod slave;

pub use config::RenderingControlConfig;
pub use host::host;
pub use master::master;
pub use slave::slave;
