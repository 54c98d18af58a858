//! Priority rendering: what around the head must be redrawn when, and how pieces of different age are joined.
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
//! - **Validity** ([`Threshold::period`]): an image is wrong when a point of it is off by more than an angle, because the eye
//!   went on (chord or sine), because the object grew (disc or sphere), because it is animated or turns. A turn of the head
//!   never makes it wrong; a face out of sight can wait ([`until_in_sight_s`]).
//! - **Objects** ([`Objects`]): an object is in the slowest memory in which its image stays right; memory k is drawn every 2^k
//!   frames. It changes memories only in a frame that draws both, and both are shown together.
//! - **Cells** ([`Cells`]): the world is cut in square columns. A cell's ring around the home cell decides its memory. Memory 0 holds
//!   the inner rings, memory 1 one ring, and each further memory `ring_growth` times as many as the one before. A memory is due when
//!   the eye has gone farther than its nearest cell allows. That cell is the nearest of its block, or the nearest that holds
//!   something (`to_held_cells`). When the eye has left the home cell and the slowest memory is due, cells are dealt anew, and the
//!   memories whose cells are others are shown together. With warping an update of a memory makes all faster ones due (cascade).
//! - **Segmentation** ([`Segmentation`]): meshes are cut at the borders of cells, each line once for all who share it, so that parts
//!   meet in the same vertices bit for bit. A segment is what a mesh has in a cell.
//! - **Warping** ([`RegionWarp`]): a vertex on the border to the slower memory is moved by the difference of the places that both
//!   were drawn from, so that it has the same direction and depth in both.
//!
//! Units: metres, seconds, radians unless a name says degrees. Axes right-handed, y up. Same input, same bits on every host.
//!
//! # Not here
//!
//! Faces and their source, and what happens to updates that come too late: those belong to the pipeline that draws.
//!
//! # Sources
//!
//! CPR05 = Chow, Pose and Regan, ACSC 2005; Regan and Pose, SIGGRAPH 94; US patent 5,841,439 (validity periods). Cell size, falloff
//! and threshold are not printed.

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
pub use cells::{Cell, Cells, Dealing};
pub use config::PriorityTiming;
pub use error::PriorityError;
pub use objects::Objects;
pub use segment::{CutVertex, Segmentation};
pub use sight::{angle_to_face, mean_faces_touched, until_in_sight_s};
pub use update::Update;
pub use validity::{Distance, SeenObject, SizeRule, Threshold, Translation, ValidityPeriod, level};
pub use warp::{Falloff, RegionWarp};
