//! The figures of the SpatialGL paper and the results of the model: rows with provenance, statements without numbers,
//! and drawings.

mod counted;
mod document;
mod drawings;
mod plain;
mod printed;
mod row;
mod shown;

pub use document::markdown;
pub use drawings::{Drawing, drawings};
pub use row::{DefinitionRow, FigureRow, Figures, MeasuredScene};
pub use shown::Shown;

use crate::error::VolumeError;
use crate::experiment::Volume;
use plain::plain;
use pxpl5_scene::Scene;
use row::order;
use spatialgl::Workers;
use spatialgl::perspecta::figures::{definitions, formulas, measured, packing};
use std::sync::Arc;

/// Measures all figures. Figure P17 (the percentage of occupied tiles) and the number of draws with bins are measured
/// on each of the scenes. `finished` is called with the number of finished steps and the number of all steps.
///
/// # Errors
///
/// Returns [`VolumeError`] if a scene cannot be drawn.
pub fn all(scenes: &[Arc<Scene>], workers: &dyn Workers, finished: impl Fn(u64, u64)) -> Result<Figures, VolumeError> {
    let steps = scenes.len() as u64 + 2;
    // Figures that need no scene come first.
    let mut without_scene = formulas();
    without_scene.extend(packing());
    without_scene.extend(printed::figures(workers)?);
    without_scene.extend(counted::figures(workers)?);
    let mut rows: Vec<FigureRow> = without_scene.into_iter().map(|figure| FigureRow::of(figure, None)).collect();
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
    let mut definitions: Vec<DefinitionRow> = definitions().into_iter().map(DefinitionRow::of).collect();
    definitions.sort_by_key(|row| order(row.definition.id));
    Ok(Figures { schema: "pxpl5-volume-figures/2", figures: rows, definitions, shown, scenes: of_scenes })
}
