use crate::dry_run::{DryRun, SeenTimes};
use crate::head_views::HeadViews;
use crate::observe::observers::{FinalResults, StreamingObserver};
use crate::pipeline::PictureTimes;
use crate::result::picture_ends::WARM_UP_PICTURES;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::display::LightTimes;
use pxpl5_wire::{PeriodNumber, ViewNumber};
use std::any::Any;
use std::collections::BTreeMap;

/// One millisecond, the step to which a prediction interval is rounded before tuning. A finer step changes the tuned
/// parameters by less than one per cent.
const INTERVAL_STEP_PS: u64 = 1_000_000_000;

/// A streaming observer that collects the times at which views are shown, and the prediction intervals.
#[derive(Debug, Default)]
pub(crate) struct DryRunObserver {
    pictures: usize,
    /// The newest views. A later picture may show one of them again, also after a picture of a newer view.
    going_on: BTreeMap<ViewNumber, ShownView>,
    aimed_at: BTreeMap<ViewNumber, Time>,
    leads: Mean,
    intervals: Mean,
    turns: Mean,
    turned_to: PeriodNumber,
    /// The newest picture, whose successor on the screen is not known yet.
    waiting: Option<PictureTimes>,
}

/// Number of views after which a view is final. A pose is sampled at most a few pictures ahead, and no pipeline shows a
/// picture later than that, so this number is far more than any run needs.
const VIEWS_HELD: usize = 64;

/// The times at which the pictures of one view are lit, from the first to the last light, and the requests of its poses.
#[derive(Clone, Debug)]
struct ShownView {
    shown: LightTimes,
    is_complete: bool,
    requested_at: Vec<Time>,
    measured_at: Option<Time>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum_ms: f64,
    n: u64,
}

impl Mean {
    fn add(&mut self, span: Span) {
        self.sum_ms += span.as_ms();
        self.n += 1;
    }

    fn ms(self) -> f64 {
        self.sum_ms / self.n as f64
    }

    /// Returns the mean, rounded to steps of [`INTERVAL_STEP_PS`], or `None` if no interval was added.
    fn rounded_ps(self) -> Option<u64> {
        let steps = (self.ms() * 1e9 / INTERVAL_STEP_PS as f64).round();
        (self.n > 0).then_some(steps as u64 * INTERVAL_STEP_PS)
    }
}

impl StreamingObserver for DryRunObserver {
    fn take(&mut self, results: &FinalResults<'_>) {
        let Some(head) = results.head else { return };
        for (times, next) in self.timed(results) {
            let shown = results.pipeline.shown(results.record, &times, next.as_ref());
            self.take_picture(&times, shown);
        }
        self.note_requests(head);
        self.end_views(results);
        self.turned_to
            .until(results.until)
            .filter_map(|period| results.turn_interval(period))
            .for_each(|span| self.turns.add(span));
        self.turned_to = results.until;
    }

    fn result(self: Box<Self>) -> Box<dyn Any + Send + Sync> {
        Box::new(self.into_dry_run())
    }
}

impl DryRunObserver {
    pub(crate) fn into_dry_run(self) -> DryRun {
        DryRun {
            seen_times: SeenTimes::new(self.aimed_at, (self.leads.ms() * 1e9) as u64),
            interval_ps: self.intervals.rounded_ps(),
            turn_interval_ps: self.turns.rounded_ps(),
        }
    }

    /// Returns each new picture with its successor, because the successor ends the display time of the picture.
    ///
    /// For a display with several layers (display memories), only the first layer is timed. The first layer holds the
    /// structures that must be drawn most often. The last picture of this layer is returned only when its successor is
    /// known.
    fn timed(&mut self, results: &FinalResults<'_>) -> Vec<(PictureTimes, Option<PictureTimes>)> {
        let is_timed = |times: &&PictureTimes| times.layer == 0;
        let timed = results.pictures.iter().filter(is_timed).copied();
        let mut timed: Vec<PictureTimes> = self.waiting.take().into_iter().chain(timed).collect();
        let next = results.next.filter(is_timed).copied();
        // If another layer is shown next, the successor of the last picture is not known yet.
        if results.next.is_some() && next.is_none() {
            self.waiting = timed.pop();
        }
        let nexts = timed.iter().skip(1).copied().chain(next.or(self.waiting)).map(Some).chain([None]);
        timed.iter().copied().zip(nexts).collect()
    }

    fn take_picture(&mut self, times: &PictureTimes, shown: LightTimes) {
        self.pictures += 1;
        let is_complete = times.is_shown() && self.pictures > WARM_UP_PICTURES;
        let view = self.going_on.entry(times.view).or_insert_with(|| ShownView {
            shown,
            is_complete,
            requested_at: Vec::new(),
            measured_at: None,
        });
        view.shown.last = view.shown.last.max(shown.last);
        view.is_complete |= is_complete;
    }

    /// Copies the requests of the poses of all views that may still be shown, before the run discards their records.
    fn note_requests(&mut self, head: &HeadViews) {
        let sampled = head.sampled();
        for (view, shown) in &mut self.going_on {
            let first = sampled.partition_point(|sampled| sampled.number < *view);
            let of_view = sampled[first..].iter().take_while(|sampled| sampled.number == *view);
            let requested_at: Vec<Time> = of_view.clone().map(|sampled| sampled.reports_until).collect();
            if !requested_at.is_empty() {
                shown.requested_at = requested_at;
                shown.measured_at = of_view.filter_map(|sampled| sampled.measured_at).last();
            }
        }
    }

    /// Adds all views but the newest [`VIEWS_HELD`] to the results, and all views at the end of the run.
    fn end_views(&mut self, results: &FinalResults<'_>) {
        let held = if results.next.is_some() { VIEWS_HELD } else { 0 };
        while self.going_on.len() > held
            && let Some((view, shown)) = self.going_on.pop_first()
        {
            self.end_view(results, view, &shown);
        }
    }

    /// Adds the prediction interval of a view, and the instant of the view unless the firmware computes display times
    /// itself.
    fn end_view(&mut self, results: &FinalResults<'_>, view: ViewNumber, ended: &ShownView) {
        let instant = results.aim.instant(&ended.shown);
        if !results.pipeline.properties().knows_when_seen {
            self.aimed_at.insert(view, instant);
        }
        ended.requested_at.iter().for_each(|at| self.leads.add(instant.since(*at)));
        if let Some(measured_at) = ended.measured_at.filter(|_| ended.is_complete) {
            self.intervals.add(instant.since(measured_at));
        }
    }
}
