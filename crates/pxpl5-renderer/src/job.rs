//! Pixels of one region, computed when somebody looks.

use crate::{Lanes, Layout, PixelArray};
use pxpl5_wire::{CommandWords, PixelSource, Word};
use std::fmt;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Pixel arrays that are not in use; a thread that computes pixels borrows one.
pub struct ArrayPool {
    layout: Layout,
    idle: Mutex<Vec<Lanes>>,
}

impl fmt::Debug for ArrayPool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ArrayPool").finish_non_exhaustive()
    }
}

impl ArrayPool {
    /// A pool of arrays with this memory layout.
    #[must_use]
    pub fn new(layout: Layout) -> Arc<Self> {
        Arc::new(Self { layout, idle: Mutex::new(Vec::new()) })
    }

    fn with_array<T>(&self, use_array: impl FnOnce(&mut Lanes) -> T) -> T {
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut array = idle.unwrap_or_else(|| Lanes::new(&self.layout));
        let result = use_array(&mut array);
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(array);
        result
    }
}

/// Everything that was sent to one region context since it was cleared.
#[derive(Debug)]
pub(crate) struct PixelJob {
    pub(crate) pool: Arc<ArrayPool>,
    pub(crate) lists: Vec<Arc<dyn CommandWords>>,
    /// Whether the first list overwrites whatever the array held.
    pub(crate) cleared: bool,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) done: OnceLock<Arc<[Word]>>,
}

impl PixelJob {
    fn compute(&self) -> Arc<[Word]> {
        let mut words = Vec::new();
        self.pool.with_array(|array| {
            if !self.cleared {
                array.reset();
            }
            for list in &self.lists {
                words.clear();
                list.append_words(&mut words);
                // A fault stops the list, as on the hardware; what was drawn before stays.
                let _ = array.execute(&words);
            }
            array.read_colour(self.width, self.height).into()
        })
    }
}

impl PixelSource for PixelJob {
    fn pixels(&self) -> Arc<[Word]> {
        Arc::clone(self.done.get_or_init(|| self.compute()))
    }
}

/// A region that was copied while pixels were switched off.
#[derive(Debug)]
pub(crate) struct NoPixels {
    pub(crate) pixels: u32,
}

impl PixelSource for NoPixels {
    fn pixels(&self) -> Arc<[Word]> {
        vec![0; self.pixels as usize].into()
    }
}
