//! History of the cube faces that were drawn around the viewer's head, and the latency of head rotation.

use crate::observe::observers::FinalResults;
use crate::pipelines::faces::latched_head::{ORIENTATION_WORDS, OrientationTiming, RotationLatency};
use crate::pipelines::faces::requests::{RequestedUpdate, RequestedUpdates};
use crate::result::outcome::Outcome;
use address_recalculation::{AddressRecalculationPipeline, DisplayMemory};
use pxpl5_machine::Record;
use pxpl5_sim::Span;
use pxpl5_wire::display::Display;
use pxpl5_wire::{Eye, FieldParity, NodeId, PeriodNumber};

/// An update of a display memory, with the first period in which the memory shows the update.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownUpdate {
    /// Update that is shown.
    pub note: RequestedUpdate,
    /// First period in which the update is shown.
    pub from: PeriodNumber,
}

/// Updates that each display memory of a run has shown, in order.
#[derive(Clone, Debug, Default)]
pub struct FaceHistory {
    /// Updates of each display memory.
    pub memories: Vec<Vec<ShownUpdate>>,
}

impl FaceHistory {
    /// Returns the history from the records of a run that has ended or is in progress. Returns `None` if the run's
    /// display does not accept cube faces.
    pub fn held(record: &Record) -> Option<Self> {
        let display = display(record)?;
        // Only the pipelines of this module attach requests.
        let none = RequestedUpdates::default();
        let notes = record.attached().unwrap_or(&none);
        let memories = (0..).zip(display.nodes()).map(|(memory, port)| shown(record, notes, memory, *port));
        Some(Self { memories: memories.collect() })
    }

    /// Returns the update that each display memory shows in a period, in ascending order of the memory's index.
    /// Memories that show nothing are left out.
    pub fn at(&self, period: PeriodNumber) -> impl Iterator<Item = &ShownUpdate> {
        (0..self.memories.len()).filter_map(move |memory| self.memory_at(memory, period))
    }

    /// Returns the update that a display memory shows in a period. Returns `None` before the memory's first update.
    pub fn memory_at(&self, memory: usize, period: PeriodNumber) -> Option<&ShownUpdate> {
        let shown = self.memory(memory);
        shown[..shown.partition_point(|shown| shown.from <= period)].last()
    }

    /// Returns all updates that a display memory has shown, in order.
    pub fn memory(&self, memory: usize) -> &[ShownUpdate] {
        self.memories.get(memory).map_or(&[], Vec::as_slice)
    }
}

/// Returns the updates that a display memory has shown, from the recorded swaps of this memory. Each swap shows the
/// next update.
fn shown(record: &Record, notes: &RequestedUpdates, memory: usize, port: NodeId) -> Vec<ShownUpdate> {
    let of_memory = notes.of_memory(memory);
    let swaps = record.observation().swaps.iter().filter(|swap| swap.port == port);
    let shown =
        swaps.filter_map(|swap| Some(ShownUpdate { note: of_memory.get(&swap.number)?.clone(), from: swap.tick }));
    shown.collect()
}

pub(crate) fn display(record: &Record) -> Option<&AddressRecalculationPipeline> {
    record.display_of_kind()
}

impl OrientationTiming {
    /// Returns the orientation timing of a run that has ended or is in progress. Returns `None` if the run's display
    /// does not accept cube faces.
    pub fn of_run(results: &FinalResults<'_>) -> Option<Self> {
        let link = results.record.config().host.link_span(ORIENTATION_WORDS);
        Self::before(results.record.display(), link, results.aim)
    }
}

/// Returns the middle pixel of the first surface in a period. An interlaced display shows one of two neighbouring lines
/// in each period.
fn middle_pixel(record: &Record, period: PeriodNumber) -> Option<[u32; 2]> {
    let surface = record.display().surfaces().first()?;
    Some([surface.width / 2, surface.height / 2 + FieldParity::of_field(period).first_line()])
}

impl Outcome {
    /// Returns the display memories of a display with cube faces, in the order of decreasing update rate. The slice is
    /// empty for any other display.
    pub fn display_memories(&self) -> &[DisplayMemory] {
        display(self.record()).map_or(&[], |display| display.memories(Eye::Left))
    }

    /// Returns the requested updates of display memories that were not discarded, in order. The list is empty for a
    /// pipeline without cube faces.
    pub fn requested_updates(&self) -> Vec<RequestedUpdate> {
        self.record().attached().map_or_else(Vec::new, RequestedUpdates::all)
    }

    /// Returns the number of display periods in which a display with cube faces showed old pictures in a new direction
    /// of the head. Returns 0 for any other display.
    ///
    /// Each such period counts as a picture, although the pipeline drew nothing for this period. The periods begin with
    /// the first swap of any display memory, because each field is shown with its own latched orientation.
    pub fn turned_periods(&self) -> u64 {
        let first = display(self.record()).and_then(|_| self.observation().first_swap());
        let after = self.record().display().period_at(self.end());
        first.map_or(0, |first| after.since(first.min(after)))
    }

    /// Returns the rotation latency of the middle pixel of every field, beginning with the first field that has a
    /// rotation latency. The list is empty without a tracked head, or if the display does not accept cube faces.
    pub fn rotation_latencies(&self) -> Vec<RotationLatency> {
        let run = self.final_results();
        run.rotation_latencies(PeriodNumber::FIRST.until(run.until))
    }
}

impl FinalResults<'_> {
    /// Returns the prediction interval of the orientation by which the display turns the middle pixel of a period. The
    /// interval lasts from the measurement of the orientation to the instant for which the orientation was predicted.
    /// Returns `None` if the display turns no pictures, and before the first report.
    pub(crate) fn turn_interval(&self, period: PeriodNumber) -> Option<Span> {
        let (timing, head, [x, y]) = (OrientationTiming::of_run(self)?, self.head?, middle_pixel(self.record, period)?);
        let (reports_until, aimed) = timing.orientation_of_pixel(head, x, y, period)?;
        let measured = head.measured_at(head.report_by(reports_until)?)?;
        Some(aimed.since(measured))
    }

    /// Returns the rotation latency of the middle pixel of each of the fields `fields`. Fields without a latency are
    /// left out. The results of the fields must be final.
    pub fn rotation_latencies(&self, fields: impl Iterator<Item = PeriodNumber>) -> Vec<RotationLatency> {
        let Some((latched, head)) = OrientationTiming::of_run(self).zip(self.head) else { return Vec::new() };
        let of_field = |field| {
            let [x, y] = middle_pixel(self.record, field)?;
            latched.latency(head, x, y, field)
        };
        fields.filter_map(of_field).collect()
    }
}
