//! What each pixel of a run shows, and for which pose it was drawn.

use crate::screen::Screen;
use glam::DVec2;
use pxpl5_display::{Display, Surface};
use pxpl5_run::{HeadViews, Outcome, Sampled, Source};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, PictureNumber, ViewNumber};
use std::collections::{BTreeMap, BTreeSet};
use tracking::Pose;
use tracking::view::HmdView;

/// What a view was drawn for: a pose, and the time for which moving objects were placed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment {
    pub(crate) pose: Pose,
    pub(crate) objects_at: Time,
}

/// What a pixel was drawn for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Drawn {
    View(Moment),
    Between {
        from: Moment,
        to: Moment,
        part: f64,
        on_screen: bool,
    },
    /// A picture that is shifted on its way to the screen.
    Shifted(Moment, DVec2),
}

/// What a pixel shows, as far as it can be judged.
#[derive(Clone, Copy, Debug)]
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
}

impl<'a> Shown<'a> {
    pub(crate) fn of_run(outcome: &'a Outcome, head: &HeadViews) -> Self {
        Self {
            outcome,
            screen: Screen::of_record(outcome.record()),
            views: outcome.pictures().iter().map(|times| (times.picture, times.view)).collect(),
            complete: outcome.pictures().iter().filter(|times| times.is_shown()).map(|times| times.picture).collect(),
            moments: head.sampled().into_iter().map(|sampled| (sampled.number, moment_of(&sampled))).collect(),
        }
    }

    /// What a pixel that lights at `at` shows, and whether its picture was complete in time.
    pub(crate) fn seen(&self, x: u32, y: u32, field: PeriodNumber, at: Time) -> Seen {
        match self.screen.shown(x, y, field, at) {
            Some(target) if !self.complete.contains(&target.picture) => Seen::Incomplete,
            _ => self.drawn(x, y, field, at).map_or(Seen::Nothing, Seen::Complete),
        }
    }

    /// What a pixel that lights at `at` shows; `None` before anything came.
    pub(crate) fn drawn(&self, x: u32, y: u32, field: PeriodNumber, at: Time) -> Option<Drawn> {
        let target = self.screen.shown(x, y, field, at)?;
        let moment = |number: ViewNumber| self.moments.get(&number).copied();
        let aim = self.outcome.experiment().aim();
        Some(match self.outcome.pipeline().source(self.outcome.record(), &target, &self.views, aim)? {
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
