//! Inputs of the emulated machine: scenes, model files, the head-mounted display and the motion of the head.
//!
//! ```text
//!  load("x.ply") --+                 +--> vertices, triangles, spheres   --> processors, once
//!  builtin("mig") -+--> Scene -------+--> edits_at(time)                 --> processors, every frame
//!                        |
//!                        +--> motion() --> HeadMotion::pose(time) --> Hmd::stereo --> two Views
//! ```
//!
//! # Behaviour
//!
//! - A [`Scene`] is a display list of spheres and indexed triangles. Each vertex has a normal and a colour. A
//!   *structure* is a named part of the display list with one model matrix. An [`Edit`] is a new model matrix for a
//!   structure. [`Scene::edits_at`] returns the edits of a frame for structures with a motion of their own.
//! - [`from_bytes`] reads PLY, OBJ, STL, glTF and PDB models. The models are
//!   fitted into the default view. No input makes [`from_bytes`] panic. `load` reads a file of the host and needs the
//!   feature `files`. Without this feature, the crate makes no calls to the operating system and can be compiled for a
//!   browser.
//! - [`builtin`] generates the scenes of the published measurements, or similar scenes:
//!
//! | name | triangles | spheres | provenance of the counts |
//! |---|---|---|---|
//! | `aircraft` | 100 | | assumed: few enough for Slats to draw in one field |
//! | `mig` | 417 | | published TR94 |
//! | `molecules` | 2,620 | 1,219 | published TR94 |
//! | `head` | 59,592 | | published TR94 |
//! | `room` | 4 | | assumed |
//! | `gallery`, `gallery:full` | 112, 572 | | assumed |
//! | `full-screen:N` | N | | published TR94 for N = 12 |
//! | `typical:N` | N | | their size is derived from the 1.3 regions of TR94 |
//! | `sphere:N` | N | | |
//!
//! - [`HeadMotion::pose`] returns the [`Pose`] of the head at any picosecond. [`Hmd::stereo`] returns the [`View`]s of
//!   its eyes.
//!
//! # Conventions
//!
//! Units are metres, degrees and picoseconds. World, head and eye coordinates are right-handed with +y up. Head and
//! eyes look along their -z axes. The position of a head is the point between its eyes. Triangles are anticlockwise
//! seen from outside. Clip depth z/w grows from 0 at the near plane to 1 at the far plane. Matrices act on column
//! vectors: `projection * world_to_eye * model * point`.
//!
//! # Determinism
//!
//! All results are computed in double precision with basic arithmetic, square roots and software trigonometry (`libm`),
//! and then rounded once to f32. The results agree in every bit on all hosts.
//!
//! # Not modelled
//!
//! Scenes have no textures, transparency, nested structures or levels of detail. Materials are diffuse colours, and
//! there is one light. Edits cannot add or remove primitives. The display has no lens distortion. Head speeds lack the
//! long tail of recorded speeds. The errors of trackers are modelled in the crate `tracking`, not here.
//!
//! # Sources
//!
//! TR94 is Cohen and Olano, *Low Latency Rendering on Pixel-Planes 5*, UNC TR94-028. JITP is Mine and Bishop,
//! *Just-In-Time Pixels*, UNC TR93-005. Myoglobin is by H. C. Watson 1969, Protein Data Bank 1MBN. Radii of atoms are
//! by Bondi 1964. [`config`] and [`HmdConfig::unc`] list every number with its provenance.

#![warn(missing_docs)]

mod builtin;
pub mod config;
mod decimate;
mod edit;
mod error;
mod from_triangles;
mod import;
mod motion;
mod scene;
mod sway;
mod trig;

pub use builtin::{builtin, names};
pub use decimate::Decimation;
pub use edit::{Edit, Hinge};
pub use import::{Format, Placement, from_bytes, from_reader, placed_from_bytes, placed_from_reader};
#[cfg(feature = "files")]
pub use import::{load, load_placed};
pub use motion::{HeadMotion, HeadPath};
pub use scene::{Frame, Lighting, Scene, SceneParts, Sphere, Structure, Vertex};
pub use sway::Sway;
pub use tracking::Pose;
pub use tracking::view::{EyePoint, Hmd, HmdConfig, View};

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
