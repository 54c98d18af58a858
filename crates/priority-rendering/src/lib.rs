//! Priority rendering: policies that decide when parts of the scene must be redrawn, and warping that joins parts of
//! different age.
//!
//! ```text
//!  objects --> [ validity period ] --> level --> Objects --+
//!                                                          +--> Update: memories that are due, most urgent first;
//!  eye ------> [ cells around home ] ---------> Cells -----+            those that may only be shown together
//!                                                 |
//!                                                 +--> RegionWarp: vertices at borders between memories
//! ```
//!
//! # Behaviour
//!
//! - **Validity** ([`Threshold::period`]): an image is wrong when the direction of a point is off by more than an
//!   angle. The causes are: the eye has moved (chord or sine), the object appears larger (disc or sphere), the object
//!   is animated, or the object rotates. A rotation of the head never makes an image wrong. A face that is out of sight
//!   can wait ([`time_until_visible_s`]).
//! - **Objects** ([`Objects`]): each object is in the slowest memory that keeps its image right. Memory k is drawn
//!   every 2^k frames. An object changes memories only in a frame that draws both, and both are shown together.
//! - **Cells** ([`Cells`]): the world is cut into square columns. The ring of a cell around the home cell determines
//!   its memory. Memory 0 holds the inner rings, and memory 1 holds one ring. Each further memory holds `ring_growth`
//!   times as many rings as the previous one.
//! - **Due memories**: a memory is due when the eye has moved farther than the memory's nearest cell permits. The
//!   nearest cell is that of its block, or the nearest occupied cell (`to_held_cells`). With warping, an update of a
//!   memory makes all faster ones due (cascade).
//! - **New home cell**: when the eye has left the home cell and the slowest memory is due, cells are assigned anew.
//!   Memories with changed cells are then shown together.
//! - **Segmentation** ([`Segmentation`]): meshes are cut at the borders of cells. Each line is cut once for all
//!   triangles that share it, so parts have bit-identical vertices along a cut. A segment is the part of a mesh in one
//!   cell.
//! - **Warping** ([`RegionWarp`]): a vertex on the border to the slower memory is moved by the difference of both eye
//!   positions. The vertex then has the same direction and depth in both memories.
//!
//! Units are metres, seconds and radians unless a name says degrees. Axes are right-handed with y up. Results are
//! bit-identical on every host.
//!
//! # Not here
//!
//! The pipeline that draws contains the faces, their source, and the handling of late updates.
//!
//! # Sources
//!
//! CPR05 = Chow, Pose and Regan, ACSC 2005; Regan and Pose, SIGGRAPH 94; US patent 5,841,439 (validity periods). Cell
//! size, falloff and threshold are not printed.

mod account;
mod cells;
mod config;
mod error;
mod objects;
mod segment;
mod sight;
mod update;
mod validity;
mod warp;

pub use account::{draws_per_s, saved_percent};
pub use cells::{Cell, CellAssignment, Cells};
pub use config::PriorityTiming;
pub use error::PriorityError;
pub use objects::Objects;
pub use segment::{CutVertex, Segmentation};
pub use sight::{angle_to_face, mean_faces_touched, time_until_visible_s};
pub use update::Update;
pub use validity::{Distance, ObjectView, SizeRule, Threshold, Translation, ValidityPeriod, level};
pub use warp::{Falloff, RegionWarp};
