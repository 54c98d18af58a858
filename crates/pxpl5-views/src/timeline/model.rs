//! Content of a timeline, before it is drawn.

use crate::ports::ShownPicture;
use pxpl5_gp::Stage;
use pxpl5_sim::Time;
use pxpl5_wire::display::Surface;
use pxpl5_wire::{PeriodNumber, PictureNumber, SurfaceId};

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

/// Work on one stage of a picture, drawn as a bar in a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bar {
    /// Stage of the pipeline to which the work belongs.
    pub stage: Stage,
    /// Number of the picture. If the host sends head poses (views) independently of pictures, a bar of SEND has the
    /// number of the view instead.
    pub picture: PictureNumber,
    /// Surface for which the stage works. `None` for work on all surfaces, or if the display has only one surface.
    pub surface: Option<SurfaceId>,
    /// True for the bottom half of a picture whose halves are copied separately, false for the top half. `None` for a
    /// whole picture.
    pub bottom: Option<bool>,
    /// First line that the work of this bar fills on the surface, for example the first line of a bottom half. The
    /// value is 0 for work that fills no lines.
    pub first_line: u32,
    /// Time at which the first board began this work.
    pub begin: Time,
    /// Time at which the last board ended this work. For a stage that did not end, the end of the run.
    pub end: Time,
    /// Index of the bar's lane in its row, counted from the top. Lanes divide a row in which bars overlap.
    pub lane: usize,
    /// Time spans in which the port of the surface received data. The list is empty for all stages except COPY.
    pub receiving: Vec<(Time, Time)>,
}

/// A row of a timeline, for a resource that works independently of other resources.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TimelineRow {
    /// Name of the resource, drawn on the left of the row.
    pub name: String,
    /// Bars for the work of the resource, in the order of their start.
    pub bars: Vec<Bar>,
    /// Number of lanes into which the row is divided: the largest number of bars that overlap at one time.
    pub lanes: usize,
    /// Pictures that the port of this row showed. The list is empty unless the row belongs to a port that swaps
    /// independently.
    pub shown: Vec<ShownPicture>,
}

/// The scan of the first display's first surface in one period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimelineScan {
    /// Period of the scan. For NTSC, the period is a field.
    pub period: PeriodNumber,
    /// Picture that is displayed in this period, if any.
    pub picture: Option<PictureNumber>,
    /// Time at which the first visible pixel is lit.
    pub begin: Time,
    /// Time at which the last visible pixel is lit.
    pub end: Time,
}

/// A part of a run, as a timeline.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Timeline {
    /// Start of the timeline, which is a retrace.
    pub from: Time,
    /// End of the timeline, which is a retrace.
    pub to: Time,
    /// Retraces of the first display, each with the period that begins at the retrace.
    pub retraces: Vec<(PeriodNumber, Time)>,
    /// Sampled head poses, each with the number of the picture or update for which the pose was sampled. `None` if
    /// samples are not drawn.
    pub samples: Option<Vec<(PictureNumber, Time)>>,
    /// Rows, from top to bottom.
    pub rows: Vec<TimelineRow>,
    /// Scans of the first display.
    pub scans: Vec<TimelineScan>,
    /// Surfaces of all displays, in order of their numbers.
    pub surfaces: Vec<Surface>,
    /// Picture whose dependencies are drawn.
    pub picture: Option<PictureNumber>,
    /// Number of the SEND that supplied the head pose for the picture in [`Timeline::picture`].
    pub update: Option<PictureNumber>,
    /// Dependencies of the picture in [`Timeline::picture`].
    pub arrows: Vec<Arrow>,
}

impl Timeline {
    /// Returns true if a bar belongs to the picture in [`Timeline::picture`].
    pub fn is_chosen(&self, bar: &Bar) -> bool {
        let number = if bar.stage == Stage::Send { self.update } else { self.picture };
        number == Some(bar.picture)
    }

    /// Returns the bars of all rows.
    pub fn bars(&self) -> impl Iterator<Item = &Bar> {
        self.rows.iter().flat_map(|row| &row.bars)
    }
}

/// A dependency, drawn as an arrow: the first event was necessary for the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrow {
    /// Row and lane of the first event.
    pub from: DrawingPlace,
    /// Time of the first event.
    pub begin: Time,
    /// Row and lane of the second event.
    pub to: DrawingPlace,
    /// Time of the second event.
    pub end: Time,
}

/// One end of an arrow: a row of the drawing, and the lane if the row belongs to boards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawingPlace {
    /// The row of the timeline that shows the samples of the tracker.
    Tracker,
    /// A lane (part of a row) in a row of boards.
    Lane {
        /// Index of the row, counted from the top.
        row: usize,
        /// Index of the lane in the row, counted from the top.
        lane: usize,
    },
    /// The row of the timeline that shows the display's beam.
    Beam,
}
