use pxpl5_wire::{PeriodNumber, PictureNumber};

/// Options that select the part of a run to draw, and the rows of the drawing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TimelineOptions {
    /// Picture whose dependencies are drawn. The default is the first picture after the warm-up.
    pub picture: Option<PictureNumber>,
    /// First display period to draw. For NTSC, a period is a field. The default is the period in which the pose of the
    /// chosen picture is sampled.
    pub first_field: Option<PeriodNumber>,
    /// Number of display periods to draw, at most [`MAX_FIELDS`]. By default, the drawing ends one period after the
    /// chosen picture is shown.
    pub fields: Option<u64>,
    /// Title above the drawing.
    pub title: Option<String>,
    /// True for a drawing without the rows of the host and the tracker.
    pub without_host: bool,
}

/// Largest number of display periods in a drawing. More periods cannot be distinguished at the width of a page.
pub const MAX_FIELDS: u64 = 16;
