//! Perspecta: a diffuse screen that rotates about its vertical axis, and a projector that flashes (strobes) a picture
//! at each of 396 angles of a revolution. Each pixel has one bit per colour.
//!
//! ```text
//!  ring --map, tiles--> [ frame store 0 | frame store 1 ] --strobe k--> screen at k d --> [ viewer ] --> picture
//!       --swap request-->        swapped at strobe 0                                     one revolution
//! ```
//!
//! # Behaviour
//!
//! - A volume is N slices with one bit each for red, green and blue. It arrives as maps and tiles ([`volume_messages`])
//!   in the frame store that is not shown. A map lists the tiles that will be sent, and makes all others dark. A swap
//!   request takes effect at the first later strobe 0 at which all announced tiles have arrived, so a partly written
//!   slice is never shown.
//! - Strobe k of revolution n lights at the time (n + k / N) / f, for f revolutions per second. In terms of
//!   [`Display`](pxpl5_wire::display::Display), a period is a revolution and a surface is a slice. Each pixel of a
//!   slice lights when its strobe begins.
//! - Strobes k and k + N/2 show the same plane from opposite sides, so a volume appears twice per revolution.
//! - The viewer adds the light of all lit pixels of one revolution, each as a point at its voxel, in integers. No voxel
//!   hides another.
//!
//! # Numbers
//!
//! [`PerspectaConfig`] has the numbers of the SpatialGL paper. Where the paper gives no number, the table has an
//! assumed value with a range. [`figures`] compares the paper's figures with this model.
//!
//! # Not modelled
//!
//! Optics and keystone of the projector, the motor, the colours of the projector's lamps, and the relay optics that
//! turn with the screen. Pixels outside the screen's circle are as bright as pixels inside it.
//!
//! # Sources
//!
//! The SpatialGL paper (ASI-0110, 2005). Favalora et al. 2001 (SPIE 4297) and Chun et al. 2005 (SPIE 5664) for presets.

mod display;
pub mod figures;
mod protocol;
mod store;
mod timing;
mod viewer;

pub use protocol::{BatchMessages, TileMessage, batch_messages, volume_messages};
pub use timing::PerspectaConfig;
pub use viewer::{Camera, PictureLight, ViewOptions, film, view_planes, view_undithered};
