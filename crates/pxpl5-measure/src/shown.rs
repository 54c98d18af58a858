//! What each pixel of a run shows, and for which pose it was drawn.

use crate::screen::Screen;
use glam::DVec2;
use pxpl5_display::{Display, Surface};
use pxpl5_run::{HeadViews, Outcome, Source};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, PictureNumber, ViewNumber};
use std::collections::BTreeMap;
use tracking::Pose;
use tracking::view::HmdView;

/// What a pixel was drawn for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Drawn {
    Pose(Pose),
    Between {
        from: Pose,
        to: Pose,
        part: f64,
        on_screen: bool,
    },
    /// A picture that is shifted on its way to the screen.
    Shifted(Pose, DVec2),
}

/// Everything that is known of a run's views.
#[derive(Debug)]
pub(crate) struct Shown<'a> {
    pub(crate) outcome: &'a Outcome,
    screen: Screen,
    views: BTreeMap<PictureNumber, ViewNumber>,
    poses: BTreeMap<ViewNumber, Pose>,
}

impl<'a> Shown<'a> {
    pub(crate) fn of_run(outcome: &'a Outcome, head: &HeadViews) -> Self {
        Self {
            outcome,
            screen: Screen::of_record(outcome.record()),
            views: outcome.pictures().iter().map(|times| (times.picture, times.view)).collect(),
            poses: head.sampled().into_iter().map(|sampled| (sampled.number, sampled.pose)).collect(),
        }
    }

    /// What a pixel that lights at `at` shows; `None` before anything came.
    pub(crate) fn drawn(&self, x: u32, y: u32, field: PeriodNumber, at: Time) -> Option<Drawn> {
        let target = self.screen.shown(x, y, field, at)?;
        let pose = |number: ViewNumber| self.poses.get(&number).copied();
        Some(match self.outcome.pipeline().source(self.outcome.record(), &target, &self.views)? {
            Source::View(number) => Drawn::Pose(pose(number)?),
            Source::Between { from, to, part, on_screen } => {
                Drawn::Between { from: pose(from)?, to: pose(to)?, part, on_screen }
            }
        })
    }
}

/// The picture of the head-mounted display on the first surface of a display.
pub(crate) fn view_of(display: &dyn Display) -> HmdView {
    let ntsc = HmdView::ntsc();
    let sized = |surface: &Surface| HmdView::new(surface.width, surface.height, ntsc.horizontal_deg());
    display.surfaces().first().and_then(|surface| sized(surface).ok()).unwrap_or(ntsc)
}
