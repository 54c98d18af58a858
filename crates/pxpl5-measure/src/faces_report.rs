//! What a display with faces did, as numbers.

use crate::turn_sum::{RotationPart, Turns};
use address_recalculation::{AddressRecalculationPipeline, DisplayMemory, Latch};
use pxpl5_run::{FaceHistory, Outcome, Statistics};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
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
    /// picture's middle, milliseconds, over all fields from the first update on; `None` before it, and in a run that has dropped records.
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
        let memories = outcome.display_memories().iter().enumerate();
        Some(Self {
            schema: Self::SCHEMA,
            face_texels: timing.face_texels,
            latch: display.config().latch,
            pipeline_ns: timing.depth().as_ms() * 1e6,
            matrix_loads: counted("matrix loads"),
            matrix_refused: counted("matrices refused"),
            memories: memories.map(|(k, memory)| MemoryReport::of(outcome, k, memory)).collect(),
            rotation_latency_ms: turns.latency_ms,
            rotation_latency_parts_ms: turns.parts_ms,
        })
    }
}

impl MemoryReport {
    fn of(outcome: &Outcome, k: usize, memory: &DisplayMemory) -> Self {
        let stats = memory.stats();
        let in_window = outcome.tally().memory_updates.get(&k).copied().unwrap_or_default();
        // Periods from one update to the next, on average over the window.
        let period =
            outcome.window().filter(|_| in_window >= 2).map(|window| window.periods() as f64 / in_window as f64);
        let notes = outcome.face_notes().all();
        let last = notes.iter().rfind(|note| note.memory == k);
        let steps = steps(outcome, k);
        Self {
            updates_hz: period.map(|period| 1e3 / (period * outcome.field_ms())),
            period_frames: period,
            updates: stats.swaps,
            segments: last.map_or(0, |note| note.structures.iter().filter(|held| **held).count()),
            regions_copied: stats.regions,
            missed: stats.missed,
            translation_latency_ms: (!steps.total.is_empty()).then(|| Statistics::of(steps.total.iter().copied())),
            translation_latency_parts_ms: steps.mean_parts_ms(),
            lateness_ms: stats.lateness.as_ms(),
            bytes: memory.bytes(),
        }
    }
}

/// Parts of the latency of a step of the head, in the order of time.
const STEP_PARTS: [&str; 4] = ["before_due", "draw", "age", "scan"];

/// Latencies of what a memory shows, field by field, milliseconds.
#[derive(Debug, Default)]
struct Steps {
    total: Vec<f64>,
    parts: [f64; STEP_PARTS.len()],
}

impl Steps {
    fn mean_parts_ms(&self) -> Vec<(&'static str, f64)> {
        let count = self.total.len() as f64;
        let means = STEP_PARTS.into_iter().zip(self.parts).map(|(name, sum)| (name, sum / count));
        means.filter(|_| count > 0.0).collect()
    }
}

/// The latency of what memory `k` shows in the middle of every field from its first update on.
fn steps(outcome: &Outcome, k: usize) -> Steps {
    let mut steps = Steps::default();
    let display: Option<&AddressRecalculationPipeline> = outcome.record().display_of_kind();
    // The first fields of such a run are not known any more.
    if outcome.has_forgotten() {
        return steps;
    }
    let Some(scan) = display.and_then(|display| display.config().scan().ok()) else { return steps };
    let Some(history) = FaceHistory::of(outcome) else { return steps };
    let sampled = outcome.head().map(|head| head.sampled()).unwrap_or_default();
    let measured = |view| sampled.iter().find(|sampled| sampled.number == view).and_then(|sampled| sampled.measured_at);
    let all = history.memory(k);
    for (place, shown) in all.iter().enumerate() {
        let due = shown.note.due_at;
        let begin = measured(shown.note.view).unwrap_or(due);
        let swapped = scan.retrace(shown.from);
        let last = all.get(place + 1).map_or(PeriodNumber(outcome.fields()), |next| next.from);
        for field in shown.from.until(last) {
            // An interlaced display shows one of two neighbouring lines in each period.
            let mut middle =
                [0, 1].into_iter().map(|line| scan.lights(scan.width() / 2, scan.height() / 2 + line, field));
            let Some(light) = middle.find_map(|light| light) else { continue };
            let instants = [begin, due, swapped, scan.retrace(field), light];
            // A view may rest on a report that came after the memory was due: such a part is below zero.
            let between = |from: Time, to: Time| (to.0 as f64 - from.0 as f64) * 1e-9;
            for (sum, pair) in steps.parts.iter_mut().zip(instants.windows(2)) {
                *sum += between(pair[0], pair[1]);
            }
            steps.total.push(between(begin, light));
        }
    }
    steps
}
