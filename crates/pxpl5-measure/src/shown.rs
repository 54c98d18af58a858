//! What each pixel of a run shows, and for which pose it was drawn.

use crate::screen::Screen;
use glam::DVec2;
use pxpl5_display::{Display, Surface};
use pxpl5_run::{Estimator, HeadViews, Outcome, Sampled, Source};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, PictureNumber, ViewNumber};
use std::collections::{BTreeMap, BTreeSet};
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
    poses: BTreeMap<ViewNumber, Aimed>,
}

/// A view's pose and the instant that its picture is drawn for.
#[derive(Clone, Copy, Debug)]
struct Aimed {
    pose: Pose,
    at: Time,
}

/// What a pixel shows, and the instant that it was drawn for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawnFor {
    pub(crate) drawn: Drawn,
    pub(crate) instant: Time,
}

impl<'a> Shown<'a> {
    pub(crate) fn of_run(outcome: &'a Outcome, head: &HeadViews) -> Self {
        let poses = head.sampled().into_iter().map(|sampled| {
            let aimed = Aimed { pose: sampled.pose, at: sampled.aimed_at };
            (sampled.number, aimed)
        });
        Self {
            outcome,
            screen: Screen::of_record(outcome.record()),
            views: outcome.pictures().iter().map(|times| (times.picture, times.view)).collect(),
            poses: poses.collect(),
        }
    }

    /// The same run with the poses that some of its views would have had; all others show nothing.
    pub(crate) fn with_poses(self, head: &HeadViews, of: &BTreeSet<ViewNumber>, mut estimator: Estimator<'_>) -> Self {
        let mut sampled: Vec<Sampled> = head.sampled().into_iter().filter(|s| of.contains(&s.number)).collect();
        sampled.sort_by_key(|sampled| sampled.known);
        let poses = sampled.into_iter().map(|sampled| {
            let pose = estimator.pose(sampled.known, sampled.aimed_at);
            (sampled.number, Aimed { pose, at: sampled.aimed_at })
        });
        Self { poses: poses.collect(), ..self }
    }

    /// The views that a pixel shows which lights at `at`: one, or two between which it stands; none before anything came.
    pub(crate) fn views_at(&self, x: u32, y: u32, field: PeriodNumber, at: Time) -> Vec<ViewNumber> {
        match self.source(x, y, field, at) {
            Some(Source::View(number)) => vec![number],
            Some(Source::Between { from, to, .. }) => vec![from, to],
            None => Vec::new(),
        }
    }

    fn source(&self, x: u32, y: u32, field: PeriodNumber, at: Time) -> Option<Source> {
        let target = self.screen.shown(x, y, field, at)?;
        self.outcome.pipeline().source(self.outcome.record(), &target, &self.views)
    }

    /// What a pixel that lights at `at` shows; `None` before anything came.
    pub(crate) fn drawn(&self, x: u32, y: u32, field: PeriodNumber, at: Time) -> Option<DrawnFor> {
        match self.source(x, y, field, at)? {
            Source::View(number) => {
                let aimed = self.poses.get(&number)?;
                Some(DrawnFor { drawn: Drawn::Pose(aimed.pose), instant: aimed.at })
            }
            Source::Between { from, to, part, on_screen } => {
                let from = self.poses.get(&from)?;
                let to = self.poses.get(&to)?;
                let ahead_ps = to.at.since(from.at).0 as f64 * part;
                let drawn = Drawn::Between { from: from.pose, to: to.pose, part, on_screen };
                Some(DrawnFor { drawn, instant: Time(from.at.0 + ahead_ps as u64) })
            }
        }
    }
}

/// The picture of the head-mounted display on the first surface of a display.
pub(crate) fn view_of(display: &dyn Display) -> HmdView {
    let ntsc = HmdView::ntsc();
    let sized = |surface: &Surface| HmdView::new(surface.width, surface.height, ntsc.horizontal_deg());
    display.surfaces().first().and_then(|surface| sized(surface).ok()).unwrap_or(ntsc)
}
