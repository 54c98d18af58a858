//! Records of stages, which firmware makes for observers of a run. Records cost no simulated time and change no state.

use pxpl5_sim::Time;
use pxpl5_wire::{NodeId, PictureNumber, SurfaceId, ViewNumber};
use serde::{Deserialize, Serialize};

/// A stage of a pipeline, named as in the papers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// The instant at which the tracker measures the pose of the head for a picture.
    Sample,
    /// The host sends edits, attributes and transforms to the graphics processors.
    Send,
    /// The graphics processors apply the edits to the scene.
    Edit,
    /// The graphics processors transform primitives to screen space and put commands into bins.
    Transform,
    /// The graphics processors send commands to the renderers. The stage ends when the last command is accepted.
    Render,
    /// The renderers send their regions to the frame buffer.
    Copy,
    /// The display shows the finished picture from this retrace on.
    Swap,
}

impl Stage {
    /// All stages with their names in reports, in the order of the work on a picture.
    pub const ALL: [(&str, Self); 7] = [
        ("sample", Self::Sample),
        ("send", Self::Send),
        ("edit", Self::Edit),
        ("transform", Self::Transform),
        ("render", Self::Render),
        ("copy", Self::Copy),
        ("swap", Self::Swap),
    ];
}

pxpl5_sim::parameters::named!(Stage, "stage", Stage::ALL);

/// The begin or the end of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StageEdge {
    Begin,
    /// The time at which the last work of the stage ends, or the receiver accepts its last message.
    End,
}

impl StageEdge {
    pub const ALL: [(&str, Self); 2] = [("begin", Self::Begin), ("end", Self::End)];
}

pxpl5_sim::parameters::named!(StageEdge, "edge of a stage", StageEdge::ALL);

/// A record that a stage began or ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Mark {
    pub time: Time,
    pub node: NodeId,
    /// Number of the picture to which the stage belongs. If the host sends views independently of pictures, its records
    /// contain the number of the transmission instead.
    pub picture: PictureNumber,
    /// Picture of an eye, or other surface, for which the stage draws. `None` if the stage does not draw one surface at
    /// a time.
    pub surface: Option<SurfaceId>,
    pub stage: Stage,
    pub edge: StageEdge,
    /// View that the picture shows. `None` if the program did not record the view.
    pub view: Option<ViewNumber>,
}
