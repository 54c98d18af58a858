//! Streaming observers, which process the records of a run during the run, so that old records can be discarded.

use crate::head_views::HeadViews;
use crate::pipeline::{PictureTimes, Pipeline};
use crate::result_window::ResultWindow;
use pxpl5_machine::{Arrival, Record};
use pxpl5_scene::Hmd;
use pxpl5_wire::PeriodNumber;
use pxpl5_wire::display::Aim;
use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

/// Results of a run that can no longer change, and that a streaming observer has not received before.
///
/// After a run that keeps everything, one value of this type holds all results of the run.
#[derive(Clone, Copy, Debug)]
pub struct FinalResults<'a> {
    /// Pipeline that draws the pictures.
    pub pipeline: &'a dyn Pipeline,
    /// Instant for which a picture's view is drawn, within the time in which the picture is displayed. Examples are the
    /// middle and the first pixel.
    pub aim: Aim,
    /// Number of periods of the first display that the run simulates.
    pub fields: u64,
    /// The machine and its records in memory, including records of later pictures and periods.
    pub record: &'a Record,
    /// Views of the tracked head that remain in memory. `None` without a head.
    pub head: Option<&'a Arc<HeadViews>>,
    /// Optics of the head-mounted display.
    pub hmd: Hmd,
    /// Regions that have arrived since the last call of the observer. Some may belong to later pictures.
    pub arrivals: &'a [Arrival],
    /// Pictures whose results can no longer change, in the order in which the pictures are shown.
    pub pictures: &'a [PictureTimes],
    /// The next picture that is shown after all of `pictures`. `None` at the end of the run.
    pub next: Option<&'a PictureTimes>,
    /// First period whose results can still change. The observer has received every picture that is shown before this
    /// period, even in part.
    pub until: PeriodNumber,
    /// Largest number of samples of each kind that are kept individually: see
    /// [`Samples::keeping`](crate::Samples::keeping).
    pub samples: usize,
    /// Result window as determined so far. `None` if the run has no window.
    ///
    /// The start of the result window may still move to a later period. All data that the observer received earlier
    /// then lies outside the result window.
    pub window: Option<ResultWindow>,
}

impl FinalResults<'_> {
    /// Returns the pictures that lie in the result window.
    pub fn steady_pictures(&self) -> impl Iterator<Item = &PictureTimes> {
        let display = self.record.display();
        let window = self.window;
        let is_held = move |times: &&PictureTimes| {
            window.is_some_and(|window| window.holds_picture(display.period_at(times.shown_at)))
        };
        self.pictures.iter().filter(is_held)
    }

    /// Returns the final periods of the result window, beginning with `next`. `next` is the first period that the
    /// observer has not received.
    pub fn periods_from(&self, next: PeriodNumber) -> impl DoubleEndedIterator<Item = PeriodNumber> + Clone + use<> {
        let Self { until, window, .. } = *self;
        let (first, end) = window
            .map_or((until, until), |window| (window.first_period.max(next), window.last_period.next().min(until)));
        first.until(end.max(first))
    }
}

/// A streaming observer of a run.
///
/// The observer receives every record once, in order. The observer must store all data for later use, because the run
/// discards old records.
pub trait StreamingObserver: Debug + Send {
    /// Processes results that can no longer change.
    fn take(&mut self, results: &FinalResults<'_>);

    /// Returns the observer's result. The run calls this method once, after the last call of `take`.
    fn result(self: Box<Self>) -> Box<dyn Any + Send + Sync>;
}

/// Function that creates the streaming observer of a run.
pub type ObserverFactory = fn() -> Box<dyn StreamingObserver>;
