//! Priority rendering: policies that decide when parts of the scene must be drawn again, and warping, by which parts of
//! different age meet without gaps.
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
//! - **Validity** ([`Threshold::period`]): an image is wrong when the direction of a point is off by more than the
//!   threshold angle. There are four causes: the eye has moved (chord or sine), the object appears larger (disc or
//!   sphere), is animated, or rotates. A rotation of the head never makes an image wrong.
//! - **Objects** ([`Objects`]): each object is in the least often drawn memory in which its image stays correct. Memory
//!   k is drawn every 2^k frames. An object changes its memory only in a frame that draws and shows both.
//! - **Cells** ([`Cells`]): the floor is divided into square cells. The home cell is the one that contained the eye
//!   when cells were last assigned to memories, and all cells at one distance from it form a ring. Memory 0 holds the
//!   inner rings, memory 1 one ring, and each later memory `ring_growth` times as many as the one before.
//! - **Due memories**: a memory must be drawn again when the eye has moved too far since its last update. How far it
//!   may move grows with the distance to the nearest cell, among all cells that the memory could hold or only among
//!   cells with content (`to_held_cells`). With warping, an update also makes all more often drawn memories due
//!   (cascade).
//! - **New home cell**: cells are assigned anew when the eye has left the home cell and the least often drawn memory is
//!   due. All memories whose cells have changed are then shown together.
//! - **Segmentation** ([`Segmentation`]): meshes are cut at the borders of cells. Each line is cut once for all
//!   triangles that share it, so the parts have bit-identical vertices along a cut. A segment is the part of a mesh in
//!   one cell.
//! - **Warping** ([`RegionWarp`]): a vertex on the border to the less often drawn memory is moved by the difference of
//!   the two eye positions from which the memories were drawn. It then has the same direction and depth in both.
//!
//! Units are metres, seconds and radians, except in names that contain `deg`. Axes are right-handed with y up. Results
//! are bit-identical on every computer.
//!
//! # Not here
//!
//! The program that draws the faces supplies their pixels and handles late updates.
//!
//! # Sources
//!
//! CPR05 = Chow, Pose and Regan, ACSC 2005; Regan and Pose, SIGGRAPH 94; US patent 5,841,439 (validity periods). Cell
//! size, falloff and threshold are not printed.

mod account;
mod cells;
mod config;
mod objects;
mod segment;
mod update;
mod validity;
mod warp;

pub use account::{draws_per_s, saved_percent};
pub use cells::{Cell, CellAssignment, Cells};
pub use config::PriorityTiming;
pub use objects::Objects;
pub use segment::{CutVertex, Segmentation};
pub use update::Update;
pub use validity::{Distance, ObjectView, SizeRule, Threshold, Translation, ValidityPeriod, level};
pub use warp::{Falloff, RegionWarp};
