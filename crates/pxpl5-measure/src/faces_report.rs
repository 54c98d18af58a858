//! Report of an address recalculation display, as numbers.

use crate::head_results::HeadResults;
use crate::step_observer::Steps;
use crate::turn_observer::RotationPart;
use address_recalculation::{AddressRecalculationPipeline, DisplayMemory, Latch};
use pxpl5_run::{Outcome, Statistics};
use serde::Serialize;

/// Results of an address recalculation pipeline and its display memories in a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FacesReport {
    /// Name and version of the layout of this report.
    pub schema: &'static str,
    /// Number of texels along the edge of a face, including guard texels.
    pub face_texels: u64,
    /// Times at which the display reads the orientation of the head: once for each field, line or pixel.
    pub latch: Latch,
    /// Time in nanoseconds from the reading (latching) of an orientation until the first pixel with this orientation is
    /// lit.
    pub pipeline_ns: f64,
    /// Number of head orientations that the display accepted.
    pub matrix_loads: u64,
    /// Number of head orientations that the display refused.
    pub matrix_refused: u64,
    /// The display memories, starting with the memory that is drawn most often.
    pub memories: Vec<MemoryReport>,
    /// Time from the measurement of an orientation until the middle of the picture is lit, in milliseconds. `None`
    /// without a tracker.
    pub rotation_latency_ms: Option<Statistics>,
    /// Parts of the rotation latency. The means of the parts add up to the mean of the rotation latency.
    pub rotation_latency_parts_ms: Vec<RotationPart>,
}

/// Results of one display memory in a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MemoryReport {
    /// Updates shown per second within the result window. `None` if fewer than two updates were shown.
    pub updates_hz: Option<f64>,
    /// Mean number of display periods between consecutive updates. `None` if fewer than two updates were shown.
    pub period_frames: Option<f64>,
    /// Number of updates shown in the whole run, including the warm-up.
    pub updates: u64,
    /// Number of structures of the scene in the display memory at its last update.
    pub segments: usize,
    /// Number of regions that arrived at this display memory.
    pub regions_copied: u64,
    /// Number of retraces at which a requested update was not complete.
    pub missed: u64,
    /// Latency from a translation of the head until the middle of the picture is lit, in milliseconds, over all fields.
    ///
    /// The latency starts at the measurement of the head's pose. Without a tracker the latency starts when the display
    /// memory must be redrawn (becomes due). `None` before the first update, and in a run that discarded its records
    /// without a streaming observer.
    pub translation_latency_ms: Option<Statistics>,
    /// Means of the parts of the translation latency, in milliseconds. The parts add up to the mean of the latency.
    ///
    /// The parts are the time from the measurement until the display memory became due, the time until the update was
    /// shown, the age of the shown update, and the scan-out.
    pub translation_latency_parts_ms: Vec<(&'static str, f64)>,
    /// Total delay of late updates in milliseconds. The delay of an update lasts from the first missed retrace to the
    /// retrace that showed the update.
    pub lateness_ms: f64,
    /// Size of both buffers of the display memory, in bytes.
    pub bytes: u64,
}

impl FacesReport {
    /// Name and version of the layout of this report.
    pub const SCHEMA: &'static str = "pxpl5-arp/1";

    /// Returns the report of a run, or `None` if the run's display is not an address recalculation display.
    pub(crate) fn of(outcome: &Outcome, results: &HeadResults) -> Option<Self> {
        let display: &AddressRecalculationPipeline = outcome.record().display_of_kind()?;
        let timing = &display.config().timing;
        // A display that lacks a counter has counted nothing.
        let counted = |name: &str| {
            let counters = outcome.record().display().counters();
            counters.iter().find(|counter| counter.name == name).map_or(0, |counter| counter.count)
        };
        let HeadResults { turns, steps, .. } = results;
        let memories = outcome.display_memories().iter().enumerate();
        Some(Self {
            schema: Self::SCHEMA,
            face_texels: timing.face_texels,
            latch: display.config().latch,
            pipeline_ns: timing.depth().as_ms() * 1e6,
            matrix_loads: counted("matrix loads"),
            matrix_refused: counted("matrices refused"),
            memories: memories
                .map(|(k, memory)| MemoryReport::of(outcome, (k, memory), steps.get(k).cloned().unwrap_or_default()))
                .collect(),
            rotation_latency_ms: turns.0,
            rotation_latency_parts_ms: turns.1.clone(),
        })
    }
}

impl MemoryReport {
    fn of(outcome: &Outcome, (k, memory): (usize, &DisplayMemory), steps: Steps) -> Self {
        let stats = memory.stats();
        let in_window = outcome.tally().updates.get(&k).copied().unwrap_or_default();
        // Mean number of periods between updates within the window.
        let period =
            outcome.window().filter(|_| in_window >= 2).map(|window| window.periods() as f64 / in_window as f64);
        // The last update shows which structures the memory holds.
        let notes = outcome.requested_updates();
        let last = notes.iter().rfind(|note| note.memory == k);
        Self {
            updates_hz: period.map(|period| 1e3 / (period * outcome.field_ms())),
            period_frames: period,
            updates: stats.swaps,
            segments: last.map_or(0, |note| note.structures.iter().filter(|held| **held).count()),
            regions_copied: stats.regions,
            missed: stats.missed,
            translation_latency_ms: steps.0,
            translation_latency_parts_ms: steps.1,
            lateness_ms: stats.lateness.as_ms(),
            bytes: memory.bytes(),
        }
    }
}
