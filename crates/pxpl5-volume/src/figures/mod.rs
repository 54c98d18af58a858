//! The SpatialGL paper's figures beside the model's: rows with standings, what it says without numbers, its drawings anew.

mod document;
mod drawings;
mod printed;
mod shown;

pub use document::{MeasuredScene, markdown};
pub use drawings::{Drawing, drawings};
pub use shown::Shown;

use crate::error::VolumeError;
use crate::experiment::Volume;
use crate::settings::VolumeSettings;
use perspecta::figures::{Figure, formulas, measured};
use pxpl5_scene::Scene;
use serde::Serialize;
use spatialgl::Workers;
use std::sync::Arc;

/// A figure, and on which scene it was measured.
#[derive(Clone, Debug, Serialize)]
pub struct FigureRow {
    /// What is printed or derived, and what the model has.
    #[serde(flatten)]
    pub figure: Figure,
    /// Where the paper prints it; "derived" for what follows from what it prints.
    pub source: &'static str,
    /// The scene that was drawn for it; none where nothing was.
    pub scene: Option<String>,
    /// (computed - published) / published, in percent.
    pub error_percent: f64,
    /// Whether the model agrees.
    pub is_met: bool,
}

/// Everything that the paper says, beside what the model has.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Name and version of this record's layout.
    pub schema: &'static str,
    /// A row for each figure, P1 to P20 and then D1 to D12.
    pub figures: Vec<FigureRow>,
    /// What the paper states without numbers.
    pub shown: Vec<Shown>,
    /// The scenes on which measured rows were measured.
    pub scenes: Vec<MeasuredScene>,
}

/// The paper's settings for what it measures: its hyperbola, along the normal, so that jitter decides nothing.
fn plain() -> VolumeSettings {
    VolumeSettings { projection: crate::ProjectionKind::Orthographic, ..VolumeSettings::paper() }
}

/// Measures everything; P17 and the draws that bins leave on each of the scenes. `finished` hears how many steps are done.
///
/// # Errors
///
/// [`VolumeError`] if a scene cannot be drawn.
pub fn all(scenes: &[Arc<Scene>], workers: &dyn Workers, finished: impl Fn(u64, u64)) -> Result<Figures, VolumeError> {
    let steps = scenes.len() as u64 + 2;
    let mut rows: Vec<FigureRow> = formulas().into_iter().map(|figure| FigureRow::of(figure, None)).collect();
    rows.extend(printed::figures(workers)?.into_iter().map(|figure| FigureRow::of(figure, None)));
    finished(1, steps);
    let mut of_scenes = Vec::new();
    for (i, scene) in scenes.iter().enumerate() {
        let volume = Volume::draw(&plain(), scene, workers)?;
        let found = measured(&volume.frame.stats);
        rows.extend(found.into_iter().map(|figure| FigureRow::of(figure, Some(scene.name()))));
        of_scenes.push(MeasuredScene::of(&volume));
        finished(i as u64 + 2, steps);
    }
    rows.sort_by_key(|row| order(row.figure.id));
    let shown = shown::all(scenes, workers)?;
    finished(steps, steps);
    Ok(Figures { schema: "pxpl5-volume-figures/1", figures: rows, shown, scenes: of_scenes })
}

impl FigureRow {
    fn of(figure: Figure, scene: Option<&str>) -> Self {
        let error_percent = figure.error_percent();
        let is_met = figure.is_met();
        Self { source: source(figure.id), scene: scene.map(str::to_owned), error_percent, is_met, figure }
    }
}

/// Printed figures first, then derived ones, then those that have no number.
fn order(id: &str) -> (u8, u32) {
    let number = id.get(1..).and_then(|digits| digits.parse().ok());
    match (id.chars().next(), number) {
        (Some('P'), Some(number)) => (0, number),
        (Some('D'), Some(number)) => (1, number),
        _ => (2, 0),
    }
}

/// The section of the paper that prints a figure.
fn source(id: &str) -> &'static str {
    match id {
        "P1" => "SpatialGL Graphics Pipeline; Slice View Volume",
        "P2" | "P3" | "P4" => "Shader Clip Planes",
        "P5" => "Slice View Volume",
        "P6" | "P7" | "P8" | "P9" | "P10" => "Image Reformatting",
        "P11" => "SpatialGL Optimizations",
        "P13" => "Vertex Outcodes",
        "P14" => "Binning",
        "P15" | "P16" | "P17" => "Tile Queries",
        "P18" => "Tile Batching",
        "P19" => "Degenerate Sections",
        "P20" => "Introduction",
        _ => "derived",
    }
}
