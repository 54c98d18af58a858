//! The command `pxpl5 scenes`, which lists the built-in scenes.

use crate::error::CliError;
use crate::terminal::{print, warn};
use clap::Args;
use pxpl5::Plan;
use pxpl5::scene::{self, Scene};
use serde_json::json;
use std::sync::Arc;

/// List the built-in scenes.
#[derive(Args, Debug)]
pub(crate) struct ScenesArgs {
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Loads the scene of an experiment. Prints a warning for each part of the scene's file that the importer changed.
pub(crate) fn load(plan: &Plan, quiet: bool) -> Result<Arc<Scene>, CliError> {
    let scene = plan.load_scene()?;
    print_warnings(&scene, quiet);
    Ok(scene)
}

pub(crate) fn print_warnings(scene: &Scene, quiet: bool) {
    let named: Vec<String> = scene.warnings().iter().map(|warning| format!("{}: {warning}", scene.name())).collect();
    warn(&named, quiet);
}

pub(crate) fn run(args: ScenesArgs) -> Result<(), CliError> {
    if args.json {
        let scenes: Vec<_> = scene::names().iter().map(|(name, about)| json!({"name": name, "about": about})).collect();
        return print(&format!("{:#}\n", json!({"schema": "pxpl5-scenes/1", "scenes": scenes})));
    }
    let lines: String = scene::names().iter().map(|(name, about)| format!("{name:<15} {about}\n")).collect();
    print(&format!(
        "{lines}\nA model file (.ply, .obj, .stl, .gltf, .glb, .pdb) can replace a built-in scene: pxpl5 run --scene FILE\n"
    ))
}
