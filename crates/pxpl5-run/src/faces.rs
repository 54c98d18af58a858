//! What was drawn onto faces around a head, and where the time of a turn goes.

use crate::face_notes::{FaceNote, FaceNotes};
use crate::latched_head::{LatchedHead, ORIENTATION_WORDS, RotationLatency};
use crate::outcome::Outcome;
use crate::sums::Settled;
use address_recalculation::{AddressRecalculationPipeline, DisplayMemory};
use pxpl5_display::Display;
use pxpl5_machine::Record;
use pxpl5_wire::{Eye, FieldParity, NodeId, PeriodNumber};

/// What a display memory shows.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownMemory {
    /// The update that is shown.
    pub note: FaceNote,
    /// The period from whose begin on it is shown.
    pub from: PeriodNumber,
}

/// What every memory of a run showed from when on.
#[derive(Clone, Debug, Default)]
pub struct FaceHistory {
    memories: Vec<Vec<ShownMemory>>,
}

impl FaceHistory {
    /// Of a run, as far as it is kept; `None` where its display takes no faces.
    #[must_use]
    pub fn of(outcome: &Outcome) -> Option<Self> {
        Self::held(outcome.record(), outcome.face_notes())
    }

    /// The same of what is held while a run goes on.
    #[must_use]
    pub fn held(record: &Record, notes: &FaceNotes) -> Option<Self> {
        let display = display(record)?;
        let memories = (0..).zip(display.nodes()).map(|(memory, port)| shown(record, notes, memory, *port));
        Some(Self { memories: memories.collect() })
    }

    /// What each memory that shows something shows in a period, the lowest first.
    pub fn at(&self, period: PeriodNumber) -> impl Iterator<Item = &ShownMemory> {
        (0..self.memories.len()).filter_map(move |memory| self.memory_at(memory, period))
    }

    /// Returns the number of memories of the display.
    #[must_use]
    pub const fn n_memories(&self) -> usize {
        self.memories.len()
    }

    /// Returns what a memory shows in a period; `None` before its first update.
    #[must_use]
    pub fn memory_at(&self, memory: usize, period: PeriodNumber) -> Option<&ShownMemory> {
        let shown = self.memory(memory);
        shown[..shown.partition_point(|shown| shown.from <= period)].last()
    }

    /// Everything that a memory showed, in order.
    #[must_use]
    pub fn memory(&self, memory: usize) -> &[ShownMemory] {
        self.memories.get(memory).map_or(&[], Vec::as_slice)
    }
}

/// The updates of a memory are shown in their order, each by a swap; those of the swaps that are held.
fn shown(record: &Record, notes: &FaceNotes, memory: usize, port: NodeId) -> Vec<ShownMemory> {
    let of_memory = notes.of_memory(memory);
    let swaps = record.observation().swaps.iter().filter(|swap| swap.port == port);
    let shown =
        swaps.filter_map(|swap| Some(ShownMemory { note: of_memory.get(&swap.number)?.clone(), from: swap.tick }));
    shown.collect()
}

pub(crate) fn display(record: &Record) -> Option<&AddressRecalculationPipeline> {
    record.display_of_kind()
}

impl LatchedHead {
    /// Of a run; `None` where its display takes no faces.
    #[must_use]
    pub fn of(outcome: &Outcome) -> Option<Self> {
        Self::of_run(&outcome.settled())
    }

    /// The same while a run goes on.
    #[must_use]
    pub fn of_run(settled: &Settled<'_>) -> Option<Self> {
        let link = settled.record.config().host.link_span(ORIENTATION_WORDS);
        Self::before(settled.record.display(), link, settled.aim)
    }
}

impl Outcome {
    /// The memories of a display with faces, the one that is drawn most often first; none of any other display.
    #[must_use]
    pub fn display_memories(&self) -> &[DisplayMemory] {
        display(self.record()).map_or(&[], |display| display.memories(Eye::Left))
    }

    /// The rotation latency of the middle pixel of every field from the first that has one: empty without a tracked head, and
    /// where the display takes no faces.
    #[must_use]
    pub fn rotation_latencies(&self) -> Vec<RotationLatency> {
        let run = self.settled();
        run.rotation_latencies(PeriodNumber::FIRST.until(run.until))
    }
}

impl Settled<'_> {
    /// The rotation latency of the middle pixel of some settled fields, as far as they have one.
    #[must_use]
    pub fn rotation_latencies(&self, fields: impl Iterator<Item = PeriodNumber>) -> Vec<RotationLatency> {
        let Some((latched, head)) = LatchedHead::of_run(self).zip(self.head) else { return Vec::new() };
        let Some(surface) = self.record.display().surfaces().first() else { return Vec::new() };
        let x = surface.width / 2;
        let of_field = |field: PeriodNumber| {
            let y = surface.height / 2 + FieldParity::of_field(field).first_line();
            latched.latency(head, x, y, field)
        };
        fields.filter_map(of_field).collect()
    }
}
