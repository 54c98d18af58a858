//! The figures of the SpatialGL paper, as a table, a document and drawings.

use super::args::FiguresArgs;
use super::table::{fresh, rows_text, titled};
use crate::error::CliError;
use crate::output::{OutputFile, OutputFolder};
use crate::progress::Progress;
use crate::terminal::{answer, json_text, print};
use crate::volume::settings::load;
use pxpl5::lab::volumes::VolumeFigureQuery;
use pxpl5::scene::Scene;
use pxpl5::views::png_bytes;
use pxpl5::volume::figures::{FigureDrawing, VolumeFigures, drawings, markdown};
use pxpl5::volume::spatialgl::Threads;
use std::fmt::Write as _;
use std::sync::Arc;

const SCENES: [&str; 3] = ["mig", "head", "molecules"];

/// Measures the group of the volumetric display: `pxpl5 figures --group volumetric`.
pub(super) fn run(args: &FiguresArgs) -> Result<(), CliError> {
    let document = args.write.as_deref().map(|path| OutputFile::open(path, "--write")).transpose()?;
    let mut folder = args.out.as_deref().map(|out| OutputFolder::of_run(out, "figures")).transpose()?;
    let (scenes, figures) = measured(args.quiet)?;
    if let Some(document) = document {
        document.write(markdown(&figures).as_bytes())?;
    }
    if let Some(folder) = &mut folder {
        draw(folder, &scenes)?;
    }
    folder.map(OutputFolder::commit).transpose()?;
    if let Some(path) = &args.check {
        fresh(path, &markdown(&figures), "figures --group volumetric")?;
    }
    answer(args.json, args.quiet, &json_text(&figures)?, || text(&figures))
}

/// Measures the figures on all scenes. Drawings use the first scene.
fn measured(quiet: bool) -> Result<(Vec<Arc<Scene>>, VolumeFigures), CliError> {
    let study = VolumeFigureQuery { scenes: SCENES.iter().map(|name| load(name, None)).collect::<Result<_, _>>()? };
    let figures = Progress::new("scenes", quiet).run(&study)?;
    Ok((study.scenes, figures))
}

/// Prints the table of the figures with its title, for `pxpl5 figures`.
pub(super) fn print_table() -> Result<(), CliError> {
    print(&titled("Volumetric slices (docs/volumetric.md)", &measured(false)?.1.figures))
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
