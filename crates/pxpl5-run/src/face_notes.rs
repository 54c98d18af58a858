//! What a host asked a machine to draw onto faces around a head.

use pxpl5_sim::Time;
use pxpl5_wire::{PictureNumber, ViewNumber};
use std::sync::{Arc, Mutex, PoisonError};

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

/// The updates of a run, written while it goes on.
#[derive(Clone, Debug, Default)]
pub struct FaceNotes(Arc<Mutex<Vec<FaceNote>>>);

impl FaceNotes {
    pub(crate) fn write(&self, note: FaceNote) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(note);
    }

    /// All of them, in order.
    #[must_use]
    pub fn all(&self) -> Vec<FaceNote> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
