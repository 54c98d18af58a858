//! What of a run is drawn.

use pxpl5_wire::{PeriodNumber, PictureNumber};

/// What of a run is drawn, and how.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TimelineOptions {
    /// The picture whose dependencies are drawn; else the first after the warm-up.
    pub picture: Option<PictureNumber>,
    /// The first period of the display that is drawn, an NTSC field; else the one in which that picture's pose is
    /// sampled.
    pub first_field: Option<PeriodNumber>,
    /// The number of periods drawn, at most [`MAX_FIELDS`]; else until a period after the picture is shown.
    pub fields: Option<u64>,
    /// What stands above the drawing.
    pub title: Option<String>,
    /// The host's row is left out, and so is the tracker's.
    pub without_host: bool,
}

/// More periods than this cannot be told apart at page width.
pub const MAX_FIELDS: u64 = 16;
