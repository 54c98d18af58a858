//! Marks that firmware records for the observer. Marks cost no simulated time and change nothing.

use pxpl5_sim::Time;
use pxpl5_wire::{NodeId, PictureNumber, SurfaceId, ViewNumber};
use serde::{Deserialize, Serialize};

/// A stage of a pipeline, named as in the papers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// The tracker sampled the pose that the picture shows.
    Sample,
    /// The host sends edits, attributes and transforms to the GPs.
    Send,
    /// The GPs apply the edits.
    Edit,
    /// The GPs transform primitives to screen space and put commands into bins.
    Transform,
    /// The GPs send commands to the renderers until the last one is accepted.
    Render,
    /// The renderers send regions to the frame buffer.
    Copy,
    /// The display shows the finished picture from this retrace on.
    Swap,
}

/// Begin or end of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StageEdge {
    /// The program starts the stage.
    Begin,
    /// The last work or message of the stage is complete.
    End,
}

/// A record of the begin or end of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Mark {
    /// Simulated time of the record.
    pub time: Time,
    /// Port of the board.
    pub node: NodeId,
    /// Number of the picture. A host that sends views independently of pictures counts its transmissions instead.
    pub picture: PictureNumber,
    /// Surface that the stage draws, for stages that draw one eye at a time.
    pub surface: Option<SurfaceId>,
    /// Stage that begins or ends.
    pub stage: Stage,
    /// Begin or end.
    pub edge: StageEdge,
    /// View that the picture shows, if the program reports it.
    pub view: Option<ViewNumber>,
}
