//! `pxpl5 scenes`.

use crate::error::CliError;
use crate::terminal::print;
use clap::Args;
use pxpl5::scene;
use serde_json::json;

/// List the built-in scenes.
#[derive(Args, Debug)]
pub(crate) struct ScenesArgs {
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: ScenesArgs) -> Result<(), CliError> {
    if args.json {
        let scenes: Vec<_> = scene::names().iter().map(|(name, about)| json!({"name": name, "about": about})).collect();
        return print(&format!("{:#}\n", json!({"schema": "pxpl5-scenes/1", "scenes": scenes})));
    }
    let lines: String = scene::names().iter().map(|(name, about)| format!("{name:<15} {about}\n")).collect();
    print(&format!("{lines}\nAny model file (.ply, .obj, .pdb) will do as well: pxpl5 run --scene FILE\n"))
}
