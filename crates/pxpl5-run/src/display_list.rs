//! Converts scenes to display lists for graphics processors and to views for hosts.

use crate::views::{Poses, Views, ViewsWanted};
use pphigs::{
    DisplayList, DisplayStructure, EyeView, FrameView, MAX_EDITS, ModelEdit, ModelFrame, RecentViews, Shading,
};
use pxpl5_geometry::{Culling, WorldSphere};
use pxpl5_scene::{HeadMotion, Hmd, HmdConfig, Pose, Scene};
use pxpl5_sim::Time;
use pxpl5_wire::ViewNumber;
use pxpl5_wire::display::Surface;
use std::sync::Arc;

/// Returns the scene's primitives as a display list. Returns an error if the scene is empty, or if it has more moving
/// structures than the host can send.
pub fn display_list(scene: &Scene) -> Result<DisplayList, String> {
    // Check that the scene has primitives and that its edits fit into a frame message.
    if scene.triangles().is_empty() && scene.spheres().is_empty() {
        return Err(format!("scene {} has neither triangles nor spheres", scene.name()));
    }
    let edits = scene.edits_at(0).len();
    if edits > MAX_EDITS {
        return Err(format!(
            "scene {} moves {edits} structures a frame; the host sends at most {MAX_EDITS}",
            scene.name()
        ));
    }
    // Convert structures, spheres and vertices to the types of the display list.
    let structure = |s: &pxpl5_scene::Structure| DisplayStructure {
        triangles: s.triangles.clone(),
        spheres: s.spheres.clone(),
        frame: match s.frame {
            pxpl5_scene::Frame::World => ModelFrame::World,
            pxpl5_scene::Frame::Head => ModelFrame::Head,
        },
        culling: if s.culls_back_faces { Culling::Back } else { Culling::None },
    };
    let sphere = |s: &pxpl5_scene::Sphere| WorldSphere { centre: s.centre, radius: s.radius, colour: s.colour };
    let light = scene.lighting();
    let list = DisplayList {
        positions: scene.vertices().iter().map(|v| v.position).collect(),
        normals: scene.vertices().iter().map(|v| v.normal).collect(),
        colours: scene.vertices().iter().map(|v| v.colour).collect(),
        triangles: scene.triangles().to_vec(),
        spheres: scene.spheres().iter().map(sphere).collect(),
        structures: scene.structures().iter().map(structure).collect(),
        towards_light: light.towards_light,
        ambient: light.ambient,
        diffuse: light.diffuse,
        background: light.background,
        is_matte: false,
        recent: RecentViews::default(),
    };
    Ok(list.with_vertices_in_order())
}

/// Returns the scene's primitives as a display list for a pipeline with the given shading.
pub(crate) fn display_list_for(scene: &Scene, shading: Shading) -> Result<DisplayList, String> {
    let list = display_list(scene)?;
    Ok(if shading == Shading::Precomputed { list.with_precomputed_colours() } else { list })
}

/// Returns the view of a scene at a time, seen from a pose through the papers' head-mounted display.
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

/// Returns a head-mounted display with the resolution of a surface.
///
/// # Panics
///
/// Never, because every display has surfaces with a width and height of 1 to 65,536 pixels.
pub(crate) fn hmd_before(surface: Option<&Surface>, hmd: HmdConfig) -> Hmd {
    let config = surface.map_or(hmd, |surface| HmdConfig { width_px: surface.width, height_px: surface.height, ..hmd });
    Hmd::new(config).expect("a surface has pixels")
}

/// Returns the poses of the scene's own head motion. The host follows this motion without any delay.
pub(crate) fn poses(scene: &Scene, seed: u64) -> Poses {
    let motion: HeadMotion = scene.motion().with_seed(seed);
    Arc::new(move |known, _| motion.pose(known.0))
}

/// Returns two functions that give views of the scene's own head motion. The first returns the view at the sample time,
/// the second the view at the time when it is seen.
pub fn views(scene: &Arc<Scene>, seed: u64, hmd: Hmd, eyes: usize) -> (Views, ViewsWanted) {
    let motion: HeadMotion = scene.motion().with_seed(seed);
    let at = {
        let scene = Arc::clone(scene);
        move |number: ViewNumber, time: Time| view(&scene, &hmd, eyes, number, time, &motion.pose(time.0))
    };
    let wanted = at.clone();
    (Arc::new(at), Arc::new(move |number, _, shown_at| wanted(number, shown_at)))
}
