//! Converts scenes to views, which the firmware of a host requests.

use crate::views::{Poses, Views, ViewsWanted};
use pphigs::{EyeView, FrameView, ModelEdit};
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

pub(crate) fn poses(scene: &Scene, seed: u64) -> Poses {
    let motion: HeadMotion = scene.motion().with_seed(seed);
    Arc::new(move |reports_until, _| motion.pose(reports_until.0))
}

/// Returns two functions that give views of the scene's own head motion.
///
/// The first function returns the view at the time of the request. The second function returns the view at a later
/// time, at which the picture is seen.
pub fn views(scene: &Arc<Scene>, seed: u64, hmd: Hmd, eyes: usize) -> (Views, ViewsWanted) {
    let motion: HeadMotion = scene.motion().with_seed(seed);
    let at = {
        let scene = Arc::clone(scene);
        move |number: ViewNumber, time: Time| view(&scene, &hmd, eyes, number, time, &motion.pose(time.0))
    };
    let wanted = at.clone();
    (Arc::new(at), Arc::new(move |number, _, shown_at| wanted(number, shown_at)))
}
