use pxpl5_machine::{Attachment, Record};
use pxpl5_sim::Time;
use pxpl5_wire::{PictureNumber, ViewNumber};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A requested update of a display memory.
#[derive(Clone, Debug, PartialEq)]
pub struct RequestedUpdate {
    /// Number of the update, in one count over all display memories.
    pub picture: PictureNumber,
    /// Number of the view whose eye position was used to draw the update.
    pub view: ViewNumber,
    /// Index of the display memory.
    pub memory: usize,
    /// Time at which the policy decided that the display memory must be redrawn.
    pub due_at: Time,
    /// Flag of each structure of the scene: true if the display memory contains the structure.
    pub structures: Arc<[bool]>,
}

/// A record of the updates of a run that were not discarded.
///
/// The record grows during the run.
#[derive(Debug, Default)]
pub struct RequestedUpdates(Mutex<Held>);

#[derive(Debug, Default)]
struct Held {
    asked: BTreeMap<usize, u64>,
    /// Updates that were not discarded, in order. Each entry begins with the number of earlier updates of the same
    /// display memory.
    notes: Vec<(u64, RequestedUpdate)>,
}

impl RequestedUpdates {
    pub(crate) fn write(&self, note: RequestedUpdate) {
        let Held { asked, notes } = &mut *self.held();
        let asked = asked.entry(note.memory).or_default();
        notes.push((*asked, note));
        *asked += 1;
    }

    /// Returns all updates that were not discarded, in order.
    pub fn all(&self) -> Vec<RequestedUpdate> {
        self.held().notes.iter().map(|(_, note)| note.clone()).collect()
    }

    /// Returns the updates of a display memory that were not discarded. The key is the number of earlier updates of
    /// this memory.
    pub(crate) fn of_memory(&self, memory: usize) -> BTreeMap<u64, RequestedUpdate> {
        let held = self.held();
        let of_memory = held.notes.iter().filter(|(_, note)| note.memory == memory);
        of_memory.cloned().collect()
    }

    fn held(&self) -> MutexGuard<'_, Held> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Attachment for RequestedUpdates {
    /// Discards the updates that each display memory showed before the first swap that the record still holds.
    fn discard(&self, record: &Record) {
        let ports = record.ports().display().iter();
        let first: Vec<u64> = ports.map(|port| record.observation().first_swap_held(*port)).collect();
        self.held().notes.retain(|(before, note)| first.get(note.memory).is_none_or(|first| before >= first));
    }
}
