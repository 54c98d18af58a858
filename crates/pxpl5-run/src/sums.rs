//! Sums over a run that are taken while it goes on, so that what they were taken of can be given up.

use crate::face_notes::FaceNotes;
use crate::head_views::HeadViews;
use crate::pipeline::{PictureTimes, Pipeline};
use crate::result_window::ResultWindow;
use pxpl5_display::Aim;
use pxpl5_machine::{Arrival, Record};
use pxpl5_wire::PeriodNumber;
use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

/// What of a run will not change any more and was not handed on before: of a run that keeps everything all of it, at its end.
#[derive(Clone, Copy, Debug)]
pub struct Settled<'a> {
    /// What draws.
    pub pipeline: &'a dyn Pipeline,
    /// For which instant of what is shown from them views are drawn.
    pub aim: Aim,
    /// Periods of the first display that are simulated in all.
    pub fields: u64,
    /// The machine and its records, as far as they are kept; those of later pictures and periods among them.
    pub record: &'a Record,
    /// The views of the head with its tracker, if there is one, as far as they are kept.
    pub head: Option<&'a Arc<HeadViews>>,
    /// The updates of display memories that were asked for, as far as they are kept.
    pub notes: &'a FaceNotes,
    /// Regions that have arrived since what was handed on before. They may belong to later pictures.
    pub arrivals: &'a [Arrival],
    /// Pictures, in the order in which they are shown.
    pub pictures: &'a [PictureTimes],
    /// The picture that is shown after them; `None` after the last of the run.
    pub next: Option<&'a PictureTimes>,
    /// All periods before this one: each picture that is shown in them, part or whole, was handed on by now.
    pub until: PeriodNumber,
    /// How many numbers of a kind are kept one by one: [`Samples::keeping`](crate::Samples::keeping).
    pub samples: usize,
    /// The window over which results are computed, as far as it is known by now: it may still begin later, never earlier. Then all
    /// that was handed on before lies outside. `None` where the run has none.
    pub window: Option<ResultWindow>,
}

impl Settled<'_> {
    /// The pictures that lie in the window.
    pub fn steady_pictures(&self) -> impl Iterator<Item = &PictureTimes> {
        let display = self.record.display();
        let window = self.window;
        let is_held = move |times: &&PictureTimes| {
            window.is_some_and(|window| window.holds_picture(display.period_at(times.shown_at)))
        };
        self.pictures.iter().filter(is_held)
    }

    /// The periods of the window, from one that was not handed on before to the last one that will not change.
    pub fn periods_from(&self, next: PeriodNumber) -> impl DoubleEndedIterator<Item = PeriodNumber> + Clone + use<> {
        let Self { until, window, .. } = *self;
        let (first, end) = window
            .map_or((until, until), |window| (window.first_period.max(next), window.last_period.next().min(until)));
        first.until(end.max(first))
    }
}

/// Somebody who sums up a run while it goes on. He is handed everything once, in order, and keeps of it what he needs later: records are
/// given up behind him.
pub trait Summing: Debug + Send {
    /// Takes what will not change any more.
    fn take(&mut self, settled: &Settled<'_>);

    /// What comes of it when all was taken.
    fn said(self: Box<Self>) -> Box<dyn Any + Send + Sync>;
}

/// Who begins to sum up a run.
pub type Sums = fn() -> Box<dyn Summing>;
