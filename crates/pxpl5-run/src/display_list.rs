use crate::error::ExperimentError;
use crate::pipeline::PipelineProperties;
use pphigs::{DisplayList, DisplayStructure, MAX_EDITS, ModelFrame, RecentViews, Shading};
use pxpl5_geometry::{Culling, WorldSphere};
use pxpl5_gp::CodeVersion;
use pxpl5_machine::MachineConfig;
use pxpl5_scene::Scene;

/// Returns the triangles and spheres of a scene as a display list.
///
/// # Errors
///
/// Returns [`ExperimentError::Scene`] if the scene is empty, or if it has more moving structures than the host can
/// send.
pub fn display_list(scene: &Scene) -> Result<DisplayList, ExperimentError> {
    // Check that the scene has primitives and that its edits fit into a frame message.
    if scene.triangles().is_empty() && scene.spheres().is_empty() {
        let reason = format!("scene {} has neither triangles nor spheres", scene.name());
        return Err(ExperimentError::Scene(reason));
    }
    let edits = scene.edits_at(0).len();
    if edits > MAX_EDITS {
        return Err(ExperimentError::Scene(format!(
            "scene {} moves {edits} structures a frame; the host sends at most {MAX_EDITS}",
            scene.name()
        )));
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
        is_single: false,
        recent: RecentViews::default(),
    };
    Ok(list.with_vertices_in_order())
}

/// Returns the list of [`display_list`] in the form that a pipeline draws on a machine.
pub(crate) fn display_list_for(
    scene: &Scene,
    pipeline: &PipelineProperties,
    config: &MachineConfig,
) -> Result<DisplayList, ExperimentError> {
    let list = display_list(scene)?;
    let is_precomputed = pipeline.shading == Shading::Precomputed;
    let list = if is_precomputed { list.with_precomputed_colours() } else { list };
    let is_single = pipeline.code_use.is_single(config.code.unwrap_or(CodeVersion::Compiled));
    Ok(DisplayList { is_single, ..list })
}
