//! Records of stages, made by firmware for observers of a run. Records cost no simulated time and change no state.

use pxpl5_sim::Time;
use pxpl5_wire::{NodeId, PictureNumber, SurfaceId, ViewNumber};
use serde::{Deserialize, Serialize};

/// A stage of a pipeline, named as in the papers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// The instant at which the tracker measured the pose of the head for which the picture is drawn.
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
    /// All stages with their names in reports, in the order in which a picture passes the stages.
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

/// One end of a stage: its begin or its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StageEdge {
    /// The start of the stage.
    Begin,
    /// The end of the stage: the time at which the last work of the stage ends or its last message is accepted.
    End,
}

impl StageEdge {
    /// The two edges of a stage with their names in reports.
    pub const ALL: [(&str, Self); 2] = [("begin", Self::Begin), ("end", Self::End)];
}

pxpl5_sim::parameters::named!(StageEdge, "edge of a stage", StageEdge::ALL);

/// A record that a stage began or ended at a certain time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Mark {
    /// Simulated time at which the stage began or ended.
    pub time: Time,
    /// Ring port of the board that made the record.
    pub node: NodeId,
    /// Number of the picture that the stage makes. If the host sends views independently of pictures, its records have
    /// the number of the transmission instead.
    pub picture: PictureNumber,
    /// Surface (such as the picture of an eye) for which the stage draws. `None` if the stage does not draw one surface
    /// at a time.
    pub surface: Option<SurfaceId>,
    /// Stage that began or ended.
    pub stage: Stage,
    /// Begin or end of the stage.
    pub edge: StageEdge,
    /// View that the picture shows, if the program has recorded the view.
    pub view: Option<ViewNumber>,
}
