//! What a display with faces did, as numbers.

use crate::step_sum::Steps;
use crate::turn_sum::{RotationPart, Turns};
use address_recalculation::{AddressRecalculationPipeline, DisplayMemory, Latch};
use pxpl5_run::{Outcome, Statistics};
use serde::Serialize;

/// An address recalculation pipeline and its memories over a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FacesReport {
    /// Name and version of this record's layout.
    pub schema: &'static str,
    /// Texels along an edge of a face, guard texels included.
    pub face_texels: u64,
    /// Before what the orientation is latched.
    pub latch: Latch,
    /// From the latch to the light of the first pixel, nanoseconds.
    pub pipeline_ns: f64,
    /// Orientations that the display took.
    pub matrix_loads: u64,
    /// Orientations that it refused.
    pub matrix_refused: u64,
    /// Its memories, the one that is drawn most often first.
    pub memories: Vec<MemoryReport>,
    /// From the measurement of an orientation to the light of the picture's middle, milliseconds; nothing without a tracked head.
    pub rotation_latency_ms: Option<Statistics>,
    /// Its parts, which add up to it.
    pub rotation_latency_parts_ms: Vec<RotationPart>,
}

/// A display memory over a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MemoryReport {
    /// Updates that were shown, a second, over the window; nothing where fewer than two were, since a single one has no rate.
    pub updates_hz: Option<f64>,
    /// Periods of the display from one to the next; nothing where there is no rate.
    pub period_frames: Option<f64>,
    /// Updates that were shown in the whole run, start-up included.
    pub updates: u64,
    /// Structures that it held at its last update.
    pub segments: usize,
    /// Regions that came.
    pub regions_copied: u64,
    /// Retraces at which an update that had been asked for was not whole.
    pub missed: u64,
    /// From the measurement of the head, or without a tracker from the instant at which the memory became due, to the light of the
    /// picture's middle, milliseconds, over all fields from the first update on; `None` before it, and where a run dropped its records unobserved.
    pub translation_latency_ms: Option<Statistics>,
    /// Means of its parts, which add up to its mean: from the measurement until the memory became due, until the update was shown, the
    /// age of what is shown, the scan.
    pub translation_latency_parts_ms: Vec<(&'static str, f64)>,
    /// From the first retrace that each late update missed to the one that showed it, summed up, milliseconds.
    pub lateness_ms: f64,
    /// Bytes of both its buffers.
    pub bytes: u64,
}

impl FacesReport {
    /// Name and version of the layout.
    pub const SCHEMA: &'static str = "pxpl5-arp/1";

    /// Of a run; `None` where its display takes no faces.
    #[must_use]
    pub fn of(outcome: &Outcome) -> Option<Self> {
        let display: &AddressRecalculationPipeline = outcome.record().display_of_kind()?;
        let timing = &display.config().timing;
        let counted = |name: &str| {
            let counters = outcome.record().display().counters();
            counters.iter().find(|counter| counter.name == name).map_or(0, |counter| counter.count)
        };
        let turns = Turns::of(outcome);
        let steps = Steps::of(outcome);
        let memories = outcome.display_memories().iter().enumerate();
        Some(Self {
            schema: Self::SCHEMA,
            face_texels: timing.face_texels,
            latch: display.config().latch,
            pipeline_ns: timing.depth().as_ms() * 1e6,
            matrix_loads: counted("matrix loads"),
            matrix_refused: counted("matrices refused"),
            memories: memories.map(|(k, memory)| MemoryReport::of(outcome, (k, memory), steps.get(k))).collect(),
            rotation_latency_ms: turns.latency_ms,
            rotation_latency_parts_ms: turns.parts_ms,
        })
    }
}

impl MemoryReport {
    fn of(outcome: &Outcome, (k, memory): (usize, &DisplayMemory), steps: Option<&Steps>) -> Self {
        let stats = memory.stats();
        let in_window = outcome.tally().memory_updates.get(&k).copied().unwrap_or_default();
        // Periods from one update to the next, on average over the window.
        let period =
            outcome.window().filter(|_| in_window >= 2).map(|window| window.periods() as f64 / in_window as f64);
        let notes = outcome.face_notes().all();
        let last = notes.iter().rfind(|note| note.memory == k);
        Self {
            updates_hz: period.map(|period| 1e3 / (period * outcome.field_ms())),
            period_frames: period,
            updates: stats.swaps,
            segments: last.map_or(0, |note| note.structures.iter().filter(|held| **held).count()),
            regions_copied: stats.regions,
            missed: stats.missed,
            translation_latency_ms: steps.and_then(|steps| steps.latency_ms),
            translation_latency_parts_ms: steps.map(|steps| steps.parts_ms.clone()).unwrap_or_default(),
            lateness_ms: stats.lateness.as_ms(),
            bytes: memory.bytes(),
        }
    }
}
