//! Cube control: Rendering Control's firmware for six faces around an eye, regions with depth and display memories.
//!
//! ```text
//!   host:    which memory, which structures, where the eye is: SEND u   (wait for EDIT u)   SEND u+1 ...
//!   slaves:           EDIT u, TRANSFORM u for six faces
//!   master:                            map of the regions that come, request to swap --> port of the memory
//!   slaves, renderers:                 RENDER u (token walk, regions with primitives alone)
//!   renderers, display memories:              COPY u: colours, then depths          swap at a retrace that finds all there
//! ```
//!
//! The shape is that of Rendering Control (TR94): one GP is the [`master`](fn@master), the others are slaves with two programs
//! each, a token for each region walks from slave to slave, and what a stage waits for are its rules with a drawing for each update. Here
//! a drawing is an *update* of one display memory: all six faces, in the grid of [`address_recalculation::region_grid`].
//!
//! # What is different
//!
//! - **Faces.** The host sends the eye's position and never an orientation. Each slave makes the six axis-aligned views of it
//!   ([`face_view`]), and transforms a primitive once for each face that it touches. What lies beyond a side of a face is dropped by
//!   comparisons of coordinates: the table charges no time for them (assumed), by code they take theirs ([`pphigs::Surrounding`]).
//! - **Depth.** A pixel's depth is what the renderers hold for it: z/w along the axis of the face, 24 bits, 0 at the near plane, all
//!   ones where nothing is drawn. Near and far plane are the same in all views, so depths of different memories compare. A region is
//!   copied as two words a texel in 32 messages, through two blocks of the backing store; or as 16 + 16 bits in 16 messages.
//! - **Empty regions** get no token and are not copied; the map that begins an update leaves them out. Of an update without any
//!   primitive one region is copied, so that its end is seen.
//! - **Memories** are served in the order of the host's updates. Each has a double buffer of its own: an update may be
//!   copied when the one before it in the same memory is shown. The swap is asked for when the update begins: the display shows it at
//!   the first retrace at which it is whole, and counts those that it missed. Updates of a group name each other and swap together.
//!
//! - **Warping.** An update may say how its vertices are moved ([`FaceWarp`]): each slave moves those that it transforms, so that on
//!   the border to a slower memory they are seen in the direction from which that one was drawn. Spheres and what moves by itself stay
//!   where they are.
//!
//! # Not modelled
//!
//! Attribute traversal beyond a cost per edit; the time of moving vertices, some twenty floating-point operations beside the thousand
//! of a triangle, for which there is no code either.
//!
//! Sources: TR94 for the firmware; Chow, Pose and Regan 2005 for memories, updates and groups. Nobody has built the whole.

mod config;
mod faces;
mod host;
mod master;
mod protocol;
mod rules;
mod slave;
mod update;
mod warp;
mod warped_lists;

pub use config::{CubeControlConfig, Faces};
pub use faces::{CubePass, face_view};
pub use host::{Planned, host};
pub use master::master;
pub use slave::slave;
pub use update::FaceUpdate;
pub use warp::FaceWarp;
pub use warped_lists::WarpedLists;
