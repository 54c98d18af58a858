//! The data of the figures: rows, scenes, and the complete record.

use super::shown::ShownStatement;
use crate::experiment::Volume;
use pxpl5_sim::figures::{Definition, FigureRow};
use serde::Serialize;

/// All figures of the SpatialGL paper, with the results of the model.
#[derive(Clone, Debug, Serialize)]
pub struct VolumeFigures {
    /// Name and version of the JSON layout of this data.
    pub schema: &'static str,
    /// One row for each figure that the code computes or counts: printed figures by number, then derived figures.
    pub figures: Vec<FigureRow>,
    /// Inputs of the model, and numbers that follow from inputs by arithmetic alone. These numbers are not compared.
    pub definitions: Vec<Definition>,
    /// Statements of the SpatialGL paper without numbers, each with the measurements that test it.
    pub shown: Vec<ShownStatement>,
    /// Scenes on which figures were measured.
    pub scenes: Vec<MeasuredScene>,
}

/// Counts of a scene drawn with the hyperbolic clip and an orthographic projection.
#[derive(Clone, Debug, Serialize)]
pub struct MeasuredScene {
    /// Name of the scene that was drawn.
    pub scene: String,
    /// Number of triangles in the scene.
    pub triangles: u64,
    /// Number of primitives drawn with bins, as a percentage of the number without bins.
    pub draws_percent: f64,
    /// Percentage of queried tiles in which a pixel was drawn.
    pub tile_occupancy_percent: f64,
    /// Sizes of a volume in bytes: unpacked, packed, and as sent.
    pub bytes: [u64; 3],
    /// Modelled times of one volume in milliseconds: processor, GPU, bus.
    pub model_ms: [f64; 3],
    /// Volumes per second of the time model in two cases: processor, GPU and bus work one after the other, or at the
    /// same time.
    pub volumes_hz: [f64; 2],
    /// Hash of all bits of the volume.
    pub volume_hash: String,
}

impl MeasuredScene {
    pub(super) fn of(volume: &Volume) -> Self {
        let stats = &volume.frame.stats;
        let time = volume.time();
        Self {
            scene: volume.scene.clone(),
            triangles: stats.primitives,
            draws_percent: 100.0 * stats.draws as f64 / stats.draws_unbinned.max(1) as f64,
            tile_occupancy_percent: stats.tile_occupancy_percent(),
            bytes: [stats.bytes_unpacked, stats.bytes_packed, stats.bytes_sent],
            model_ms: [time.cpu_ms, time.gpu_ms, time.bus_ms()],
            volumes_hz: [time.serial_hz(), time.overlapped_hz()],
            volume_hash: format!("{:016x}", volume.frame.planes.hash()),
        }
    }
}

/// Returns a sort key for the identifier of a figure: printed figures first, then derived figures, then identifiers
/// without a number.
pub(super) fn order(id: &str) -> (u8, u32) {
    let number = id.get(1..).and_then(|digits| digits.parse().ok());
    match (id.chars().next(), number) {
        (Some('P'), Some(number)) => (0, number),
        (Some('D'), Some(number)) => (1, number),
        _ => (2, 0),
    }
}
