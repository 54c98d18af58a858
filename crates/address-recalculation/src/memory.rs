//! A display memory: two buffers of six faces, of which one is shown, and whole updates alone.

use crate::face::{CubeFace, TexelAddress};
use crate::protocol::region_grid;
use crate::texel::{FaceSet, TexelFormat};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Lines, PixelSource, REGION_SIZE, RegionPixels, Word};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, OnceLock};

/// Texels of a region.
const REGION_TEXELS: usize = (REGION_SIZE * REGION_SIZE) as usize;

/// Words of a message of pixels.
const MESSAGE_WORDS: u32 = 1_024;

/// A region as it came, computed when somebody looks.
#[derive(Debug)]
pub(crate) struct StoredRegion {
    source: Arc<dyn PixelSource>,
    words: OnceLock<Arc<[Word]>>,
}

/// The valid regions of a buffer; all others are empty.
pub(crate) type Regions = BTreeMap<u16, Arc<StoredRegion>>;

/// What a memory is like: its faces, its texels, and whether it keeps depths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct MemoryKind {
    pub(crate) face_texels: u32,
    pub(crate) format: TexelFormat,
    /// Not the background memory: all its texels are nearer than nothing and farther than everything.
    pub(crate) has_depth: bool,
}

impl MemoryKind {
    /// Messages of a region: 16 of colours, 16 more of depths where they need words of their own.
    fn parts(self) -> u32 {
        let words = if self.has_depth { self.format.words() } else { 1 };
        words * REGION_TEXELS as u32 / MESSAGE_WORDS
    }

    /// Writes some regions of a buffer into faces.
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

    /// One row of a region; what a source is short of stays empty.
    fn draw_row(self, words: &[Word], start: usize, first: TexelAddress, faces: &mut FaceSet) {
        let row = start..start + REGION_SIZE as usize;
        let Some(low) = words.get(row.clone()) else { return };
        if !self.has_depth {
            return faces.set_row(first, low, std::iter::repeat(0));
        }
        if self.format.words() == 1 {
            let colours: Vec<u32> = low.iter().map(|word| crate::texel::widened(word & 0xFFFF)).collect();
            return faces.set_row(first, &colours, low.iter().map(|word| *word >> 16 << 8));
        }
        let Some(depths) = words.get(REGION_TEXELS + row.start..REGION_TEXELS + row.end) else { return };
        faces.set_row(first, low, depths.iter().copied());
    }
}

/// A region of which some messages have arrived.
#[derive(Clone, Debug)]
struct Arriving {
    pixels: RegionPixels,
    parts: BTreeSet<u32>,
    first_part_at: Time,
}

#[derive(Clone, Debug, Default)]
struct Buffer {
    /// Announced and not yet complete.
    missing: BTreeSet<u16>,
    arriving: BTreeMap<u16, Arriving>,
    valid: Arc<Regions>,
}

/// A request to show a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct SwapRequest {
    asked_at: Time,
    buffer: u8,
    /// Memories that must swap at the same retrace, bit by bit; none for this one alone.
    together: u8,
}

/// What a display memory has counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct MemoryStats {
    /// Regions that arrived whole.
    pub regions: u64,
    /// Updates that were shown.
    pub swaps: u64,
    /// Retraces at which an update that had been asked for was not whole, so that the one before stayed.
    pub missed: u64,
    /// How late those updates were that came too late: from the first retrace that each missed to the one that showed it.
    pub lateness: Span,
}

/// A double-buffered cube of faces with depth.
///
/// An update begins with a map of the regions that come; it is shown from a retrace on that finds all of them there, and
/// never before.
#[derive(Clone, Debug)]
pub struct DisplayMemory {
    kind: MemoryKind,
    buffers: [Buffer; 2],
    shown: u8,
    request: Option<SwapRequest>,
    late_since: Option<Time>,
    stats: MemoryStats,
}

/// What a message of pixels was to a memory.
pub(crate) enum PixelReceipt {
    /// The last one of a region, the first of which came at this time.
    Region(Time),
    /// Another one of a region.
    Part,
}

impl DisplayMemory {
    pub(crate) fn new(kind: MemoryKind) -> Self {
        let stats = MemoryStats::default();
        Self { kind, buffers: Default::default(), shown: 0, request: None, late_since: None, stats }
    }

    /// What it has counted.
    #[must_use]
    pub const fn stats(&self) -> &MemoryStats {
        &self.stats
    }

    /// The buffer that is shown, 0 or 1.
    #[must_use]
    pub const fn shown_buffer(&self) -> u8 {
        self.shown
    }

    /// Bytes of both buffers.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let depth = if self.kind.has_depth { self.kind.format.depth_bits } else { 0 };
        let bits = u64::from(self.kind.format.colour_bits + depth);
        2 * 6 * u64::from(self.kind.face_texels).pow(2) * bits / 8
    }

    /// The six faces that are shown now, all their regions computed.
    #[must_use]
    pub fn shown_faces(&self) -> FaceSet {
        let wanted = vec![true; region_grid(self.kind.face_texels).regions() as usize];
        let mut faces = FaceSet::new(self.kind.face_texels, self.kind.format);
        self.kind.draw(&self.shown(), &wanted, &mut faces);
        faces
    }

    pub(crate) const fn kind(&self) -> MemoryKind {
        self.kind
    }

    /// The regions that are shown now.
    pub(crate) fn shown(&self) -> Arc<Regions> {
        Arc::clone(&self.buffers[usize::from(self.shown)].valid)
    }

    /// Begins an update: all regions of the buffer are empty until they come.
    pub(crate) fn begin(&mut self, buffer: u8, regions: Vec<u16>) -> Result<(), &'static str> {
        if buffer == self.shown {
            return Err("an update of the buffer that is shown");
        }
        self.request = None;
        self.late_since = None;
        self.buffers[usize::from(buffer)] = Buffer { missing: regions.into_iter().collect(), ..Buffer::default() };
        Ok(())
    }

    /// Asks for a buffer from the next retrace on that finds it whole.
    pub(crate) fn ask(&mut self, buffer: u8, together: u8, now: Time) {
        self.request = Some(SwapRequest { asked_at: now, buffer, together });
    }

    /// Takes a message of pixels.
    pub(crate) fn receive(&mut self, pixels: RegionPixels, now: Time) -> Result<PixelReceipt, &'static str> {
        let target = pixels.target;
        let region = target.region.0;
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

    /// At a retrace: the memories that must swap with this one, if it has been asked before this instant and is whole.
    pub(crate) fn is_ready(&self, now: Time) -> Option<u8> {
        let request = self.request.filter(|request| request.asked_at < now)?;
        self.buffers[usize::from(request.buffer)].missing.is_empty().then_some(request.together)
    }

    /// At a retrace: shows the buffer that was asked for, if this memory may; which.
    pub(crate) fn retrace(&mut self, may_swap: bool, now: Time) -> Option<u8> {
        let request = self.request.filter(|request| request.asked_at < now)?;
        if !may_swap {
            self.stats.missed += 1;
            self.late_since.get_or_insert(now);
            return None;
        }
        self.request = None;
        self.stats.swaps += 1;
        if let Some(since) = self.late_since.take() {
            self.stats.lateness += now.since(since);
        }
        self.shown = request.buffer;
        Some(request.buffer)
    }
}
