//! Report of an address recalculation display, as numbers.

use crate::turn_sum::{RotationPart, Turns};
use address_recalculation::{AddressRecalculationPipeline, DisplayMemory, Latch};
use pxpl5_run::{FaceHistory, Outcome, Statistics};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use serde::Serialize;

/// Results of an address recalculation pipeline and its memories in a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FacesReport {
    /// Name and version of this record's layout.
    pub schema: &'static str,
    /// Number of texels along the edge of a face, including guard texels.
    pub face_texels: u64,
    /// The moment at which the display latches the orientation.
    pub latch: Latch,
    /// From the latch to the light of the first pixel, in nanoseconds.
    pub pipeline_ns: f64,
    /// Number of orientations that the display accepted.
    pub matrix_loads: u64,
    /// Number of orientations that the display refused.
    pub matrix_refused: u64,
    /// The display memories, starting with the one that is drawn most often.
    pub memories: Vec<MemoryReport>,
    /// From the measurement of an orientation to the light of the picture's middle, in milliseconds. `None` without a
    /// tracker.
    pub rotation_latency_ms: Option<Statistics>,
    /// Parts of the rotation latency. Their means add up to the mean of the whole.
    pub rotation_latency_parts_ms: Vec<RotationPart>,
}

/// Results of one display memory in a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MemoryReport {
    /// Updates shown per second within the window. `None` if fewer than two updates were shown.
    pub updates_hz: Option<f64>,
    /// Display periods between consecutive updates. `None` if fewer than two updates were shown.
    pub period_frames: Option<f64>,
    /// Number of updates shown in the whole run, including start-up.
    pub updates: u64,
    /// Number of structures of the scene in the memory at its last update.
    pub segments: usize,
    /// Number of regions that arrived.
    pub regions_copied: u64,
    /// Number of retraces at which a requested update was not complete.
    pub missed: u64,
    /// Latency of the head's translation to the light of the picture's middle, in milliseconds, over all fields.
    ///
    /// The latency starts at the measurement of the head. Without a tracker it starts when the memory becomes due.
    /// `None` before the first update, and in a run that has discarded records.
    pub translation_latency_ms: Option<Statistics>,
    /// Means of the parts of the translation latency, in milliseconds. They add up to its mean.
    ///
    /// The parts are: measurement until the memory became due, due until shown, age of the shown update, and scan-out.
    pub translation_latency_parts_ms: Vec<(&'static str, f64)>,
    /// Total delay of late updates in milliseconds, each from the first missed retrace to the retrace that showed it.
    pub lateness_ms: f64,
    /// Size of both buffers of the memory, in bytes.
    pub bytes: u64,
}

impl FacesReport {
    /// Name and version of the record's layout.
    pub const SCHEMA: &'static str = "pxpl5-arp/1";

    /// Returns the report of a run, or `None` if its display is not an address recalculation pipeline.
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
        // Mean number of periods between updates within the window.
        let period =
            outcome.window().filter(|_| in_window >= 2).map(|window| window.periods() as f64 / in_window as f64);
        // The last update tells which structures the memory holds.
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

/// Names of the parts of the translation latency, in the order of time.
const STEP_PARTS: [&str; 4] = ["before_due", "draw", "age", "scan"];

/// Translation latencies of a memory, one entry per field, in milliseconds.
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

/// Returns the translation latency of memory `k` at the middle of every field from its first update on.
fn steps(outcome: &Outcome, k: usize) -> Steps {
    let mut steps = Steps::default();
    let display: Option<&AddressRecalculationPipeline> = outcome.record().display_of_kind();
    // A run that has discarded records does not know its first fields any more.
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
            // Each field of an interlaced display shows only one of two neighbouring lines.
            let mut middle =
                [0, 1].into_iter().map(|line| scan.lights(scan.width() / 2, scan.height() / 2 + line, field));
            let Some(light) = middle.find_map(|light| light) else { continue };
            let instants = [begin, due, swapped, scan.retrace(field), light];
            // A part may be negative: a view can use a report that arrived after the memory became due.
            let between = |from: Time, to: Time| (to.0 as f64 - from.0 as f64) * 1e-9;
            for (sum, pair) in steps.parts.iter_mut().zip(instants.windows(2)) {
                *sum += between(pair[0], pair[1]);
            }
            steps.total.push(between(begin, light));
        }
    }
    steps
}
