//! Rendering Control: the pipeline of PPHIGS with a master and several slave graphics processors.
//!
//! ```text
//!   host:    SEND i   (wait for EDIT i)   SEND i+1 ...
//!   slaves:           EDIT i  TRANSFORM left, TRANSFORM right
//!   slaves, renderers:            RENDER left (token walk), RENDER right
//!   renderers, frame buffers:               COPY left, COPY right          swap at the retrace
//! ```
//!
//! One graphics processor is the [`master`](fn@master), which begins each stage when the [`rules`] of TR94 permit the
//! stage. The other graphics processors are slaves. Each slave runs two programs: EDIT and TRANSFORM in the foreground,
//! and an interrupt program that receives tokens and sends bins. The [`host`](fn@host) reads the tracker and sends view
//! and edits.
//!
//! RENDER: the master first assigns the regions with the most bin entries to the renderers. The master creates a token
//! for each region and sends the token to a slave. The slaves take turns as the first holder of a token. A slave with a
//! token sends its bin of the region and passes the token on. The last slave adds the commands that end the region. If
//! the frame buffer was available when the master sent the token, the last slave also adds the copy command. Otherwise
//! the renderer keeps the region until the master sends the copy command. RENDER ends when the last commands are
//! *accepted*.
//!
//! The programs draw any kind of picture that implements [`Drawn`]: [`Frames`] of one or two eyes, or the cube faces of
//! [`cube`].
//!
//! An observer measures the latency from events in the trace. The latency starts with TRANSFORM of an eye's picture.
//! Three ends are possible: the end of COPY of this picture, the retrace at which the picture becomes visible, or the
//! display of its first line.
//!
//! **Not modelled:** traversal of attributes (each edit has a fixed cost instead), loss of messages.
//!
//! Assumed: a finished region goes to the renderer's backing store (51 us). From there, the region goes to the frame
//! buffer while the renderer executes the next region's commands. Only one region is sent at a time. A second finished
//! region waits in pixel memory, and later commands wait in the input FIFO. A chain of messages, which the DMA gets as
//! a whole, has the software cost of one message.
//!
//! Sources: TR94, I3D95.

pub mod cube;
mod drawn;
mod frames;
mod host;
mod master;
mod protocol;
pub mod rules;
mod slave;

pub use drawn::{Drawn, RenderingControlConfig, Sent};
pub use frames::Frames;
pub use host::{HostAction, frames, host};
pub use master::master;
pub use slave::slave;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
