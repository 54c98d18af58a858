use crate::dry_run::{DryRun, SeenTimes};
use crate::head_views::{HeadViews, SampledPose};
use crate::instants::Instants;
use crate::observers::{FinalResults, StreamingObserver};
use crate::picture_ends::WARM_UP_PICTURES;
use crate::pipeline::PictureTimes;
use pxpl5_sim::Span;
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
    /// Views that a later picture may show again.
    going_on: BTreeMap<ViewNumber, ShownView>,
    aimed_at: Instants,
    leads: Mean,
    intervals: Mean,
    turns: Mean,
    turned_to: PeriodNumber,
    /// The newest picture, whose successor on the screen is not known yet.
    waiting: Option<PictureTimes>,
}

/// The times at which the pictures of one view are lit, from the first to the last light.
#[derive(Clone, Copy, Debug)]
struct ShownView {
    shown: LightTimes,
    is_complete: bool,
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
        let sampled = head.sampled();
        for (times, next) in self.timed(results) {
            let shown = results.pipeline.shown(results.record, &times, next.as_ref());
            self.take_picture(&times, shown);
        }
        self.end_views(results, &sampled);
        self.take_turns(results, head);
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
        let view = self.going_on.entry(times.view).or_insert(ShownView { shown, is_complete });
        view.shown.last = view.shown.last.max(shown.last);
        view.is_complete |= is_complete;
    }

    /// Adds all views but the newest to the results, because the next picture may show the newest view again. At the
    /// end of the run, adds the newest view too.
    fn end_views(&mut self, results: &FinalResults<'_>, sampled: &[SampledPose]) {
        let newest = self.going_on.pop_last();
        let ended = std::mem::take(&mut self.going_on);
        ended.iter().for_each(|(view, shown)| self.end_view(results, sampled, *view, *shown));
        match newest {
            Some((view, shown)) if results.next.is_none() => self.end_view(results, sampled, view, shown),
            newest => self.going_on.extend(newest),
        }
    }

    /// Adds the prediction interval of a view that no later picture shows.
    ///
    /// The instant of the view is stored too, unless the firmware computes display times itself. Such firmware may show
    /// views in an order that differs from the order of their numbers.
    fn end_view(&mut self, results: &FinalResults<'_>, sampled: &[SampledPose], view: ViewNumber, shown: ShownView) {
        let ShownView { shown, is_complete } = shown;
        let instant = results.aim.instant(&shown);
        if !results.pipeline.knows_when_seen() {
            self.aimed_at.push(view.0, instant);
        }
        let first = sampled.partition_point(|sampled| sampled.number < view);
        let of_view = sampled[first..].iter().take_while(|sampled| sampled.number == view);
        of_view.clone().for_each(|sampled| self.leads.add(instant.since(sampled.reports_until)));
        let measured_at = of_view.filter_map(|sampled| sampled.measured_at).last();
        if let Some(measured_at) = measured_at.filter(|_| is_complete) {
            self.intervals.add(instant.since(measured_at));
        }
    }

    fn take_turns(&mut self, results: &FinalResults<'_>, head: &HeadViews) {
        let FinalResults { pipeline, record, aim, until, .. } = *results;
        let periods = self.turned_to.until(until);
        let spans = periods.filter_map(|period| pipeline.turn_interval(record, head, aim, period));
        spans.for_each(|span| self.turns.add(span));
        self.turned_to = until;
    }
}
