//! The figures of the SpatialGL paper and the results of the model: rows with provenance, statements without numbers,
//! and drawings.

mod counted;
mod document;
mod drawings;
mod printed;
mod row;
mod shown;

pub use document::markdown;
pub use drawings::{FigureDrawing, drawings};
pub use row::{MeasuredScene, VolumeFigures};
pub use shown::ShownStatement;

use crate::experiment::Volume;
use pxpl5_scene::Scene;
use pxpl5_sim::Watcher;
use pxpl5_sim::figures::FigureRow;
use pxpl5_sim::parameters::SettingError;
use row::order;
use shown::plain;
use spatialgl::Workers;
use spatialgl::perspecta::figures::{definitions, formulas, measured, packing};
use std::sync::Arc;

/// Measures all figures. Figure P17 (the percentage of occupied tiles) and the number of draws with bins are measured
/// on each of the scenes.
///
/// # Errors
///
/// Returns [`SettingError`] if a scene cannot be drawn.
pub fn all(
    scenes: &[Arc<Scene>],
    workers: &dyn Workers,
    watcher: &mut dyn Watcher,
) -> Result<VolumeFigures, SettingError> {
    let steps = scenes.len() as u64 + 2;
    // Figures that need no scene come first.
    let mut rows = formulas();
    rows.extend(packing());
    rows.extend(printed::figures(workers)?);
    rows.extend(counted::figures(workers)?);
    watcher.progress(1, steps);
    let mut of_scenes = Vec::new();
    for (i, scene) in scenes.iter().enumerate() {
        let volume = Volume::draw(&plain(), scene, workers)?;
        let found = measured(&volume.frame.stats);
        rows.extend(found.into_iter().map(|row| FigureRow { scene: Some(scene.name().to_owned()), ..row }));
        of_scenes.push(MeasuredScene::of(&volume));
        watcher.progress(i as u64 + 2, steps);
    }
    rows.sort_by_key(|row| order(row.id));
    let shown = shown::all(scenes, workers)?;
    watcher.progress(steps, steps);
    let mut definitions = definitions();
    definitions.sort_by_key(|definition| order(definition.id));
    Ok(VolumeFigures { schema: "pxpl5-volume-figures/3", figures: rows, definitions, shown, scenes: of_scenes })
}
