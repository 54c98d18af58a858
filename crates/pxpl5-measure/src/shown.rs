//! What each pixel of a run shows, and for which pose it was drawn.

pub(crate) use crate::drawn::{Drawn, FacesSeen, Moment};
use crate::screen::Screen;
use crate::turned::TurnedFaces;
use pxpl5_display::{Display, Surface};
use pxpl5_run::{Cause, Estimator, HeadViews, Outcome, Sampled, Source};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, PictureNumber, ViewNumber};
use std::collections::{BTreeMap, BTreeSet};
use tracking::view::HmdView;

/// What a pixel shows, as far as it can be judged.
#[derive(Clone, Debug)]
pub(crate) enum Seen {
    /// Nothing yet, or nothing that is known.
    Nothing,
    /// A part of a picture that was not complete in time.
    Incomplete,
    /// A part of one that was.
    Complete(Drawn),
}

/// Everything that is known of a run's views.
#[derive(Debug)]
pub(crate) struct Shown<'a> {
    pub(crate) outcome: &'a Outcome,
    screen: Screen,
    views: BTreeMap<PictureNumber, ViewNumber>,
    /// Pictures that were complete in time.
    complete: BTreeSet<PictureNumber>,
    moments: BTreeMap<ViewNumber, Moment>,
    /// Of a display with faces.
    faces: Option<TurnedFaces<'a>>,
}

impl<'a> Shown<'a> {
    pub(crate) fn of_run(outcome: &'a Outcome, head: &'a HeadViews) -> Self {
        Self {
            outcome,
            screen: Screen::of_record(outcome.record()),
            views: outcome.pictures().iter().map(|times| (times.picture, times.view)).collect(),
            complete: outcome.pictures().iter().filter(|times| times.is_shown()).map(|times| times.picture).collect(),
            moments: head.sampled().into_iter().map(|sampled| (sampled.number, moment_of(&sampled))).collect(),
            faces: TurnedFaces::of_run(outcome, head),
        }
    }

    /// What a pixel that lights at `at` shows, and whether its picture was complete in time.
    pub(crate) fn seen(&self, x: u32, y: u32, field: PeriodNumber, at: Time) -> Seen {
        if self.faces.is_some() {
            return self.drawn(x, y, field, at).map_or(Seen::Nothing, Seen::Complete);
        }
        match self.screen.shown(x, y, field, at) {
            Some(target) if !self.complete.contains(&target.picture) => Seen::Incomplete,
            _ => self.drawn(x, y, field, at).map_or(Seen::Nothing, Seen::Complete),
        }
    }

    /// The same run with the poses that some of its views would have had; all others show nothing.
    pub(crate) fn with_poses(self, head: &'a HeadViews, of: &BTreeSet<ViewNumber>, without: Cause) -> Self {
        let mut estimator = Estimator::new(head, Some(without));
        let mut sampled: Vec<Sampled> = head.sampled().into_iter().filter(|s| of.contains(&s.number)).collect();
        sampled.sort_by_key(|sampled| sampled.known);
        let moments = sampled.into_iter().map(|sampled| {
            let pose = estimator.pose(sampled.known, sampled.objects_at);
            (sampled.number, Moment { pose, objects_at: sampled.objects_at })
        });
        let faces = self.faces.map(|faces| faces.without(without));
        Self { moments: moments.collect(), faces, ..self }
    }

    /// The views that a pixel shows which lights at `at`: one, or two between which it stands; none before anything came.
    pub(crate) fn views_at(&self, x: u32, y: u32, field: PeriodNumber, at: Time) -> Vec<ViewNumber> {
        if let Some(faces) = &self.faces {
            return faces.views_at(field);
        }
        match self.source(x, y, field, at) {
            Some(Source::View(number)) => vec![number],
            Some(Source::Between { from, to, .. }) => vec![from, to],
            None => Vec::new(),
        }
    }

    fn source(&self, x: u32, y: u32, field: PeriodNumber, at: Time) -> Option<Source> {
        let target = self.screen.shown(x, y, field, at)?;
        let aim = self.outcome.experiment().aim();
        self.outcome.pipeline().source(self.outcome.record(), &target, &self.views, aim)
    }

    /// What a pixel that lights at `at` shows; `None` before anything came.
    pub(crate) fn drawn(&self, x: u32, y: u32, field: PeriodNumber, at: Time) -> Option<Drawn> {
        let moment = |number: ViewNumber| self.moments.get(&number).copied();
        if let Some(faces) = &self.faces {
            return faces.drawn(x, y, field, moment).map(Drawn::Faces);
        }
        Some(match self.source(x, y, field, at)? {
            Source::View(number) => Drawn::View(moment(number)?),
            Source::Between { from, to, part, on_screen } => {
                Drawn::Between { from: moment(from)?, to: moment(to)?, part, on_screen }
            }
        })
    }
}

fn moment_of(sampled: &Sampled) -> Moment {
    Moment { pose: sampled.pose, objects_at: sampled.objects_at }
}

/// The picture of the head-mounted display on the first surface of a display.
pub(crate) fn view_of(display: &dyn Display) -> HmdView {
    let ntsc = HmdView::ntsc();
    let sized = |surface: &Surface| HmdView::new(surface.width, surface.height, ntsc.horizontal_deg());
    display.surfaces().first().and_then(|surface| sized(surface).ok()).unwrap_or(ntsc)
}
