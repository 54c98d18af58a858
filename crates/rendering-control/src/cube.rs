//! Cube control: the firmware of Rendering Control (TR94), adapted to display memories that hold colours and depths of
//! six faces around the eye.
//!
//! ```text
//!   host:    memory, structures, position of the eye: SEND u   (wait for EDIT u)   SEND u+1 ...
//!   slaves:           EDIT u, TRANSFORM u for six faces
//!   master:                            map of the regions to come, request to swap --> port of the memory
//!   slaves, renderers:                 RENDER u (token walk, only regions with primitives)
//!   renderers, display memories:              COPY u: colours, then depths          swap when all are there
//! ```
//!
//! The programs are the programs of Rendering Control ([`host`](crate::host()), [`master`](crate::master()),
//! [`slave`](crate::slave())), which draw any kind of picture that implements [`Drawn`](crate::Drawn). [`Faces`] is
//! such a kind. The rules of TR94 for the start of a stage apply to updates instead of frames. An *update* draws one
//! display memory: all six faces, in the grid of [`address_recalculation::region_grid`].
//!
//! # Differences from Rendering Control
//!
//! - **Faces.** The host sends the eye's position but no orientation. Each slave derives six axis-aligned views
//!   ([`face_view`]). A primitive is transformed once for each face that it touches. Comparisons of coordinates find
//!   the faces that a primitive does not touch. In the timing table, these comparisons take no time (assumed). With
//!   i860 code, the comparisons take the time of their code ([`pphigs::CubeTransform`]).
//! - **Depth.** The depth of a texel is the depth that the renderers compute: z/w along the axis of the face, in 24
//!   bits. The near plane is 0, and empty texels have all bits set. All views have the same near and far plane, so
//!   depths of different memories can be compared. A region is copied as two words for each texel in 32 messages,
//!   and takes the space of two regions in the backing store. With 16 bits of colour and 16 bits of depth, a region
//!   takes 16 messages.
//! - **Empty regions** get no token and are not copied. The message that announces an update omits empty regions. An
//!   update without primitives still copies one region, so that its end is detected.
//! - **Memories** are updated in the order that the host chooses. Each memory has its own double buffer. An update must
//!   not be copied before the previous update of the same memory is visible. The master requests the swap at the
//!   beginning of the update. The display swaps at the first retrace at which the update is complete, and counts the
//!   earlier retraces. The memories of a group swap together.
//! - **Warping.** An update can displace its vertices ([`FaceWarp`]). Each slave displaces the vertices that it
//!   transforms. Some memories are updated less often than other memories. A vertex on the border between two memories
//!   then appears in the same direction in both memories. Spheres and moving objects are not warped.
//!
//! # Not modelled
//!
//! - Traversal of attributes (each edit has a fixed cost instead).
//! - The time to displace vertices: about twenty floating-point operations for each vertex, compared with a thousand
//!   for a triangle. There is no i860 code for this work either.
//!
//! Sources: TR94 for the firmware; Chow, Pose and Regan 2005 for memories, updates and groups. No such machine was ever
//! built.

mod config;
mod faces;
mod update;
mod warp;
mod warped_lists;

pub use config::Faces;
pub use faces::face_view;
pub use update::FaceUpdate;
pub use warp::FaceWarp;
pub use warped_lists::WarpedLists;
