//! Latency from a step (translation) of the head until the content of each display memory is lit.

use address_recalculation::{AddressRecalculationPipeline, FaceScan};
use pxpl5_run::{FaceHistory, FinalResults, Samples, ShownUpdate, Statistics};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;

/// Names of the parts of the latency after a step (translation) of the head, in the order of time.
const PARTS: [&str; 4] = ["before_due", "draw", "age", "scan"];

/// A streaming observer of latencies. A latency lasts from a step (translation) of the head until the content of a
/// display memory is lit.
///
/// The observer adds one latency for each display memory and each display period after the memory's first update.
#[derive(Debug, Default)]
pub(crate) struct StepSum {
    next: PeriodNumber,
    memories: Vec<OfMemory>,
}

#[derive(Debug, Default)]
struct OfMemory {
    /// The display period that first shows the display memory's newest update, and the instant at which this update's
    /// latency begins.
    begin: Option<(PeriodNumber, Time)>,
    total: Samples,
    parts: [f64; PARTS.len()],
}

/// Latencies from a step (translation) of the head until the content of one display memory is lit.
///
/// The first entry has the latency over all display periods since the display memory's first update, in milliseconds.
/// It is `None` before the first update. The second entry has the mean of each part.
pub(crate) type Steps = (Option<Statistics>, Vec<(&'static str, f64)>);

impl StepSum {
    pub(crate) fn take(&mut self, run: &FinalResults<'_>) {
        let display: Option<&AddressRecalculationPipeline> = run.record.display_of_kind();
        let Some(scan) = display.and_then(|display| display.config().scan().ok()) else { return };
        let Some(history) = FaceHistory::held(run.record) else { return };
        // Each field and memory gives one latency, once its results can no longer change.
        for field in self.next.until(run.until) {
            for memory in 0..history.memories.len() {
                let Some(shown) = history.memory_at(memory, field) else { continue };
                if self.memories.len() <= memory {
                    self.memories.resize_with(memory + 1, || OfMemory {
                        total: Samples::keeping(run.samples),
                        ..OfMemory::default()
                    });
                }
                self.memories[memory].push(run, &scan, shown, field);
            }
        }
        self.next = run.until;
    }

    /// Returns the results of all display memories, starting with the memory that is drawn most often.
    pub(crate) fn result(self) -> Vec<Steps> {
        self.memories.into_iter().map(OfMemory::result).collect()
    }
}

impl OfMemory {
    /// Adds the latency of the content that a display memory shows in a field. The latency ends when the middle of the
    /// field is lit.
    fn push(&mut self, run: &FinalResults<'_>, scan: &FaceScan, shown: &ShownUpdate, field: PeriodNumber) {
        let due = shown.note.due_at;
        // The measurement is looked up once for each update, because a long run may discard the view of an update that
        // is shown for many fields.
        let begin = match self.begin {
            Some((from, begin)) if from == shown.from => begin,
            _ => measured_at(run, shown).unwrap_or(due),
        };
        self.begin = Some((shown.from, begin));
        // An interlaced display shows one of two neighbouring lines in each period.
        let mut middle = [0, 1].into_iter().map(|line| scan.when(scan.width() / 2, scan.height() / 2 + line, field));
        let Some(light) = middle.find_map(|light| light) else { return };
        let instants = [begin, due, scan.retrace(shown.from), scan.retrace(field), light];
        for (sum, pair) in self.parts.iter_mut().zip(instants.windows(2)) {
            *sum += between_ms(pair[0], pair[1]);
        }
        self.total.push(between_ms(begin, light));
    }

    fn result(self) -> Steps {
        let count = self.total.count();
        if count == 0 {
            return Steps::default();
        }
        let parts = PARTS.into_iter().zip(self.parts).map(|(name, sum)| (name, sum / count as f64));
        (Some(self.total.statistics()), parts.collect())
    }
}

fn measured_at(run: &FinalResults<'_>, shown: &ShownUpdate) -> Option<Time> {
    let sampled = run.head?.sampled();
    sampled.iter().find(|sampled| sampled.number == shown.note.view)?.measured_at
}

/// Returns the time between two instants in milliseconds.
///
/// The result is negative if a view uses a tracker report that arrived after the view's display memory was due.
fn between_ms(from: Time, to: Time) -> f64 {
    (to.0 as f64 - from.0 as f64) * 1e-9
}
