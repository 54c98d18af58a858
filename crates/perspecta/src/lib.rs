//! Perspecta: a diffuse screen that spins about its vertical axis, and a projector that strobes a picture of one bit a
//! colour at each of 396 angles of a revolution.
//!
//! ```text
//!  ring --map, tiles--> [ frame store 0 | frame store 1 ] --strobe k--> screen at k d --> [ viewer ] --> picture
//!       --swap request-->        swapped at strobe 0                                     one revolution
//! ```
//!
//! # Behaviour
//!
//! - A volume is N slices of one bit for red, green and blue. It arrives as maps and tiles ([`volume_messages`]) in the
//!   store that is not shown; a map blanks what is not sent. A request to swap takes effect at a strobe 0 after it, and not
//!   before every announced tile is there: a slice half written is never shown.
//! - Strobe k of revolution n lights at (n + k / N) / f. As [`Display`](pxpl5_display::Display), a period is a revolution
//!   and a surface a slice; each pixel of a slice lights when its strobe begins.
//! - Strobes k and k + N/2 show the same plane turned over, so a volume appears twice a revolution.
//! - The viewer adds up all lit pixels of one revolution as points of light at their voxels, in whole numbers. Nothing hides
//!   anything.
//!
//! # Numbers
//!
//! [`PerspectaConfig`] has the ones that the paper gives and those that it leaves open, with their ranges; [`figures`] the
//! paper's own against ours.
//!
//! # Not modelled
//!
//! Optics and keystone of the projector, the motor, colours of its lamps, the relay optics that turn with the screen; pixels
//! outside the screen's circle are as bright as those in it.
//!
//! # Sources
//!
//! The SpatialGL paper (ASI-0110, 2005); Favalora et al. 2001 (SPIE 4297) and Chun et al. 2005 (SPIE 5664) for presets.

mod display;
mod error;
pub mod figures;
mod protocol;
mod store;
mod timing;
mod viewer;

pub use error::PerspectaError;
pub use protocol::{BatchMessages, TileMessage, batch_messages, volume_messages};
pub use timing::PerspectaConfig;
pub use viewer::{Camera, Light, ViewOptions, film, view_planes, view_undithered};
