//! The fast path: runs of pixels looked up together, equal to the hardware's words in every bit.
//!
//! Depths are compared texel by texel and once ([`Composed`]), in pieces of a row, when the first pixel asks: a picture reads each
//! texel several times.
//!
//! Directions are sums of three products below 2^53, so doubles hold them exactly. A quotient needs no correction: it is a
//! multiple of 1/(2F) with F below 2^(v + m - 1), v and m being the bits of vector and matrix, and less than 2^q; a double near
//! it is at most 2^(q - 54) wrong. With v + m + q <= 53 that is less than 1/(2F), so rounding never reaches the next whole number.
//! Wider words, and footprints that leave their face, go one by one through the address unit.

use crate::address::{AddressUnit, Footprint};
use crate::composition::{Composition, CompositionOrder, Gathered, nearer, shown};
use crate::config::ArpConfig;
use crate::face::TexelAddress;
use crate::lens::LensTable;
use crate::orientation::MatrixWords;
use crate::texel::{FaceSet, nearness};
use multiversion::multiversion;

/// Pixels that are looked up together: the doubles in a vector of the widest unit.
const LANES: usize = 8;

type Each<T> = [T; LANES];

/// What a look cost besides one access a pixel and memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LookStats {
    /// Footprints with a texel on another face.
    pub split: u64,
    /// Footprints with two texels in one bank: a second access.
    pub conflicts: u64,
}

impl LookStats {
    /// Adds those of another look.
    pub const fn add(&mut self, other: Self) {
        self.split += other.split;
        self.conflicts += other.conflicts;
    }

    fn count(&mut self, footprint: &Footprint) {
        self.split += u64::from(footprint.is_split);
        self.conflicts += u64::from(footprint.has_conflict());
    }
}

/// Which texels pixels read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Addressing<'a> {
    table: &'a LensTable,
    unit: AddressUnit,
    /// Whether doubles are exact for these words.
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

    /// The footprints of up to eight pixels; `None` if one of them leaves its face, or its words are too wide.
    fn lanes(&self, vectors: [&[i32]; 3], matrix: &MatrixWords) -> Option<Addresses> {
        if !self.is_exact {
            return None;
        }
        let lanes = addresses(&self.unit, &vectors.map(filled), matrix);
        lanes.is_inside.then_some(lanes)
    }

    /// Marks the pieces of 128 x 128 texels that a run of pixels reads, in the order of [`crate::region_grid`].
    pub(crate) fn mark(&self, first: usize, count: usize, matrix: &MatrixWords, touched: &mut [bool]) {
        let vectors = self.table.run(first, count);
        for start in (0..count).step_by(LANES) {
            let here = start..(start + LANES).min(count);
            let vectors = vectors.map(|axis| &axis[here.clone()]);
            match self.lanes(vectors, matrix) {
                Some(lanes) => lanes.index.iter().for_each(|index| self.mark_square(*index, touched)),
                None => (0..here.len()).for_each(|i| self.mark_footprint(vectors.map(|axis| axis[i]), matrix, touched)),
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

/// Eight lanes of up to eight numbers; those that are left take the first.
fn filled(axis: &[i32]) -> Each<i32> {
    axis.try_into().unwrap_or_else(|_| {
        let mut lanes = [axis[0]; LANES];
        lanes[..axis.len()].copy_from_slice(axis);
        lanes
    })
}

/// What pixels are made of while orientation and shown buffers stay the same.
#[derive(Clone, Debug)]
pub struct Lookup<'a> {
    addressing: Addressing<'a>,
    composition: Composition,
    memories: Vec<&'a FaceSet>,
    background: Option<&'a FaceSet>,
    composed: Composed,
}

impl<'a> Lookup<'a> {
    /// A look through the shown faces of all display memories, and of the background memory where there is one.
    ///
    /// # Panics
    /// For faces of another size than the configuration's.
    #[must_use]
    pub fn new(
        config: &ArpConfig,
        table: &'a LensTable,
        memories: Vec<&'a FaceSet>,
        background: Option<&'a FaceSet>,
    ) -> Self {
        let texels = config.timing.face_texels as u32;
        assert!(memories.iter().chain(&background).all(|faces| faces.texels() == texels), "faces of {texels} texels");
        let addressing = Addressing::new(config, table);
        Self { addressing, composition: config.composition(), memories, background, composed: Composed::new(texels) }
    }

    /// Looks up pixels from one on, in the order of lines, for one orientation: colours as 0x00RRGGBB.
    ///
    /// # Panics
    /// For a run that does not lie in the table.
    pub fn run(&mut self, first: usize, matrix: &MatrixWords, out: &mut [u32]) -> LookStats {
        let mut stats = LookStats::default();
        let vectors = self.addressing.table.run(first, out.len());
        for (group, pixels) in out.chunks_mut(LANES).enumerate() {
            let here = group * LANES..group * LANES + pixels.len();
            let vectors = vectors.map(|axis| &axis[here.clone()]);
            stats.add(self.group(vectors, matrix, pixels));
        }
        stats
    }

    /// The memory that wins the texel of each pixel with the most weight; `None` where all are empty.
    ///
    /// # Panics
    /// As [`Lookup::run`].
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

    fn group(&mut self, vectors: [&[i32]; 3], matrix: &MatrixWords, out: &mut [u32]) -> LookStats {
        if self.composition.order == CompositionOrder::DepthFirst
            && let Some(lanes) = self.addressing.lanes(vectors, matrix)
        {
            out.copy_from_slice(&self.pixels(&lanes)[..out.len()]);
            return LookStats::default();
        }
        let mut stats = LookStats::default();
        for (i, pixel) in out.iter_mut().enumerate() {
            let footprint = self.addressing.footprint(vectors.map(|axis| axis[i]), matrix);
            *pixel = footprint.map_or(self.composition.background, |footprint| {
                stats.count(&footprint);
                self.pixel(&footprint)
            });
        }
        stats
    }

    /// A pixel by its footprint, as it comes.
    fn pixel(&self, footprint: &Footprint) -> u32 {
        let words = |faces: &FaceSet| footprint.texels.map(|texel| texel.map_or(0, |texel| word(faces, texel)));
        let memories: Vec<[u64; 4]> = self.memories.iter().map(|faces| words(faces)).collect();
        let behind = self.background.map_or([0; 4], words).map(|word| shown(word, self.composition.background));
        let weights = footprint.weights(self.addressing.unit.weight_bits);
        let weights = [0, 1, 2, 3].map(|k| footprint.texels[k].map(|_| weights[k]));
        self.composition.pixel(&Gathered { memories: &memories, behind, weights })
    }

    fn pixels(&mut self, lanes: &Addresses) -> Each<u32> {
        let unit = self.addressing.unit;
        let reach = if unit.weight_bits == 0 { 0 } else { unit.geometry.texels as usize };
        if !self.composed.holds(&lanes.index, reach) {
            self.compose(&lanes.index, reach);
        }
        let four = gather(&self.composed.colours, &lanes.index, reach);
        if unit.weight_bits == 0 { four[0] } else { mix(&four, lanes, unit.weight_bits as u32) }
    }

    fn compose(&mut self, index: &Each<u32>, reach: usize) {
        let memories = &self.memories;
        let behind = self.background.map(FaceSet::words);
        for piece in index.iter().flat_map(|first| [*first as usize, *first as usize + reach]).map(|n| n / PIECE) {
            if !std::mem::replace(&mut self.composed.is_done[piece], true) {
                let start = piece * PIECE;
                let colours = &mut self.composed.colours;
                let end = (start + PIECE + 1).min(colours.len());
                compose(&mut colours[start..end], memories, behind, self.composition.background, start);
            }
        }
    }
}

/// Texels that are composed at once.
const PIECE: usize = 16;

/// What all memories show together, texel by texel, as far as pixels have asked for it: neighbouring pixels share texels, so that
/// each texel's depths are compared once and not by each of its readers.
#[derive(Clone, Debug)]
struct Composed {
    colours: Vec<u32>,
    /// Of each piece, whether its texels and the one after them are there.
    is_done: Vec<bool>,
}

impl Composed {
    fn new(texels: u32) -> Self {
        let all = 6 * (texels * texels) as usize;
        Self { colours: vec![0; all], is_done: vec![false; all.div_ceil(PIECE)] }
    }

    /// Whether the footprints that begin at these texels are there; `reach` texels down lies the next row.
    #[inline(always)]
    fn holds(&self, index: &Each<u32>, reach: usize) -> bool {
        index.iter().fold(true, |holds, first| {
            let first = *first as usize;
            holds & self.is_done[first / PIECE] & self.is_done[(first + reach) / PIECE]
        })
    }
}

/// Composes a run of texels from one on: the nearest of all memories, what is behind them where all are empty.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn compose(out: &mut [u32], memories: &[&FaceSet], behind: Option<&[u64]>, background: u32, start: usize) {
    let here = start..start + out.len();
    let mut best = [0; PIECE + 1];
    for faces in memories {
        for (best, word) in best.iter_mut().zip(&faces.words()[here.clone()]) {
            *best = nearer(*best, *word);
        }
    }
    let mut far = [background; PIECE + 1];
    for (far, word) in far.iter_mut().zip(behind.map_or(&[][..], |words| &words[here])) {
        *far = shown(*word, background);
    }
    for ((out, best), far) in out.iter_mut().zip(best).zip(far) {
        *out = shown(best, far);
    }
}

/// The colours of the four texels of each lane; `reach` texels down lies the next row, or none where nothing is interpolated.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn gather(colours: &[u32], index: &Each<u32>, reach: usize) -> [Each<u32>; 4] {
    let right = usize::from(reach > 0);
    let mut four = [[0; LANES]; 4];
    for (lane, first) in index.iter().enumerate() {
        let first = *first as usize;
        let square = &colours[first..=first + reach + right];
        four[0][lane] = square[0];
        four[1][lane] = square[right];
        four[2][lane] = square[reach];
        four[3][lane] = square[reach + right];
    }
    four
}

fn word(faces: &FaceSet, texel: TexelAddress) -> u64 {
    faces.words()[texel.index(faces.texels())]
}

/// Where the footprints of eight pixels begin, and their fractions.
struct Addresses {
    index: Each<u32>,
    right: Each<u32>,
    down: Each<u32>,
    /// Whether no footprint leaves its face; otherwise the numbers mean nothing.
    is_inside: bool,
}

#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn addresses(unit: &AddressUnit, vectors: &[Each<i32>; 3], matrix: &MatrixWords) -> Addresses {
    let mut face = [0; LANES];
    let mut forward = [0.0; LANES];
    let mut right = [0.0; LANES];
    let mut up = [0.0; LANES];
    let m = matrix.0.map(|row| row.map(f64::from));
    for lane in 0..LANES {
        let v = [f64::from(vectors[0][lane]), f64::from(vectors[1][lane]), f64::from(vectors[2][lane])];
        let x = m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2];
        let y = m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2];
        let z = m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2];
        let [ax, ay, az] = [x.abs(), y.abs(), z.abs()];
        let is_x = ax >= ay && ax >= az;
        let is_y = !is_x && ay >= az;
        let longest = if is_x {
            x
        } else if is_y {
            y
        } else {
            z
        };
        let sign = if longest < 0.0 { -1.0 } else { 1.0 };
        let axis = if is_x {
            0
        } else if is_y {
            2
        } else {
            4
        };
        face[lane] = axis + i32::from(longest < 0.0);
        forward[lane] = longest.abs();
        right[lane] = if is_x {
            sign * z
        } else if is_y {
            x
        } else {
            -sign * x
        };
        up[lane] = if is_y { sign * z } else { y };
    }
    let across = places(unit, &right, &forward);
    let down = places(unit, &up.map(|length| -length), &forward);
    footprints(unit, &face, &across, &down)
}

/// Places between the middles of texels in parts of 2^quotient_bits.
#[inline(always)]
fn places(unit: &AddressUnit, side: &Each<f64>, forward: &Each<f64>) -> Each<i32> {
    let q = unit.quotient_bits as u32;
    let scale = f64::from(1_u32 << q);
    let largest = (1_i32 << q) - 1;
    let half = if unit.weight_bits == 0 { 0 } else { 1 << (q - 1) };
    let inner = unit.geometry.inner() as i32;
    let first = ((unit.geometry.guard as i32) << q) + inner / 2 - half;
    let mut out = [0; LANES];
    for lane in 0..LANES {
        let quotient = (forward[lane] + side[lane]) * scale / (2.0 * forward[lane]);
        out[lane] = first + (quotient as i32).min(largest) * inner;
    }
    out
}

#[inline(always)]
fn footprints(unit: &AddressUnit, face: &Each<i32>, across: &Each<i32>, down: &Each<i32>) -> Addresses {
    let q = unit.quotient_bits as u32;
    let size = unit.geometry.texels as i32;
    let last = if unit.weight_bits == 0 { size - 1 } else { size - 2 };
    let mut all = Addresses { index: [0; LANES], right: [0; LANES], down: [0; LANES], is_inside: true };
    let mut outside = 0;
    for lane in 0..LANES {
        let column = across[lane] >> q;
        let row = down[lane] >> q;
        outside |= i32::from(column < 0) | i32::from(row < 0) | i32::from(column > last) | i32::from(row > last);
        all.index[lane] = ((face[lane] * size + row) * size + column) as u32;
        all.right[lane] = fraction(unit, across[lane]);
        all.down[lane] = fraction(unit, down[lane]);
    }
    all.is_inside = outside == 0;
    all
}

#[inline(always)]
const fn fraction(unit: &AddressUnit, place: i32) -> u32 {
    let below = (unit.quotient_bits - unit.weight_bits) as u32;
    let fraction = place as u32 & ((1 << unit.quotient_bits) - 1);
    (fraction + ((1 << below) >> 1)) >> below
}

/// Four colours of each lane, weighed.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn mix(four: &[Each<u32>; 4], lanes: &Addresses, weight_bits: u32) -> Each<u32> {
    let one = 1 << weight_bits;
    let half = (1 << (2 * weight_bits)) >> 1;
    let mut out = [0; LANES];
    for lane in 0..LANES {
        let right = lanes.right[lane];
        let down = lanes.down[lane];
        let weights = [(one - right) * (one - down), right * (one - down), (one - right) * down, right * down];
        for shift in [16, 8, 0] {
            let mut sum = half;
            for k in 0..4 {
                sum += (four[k][lane] >> shift & 0xFF) * weights[k];
            }
            out[lane] |= sum >> (2 * weight_bits) << shift;
        }
    }
    out
}
