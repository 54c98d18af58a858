//! Experiments on address recalculation with an ideal renderer: walks, reports, the papers' figures and pictures.
//!
//! ```text
//!  Scene ---------> World --+                     +--> WalkTally --> Report, comparison, figures
//!  Walk  ---------> eye ----+--> Simulation ------+
//!  Plan --> Settings -------+     policy, source  +--> Faces --> what the eye sees, pictures
//! ```
//!
//! # Behaviour
//!
//! - [`Plan`] holds settings by path (`priority.cell_m=5`). Settings that are not given follow from the others.
//! - [`World`] cuts a scene at the borders of cells, once.
//! - [`Simulation::frame`] asks the policy which memories are due for a position of the eye, and passes the work to the
//!   source.
//! - An ideal source draws within the same frame. A timed source serves memories in ascending order. It shows complete
//!   updates in the next frame and counts incomplete ones.
//! - A memory holds the data it is drawn from ([`Content`]). Its faces are drawn only when they are read ([`Faces`]).
//! - [`walk()`] counts the updates, draws and tears of a whole walk. [`Report`] writes them as JSON.
//! - [`WalkOutcome`] holds the results of one plan. [`compare()`] walks with every policy and warp.
//! - [`figures`] compares the papers' figures with the simulated ones. [`pictures`] draws pictures.
//!
//! Units are metres, seconds and radians unless a name says otherwise. A frame is 1/60 s. Results are bit-identical on
//! every host.
//!
//! # Not here
//!
//! Trackers and the host: the eye's position is known at the start of each frame, and its orientation at the latch.
//! Latencies begin there, while latencies of `pxpl5 run` include a tracker and a host. Pixel-Planes 5 is not available
//! as a source.

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
pub use report::{Latency, MemoryReport, PriorityReport, Report, SCHEMA, TearsReport, ViewStatistics};
pub use settings::{PolicyKind, Settings, SourceKind};
pub use simulation::{FrameOutcome, Simulation};
pub use tears::{Percentiles, Tears};
pub use walk::{MemoryTally, WalkTally, at_frames, walk};
pub use world::{Object, Segment, SharedVertex, Tint, World};
