//! Experiments on address recalculation with an ideal renderer: walks, reports, the papers' figures and pictures.
//!
//! ```text
//!  Scene ---------> World --+                     +--> WalkTally --> ArpReport, comparison, figures
//!  Walk  ---------> eye ----+--> Simulation ------+
//!  WalkPlan --> WalkSettings -------+     policy, source  +--> WalkFaces --> what the eye sees, pictures
//! ```
//!
//! # Behaviour
//!
//! - [`WalkPlan`] holds settings by path (`priority.cell_m=5`). The defaults of some settings depend on other settings.
//! - [`World`] cuts a scene at the borders of cells, once.
//! - [`Simulation::frame`] calls the policy, which returns the memories that are due for an update. The renderer then
//!   draws these memories.
//! - An ideal renderer draws within the same frame. A renderer of limited speed draws memories in ascending order of
//!   their indices. The renderer shows complete updates in the next frame and counts incomplete updates.
//! - A memory holds the data from which it is drawn ([`Content`]). Its faces are drawn only when they are read
//!   ([`WalkFaces`]).
//! - [`walk()`] counts the updates, draws and tears (gaps between memories) of a whole walk. [`ArpReport`] contains
//!   these results in the form of a JSON report.
//! - [`WalkOutcome`] holds the results of one plan. [`compare()`] simulates a walk with every policy and kind of
//!   warping.
//! - [`figures`] compares the papers' figures with the simulated figures. [`pictures`] draws pictures.
//!
//! Units are metres, seconds and radians unless a name contains another unit. A frame is 1/60 s. Results are
//! bit-identical on every computer.
//!
//! # Not here
//!
//! Trackers and the host. The eye's position is known at the start of each frame. The head's orientation is known when
//! the display reads it. Latencies begin at these instants, while latencies of `pxpl5 run` include a tracker and a
//! host. Pixel-Planes 5 is not available as a renderer.

mod compare;
mod content;
pub mod cube_faces;
mod experiment;
pub mod figures;
mod hall;
pub mod pictures;
mod plan;
mod report;
mod settings;
mod simulation;
mod source;
mod tears;
mod walk;
mod walk_faces;
mod world;

pub use address_recalculation;
pub use compare::{ArpComparison, ComparedRow, compare, variant_count};
pub use content::Content;
pub use experiment::{WalkOutcome, WalkReport};
pub use hall::{Route, path_of, scaled};
pub use plan::{WalkNumbers, WalkPlan};
pub use pxpl5_sim::parameters::PathSettings;
pub use report::{ArpReport, PriorityReport, SCHEMA, TearsReport, WalkLatency, WalkMemoryReport};
pub use settings::{PolicyKind, SourceKind, WalkSettings};
pub use simulation::{FrameOutcome, Simulation};
pub use tears::{TearWidths, Tears};
pub use walk::{MemoryTally, WalkTally, at_frames, walk};
pub use walk_faces::WalkFaces;
pub use world::{Object, Segment, SharedVertex, Tint, World};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
