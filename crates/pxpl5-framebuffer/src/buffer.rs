//! One of the two pixel buffers of a board. A buffer keeps the data of a region while a pixel of the region can be
//! seen.

use crate::region::RegionWrite;
use crate::scans::{Overwritten, Scans};
use pxpl5_sim::Span;
use pxpl5_wire::Video;
use pxpl5_wire::{CopyTarget, Lines, PeriodNumber};
use std::collections::BTreeMap;
use std::sync::Arc;

/// List of the regions in a buffer, the oldest first. Pictures ([`ScannedField`](crate::ScannedField),
/// [`BufferContents`](crate::BufferContents)) share it.
pub(crate) type Regions = Arc<[Arc<RegionWrite>]>;

/// Number of stored regions above which the buffer searches for regions that newer regions cover completely. The search
/// compares single pixels, so a search at every retrace would take too long.
const FEW: usize = 128;

#[derive(Clone, Debug)]
pub(crate) struct Buffer {
    held: Vec<StoredRegion>,
    /// The regions in `held` as a list that pictures can share. `None` after a change of `held`, until a picture needs
    /// the list.
    shared: Option<Regions>,
    search_above: usize,
    /// Indices in `held` of the regions that are still arriving. The list is short, because a port receives one region
    /// at a time.
    arriving: Vec<usize>,
    /// For each set of pixels, the index of the newest complete region that fills exactly this set. The region hides
    /// all older regions of the set. [`cut`] returns the key for a set.
    newest: BTreeMap<[u32; 6], usize>,
    scans: Scans,
}

#[derive(Clone, Debug)]
struct StoredRegion {
    region: Arc<RegionWrite>,
    hidden: bool,
}

impl Buffer {
    pub(crate) fn new() -> Self {
        Self {
            held: Vec::new(),
            shared: None,
            search_above: FEW,
            arriving: Vec::new(),
            newest: BTreeMap::new(),
            scans: Scans::default(),
        }
    }

    pub(crate) fn arriving(&mut self, target: &CopyTarget) -> Option<usize> {
        self.arriving.iter().rev().copied().find(|place| self.held[*place].region.target == *target)
    }

    pub(crate) fn add(&mut self, region: RegionWrite) -> usize {
        self.held.push(StoredRegion { region: Arc::new(region), hidden: false });
        self.arriving.push(self.held.len() - 1);
        self.held.len() - 1
    }

    pub(crate) fn region(&self, place: usize) -> &RegionWrite {
        &self.held[place].region
    }

    /// Returns the region with index `place` for modification. Earlier pictures of the buffer keep an unmodified copy.
    pub(crate) fn region_mut(&mut self, place: usize) -> &mut RegionWrite {
        self.shared = None;
        Arc::make_mut(&mut self.held[place].region)
    }

    pub(crate) fn scan(&mut self, field: PeriodNumber) {
        self.scans.begin(field);
    }

    /// Records that the region with index `place` is complete, so that it hides an older complete region in exactly the
    /// same pixels. Returns the index of the hidden region.
    pub(crate) fn hide_below(&mut self, place: usize) -> Option<usize> {
        self.arriving.retain(|other| *other != place);
        let newest = self.newest.entry(cut(&self.held[place].region.target)).or_insert(place);
        if *newest == place {
            return None;
        }
        // The region with the higher index is newer, even if the older region completes later.
        let older = place.min(*newest);
        self.held[older].hidden = true;
        *newest = place.max(*newest);
        (older != place).then_some(older)
    }

    /// Returns the number of lines that the beam had not shown completely when a newer region overwrote them. `older`
    /// and `newer` are the indices of the overwritten region and of the newer region, which fill the same pixels.
    pub(crate) fn lines_never_shown(&self, older: usize, newer: usize, video: &Video, word: Span) -> u64 {
        let [older, newer] = [older, newer].map(|place| self.region(place));
        self.scans.lines_never_shown(&Overwritten { older, newer, video, word })
    }

    /// Recomputes the lists `arriving` and `newest` after the removal of regions.
    fn index(&mut self) {
        self.arriving.clear();
        self.newest.clear();
        for (place, held) in self.held.iter().enumerate() {
            if held.region.is_complete() {
                self.newest.insert(cut(&held.region.target), place);
            } else {
                self.arriving.push(place);
            }
        }
    }

    /// Returns all regions, the oldest first. The list is reused until the buffer changes.
    pub(crate) fn share(&mut self) -> Regions {
        let held = &self.held;
        Arc::clone(self.shared.get_or_insert_with(|| regions_of(held)))
    }

    pub(crate) fn regions(&self) -> Regions {
        self.shared.clone().unwrap_or_else(|| regions_of(&self.held))
    }

    /// Removes regions that no later scan can show. `width` and `height` are the size of the frame in pixels.
    pub(crate) fn prune(&mut self, width: u32, height: u32) {
        if self.held.iter().any(|held| held.hidden) {
            self.held.retain(|held| !held.hidden);
            self.shared = None;
            self.index();
        }
        // The search by pixels is slow, so run it only after the arrival of many regions.
        if self.held.len() > self.search_above {
            self.discard_covered(width, height);
            self.search_above = FEW.max(2 * self.held.len());
        }
    }

    /// Removes regions whose pixels are all covered by newer regions. Single pixels are compared, because several
    /// regions with different borders can together cover one.
    ///
    /// A region that is still arriving is never covered: it is the newest, because a port receives one region at a
    /// time.
    fn discard_covered(&mut self, width: u32, height: u32) {
        // Mark the pixels of each region, from the newest region to the oldest.
        let mut covered = vec![false; (width * height) as usize];
        for held in self.held.iter_mut().rev() {
            held.hidden = true;
            for segment in held.region.segments(Span::ZERO) {
                let begin = (segment.y * width + segment.x) as usize;
                for pixel in &mut covered[begin..begin + segment.length as usize] {
                    held.hidden &= *pixel;
                    *pixel = true;
                }
            }
        }
        self.held.retain(|held| !held.hidden);
        self.shared = None;
        self.index();
    }
}

fn regions_of(held: &[StoredRegion]) -> Regions {
    held.iter().map(|held| Arc::clone(&held.region)).collect()
}

/// Returns a key that is equal for two regions exactly if they fill the same pixels of the frame. It consists of the
/// lines, the number and the grid of the region.
fn cut(target: &CopyTarget) -> [u32; 6] {
    let lines = match target.lines {
        Lines::Frame => 2,
        Lines::Field(parity) => parity.first_line(),
    };
    let grid = target.grid;
    [lines, u32::from(target.region.0), grid.width, grid.height, grid.region_width, grid.region_height]
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_sim::Time;
    use pxpl5_wire::{FieldParity, NodeId, PictureNumber, PixelSource, RegionGrid, RegionId, RegionPixels, Word};

    const SIZE: [u32; 2] = [640, 480];

    #[derive(Debug)]
    struct NoPixels;

    impl PixelSource for NoPixels {
        fn pixels(&self) -> Arc<[Word]> {
            Arc::new([])
        }
    }

    /// Returns the destination of a random region. The low bits of `random` select the lines and the grid, and the high
    /// bits select the region.
    fn target(picture: u64, random: u64) -> CopyTarget {
        let cut = |region_width, region_height| RegionGrid { width: 640, height: 240, region_width, region_height };
        let (lines, grid) = [
            (Lines::Frame, RegionGrid::FRAME),
            (Lines::Field(FieldParity::Even), RegionGrid::FIELD),
            (Lines::Field(FieldParity::Odd), cut(100, 67)),
            (Lines::Field(FieldParity::Even), cut(128, 9)),
        ][random as usize % 4];
        let region = RegionId((random >> 8) as u16 % grid.regions() as u16);
        let picture = PictureNumber(picture);
        CopyTarget { frame_buffer: NodeId(7), buffer: 0, lines, grid, region, picture }
    }

    /// Reference model of `segments`: writes the picture number of a region into all pixels of the region.
    fn paint(frame: &mut [u64], target: &CopyTarget) {
        let [left, top, width, height] = target.grid.rectangle(target.region);
        for row in top..top + height {
            let y = match target.lines {
                Lines::Frame => row,
                Lines::Field(FieldParity::Even) => 2 * row,
                Lines::Field(FieldParity::Odd) => 2 * row + 1,
            };
            frame[(y * SIZE[0] + left) as usize..][..width as usize].fill(target.picture.0);
        }
    }

    fn painted<'a>(regions: impl Iterator<Item = &'a RegionWrite>) -> Vec<u64> {
        let mut frame = vec![0; (SIZE[0] * SIZE[1]) as usize];
        regions.for_each(|region| paint(&mut frame, &region.target));
        frame
    }

    /// Tests that the buffer discards exactly those regions whose pixels later regions have all overwritten. The number
    /// of regions in the buffer must stay limited.
    #[test]
    fn exactly_the_regions_covered_by_later_regions_are_discarded() {
        let video = crate::FrameBufferConfig::NTSC.video.video().expect("valid");
        let mut buffer = Buffer::new();
        let mut frame = vec![0; (SIZE[0] * SIZE[1]) as usize];
        let mut random = 0x9E37_79B9_7F4A_7C15_u64;
        let mut searches = 0;
        for picture in 1..=1500 {
            random = random.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
            let target = target(picture, random >> 33);
            let [_, _, width, height] = target.grid.rectangle(target.region);
            let parts = (width * height).div_ceil(pxpl5_wire::MAX_MESSAGE_WORDS);
            let pixels = RegionPixels { target, image: Arc::new(NoPixels), part: 0, parts };
            let place = buffer.add(RegionWrite::new(&pixels, &video).expect("within the frame"));
            for part in 0..parts {
                buffer.region_mut(place).arrive(part, Time(picture));
            }
            buffer.hide_below(place);
            paint(&mut frame, &target);
            let before = buffer.held.iter().filter(|held| !held.hidden).count();
            buffer.prune(SIZE[0], SIZE[1]);
            assert_eq!(painted(buffer.regions().iter().map(|region| &**region)), frame, "{picture}");
            if buffer.held.len() < before {
                searches += 1;
                let seen: std::collections::BTreeSet<u64> = frame.iter().copied().collect();
                for held in &buffer.held {
                    assert!(
                        seen.contains(&held.region.target.picture.0),
                        "{picture}: nothing is seen of {:?}",
                        held.region.target
                    );
                }
            }
            assert!(buffer.held.len() <= 2 * FEW, "{picture}");
        }
        assert!(searches > 1);
    }
}
