//! The words of the native firmware, for tests of its i860 code.

use pphigs::{Pass, RegionEnvelope, region_messages};
use pxpl5_wire::{RegionId, Word};
use std::sync::Arc;

/// Returns the words of a region's primitives as the native firmware makes them.
pub(crate) fn native(pass: &Arc<Pass>, region: RegionId) -> Vec<Word> {
    let mut words = Vec::new();
    for list in region_messages(pass, region, 0, RegionEnvelope::default()) {
        list.content.expect("pixels are wanted").append_words(&mut words);
    }
    words
}
