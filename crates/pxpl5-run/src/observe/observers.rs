//! Streaming observers, which compute results during a run, so that old records can be discarded.

use crate::head_views::HeadViews;
use crate::pipeline::{PictureTimes, Pipeline};
use crate::result::result_window::ResultWindow;
use pxpl5_machine::{Arrival, Record};
use pxpl5_scene::Hmd;
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use pxpl5_wire::display::Aim;
use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

/// Results that became final since the last call of a streaming observer.
///
/// After a run that keeps everything, one value of this type has all results.
#[derive(Clone, Copy, Debug)]
pub struct FinalResults<'a> {
    /// Pipeline that draws the pictures.
    pub pipeline: &'a dyn Pipeline,
    /// Instant for which pictures are drawn, such as the middle of the time in which a picture lights.
    pub aim: Aim,
    /// Number of periods of the first display that the run simulates.
    pub fields: u64,
    /// Instant at which the observations end. A streaming observer receives the end of the run.
    pub now: Time,
    /// The machine and its records in memory, including records of later pictures and periods.
    pub record: &'a Record,
    /// Views of the tracked head, with the requested poses in memory. `None` without a tracked head.
    pub head: Option<&'a Arc<HeadViews>>,
    /// Optics of the head-mounted display.
    pub hmd: Hmd,
    /// Regions that have arrived since the last call of the observer. Some may belong to later pictures.
    pub arrivals: &'a [Arrival],
    /// Pictures that became final since the last call, in the order in which they were shown.
    pub pictures: &'a [PictureTimes],
    /// The picture that is shown after the last entry of `pictures`. `None` at the end of the run.
    pub next: Option<&'a PictureTimes>,
    /// First period that is not final. All pictures that were shown before this period have been passed to the
    /// observer.
    pub until: PeriodNumber,
    /// Largest number of samples that a statistic stores. See [`Samples::keeping`](crate::Samples::keeping).
    pub samples: usize,
    /// Periods over which results are computed, as known so far. `None` if the run has no such periods.
    ///
    /// The start may still move to a later period. The observer then clears its results, because all earlier data lies
    /// before the new start.
    pub window: Option<ResultWindow>,
}

impl<'a> FinalResults<'a> {
    /// Returns the pictures that lie in the result window.
    pub fn steady_pictures(&self) -> &'a [PictureTimes] {
        let Some(window) = self.window else { return &[] };
        let display = self.record.display();
        // Pictures are in the order in which they are shown.
        let is_in = |times: &PictureTimes| window.holds_picture(display.period_at(times.shown_at));
        let first = self.pictures.iter().position(is_in).unwrap_or(self.pictures.len());
        let end = self.pictures.iter().rposition(is_in).map_or(first, |last| last + 1);
        &self.pictures[first..end]
    }

    /// Returns the final periods of the result window from period `next` on. `next` is the first period that the
    /// observer has not yet processed.
    pub fn periods_from(&self, next: PeriodNumber) -> impl DoubleEndedIterator<Item = PeriodNumber> + Clone + use<> {
        let Self { until, window, .. } = *self;
        let (first, end) = window
            .map_or((until, until), |window| (window.first_period.max(next), window.last_period.next().min(until)));
        first.until(end.max(first))
    }
}

/// An observer that accumulates a result during a run (streaming observer).
///
/// The observer receives every record once, in order. The run discards old records, so the observer must copy data that
/// it needs later.
pub trait StreamingObserver: Debug + Send {
    /// Processes results that can no longer change.
    fn take(&mut self, results: &FinalResults<'_>);

    /// Returns the observer's result. The run calls this method once, after the last call of `take`.
    fn result(self: Box<Self>) -> Box<dyn Any + Send + Sync>;
}

/// Function that creates the streaming observer of a run.
pub type ObserverFactory = fn() -> Box<dyn StreamingObserver>;
