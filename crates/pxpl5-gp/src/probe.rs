//! What firmware tells the observer; it costs nothing and changes nothing.

use pxpl5_sim::Time;
use pxpl5_wire::{NodeId, PictureNumber, SurfaceId, ViewNumber};
use serde::{Deserialize, Serialize};

/// A stage of a pipeline, in the papers' words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// The tracker's pose that the picture shows was sampled.
    Sample,
    /// Host to GPs: edits, attributes, transforms.
    Send,
    /// GPs apply the edits.
    Edit,
    /// Primitives to screen space, commands into bins.
    Transform,
    /// Commands to the renderers until the last is accepted.
    Render,
    /// Regions to the frame buffer.
    Copy,
    /// The finished picture is shown from the retrace on.
    Swap,
}

/// Begin or end of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StageEdge {
    /// The stage begins: its program turns to it.
    Begin,
    /// The stage ends: its last work or message is done.
    End,
}

/// One fact about the pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Mark {
    /// When it happened, in simulated time.
    pub time: Time,
    /// The port of the board on which it happened.
    pub node: NodeId,
    /// The picture. A host that sends views apart from pictures counts its transmissions here.
    pub picture: PictureNumber,
    /// The surface that it is drawn for, for stages that take one eye at a time.
    pub surface: Option<SurfaceId>,
    /// Which part of its work the firmware begins or ends.
    pub stage: Stage,
    /// Whether the stage began or ended.
    pub edge: StageEdge,
    /// The view that the picture shows, where the program says it.
    pub view: Option<ViewNumber>,
}
