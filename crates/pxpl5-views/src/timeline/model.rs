//! Content of a timeline, before it is drawn.

use crate::ports::ShownPicture;
use pxpl5_display::Surface;
use pxpl5_gp::Stage;
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, PictureNumber, SurfaceId};

/// Work on one stage of a picture, drawn as a bar in a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bar {
    /// Stage of the work.
    pub stage: Stage,
    /// Number of the picture. If the host sends views independently of pictures, the bar of a SEND has the number of
    /// the view.
    pub picture: PictureNumber,
    /// Surface of a stage that works on one surface at a time. `None` if the display has only one surface.
    pub surface: Option<SurfaceId>,
    /// True for the bottom half of a picture whose halves are copied separately, false for the top half. `None` for a
    /// whole picture.
    pub bottom: Option<bool>,
    /// First line of the surface that a bottom half fills, otherwise 0.
    pub first_line: u32,
    /// Time at which the first board began the work.
    pub begin: Time,
    /// Time at which the last board ended the work. For a stage that did not end, the end of the run.
    pub end: Time,
    /// Lane of the bar in its row, from the top.
    pub lane: usize,
    /// Time spans in which a port received data, for COPY.
    pub receiving: Vec<(Time, Time)>,
}

/// A row of a timeline, for a resource that works independently.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TimelineRow {
    /// Name on the left of the row.
    pub name: String,
    /// Bars, in the order of their begin.
    pub bars: Vec<Bar>,
    /// Number of lanes, which is the largest number of overlapping bars.
    pub lanes: usize,
    /// Pictures that the port of this row showed. Empty for rows other than ports with their own swaps.
    pub shown: Vec<ShownPicture>,
}

/// A scan of the first display's first surface, which lights in one period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scan {
    /// Period of the scan. For NTSC, the period is a field.
    pub period: PeriodNumber,
    /// Picture that is displayed in the period.
    pub picture: Option<PictureNumber>,
    /// Time at which the first visible pixel lights.
    pub begin: Time,
    /// Time at which the last visible pixel lights.
    pub end: Time,
}

/// Part of a run as a timeline.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Timeline {
    /// Begin of the timeline, which is a retrace.
    pub from: Time,
    /// End of the timeline, which is a retrace.
    pub to: Time,
    /// Retraces of the first display, each with the number of the period that it begins.
    pub retraces: Vec<(PeriodNumber, Time)>,
    /// Sampled poses, each with the number of its picture or view. `None` if samples are not drawn.
    pub samples: Option<Vec<(PictureNumber, Time)>>,
    /// Rows, from top to bottom.
    pub rows: Vec<TimelineRow>,
    /// Scans of the first display.
    pub scans: Vec<Scan>,
    /// Surfaces of all displays, in order of their numbers.
    pub surfaces: Vec<Surface>,
    /// Picture whose dependencies are drawn.
    pub picture: Option<PictureNumber>,
    /// Number of the SEND that supplied the view of this picture.
    pub update: Option<PictureNumber>,
    /// Dependencies of this picture.
    pub arrows: Vec<Arrow>,
}

impl Timeline {
    /// Returns true if a bar belongs to the picture whose dependencies are drawn.
    #[must_use]
    pub fn is_chosen(&self, bar: &Bar) -> bool {
        let number = if bar.stage == Stage::Send { self.update } else { self.picture };
        number == Some(bar.picture)
    }

    /// Returns the bars of all rows.
    pub fn bars(&self) -> impl Iterator<Item = &Bar> {
        self.rows.iter().flat_map(|row| &row.bars)
    }
}

/// A dependency, drawn as an arrow: one event was necessary for another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrow {
    /// Row and lane of the necessary event.
    pub from: DrawingPlace,
    /// Time of the necessary event.
    pub begin: Time,
    /// Row and lane of the dependent event.
    pub to: DrawingPlace,
    /// Time of the dependent event.
    pub end: Time,
}

/// Place in a drawing, by its row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawingPlace {
    /// The row of the tracker.
    Tracker,
    /// A lane in a row of boards.
    Lane {
        /// Index of the row.
        row: usize,
        /// Index of the lane in the row.
        lane: usize,
    },
    /// The row of the display's beam.
    Beam,
}
