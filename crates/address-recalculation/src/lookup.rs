//! The fast model of pixel computation, which processes groups of pixels and gives the same bits as the reference
//! model.
//!
//! A picture reads each texel several times, so its depths in all memories are compared only once, when a pixel first
//! needs it ([`Composed`]). Addresses and weights are computed for groups of pixels ([`crate::batch`]).
//!
//! Two cases go pixel by pixel to the address unit: words that are too wide for exact doubles, and pixels whose four
//! texels do not lie on one face.

use crate::address::{AddressUnit, Footprint};
use crate::batch::{BATCH, Batch, addresses, mixed};
use crate::composition::{Composition, CompositionOrder, Gathered, nearer, shown};
use crate::config::ArpConfig;
use crate::face::TexelAddress;
use crate::lens::LensTable;
use crate::orientation::MatrixWords;
use crate::texel::{FaceSet, nearness};
use multiversion::multiversion;
use std::cell::Cell;

/// Counts of extra memory accesses for a picture, beyond one access per pixel and memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LookupStats {
    /// Number of pixels whose footprint (its four texels) extends beyond one face.
    pub split: u64,
    /// Number of pixels whose footprint (its four texels) has two texels in one bank and therefore needs a second
    /// access.
    pub conflicts: u64,
}

impl LookupStats {
    pub const fn add(&mut self, other: Self) {
        self.split += other.split;
        self.conflicts += other.conflicts;
    }

    fn count(&mut self, footprint: &Footprint) {
        self.split += u64::from(footprint.is_split);
        self.conflicts += u64::from(footprint.has_conflict());
    }
}

/// Smallest number of pixels that are computed as a group. Fewer pixels are computed one by one.
const MIN_GROUP_PIXELS: usize = 4;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Addressing<'a> {
    table: &'a LensTable,
    unit: AddressUnit,
    /// True if doubles represent all intermediate values exactly for the word lengths of this display.
    is_exact: bool,
}

impl<'a> Addressing<'a> {
    pub(crate) fn new(config: &ArpConfig, table: &'a LensTable) -> Self {
        let timing = &config.timing;
        let is_exact = timing.vector_bits + timing.matrix_bits + timing.quotient_bits <= 53
            && timing.face_texels << timing.quotient_bits <= 1 << 30;
        Self { table, unit: AddressUnit::new(timing), is_exact }
    }

    fn footprint(&self, vector: [i32; 3], matrix: &MatrixWords) -> Option<Footprint> {
        self.unit.footprint(matrix.turn(vector))
    }

    /// Computes the footprints (the four texels and their weights) of up to [`BATCH`] pixels together, and returns
    /// true.
    ///
    /// Returns false and computes nothing if the words have too many bits for exact results in doubles, or if there are
    /// so few pixels that one by one is faster.
    fn fill(&self, batch: &mut Batch, vectors: [&[i32]; 3], matrix: &MatrixWords) -> bool {
        let is_worth_it = self.is_exact && vectors[0].len() >= MIN_GROUP_PIXELS;
        if is_worth_it {
            addresses(batch, &self.unit, vectors, matrix);
        }
        is_worth_it
    }

    /// Marks the regions of 128 x 128 texels that consecutive pixels read, in the order of [`crate::region_grid`].
    pub(crate) fn mark(&self, first: usize, count: usize, matrix: &MatrixWords, touched: &mut [bool]) {
        let vectors = self.table.run(first, count);
        let mut batch = Batch::new();
        for start in (0..count).step_by(BATCH) {
            let here = start..(start + BATCH).min(count);
            let vectors = vectors.map(|axis| &axis[here.clone()]);
            // Footprints that lie inside a face are computed in groups.
            let is_filled = self.fill(&mut batch, vectors, matrix);
            if is_filled {
                batch.inside().for_each(|index| self.mark_square(index, touched));
            }
            // Compute all other footprints one by one.
            for i in (0..here.len()).filter(|i| !is_filled || batch.leaves(*i)) {
                self.mark_footprint(vectors.map(|axis| axis[i]), matrix, touched);
            }
        }
    }

    fn mark_square(&self, first: u32, touched: &mut [bool]) {
        let size = self.unit.geometry.texels;
        let far = u32::from(self.unit.weight_bits > 0);
        let row = first / size;
        let column = first % size;
        for (down, right) in [(0, 0), (0, far), (far, 0), (far, far)] {
            touched[((row + down) / 128 * (size / 128) + (column + right) / 128) as usize] = true;
        }
    }

    fn mark_footprint(&self, vector: [i32; 3], matrix: &MatrixWords, touched: &mut [bool]) {
        let size = self.unit.geometry.texels;
        for texel in self.footprint(vector, matrix).iter().flat_map(|footprint| footprint.texels).flatten() {
            let row = texel.face as u32 * size + texel.row;
            touched[(row / 128 * (size / 128) + texel.column / 128) as usize] = true;
        }
    }
}

/// The fast model, which computes pixels from the visible buffers of all display memories.
#[derive(Clone, Debug)]
pub struct Lookup<'a> {
    addressing: Addressing<'a>,
    composition: Composition,
    memories: Vec<&'a FaceSet>,
    background: Option<&'a FaceSet>,
    composed: Composed,
    batch: Batch,
}

impl<'a> Lookup<'a> {
    /// Creates a lookup of pixels in the visible faces of all display memories, and of the background memory if there
    /// is one.
    ///
    /// # Panics
    ///
    /// Panics if faces do not have the size of the configuration.
    pub fn new(
        config: &ArpConfig,
        table: &'a LensTable,
        memories: Vec<&'a FaceSet>,
        background: Option<&'a FaceSet>,
    ) -> Self {
        let texels = config.timing.face_texels as u32;
        assert!(memories.iter().chain(&background).all(|faces| faces.texels() == texels), "faces of {texels} texels");
        let addressing = Addressing::new(config, table);
        Self {
            addressing,
            composition: config.composition(),
            memories,
            background,
            composed: Composed::spare(texels),
            batch: Batch::new(),
        }
    }

    /// Computes consecutive pixels, in row order, for one orientation. Colours are 0x00RRGGBB.
    ///
    /// # Panics
    ///
    /// Panics if the pixels exceed the table of viewing vectors.
    pub fn run(&mut self, first: usize, matrix: &MatrixWords, out: &mut [u32]) -> LookupStats {
        let mut stats = LookupStats::default();
        let vectors = self.addressing.table.run(first, out.len());
        for (group, pixels) in out.chunks_mut(BATCH).enumerate() {
            let here = group * BATCH..group * BATCH + pixels.len();
            let vectors = vectors.map(|axis| &axis[here.clone()]);
            stats.add(self.group(vectors, matrix, pixels));
        }
        stats
    }

    /// Finds for each pixel the memory whose colour is shown. Only the texel with the largest weight among the pixel's
    /// four texels is examined. A pixel gets `None` if all memories are empty at this texel.
    ///
    /// # Panics
    ///
    /// Panics in the same cases as [`Lookup::run`].
    pub fn winners(&self, first: usize, matrix: &MatrixWords, out: &mut [Option<u8>]) {
        let vectors = self.addressing.table.run(first, out.len());
        for (i, winner) in out.iter_mut().enumerate() {
            let footprint = self.addressing.footprint(vectors.map(|axis| axis[i]), matrix);
            *winner = footprint.and_then(|footprint| self.winner(&footprint));
        }
    }

    fn winner(&self, footprint: &Footprint) -> Option<u8> {
        let weights = footprint.weights(self.addressing.unit.weight_bits);
        let present = (0..4).rev().filter(|k| footprint.texels[*k].is_some());
        let texel = footprint.texels[present.max_by_key(|k| weights[*k])?]?;
        let index = texel.index(self.addressing.unit.geometry.texels);
        let near = self.memories.iter().map(|faces| nearness(faces.words()[index]));
        let nearest = (0_u8..).zip(near).filter(|(_, near)| *near > 0).max_by_key(|(k, near)| (*near, !k))?;
        Some(nearest.0)
    }

    fn group(&mut self, vectors: [&[i32]; 3], matrix: &MatrixWords, out: &mut [u32]) -> LookupStats {
        let mut stats = LookupStats::default();
        let is_filled = self.composition.order == CompositionOrder::DepthFirst
            && self.addressing.fill(&mut self.batch, vectors, matrix);
        // Compute footprints that lie inside a face in groups.
        if is_filled {
            self.pixels(out);
            if !self.batch.is_left() {
                return stats;
            }
        }
        // Compute the remaining pixels one by one.
        for (i, pixel) in out.iter_mut().enumerate().filter(|(i, _)| !is_filled || self.batch.leaves(*i)) {
            let footprint = self.addressing.footprint(vectors.map(|axis| axis[i]), matrix);
            *pixel = footprint.map_or(self.composition.background, |footprint| {
                stats.count(&footprint);
                self.pixel(&footprint)
            });
        }
        stats
    }

    fn pixel(&self, footprint: &Footprint) -> u32 {
        let words = |faces: &FaceSet| footprint.texels.map(|texel| texel.map_or(0, |texel| word(faces, texel)));
        let memories: Vec<[u64; 4]> = self.memories.iter().map(|faces| words(faces)).collect();
        let behind = self.background.map_or([0; 4], words).map(|word| shown(word, self.composition.background));
        let weights = footprint.weights(self.addressing.unit.weight_bits);
        let weights = [0, 1, 2, 3].map(|k| footprint.texels[k].map(|_| weights[k]));
        self.composition.pixel(&Gathered { memories: &memories, behind, weights })
    }

    fn pixels(&mut self, out: &mut [u32]) {
        let unit = self.addressing.unit;
        let reach = if unit.weight_bits == 0 { 0 } else { unit.geometry.texels as usize };
        let mut last = [usize::MAX; 2];
        for i in 0..self.batch.count {
            let first = self.batch.index[i] as usize;
            // Compose the pieces that contain the upper and the lower row, if not done yet.
            let pieces = [first / PIECE, (first + reach) / PIECE];
            if pieces != last {
                last = pieces;
                pieces.into_iter().for_each(|piece| self.compose(piece));
            }
        }
        mixed(&self.composed.colours, &self.batch, reach, unit.weight_bits as u32, out);
    }

    /// Selects the nearest memory for each texel of a group of [`PIECE`] texels, unless an earlier call has done so.
    fn compose(&mut self, piece: usize) {
        if std::mem::replace(&mut self.composed.is_done[piece], true) {
            return;
        }
        let behind = self.background.map(FaceSet::words);
        let start = piece * PIECE;
        let colours = &mut self.composed.colours;
        let end = (start + PIECE + 1).min(colours.len());
        compose(&mut colours[start..end], &self.memories, behind, self.composition.background, start);
    }
}

/// Number of consecutive texels for which the nearest memory is selected in one step. The number is a divisor of 128.
const PIECE: usize = 32;

/// Colour of each texel, taken from the display memory in which the texel has the smallest depth. The colour is
/// computed when a pixel first needs it.
///
/// Neighbouring pixels share texels, so the depths of a texel are compared once instead of once per reading pixel.
#[derive(Clone, Debug)]
struct Composed {
    colours: Vec<u32>,
    /// Flag of each group of [`PIECE`] texels: true if all texels of the group and the following texel are computed.
    is_done: Vec<bool>,
}

impl Composed {
    fn new(texels: u32) -> Self {
        let all = 6 * (texels * texels) as usize;
        Self { colours: vec![0; all], is_done: vec![false; all.div_ceil(PIECE)] }
    }

    /// Returns the buffer of this thread's previous lookup, or a new buffer if the size differs. Reuse avoids new page
    /// faults on the host.
    fn spare(texels: u32) -> Self {
        let all = 6 * (texels * texels) as usize;
        match SPARE.take().filter(|spare| spare.colours.len() == all) {
            Some(mut spare) => {
                spare.is_done.fill(false);
                spare
            }
            None => Self::new(texels),
        }
    }
}

thread_local! {
    /// Buffer kept for the next lookup: 4 bytes per texel, 6 MB for faces of 512 texels.
    static SPARE: Cell<Option<Composed>> = const { Cell::new(None) };
}

impl Drop for Lookup<'_> {
    fn drop(&mut self) {
        let left = Composed {
            colours: std::mem::take(&mut self.composed.colours),
            is_done: std::mem::take(&mut self.composed.is_done),
        };
        // The thread-local variable is unavailable only while the thread ends. Then the buffer is dropped.
        let _ = SPARE.try_with(|spare| spare.set(Some(left)));
    }
}

/// Computes the colours of a group of texels and of the following texel. Each colour comes from the nearest memory, or
/// from the background if all memories are empty.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn compose(out: &mut [u32], memories: &[&FaceSet], behind: Option<&[u64]>, background: u32, start: usize) {
    let piece = |words: &[u64]| words[start..].first_chunk::<PIECE>().copied().unwrap_or([0; PIECE]);
    let mut best = [0; PIECE];
    // Select the nearest texel of all memories.
    for faces in memories {
        let words = piece(faces.words());
        for (best, word) in best.iter_mut().zip(&words) {
            *best = nearer(*best, *word);
        }
    }
    // Empty texels show the background.
    let far = behind.map_or([0; PIECE], piece);
    for ((out, best), far) in out.iter_mut().zip(&best).zip(&far) {
        *out = shown(*best, shown(*far, background));
    }
    // The last footprint of a piece also reads the following texel.
    if let Some(after) = out.get_mut(PIECE) {
        let at = |words: &[u64]| words[start + PIECE];
        let nearest = memories.iter().fold(0, |best, faces| nearer(best, at(faces.words())));
        *after = shown(nearest, shown(behind.map_or(0, at), background));
    }
}

fn word(faces: &FaceSet, texel: TexelAddress) -> u64 {
    faces.words()[texel.index(faces.texels())]
}
