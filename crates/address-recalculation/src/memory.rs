//! A display memory: two buffers of six faces, of which one is visible. Only complete updates become visible.

use crate::face::{CubeFace, TexelAddress};
use crate::protocol::region_grid;
use crate::texel::{FaceSet, TexelFormat};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Lines, PixelSource, REGION_SIZE, RegionPixels, Word};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, OnceLock};

const REGION_TEXELS: usize = (REGION_SIZE * REGION_SIZE) as usize;

const MESSAGE_WORDS: u32 = 1_024;

/// A region that has arrived. Its texels are computed only when the region is read.
#[derive(Debug)]
pub(crate) struct StoredRegion {
    source: Arc<dyn PixelSource>,
    words: OnceLock<Arc<[Word]>>,
}

/// The regions of a buffer that have arrived in the current update. All other regions are empty.
pub(crate) type Regions = BTreeMap<u16, Arc<StoredRegion>>;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct MemoryKind {
    pub(crate) face_texels: u32,
    pub(crate) format: TexelFormat,
    /// True if the memory stores depth. The background memory stores no depth, because it lies behind all other
    /// memories and is visible at empty texels.
    pub(crate) has_depth: bool,
}

impl MemoryKind {
    /// Returns the number of messages per region: 16 for colours, and 16 more if depths need their own words.
    fn parts(self) -> u32 {
        let words = if self.has_depth { self.format.words() } else { 1 };
        words * REGION_TEXELS as u32 / MESSAGE_WORDS
    }

    /// Computes the texels of a buffer's regions and writes them into `faces`. `wanted` is true for each region to
    /// write.
    pub(crate) fn draw(self, regions: &Regions, wanted: &[bool], faces: &mut FaceSet) {
        for (number, region) in regions.iter().filter(|(number, _)| wanted[usize::from(**number)]) {
            let words = region.words.get_or_init(|| region.source.pixels());
            let across = u32::from(*number) % (self.face_texels / REGION_SIZE);
            let top = u32::from(*number) / (self.face_texels / REGION_SIZE) * REGION_SIZE;
            let face = CubeFace::ALL[(top / self.face_texels) as usize];
            for (row, line) in (0..REGION_SIZE).zip(0_usize..) {
                let first = TexelAddress { face, column: across * REGION_SIZE, row: top % self.face_texels + row };
                self.draw_row(words, line * REGION_SIZE as usize, first, faces);
            }
        }
    }

    /// Writes one row of a region. Texels for which the source has no words stay empty.
    fn draw_row(self, words: &[Word], start: usize, first: TexelAddress, faces: &mut FaceSet) {
        let row = start..start + REGION_SIZE as usize;
        let Some(low) = words.get(row.clone()) else { return };
        // The background memory has no depths.
        if !self.has_depth {
            return faces.set_row(first, low, std::iter::repeat(0));
        }
        // Colour and depth share a word: colour in the lower half.
        if self.format.words() == 1 {
            let colours: Vec<u32> = low.iter().map(|word| crate::texel::widened(word & 0xFFFF)).collect();
            return faces.set_row(first, &colours, low.iter().map(|word| *word >> 16 << 8));
        }
        let Some(depths) = words.get(REGION_TEXELS + row.start..REGION_TEXELS + row.end) else { return };
        faces.set_row(first, low, depths.iter().copied());
    }
}

#[derive(Clone, Debug)]
struct Arriving {
    pixels: RegionPixels,
    parts: BTreeSet<u32>,
    first_part_at: Time,
}

#[derive(Clone, Debug, Default)]
struct Buffer {
    /// Regions that an update announced and that are not yet complete.
    missing: BTreeSet<u16>,
    arriving: BTreeMap<u16, Arriving>,
    valid: Arc<Regions>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct SwapRequest {
    asked_at: Time,
    buffer: u8,
    /// Bit mask of the memories that must swap at the same retrace. The mask is 0 if this memory swaps alone.
    together: u8,
}

/// Counts of the regions, updates and delays of a display memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct MemoryStats {
    /// Number of complete regions that arrived.
    pub regions: u64,
    /// Number of updates that were shown.
    pub swaps: u64,
    /// Number of retraces at which a requested update was incomplete and the previous update stayed visible.
    pub missed: u64,
    /// Total delay of late updates. Each delay lasts from the first missed retrace to the retrace at which the update
    /// is shown.
    pub lateness: Span,
}

/// A display memory: the six faces of a cube with depth, in two buffers.
///
/// An update begins with a map of the regions that will arrive. The update becomes visible at the first requested
/// retrace at which all regions are present.
#[derive(Clone, Debug)]
pub struct DisplayMemory {
    kind: MemoryKind,
    buffers: [Buffer; 2],
    shown: u8,
    request: Option<SwapRequest>,
    late_since: Option<Time>,
    stats: MemoryStats,
}

pub(crate) enum PixelReceipt {
    /// The message completed a region. The value is the time at which the region's first message arrived.
    Region(Time),
    /// The message belongs to a region that is still incomplete.
    Part,
}

impl DisplayMemory {
    pub(crate) fn new(kind: MemoryKind) -> Self {
        let stats = MemoryStats::default();
        Self { kind, buffers: Default::default(), shown: 0, request: None, late_since: None, stats }
    }

    pub const fn stats(&self) -> &MemoryStats {
        &self.stats
    }

    /// Returns the index of the visible buffer, 0 or 1.
    pub const fn shown_buffer(&self) -> u8 {
        self.shown
    }

    /// Returns the size of both buffers together, in bytes.
    pub fn bytes(&self) -> u64 {
        let depth = if self.kind.has_depth { self.kind.format.depth_bits } else { 0 };
        let bits = u64::from(self.kind.format.colour_bits + depth);
        2 * 6 * u64::from(self.kind.face_texels).pow(2) * bits / 8
    }

    /// Returns the six visible faces, with the texels of all regions computed.
    pub fn shown_faces(&self) -> FaceSet {
        let wanted = vec![true; region_grid(self.kind.face_texels).regions() as usize];
        let mut faces = FaceSet::new(self.kind.face_texels, self.kind.format);
        self.kind.draw(&self.shown(), &wanted, &mut faces);
        faces
    }

    pub(crate) const fn kind(&self) -> MemoryKind {
        self.kind
    }

    pub(crate) fn shown(&self) -> Arc<Regions> {
        Arc::clone(&self.buffers[usize::from(self.shown)].valid)
    }

    /// Begins an update of a buffer. Each region of the buffer is empty until the region arrives.
    pub(crate) fn begin(&mut self, buffer: u8, regions: Vec<u16>) -> Result<(), &'static str> {
        if buffer == self.shown {
            return Err("an update of the buffer that is shown");
        }
        self.request = None;
        self.late_since = None;
        self.buffers[usize::from(buffer)] = Buffer { missing: regions.into_iter().collect(), ..Buffer::default() };
        Ok(())
    }

    /// Requests to show a buffer. The buffer becomes visible at the first retrace after `now` at which all its regions
    /// are complete.
    pub(crate) fn ask(&mut self, buffer: u8, together: u8, now: Time) {
        self.request = Some(SwapRequest { asked_at: now, buffer, together });
    }

    pub(crate) fn receive(&mut self, pixels: RegionPixels, now: Time) -> Result<PixelReceipt, &'static str> {
        let target = pixels.target;
        let region = target.region.0;
        // Refuse messages that do not belong to an announced region.
        if target.grid != region_grid(self.kind.face_texels) || target.lines != Lines::Frame {
            return Err("pixels that are not of six faces of this size");
        }
        if target.buffer == self.shown {
            return Err("pixels for the buffer that is shown");
        }
        if pixels.parts != self.kind.parts() || pixels.part >= pixels.parts {
            return Err("a region in another number of messages than colour and depth take");
        }
        let buffer = self.buffers.get_mut(usize::from(target.buffer)).ok_or("pixels for a third buffer")?;
        if !buffer.missing.contains(&region) {
            return Err("a region that no map announced");
        }
        // Collect the parts of the region. A new target replaces an incomplete region.
        let fresh = Arriving { pixels, parts: BTreeSet::new(), first_part_at: now };
        let part = fresh.pixels.part;
        let arriving = buffer.arriving.entry(region).or_insert_with(|| fresh.clone());
        if arriving.pixels.target != fresh.pixels.target {
            *arriving = fresh;
        }
        if !arriving.parts.insert(part) {
            return Err("a message twice");
        }
        if arriving.parts.len() < arriving.pixels.parts as usize {
            return Ok(PixelReceipt::Part);
        }
        Ok(PixelReceipt::Region(self.complete(target.buffer, region)))
    }

    fn complete(&mut self, buffer: u8, region: u16) -> Time {
        let buffer = &mut self.buffers[usize::from(buffer)];
        buffer.missing.remove(&region);
        self.stats.regions += 1;
        let Some(arriving) = buffer.arriving.remove(&region) else { return Time::ZERO };
        let stored = StoredRegion { source: arriving.pixels.image, words: OnceLock::new() };
        Arc::make_mut(&mut buffer.valid).insert(region, Arc::new(stored));
        arriving.first_part_at
    }

    /// Returns `None` if this memory cannot swap at a retrace at `now`, because no request precedes the retrace or the
    /// requested update is incomplete. Otherwise returns the bit mask of the memories that must swap at the same
    /// retrace, or 0 if this memory swaps alone.
    pub(crate) fn is_ready(&self, now: Time) -> Option<u8> {
        let request = self.request.filter(|request| request.asked_at < now)?;
        self.buffers[usize::from(request.buffer)].missing.is_empty().then_some(request.together)
    }

    /// Shows the requested buffer at a retrace if `may_swap` is true, and returns this buffer. Otherwise, the function
    /// counts a missed retrace if the request came before this retrace.
    pub(crate) fn retrace(&mut self, may_swap: bool, now: Time) -> Option<u8> {
        let request = self.request.filter(|request| request.asked_at < now)?;
        // Remember since when the update is late.
        if !may_swap {
            self.stats.missed += 1;
            self.late_since.get_or_insert(now);
            return None;
        }
        self.request = None;
        self.stats.swaps += 1;
        // Count the delay of a late update.
        if let Some(since) = self.late_since.take() {
            self.stats.lateness += now.since(since);
        }
        self.shown = request.buffer;
        Some(request.buffer)
    }
}
