//! Converts scenes to views, which the firmware of a host requests.

use crate::views::ViewSource;
use pphigs::{EyeView, FrameView, ModelEdit};
use pxpl5_gp::HostTiming;
use pxpl5_scene::{HeadMotion, Hmd, Pose, Scene};
use pxpl5_sim::Time;
use pxpl5_wire::ViewNumber;
use pxpl5_wire::display::Display;
use std::sync::Arc;

pub(crate) fn view(scene: &Scene, hmd: &Hmd, eyes: usize, number: ViewNumber, time: Time, pose: &Pose) -> FrameView {
    let views = if eyes == 1 { vec![hmd.mono(pose)] } else { hmd.stereo(pose).to_vec() };
    let eye = |v: &pxpl5_scene::View| EyeView {
        world_to_eye: v.world_to_eye,
        head_to_eye: v.head_to_eye,
        projection: v.projection,
    };
    let edit = |e: &pxpl5_scene::Edit| ModelEdit { structure: e.structure as u32, model: e.model };
    FrameView {
        number,
        eyes: views.iter().map(eye).collect(),
        edits: scene.edits_at(time.0).iter().map(edit).collect(),
    }
}

/// Returns a head-mounted display with the resolution of the first surface of the machine's display.
pub fn hmd_on(display: &dyn Display, hmd: &Hmd) -> Hmd {
    display.surfaces().first().map_or(*hmd, |surface| hmd.with_pixels(surface.width, surface.height))
}

/// Views of the scene's own head motion, which the host follows without any delay.
#[derive(Clone, Debug)]
pub struct SceneViews {
    /// Scene in which the viewer moves.
    pub scene: Arc<Scene>,
    /// Motion of the viewer's head.
    pub motion: HeadMotion,
    /// Optics and resolution of the head-mounted display.
    pub hmd: Hmd,
    /// Number of eyes for which views are computed: 1 or 2.
    pub eyes: usize,
    /// Time from one report of the head's pose to the next, in nanoseconds.
    pub period_ns: u64,
}

impl SceneViews {
    /// Creates the views of a scene's head motion. `seed` is the seed of the sway, and reports have the papers' period.
    pub fn new(scene: &Arc<Scene>, seed: u64, hmd: Hmd, eyes: usize) -> Self {
        let motion = scene.motion().with_seed(seed);
        Self { scene: Arc::clone(scene), motion, hmd, eyes, period_ns: HostTiming::PAPERS.view_period_ns }
    }
}

impl ViewSource for SceneViews {
    fn newest(&self, number: ViewNumber, now: Time) -> FrameView {
        self.view_at(number, now, now)
    }

    fn view_at(&self, number: ViewNumber, _: Time, shown_at: Time) -> FrameView {
        view(&self.scene, &self.hmd, self.eyes, number, shown_at, &self.motion.pose(shown_at.0))
    }

    fn pose_at(&self, now: Time, _: Time) -> Pose {
        self.motion.pose(now.0)
    }

    fn report_from(&self, instant: Time) -> Option<Time> {
        let period = self.period_ns * 1_000;
        Some(Time(instant.0.div_ceil(period) * period))
    }
}
