//! The two groups of figures with a document and pictures of their own.

use super::args::{ADDRESS_RECALCULATION, FiguresArgs};
use super::table::{fresh, rows_text, titled};
use crate::arp::settings::put;
use crate::error::CliError;
use crate::output::{OutputFile, OutputFolder};
use crate::progress::Progress;
use crate::terminal::{json_text, print};
use crate::volume::settings::load;
use pxpl5::arp::{figures as walks, pictures};
use pxpl5::lab::volumes::VolumeFigureQuery;
use pxpl5::scene::Scene;
use pxpl5::views::png_bytes;
use pxpl5::volume::figures::{FigureDrawing, VolumeFigures, drawings, markdown};
use pxpl5::volume::spatialgl::Threads;
use serde_json::json;
use std::fmt::Write as _;
use std::sync::Arc;

/// Draws the pictures of a group into a folder.
type Draw = Box<dyn FnOnce(&mut OutputFolder) -> Result<(), CliError>>;

/// A measured group, and how to draw its pictures.
struct Measured {
    markdown: String,
    json: String,
    text: String,
    draw: Draw,
}

/// Measures one group: `pxpl5 figures --group NAME`.
pub(super) fn run(name: &str, args: &FiguresArgs) -> Result<(), CliError> {
    // Open all outputs before the experiments, so that a bad path fails at once.
    let document = args.write.as_deref().map(|path| OutputFile::open(path, "--write")).transpose()?;
    let folder = args.out.as_deref().map(|out| OutputFolder::of_run(out, "figures")).transpose()?;
    let group = if name == ADDRESS_RECALCULATION { address_recalculation()? } else { volumetric(args)? };
    document.map(|document| document.write(group.markdown.as_bytes())).transpose()?;
    if let Some(mut folder) = folder {
        (group.draw)(&mut folder)?;
        folder.commit()?;
    }
    if let Some(path) = &args.check {
        fresh(path, &group.markdown, &format!("figures --group {name}"))?;
    }
    args.answer.print(&group.json, || group.text)
}

fn address_recalculation() -> Result<Measured, CliError> {
    // The walks have no finished part to keep, so Ctrl-C ends the command at once.
    let (experiments, rows) = walks::all()?;
    Ok(Measured {
        markdown: walks::markdown(&experiments, &rows),
        json: format!("{:#}\n", json!({ "schema": "pxpl5-arp-figures/2", "figures": rows })),
        text: rows_text(&rows),
        draw: Box::new(move |folder| {
            let origin = [("scene", "gallery".to_owned()), ("about", "figures of address recalculation".to_owned())];
            put(folder, &pictures::all(&experiments)?, &origin)
        }),
    })
}

const SCENES: [&str; 3] = ["mig", "head", "molecules"];

fn volumetric(args: &FiguresArgs) -> Result<Measured, CliError> {
    let (scenes, figures) = volumes(args.answer.quiet)?;
    Ok(Measured {
        markdown: markdown(&figures),
        json: json_text(&figures)?,
        text: text(&figures),
        draw: Box::new(move |folder| draw(folder, &scenes)),
    })
}

/// Measures the figures on all scenes. Drawings use the first scene.
fn volumes(quiet: bool) -> Result<(Vec<Arc<Scene>>, VolumeFigures), CliError> {
    let study = VolumeFigureQuery { scenes: SCENES.iter().map(|name| load(name, None)).collect::<Result<_, _>>()? };
    let figures = Progress::new("scenes", quiet).run(&study)?;
    Ok((study.scenes, figures))
}

/// Prints the table of the volumetric display with its title, for `pxpl5 figures`.
pub(super) fn print_volumes() -> Result<(), CliError> {
    print(&titled("Volumetric slices (docs/volumetric.md)", &volumes(false)?.1.figures))
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
