//! Experiments on address recalculation fed by an ideal renderer: a walk, its report, the papers' figures, pictures.
//!
//! ```text
//!  Scene ---------> World --+                     +--> WalkTally --> Report, comparison, figures
//!  Walk  ---------> eye ----+--> Simulation ------+
//!  Plan --> Settings -------+     policy, source  +--> Faces --> what the eye sees, pictures
//! ```
//!
//! # Behaviour
//!
//! - [`Plan`] holds settings by path (`priority.cell_m=5`), with what follows from others where it is not said.
//! - [`World`] cuts a scene at the borders of cells, once.
//! - [`Simulation::frame`] asks the policy what is due for a place of the eye, and hands it to the source: an ideal one has drawn it
//!   in the same frame; one that needs time serves memories in rising order, shows what was whole at the retrace in the frame after,
//!   and counts what was not.
//! - A memory holds what it was drawn from ([`Content`]); faces are drawn when somebody looks ([`Faces`]).
//! - [`walk()`] counts updates, draws and tears of a whole walk, [`Report`] says them as JSON; [`WalkOutcome`] is all of it
//!   for a plan, [`compare()`] for every policy and warp.
//! - [`figures`] has the papers' figures beside ours, [`pictures`] what people look at.
//!
//! Units: metres, seconds, radians unless a name says otherwise. A frame is 1/60 s. The same input gives the same bits on every host.
//!
//! # Not here
//!
//! Trackers and hosts: the eye is known at the beginning of each frame, its orientation at the latch. Latencies begin there; those of
//! `pxpl5 run` have a tracker and a host. Pixel-Planes 5 as a source.

mod compare;
mod content;
mod error;
mod experiment;
pub mod figures;
mod hall;
mod look;
pub mod pictures;
mod plan;
mod report;
mod settings;
mod simulation;
mod source;
mod tears;
mod walk;
mod world;

pub use address_recalculation;
pub use compare::{ArpComparison, ComparedRow, compare, variant_count};
pub use content::Content;
pub use error::ExperimentError;
pub use experiment::{WalkOutcome, WalkReport};
pub use hall::{Route, path_of, scaled};
pub use look::Faces;
pub use plan::{Plan, WalkNumbers};
pub use report::{Latency, Looked, MemoryReport, PriorityReport, Report, SCHEMA, TearsReport};
pub use settings::{PolicyKind, Settings, SourceKind};
pub use simulation::{FrameOutcome, Simulation};
pub use tears::{Percentiles, Tears};
pub use walk::{MemoryTally, WalkTally, at_frames, walk};
pub use world::{Object, Segment, SharedVertex, Tint, World};
