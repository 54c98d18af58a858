//! What the machine draws and who looks at it: scenes, model files, the head-mounted display, and a head's motion.
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
//! - A [`Scene`] is a display list: indexed triangles with a normal and a colour for each vertex, spheres, and
//!   *structures*, named runs of both with one model matrix each. An [`Edit`] replaces a model matrix;
//!   [`Scene::edits_at`] gives the scripted edits of a frame.
//! - [`from_bytes`] reads PLY, OBJ and PDB models and fits them into the default view. No bytes make it panic. `load`
//!   does so with a file of the host; without the feature `files` the crate asks no operating system for anything, and
//!   builds for a browser.
//! - [`builtin`] generates the scenes of the published measurements, or likenesses of them:
//!
//! | name | triangles | spheres | standing of the counts |
//! |---|---|---|---|
//! | `aircraft` | 100 | | assumed: what Slats draws in time |
//! | `mig` | 417 | | published TR94 |
//! | `molecules` | 2,620 | 1,219 | assumed |
//! | `head` | 59,592 | | assumed |
//! | `gallery`, `gallery:full` | 112, 572 | | assumed |
//! | `full-screen:N` | N | | published TR94 for N = 12 |
//! | `typical:N` | N | | published TR94 for their size |
//! | `sphere:N` | N | | |
//!
//! - [`HeadMotion::pose`] gives the head's [`Pose`] at any picosecond; [`Hmd::stereo`] the [`View`]s of its eyes.
//!
//! # Conventions
//!
//! Metres, degrees, picoseconds. World, head and eye coordinates are right-handed with +y up; a head and an eye look
//! along their -z. A head's place is the point between its eyes. Triangles are anticlockwise seen from outside. Clip depth z/w runs from 0 at the near plane to 1 at
//! the far plane, growing with distance. Matrices act on column vectors: `projection * world_to_eye * model * point`.
//!
//! # Determinism
//!
//! Everything is computed in double precision with arithmetic, square roots and software trigonometry (`libm`), then
//! rounded once to f32: all hosts agree in every bit.
//!
//! # Not modelled
//!
//! Textures, materials other than a diffuse colour, transparency, several lights, nested structures, edits that add
//! or remove primitives, level of detail; lens distortion and converging optical axes of the display; the heavy tail
//! of recorded head speeds; trackers, which see this motion through their own errors.
//!
//! # Sources
//!
//! TR94 = Cohen and Olano, *Low Latency Rendering on Pixel-Planes 5*, UNC TR94-028; JITP = Mine and Bishop,
//! *Just-In-Time Pixels*, UNC TR93-005; myoglobin = H. C. Watson 1969, Protein Data Bank 1MBN; radii of atoms =
//! Bondi 1964. Every number with its standing: [`config`] and [`HmdConfig::unc`].

#![warn(missing_docs)]

mod builtin;
pub mod config;
mod decimate;
mod edit;
mod error;
mod import;
mod motion;
mod scene;
mod sway;
mod trig;
mod view;

pub use builtin::{builtin, names};
pub use edit::{Edit, Hinge};
pub use error::{FilePlace, LoadError, RangeError, SceneError};
pub use import::{Format, Placement, from_bytes, from_reader, placed_from_bytes, placed_from_reader};
#[cfg(feature = "files")]
pub use import::{load, load_placed};
pub use motion::{HeadMotion, HeadPath};
pub use scene::{Frame, Lighting, Scene, SceneParts, Sphere, Structure, Vertex};
pub use sway::Sway;
pub use tracking::Pose;
pub use view::{EyePoint, Hmd, HmdConfig, View};
