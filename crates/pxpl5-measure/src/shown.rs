//! The picture that each pixel of a run shows, and the head pose for which this picture was drawn.

pub(crate) use crate::drawn::{Drawn, FacesSeen, Moment};
use crate::screen::Screen;
use crate::turned::LatchedFaces;
use pxpl5_run::{
    Cause, Estimator, FinalResults, HeadViews, RequestedUpdates, ResultWindow, SampledPose, Source, WARM_UP_PICTURES,
};
use pxpl5_sim::Time;
use pxpl5_wire::{CopyTarget, PeriodNumber, PictureNumber, ViewNumber};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The kind of picture at a pixel, which decides if the pixel error is evaluated.
#[derive(Clone, Debug)]
pub(crate) enum Seen {
    /// The pixel shows nothing yet, or its source is unknown.
    Nothing,
    /// The pixel belongs to a picture that was not complete in time.
    Incomplete,
    /// The pixel belongs to a complete picture that was shown before the result window.
    Before,
    /// The pixel belongs to a complete picture that was shown in time and within the result window.
    Complete(Drawn),
}

#[derive(Debug)]
pub(crate) struct Shown {
    screen: Screen,
    views: BTreeMap<PictureNumber, ViewNumber>,
    /// Pictures that were complete in time, with the first period that showed each picture. The period is `None` for
    /// pictures during the warm-up.
    complete: BTreeMap<PictureNumber, Option<PeriodNumber>>,
    /// Number of pictures of the run that were added, including incomplete pictures.
    pictures: usize,
    /// The result window. The pixels of pictures outside the result window are not evaluated.
    ///
    /// `None` for pipelines without due pictures. All pictures of such a pipeline are evaluated.
    window: Option<ResultWindow>,
    moments: BTreeMap<ViewNumber, Viewed>,
    faces: Option<LatchedFaces>,
}

/// The pose and time for which a view was drawn. `reports_until` is the arrival time of the last tracker report that
/// the host had then received.
#[derive(Clone, Copy, Debug)]
struct Viewed {
    reports_until: Time,
    moment: Moment,
}

impl Shown {
    pub(crate) fn begin(run: &FinalResults<'_>, head: &Arc<HeadViews>) -> Self {
        Self {
            screen: Screen::default(),
            views: BTreeMap::new(),
            complete: BTreeMap::new(),
            pictures: 0,
            window: None,
            moments: BTreeMap::new(),
            faces: LatchedFaces::begin(run, head),
        }
    }

    pub(crate) fn of_run(run: &FinalResults<'_>, head: &Arc<HeadViews>) -> Self {
        let mut shown = Self::begin(run, head);
        shown.take(run, head);
        shown
    }

    /// Adds final results of the run: pictures, arrivals of regions, and views. Final results can no longer change.
    pub(crate) fn take(&mut self, run: &FinalResults<'_>, head: &HeadViews) {
        self.screen.take(run);
        self.views.extend(run.pictures.iter().map(|times| (times.picture, times.view)));
        let display = run.record.display();
        // Pictures of the warm-up are complete without a period, so they are never evaluated.
        for times in run.pictures {
            self.pictures += 1;
            let is_start_up = self.pictures <= WARM_UP_PICTURES;
            if times.is_shown() {
                let period = (!is_start_up).then(|| display.period_at(times.shown_at));
                self.complete.insert(times.picture, period);
            }
        }
        self.window = run.window.filter(|_| run.pipeline.periods_a_picture(run.record).is_some());
        self.moments.extend(head.sampled().iter().map(|sampled| (sampled.number, viewed(sampled))));
        self.faces.iter_mut().for_each(|faces| faces.take(run));
    }

    /// Discards the data of pictures that no later period can show.
    ///
    /// Views that were made after the last period with final results are kept, because their pictures may still arrive.
    pub(crate) fn discard(&mut self, run: &FinalResults<'_>) {
        let instant = run.record.tick(run.until);
        self.screen.discard_before(instant);
        let still_seen = self.still_seen(run, instant);
        self.moments.retain(|number, viewed| viewed.reports_until >= instant || still_seen.contains(number));
        let on_screen: BTreeSet<PictureNumber> = self.screen.targets().map(|target| target.picture).collect();
        let moments = &self.moments;
        self.views.retain(|picture, view| moments.contains_key(view) || on_screen.contains(picture));
        self.complete.retain(|picture, _| self.views.contains_key(picture));
        self.faces.iter_mut().for_each(|faces| faces.discard_before(instant));
    }

    #[cfg(test)]
    pub(crate) fn held(&self) -> usize {
        let of_faces = self.faces.as_ref().map_or(0, LatchedFaces::held);
        self.screen.targets().count() + self.views.len() + self.complete.len() + self.moments.len() + of_faces
    }

    /// Returns the views whose pictures are on the screen at `instant` or may still be shown later. Views that were
    /// made after `instant` are left out.
    ///
    /// For an address recalculation display, the result has the views of all updates whose records are in memory.
    fn still_seen(&self, run: &FinalResults<'_>, instant: Time) -> BTreeSet<ViewNumber> {
        if self.faces.is_some() {
            let updates = run.record.attached().map_or_else(Vec::new, RequestedUpdates::all);
            return updates.iter().map(|update| update.view).collect();
        }
        let is_old = |target: &CopyTarget| {
            let viewed = self.views.get(&target.picture).and_then(|view| self.moments.get(view));
            viewed.is_some_and(|viewed| viewed.reports_until < instant)
        };
        let sources = self.screen.targets().filter(is_old).filter_map(|target| self.source(run, &target));
        sources.flat_map(views_of).collect()
    }

    /// Classifies the picture that a pixel shows when the pixel is lit at `at`.
    pub(crate) fn seen(&self, run: &FinalResults<'_>, [x, y]: [u32; 2], field: PeriodNumber, at: Time) -> Seen {
        if self.faces.is_none()
            && let Some(target) = self.screen.shown(x, y, field, at)
        {
            let Some(shown) = self.complete.get(&target.picture) else { return Seen::Incomplete };
            let is_evaluated = |period| self.window.is_none_or(|window| window.holds_picture(period));
            if !shown.is_some_and(is_evaluated) {
                return Seen::Before;
            }
        }
        self.drawn(run, [x, y], field, at).map_or(Seen::Nothing, Seen::Complete)
    }

    /// Replaces the poses of the views `of` by the poses that the run would have had without the cause of error
    /// `without`, and if all prediction intervals were longer by `later_ps`. Views that are not in `of` show nothing
    /// afterwards.
    pub(crate) fn replace_poses(
        &mut self,
        head: &Arc<HeadViews>,
        of: &BTreeSet<ViewNumber>,
        (without, later_ps): (Option<Cause>, i64),
    ) {
        let mut estimator = Estimator::new(head, without);
        let mut sampled: Vec<SampledPose> = head.sampled().into_iter().filter(|s| of.contains(&s.number)).collect();
        sampled.sort_by_key(|sampled| sampled.reports_until);
        let moments = sampled.into_iter().map(|sampled| {
            let predicted_for = Time(sampled.objects_at.0.saturating_add_signed(later_ps));
            let pose = estimator.pose(sampled.reports_until, predicted_for);
            (sampled.number, viewed(&SampledPose { pose, ..sampled }))
        });
        self.moments = moments.collect();
        self.faces.iter_mut().zip(without).for_each(|(faces, without)| faces.disable_cause(without));
    }

    /// Returns the views that a pixel shows when it is lit at `at`.
    ///
    /// The result has one view, or two for an interpolated picture. The result is empty before the first arrival.
    pub(crate) fn views_at(
        &self,
        run: &FinalResults<'_>,
        [x, y]: [u32; 2],
        field: PeriodNumber,
        at: Time,
    ) -> Vec<ViewNumber> {
        if let Some(faces) = &self.faces {
            return faces.views_at(field);
        }
        let target = self.screen.shown(x, y, field, at);
        target.and_then(|target| self.source(run, &target)).map(views_of).unwrap_or_default()
    }

    fn source(&self, run: &FinalResults<'_>, target: &CopyTarget) -> Option<Source> {
        run.pipeline.source(run.record, target, &self.views, run.aim)
    }

    /// Returns the view or views for which the pixel (`x`, `y`) was drawn. The pixel is lit at the instant `at`.
    /// Returns `None` before the first region has arrived.
    pub(crate) fn drawn(
        &self,
        run: &FinalResults<'_>,
        [x, y]: [u32; 2],
        field: PeriodNumber,
        at: Time,
    ) -> Option<Drawn> {
        let moment = |number: ViewNumber| self.moments.get(&number).map(|viewed| viewed.moment);
        if let Some(faces) = &self.faces {
            return faces.drawn(x, y, field, moment).map(Drawn::Faces);
        }
        let target = self.screen.shown(x, y, field, at)?;
        Some(match self.source(run, &target)? {
            Source::View(number) => Drawn::View(moment(number)?),
            Source::Between { from, to, part, on_screen } => {
                Drawn::Between { from: moment(from)?, to: moment(to)?, part, on_screen }
            }
        })
    }
}

fn views_of(source: Source) -> Vec<ViewNumber> {
    match source {
        Source::View(number) => vec![number],
        Source::Between { from, to, .. } => vec![from, to],
    }
}

fn viewed(sampled: &SampledPose) -> Viewed {
    let moment = Moment { pose: sampled.pose, objects_at: sampled.objects_at, measured_at: sampled.measured_at };
    Viewed { reports_until: sampled.reports_until, moment }
}
