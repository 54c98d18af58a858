//! Computation of the pixels of a region, which runs only when the pixels are read.

use crate::{Command, Lanes, Layout, OutputRegion, PixelArray};
use pxpl5_wire::format::Z_BITS;
use pxpl5_wire::{CommandContent, CopyContent, CopyTarget, PixelSource, Word};
use std::collections::HashMap;
use std::fmt;
use std::slice::Iter;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// A pool of pixel arrays. Each thread that computes pixels takes one array from the pool.
pub struct ArrayPool {
    layout: Layout,
    idle: Mutex<Vec<ArrayAndWords>>,
    empty_regions: Mutex<HashMap<EmptyRegion, Arc<[Word]>>>,
}

struct ArrayAndWords {
    array: Lanes,
    words: Vec<Word>,
}

/// Cache key of a region without primitives. It contains all data that affect the pixels of the region.
#[derive(Debug, PartialEq, Eq, Hash)]
struct EmptyRegion {
    words: Vec<Word>,
    cleared: bool,
    size: [u32; 2],
}

/// Largest number of cached regions without primitives: six stereo frames of 40 regions, 16 MB.
const EMPTY_REGIONS: usize = 256;

impl fmt::Debug for ArrayPool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ArrayPool").finish_non_exhaustive()
    }
}

impl ArrayPool {
    /// Creates a pool, whose arrays divide pixel memory as `layout` states.
    pub fn new(layout: Layout) -> Arc<Self> {
        Arc::new(Self { layout, idle: Mutex::default(), empty_regions: Mutex::default() })
    }

    pub(crate) const fn layout(&self) -> &Layout {
        &self.layout
    }

    fn with_idle_array<T>(&self, work: impl FnOnce(&mut ArrayAndWords) -> T) -> T {
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut borrowed = idle.unwrap_or_else(|| ArrayAndWords { array: Lanes::new(&self.layout), words: Vec::new() });
        let result = work(&mut borrowed);
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(borrowed);
        result
    }

    /// Returns the pixels of a region without primitives, from the cache if the same region was drawn before.
    fn empty_region(&self, region: EmptyRegion, draw: impl FnOnce() -> Arc<[Word]>) -> Arc<[Word]> {
        if let Some(pixels) = self.kept_empty_regions().get(&region) {
            return Arc::clone(pixels);
        }
        let pixels = draw();
        let mut regions = self.kept_empty_regions();
        if regions.len() >= EMPTY_REGIONS {
            regions.clear();
        }
        regions.insert(region, Arc::clone(&pixels));
        pixels
    }

    fn kept_empty_regions(&self) -> MutexGuard<'_, HashMap<EmptyRegion, Arc<[Word]>>> {
        self.empty_regions.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A computation of a region's pixels that has not run yet. It holds all command lists that a region context (part of
/// pixel memory) has received since its last clear.
#[derive(Debug)]
pub(crate) struct PixelJob {
    pub(crate) pool: Arc<ArrayPool>,
    pub(crate) lists: Arc<Vec<CommandContent>>,
    /// True if the first command list overwrites the old content of the region in pixel memory.
    pub(crate) cleared: bool,
    /// True if two optimizations are on: commands that touch no pixel are left out, and regions without primitives are
    /// cached.
    pub(crate) saves: bool,
    pub(crate) target: CopyTarget,
    /// Data of each pixel that are sent: colour, or colour and depth.
    pub(crate) content: CopyContent,
    pub(crate) done: OnceLock<Arc<[Word]>>,
}

impl PixelJob {
    fn compute(&self) -> Arc<[Word]> {
        self.pool.with_idle_array(|ArrayAndWords { array, words }| {
            words.clear();
            let mut lists = self.lists.iter();
            // Collect words up to the first list that draws a primitive.
            if self.saves
                && !lists.any(|list| list.append_visible(words))
                && let Some(region) = self.as_empty_region(words)
            {
                return self.pool.empty_region(region, || self.draw(array, words, lists));
            }
            self.draw(array, words, lists)
        })
    }

    /// Returns the cache key of a region with the commands `words`. None of these commands may draw a primitive.
    ///
    /// Returns `None` if some words are not a command, or if the copy includes depths.
    fn as_empty_region(&self, words: &[Word]) -> Option<EmptyRegion> {
        let mut kept = Vec::new();
        let mut at = 0;
        while at < words.len() {
            let (command, length) = Command::decode(words, at, &self.pool.layout).ok()?;
            if !matches!(command, Command::CopyRegion(_)) {
                kept.extend_from_slice(&words[at..at + length]);
            }
            at += length;
        }
        let region = EmptyRegion { words: kept, cleared: self.cleared, size: self.size() };
        (self.content == CopyContent::Colour).then_some(region)
    }

    fn size(&self) -> [u32; 2] {
        let [_, _, width, height] = self.target.grid.rectangle(self.target.region);
        [width, height]
    }

    fn draw(&self, array: &mut Lanes, words: &mut Vec<Word>, lists: Iter<'_, CommandContent>) -> Arc<[Word]> {
        // If the context was not cleared, pixels without drawing are black.
        if !self.cleared {
            array.reset();
        }
        let mut copied = self.execute(array, words);
        // Only a copy command in the last list counts.
        for list in lists {
            copied = if self.saves {
                self.copied(array.draw(list, words))
            } else {
                words.clear();
                list.append_words(words);
                self.execute(array, words)
            };
        }
        // If the last list contains no copy command, read the colour directly.
        let [width, height] = self.size();
        let colours = copied.map_or_else(|| array.read_colour(width, height), |output| output.pixels);
        self.content.of(colours, || self.depths(array))
    }

    /// Executes a list of words, and returns the pixels that its last output instruction sends to the frame buffer of
    /// this job. An illegal instruction ends the list, as on the hardware. Pixels drawn before the illegal instruction
    /// stay.
    fn execute(&self, array: &mut Lanes, words: &[Word]) -> Option<OutputRegion> {
        self.copied(array.execute(words).map_or_else(|_| Vec::new(), |executed| executed.outputs))
    }

    fn copied(&self, outputs: Vec<OutputRegion>) -> Option<OutputRegion> {
        outputs.into_iter().rfind(|output| output.target == self.target)
    }

    /// Returns the depths of the region's pixels as 24-bit numbers, from 0 at the near plane to 2^24 - 1 at the far
    /// plane.
    ///
    /// A layout with a narrower Z does not store the low bits of the depth. In the result they are all 1 at the far
    /// plane, and 0 elsewhere.
    fn depths(&self, array: &Lanes) -> Vec<Word> {
        let [width, height] = self.size();
        let missing = Z_BITS - u32::from(self.pool.layout.plan().z.width);
        let farthest = (1 << (Z_BITS - missing)) - 1;
        let widened = |depth: &Word| if *depth == farthest { DEPTH_FARTHEST } else { depth << missing };
        array.read_depth(width, height).iter().map(widened).collect()
    }
}

impl PixelSource for PixelJob {
    fn pixels(&self) -> Arc<[Word]> {
        Arc::clone(self.done.get_or_init(|| self.compute()))
    }
}

const DEPTH_FARTHEST: Word = (1 << Z_BITS) - 1;

#[derive(Debug)]
pub(crate) struct NoPixels {
    pub(crate) words: u32,
}

impl PixelSource for NoPixels {
    fn pixels(&self) -> Arc<[Word]> {
        vec![0; self.words as usize].into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Clear, CopyRegion, SelectRegion};
    use pxpl5_wire::{CommandSink, CommandWords, PictureNumber};
    use pxpl5_wire::{Lines, NodeId, RegionGrid, RegionId};

    #[derive(Debug)]
    struct GivenWords(Vec<Word>);

    impl CommandWords for GivenWords {
        fn append_words(&self, _: u32, out: &mut Vec<Word>) {
            out.extend_from_slice(&self.0);
        }

        fn append_visible(&self, part: u32, out: &mut dyn CommandSink) -> bool {
            self.append_words(part, out.words());
            false
        }
    }

    /// Returns the pixels of region 3 after the region was cleared to `colour`. `picture` is the number of the picture.
    fn cleared(pool: &Arc<ArrayPool>, colour: Word, picture: u64) -> Arc<[Word]> {
        let target = CopyTarget {
            frame_buffer: NodeId(9),
            buffer: (picture % 2) as u8,
            picture: PictureNumber(picture),
            grid: RegionGrid::FRAME,
            region: RegionId(3),
            lines: Lines::Frame,
        };
        // Region 3 begins at column 384. The list selects it, clears it and copies it.
        let select = Command::SelectRegion(SelectRegion { context: 0, left: 384, top: 0 });
        let commands = [select, Command::Clear(Clear { colour }), Command::CopyRegion(CopyRegion { target })];
        let mut words = Vec::new();
        commands.iter().for_each(|command| command.encode(&pool.layout, &mut words).expect("it fits"));
        let lists = Arc::new(vec![CommandContent::new(Arc::new(GivenWords(words)), 0)]);
        PixelJob {
            pool: Arc::clone(pool),
            lists,
            cleared: true,
            saves: true,
            target,
            content: CopyContent::Colour,
            done: OnceLock::new(),
        }
        .pixels()
    }

    #[test]
    fn an_empty_region_is_drawn_once_for_each_background_colour() {
        let pool = ArrayPool::new(Layout::rendering_control_phong());
        let [first, second, other] = [(0x10_20_30, 4), (0x10_20_30, 5), (0x10_20_31, 6)]
            .map(|(colour, picture)| cleared(&pool, colour, picture));
        assert!(Arc::ptr_eq(&first, &second));
        assert!(first.iter().all(|pixel| *pixel == 0x10_20_30) && other.iter().all(|pixel| *pixel == 0x10_20_31));
    }
}
