//! The command `pxpl5 volume figures`, which compares figures of the SpatialGL paper with the model.

use super::settings::load;
use crate::error::CliError;
use crate::figures::{fresh, rows_text};
use crate::output::{OutputFile, OutputFolder};
use crate::terminal::{answer, json_text, progress};
use clap::Args;
use pxpl5::scene::Scene;
use pxpl5::views::png_bytes;
use pxpl5::volume::figures::{FigureDrawing, VolumeFigures, all, drawings, markdown};
use pxpl5::volume::spatialgl::Threads;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Arc;

/// Compare the figures of the SpatialGL paper with the model, and redraw the drawings of the paper.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 volume figures
  pxpl5 volume figures --json
  pxpl5 volume figures --out out/figures                  its figures 4 to 12, redrawn from the model
  pxpl5 volume figures --write docs/volumetric.md
  pxpl5 volume figures --check docs/volumetric.md         fails if the file is out of date")]
pub(super) struct FiguresArgs {
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Write the document with all figures to this file.
    #[arg(long, value_name = "FILE", conflicts_with = "check")]
    write: Option<PathBuf>,
    /// Fail if this file differs from the document that --write would write.
    #[arg(long, value_name = "FILE")]
    check: Option<PathBuf>,
    /// Write the redrawn figures 4 to 12 into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print nothing but errors and, with --json, the JSON object.
    #[arg(long, short)]
    quiet: bool,
}

const SCENES: [&str; 3] = ["mig", "head", "molecules"];

pub(super) fn run(args: FiguresArgs) -> Result<(), CliError> {
    let document = args.write.as_deref().map(|path| OutputFile::open(path, "--write")).transpose()?;
    let mut folder = args.out.as_deref().map(|out| OutputFolder::of_run(out, "volume figures")).transpose()?;
    // Rows are measured on all scenes; drawings use the first scene.
    let scenes = SCENES.iter().map(|name| load(name, None)).collect::<Result<Vec<_>, _>>()?;
    let bar = progress(0, "scenes", args.quiet);
    let figures = all(&scenes, &Threads::all(), |done, of| bar.advance(done, of));
    bar.clear();
    let figures = figures?;
    if let Some(document) = document {
        document.write(markdown(&figures).as_bytes())?;
    }
    if let Some(folder) = &mut folder {
        draw(folder, &scenes)?;
    }
    folder.map(OutputFolder::commit).transpose()?;
    if let Some(path) = &args.check {
        fresh(path, &markdown(&figures), "volume figures")?;
    }
    answer(args.json, args.quiet, &json_text(&figures)?, || text(&figures))
}

fn draw(folder: &mut OutputFolder, scenes: &[Arc<Scene>]) -> Result<(), CliError> {
    let Some(scene) = scenes.first() else { return Ok(()) };
    let drawn = drawings(scene, &Threads::all())?;
    for drawing in &drawn {
        let texts = [("figure", drawing.number.to_string()), ("about", drawing.about.to_owned())];
        let png = png_bytes(&drawing.picture, &texts).map_err(CliError::failure)?;
        folder.put(&format!("figure-{:02}.png", drawing.number), &png)?;
    }
    let texts = [("about", "figures 4 to 12, row by row".to_owned())];
    folder.put("figures.png", &png_bytes(&FigureDrawing::sheet(&drawn), &texts).map_err(CliError::failure)?)
}

fn text(figures: &VolumeFigures) -> String {
    let mut text = rows_text(&figures.figures);
    text.push_str("\nStated without numbers:\n");
    // Statements without a number are checked for their shape.
    for shown in &figures.shown {
        let mark = if shown.holds { "shown" } else { "NOT SHOWN" };
        let _ = writeln!(text, "  {mark:<9} {}: {}", shown.statement, shown.evidence);
    }
    let _ = writeln!(text, "\n{} definitions are not compared", figures.definitions.len());
    text
}
