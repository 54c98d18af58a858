//! What the figures are: rows, scenes, and all of them together.

use super::shown::Shown;
use crate::experiment::Volume;
use perspecta::figures::{Definition, Figure};
use serde::Serialize;

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

/// A number that no run could change, and where the paper prints it.
#[derive(Clone, Debug, Serialize)]
pub struct DefinitionRow {
    /// The number.
    #[serde(flatten)]
    pub definition: Definition,
    /// Where the paper prints it; "derived" for what follows from what it prints.
    pub source: &'static str,
}

impl DefinitionRow {
    pub(super) fn of(definition: Definition) -> Self {
        Self { source: source(definition.id), definition }
    }
}

/// Everything that the paper says, beside what the model has.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Name and version of this record's layout.
    pub schema: &'static str,
    /// A row for each figure that code computes or counts: printed ones by number, then derived ones.
    pub figures: Vec<FigureRow>,
    /// Inputs of the model and what follows from them by arithmetic alone; they have no verdict.
    pub definitions: Vec<DefinitionRow>,
    /// What the paper states without numbers.
    pub shown: Vec<Shown>,
    /// The scenes on which measured rows were measured.
    pub scenes: Vec<MeasuredScene>,
}

/// Counts of a scene drawn with the hyperbola along the normal.
#[derive(Clone, Debug, Serialize)]
pub struct MeasuredScene {
    /// Name of the scene that was drawn.
    pub scene: String,
    /// Triangles that it has.
    pub triangles: u64,
    /// Draws that bins leave of all, percent.
    pub draws_percent: f64,
    /// Part of the queried tiles that holds something, percent.
    pub tile_occupancy_percent: f64,
    /// Bytes of a volume unpacked, packed and sent.
    pub bytes: [u64; 3],
    /// Milliseconds of the model: processor, GPU, bus.
    pub model_ms: [f64; 3],
    /// Volumes a second of the model, one after the other and overlapped.
    pub volumes_hz: [f64; 2],
    /// A number that any other bit of the volume would change.
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

impl FigureRow {
    pub(super) fn of(figure: Figure, scene: Option<&str>) -> Self {
        let error_percent = figure.error_percent();
        let is_met = figure.is_met();
        Self { source: source(figure.id), scene: scene.map(str::to_owned), error_percent, is_met, figure }
    }
}

/// Printed figures first, then derived ones, then those that have no number.
pub(super) fn order(id: &str) -> (u8, u32) {
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
