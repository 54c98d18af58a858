//! Options of a timeline.

use pxpl5_wire::{PeriodNumber, PictureNumber};

/// Options that select the part of a run to draw, and the content of the drawing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TimelineOptions {
    /// Picture whose dependencies are drawn. The default is the first picture after the warm-up.
    pub picture: Option<PictureNumber>,
    /// First period of the display to draw. For NTSC, a period is a field. The default is the period in which the pose
    /// of the picture is sampled.
    pub first_field: Option<PeriodNumber>,
    /// Number of periods to draw, at most [`MAX_FIELDS`]. By default, the drawing ends one period after the picture is
    /// shown.
    pub fields: Option<u64>,
    /// Title above the drawing.
    pub title: Option<String>,
    /// True to leave out the rows of the host and the tracker.
    pub without_host: bool,
}

/// Largest number of periods in a drawing. More cannot be distinguished at the width of a page.
pub const MAX_FIELDS: u64 = 16;
