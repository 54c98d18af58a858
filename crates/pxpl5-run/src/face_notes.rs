//! What a host asked a machine to draw onto faces around a head.

use pxpl5_sim::Time;
use pxpl5_wire::{PictureNumber, ViewNumber};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// An update of a display memory, as the host asked for it.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceNote {
    /// Its number among all updates.
    pub picture: PictureNumber,
    /// The view whose eye it was drawn from.
    pub view: ViewNumber,
    /// The memory that it is for.
    pub memory: usize,
    /// When the policy found the memory due.
    pub due_at: Time,
    /// Structures of the scene that the memory holds, by their place.
    pub structures: Arc<[bool]>,
}

/// The updates of a run, written while it goes on, as far as they were not given up.
#[derive(Clone, Debug, Default)]
pub struct FaceNotes(Arc<Mutex<Held>>);

#[derive(Debug, Default)]
struct Held {
    /// How many updates each memory was asked for so far.
    asked: BTreeMap<usize, u64>,
    /// Updates that are held, in order, each with how many of its memory came before it.
    notes: Vec<(u64, FaceNote)>,
}

impl FaceNotes {
    pub(crate) fn write(&self, note: FaceNote) {
        let Held { asked, notes } = &mut *self.held();
        let asked = asked.entry(note.memory).or_default();
        notes.push((*asked, note));
        *asked += 1;
    }

    /// All that are held, in order.
    #[must_use]
    pub fn all(&self) -> Vec<FaceNote> {
        self.held().notes.iter().map(|(_, note)| note.clone()).collect()
    }

    /// Those of a memory that are held, each with how many came before it.
    pub(crate) fn of_memory(&self, memory: usize) -> BTreeMap<u64, FaceNote> {
        let held = self.held();
        let of_memory = held.notes.iter().filter(|(_, note)| note.memory == memory);
        of_memory.cloned().collect()
    }

    /// Gives up the updates of a memory before one of them: it shows that one, or a later one.
    pub(crate) fn keep_from(&self, memory: usize, number: u64) {
        self.held().notes.retain(|(before, note)| note.memory != memory || *before >= number);
    }

    fn held(&self) -> MutexGuard<'_, Held> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
