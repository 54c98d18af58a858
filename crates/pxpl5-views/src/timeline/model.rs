//! What a timeline shows, before it is drawn.

use crate::ports::PortShown;
use pxpl5_display::Surface;
use pxpl5_gp::Stage;
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, PictureNumber, SurfaceId};

/// A stage of a picture in a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bar {
    /// The stage whose work the bar stands for.
    pub stage: Stage,
    /// The picture; of SEND under a pipeline whose host sends views apart from pictures, the view's number.
    pub picture: PictureNumber,
    /// The surface, for stages that take one at a time; `None` where there is only one to be told apart.
    pub surface: Option<SurfaceId>,
    /// Whether it is the bottom half of a picture whose halves are copied apart; `None` for a whole one.
    pub bottom: Option<bool>,
    /// The first line of the surface that a bottom half fills; else 0.
    pub first_line: u32,
    /// When the first board began it.
    pub begin: Time,
    /// When the last board ended it; the end of the run for a stage that did not end.
    pub end: Time,
    /// Where in the row it stands, from the top.
    pub lane: usize,
    /// When a port really received, for COPY.
    pub receiving: Vec<(Time, Time)>,
}

/// A resource that works independently.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TimelineRow {
    /// What stands left of it.
    pub name: String,
    /// Its stages in order of begin.
    pub bars: Vec<Bar>,
    /// How many bars stand above each other at most.
    pub lanes: usize,
    /// What it showed, of a port that is swapped by itself; else nothing.
    pub shown: Vec<PortShown>,
}

/// A period of the first display, in which its first surface is lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scan {
    /// The period: an NTSC display's field.
    pub period: PeriodNumber,
    /// The picture that is shown in it.
    pub picture: Option<PictureNumber>,
    /// When the first visible pixel lights.
    pub begin: Time,
    /// When the last one does.
    pub end: Time,
}

/// A part of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Timeline {
    /// Its begin, a retrace.
    pub from: Time,
    /// Its end, a retrace.
    pub to: Time,
    /// Retraces of the first display, each behind the number of the period that it begins.
    pub retraces: Vec<(PeriodNumber, Time)>,
    /// Poses that were sampled, the picture or update first; `None` when they are not shown.
    pub samples: Option<Vec<(PictureNumber, Time)>>,
    /// A row for each board, from top to bottom.
    pub rows: Vec<TimelineRow>,
    /// What the first display shows.
    pub scans: Vec<Scan>,
    /// All surfaces, in the order of their numbers.
    pub surfaces: Vec<Surface>,
    /// The picture whose dependencies are shown.
    pub picture: Option<PictureNumber>,
    /// The view that this picture shows, by the number that its SEND bears.
    pub update: Option<PictureNumber>,
    /// What it had to wait for.
    pub arrows: Vec<Arrow>,
}

impl Timeline {
    /// Whether a bar belongs to the picture whose dependencies are shown.
    #[must_use]
    pub fn is_chosen(&self, bar: &Bar) -> bool {
        let number = if bar.stage == Stage::Send { self.update } else { self.picture };
        number == Some(bar.picture)
    }

    /// All bars of all rows.
    pub fn bars(&self) -> impl Iterator<Item = &Bar> {
        self.rows.iter().flat_map(|row| &row.bars)
    }
}

/// A dependency: something could begin because something else had happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrow {
    /// Row and lane where it begins.
    pub from: DrawingPlace,
    /// The instant at which the arrow begins.
    pub begin: Time,
    /// Row and lane where it ends.
    pub to: DrawingPlace,
    /// When that could begin.
    pub end: Time,
}

/// Where in a drawing something happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawingPlace {
    /// In the tracker's row.
    Tracker,
    /// In a lane of a row of boards.
    Lane {
        /// The row.
        row: usize,
        /// Its lane.
        lane: usize,
    },
    /// In the row of the display's beam.
    Beam,
}
