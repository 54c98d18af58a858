//! Cube control: the firmware of Rendering Control, adapted to six faces around an eye, depth and display memories.
//!
//! ```text
//!   host:    which memory, which structures, where the eye is: SEND u   (wait for EDIT u)   SEND u+1 ...
//!   slaves:           EDIT u, TRANSFORM u for six faces
//!   master:                            map of the regions that come, request to swap --> port of the memory
//!   slaves, renderers:                 RENDER u (token walk, regions with primitives alone)
//!   renderers, display memories:              COPY u: colours, then depths          swap at a retrace that finds all there
//! ```
//!
//! The structure is that of Rendering Control (TR94). One GP is the [`master`](fn@master). The others are slaves with
//! two programs each. A token for each region moves from slave to slave. The rules of TR94 decide when a stage may
//! begin, with a drawing for each update. A drawing is an *update* of one display memory: all six faces, in the grid of
//! [`address_recalculation::region_grid`].
//!
//! # Differences from Rendering Control
//!
//! - **Faces.** The host sends the eye's position but no orientation. Each slave derives six axis-aligned views
//!   ([`face_view`]). A primitive is transformed once for each face that it touches. Comparisons of coordinates discard
//!   primitives outside a face. The table of times charges nothing for them (assumed). At the cycle level they take the
//!   time of their code ([`pphigs::CubeTransform`]).
//! - **Depth.** The depth of a pixel is the renderers' depth: z/w along the axis of the face, in 24 bits. The near
//!   plane is 0, and empty pixels have all bits set. All views have the same near and far plane, so depths of different
//!   memories can be compared. A region is copied as two words per texel in 32 messages, through two blocks of the
//!   backing store. Alternatively, 16 + 16 bits take 16 messages.
//! - **Empty regions** get no token and are not copied. The map that begins an update omits them. An update without
//!   primitives still copies one region, so that its end is detected.
//! - **Memories** are served in the order of the host's updates. Each memory has its own double buffer. An update may
//!   be copied when the previous update of the same memory is visible. The swap is requested at the begin of the
//!   update. The display swaps at the first retrace at which the update is complete, and counts missed retraces.
//!   Updates of a group swap together.
//! - **Warping.** An update may move its vertices ([`FaceWarp`]). Each slave moves the vertices that it transforms.
//!   Vertices on the border to a slower memory then appear in the direction from which that memory was drawn. Spheres
//!   and moving objects are not warped.
//!
//! # Not modelled
//!
//! - Traversal of attributes beyond a cost per edit.
//! - The time to move vertices: about twenty floating-point operations, compared with a thousand for a triangle. No
//!   i860 code exists for it either.
//!
//! Sources: TR94 for the firmware; Chow, Pose and Regan 2005 for memories, updates and groups. No such machine was ever
//! built.

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
pub use host::{HostAction, host};
pub use master::master;
pub use slave::slave;
pub use update::FaceUpdate;
pub use warp::FaceWarp;
pub use warped_lists::WarpedLists;
