//! Pipelines that draw the six faces of a cube around the viewer's head, for a display that chooses the texels at
//! scan-out.
//!
//! ```text
//!   policy (plan, objects, cells) --requests--> pipeline: host and firmware, or ideal faces --swaps--> history
//!   tracker --> latched head, load schedule: the orientation that the display latches
//! ```

mod cells;
mod entries;
pub(crate) mod history;
mod ideal;
mod keys;
pub(crate) mod latched_head;
mod load_schedule;
mod objects;
mod pipeline;
mod plan;
pub(crate) mod requests;
pub(crate) mod segments;

pub(crate) use entries::ENTRIES;
pub use history::{FaceHistory, ShownUpdate};
pub use keys::FacePolicy;
pub use latched_head::{OrientationTiming, RotationLatency};
pub use pipeline::{FacePipeline, FaceSource};
pub use requests::{RequestedUpdate, RequestedUpdates};
pub use segments::SegmentedScene;
