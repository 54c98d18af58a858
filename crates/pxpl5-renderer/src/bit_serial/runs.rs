//! Linear expressions and constants that follow each other in a list, without the work that cannot change anything.
//!
//! Nothing flows from pixel to pixel, so a tile may do all instructions of a run before the next tile begins:
//!
//! - A tile whose pixels are all disabled does nothing: an expression never enables.
//! - An expression that is negative at all corners of a tile disables it without adders; one that is negative at none
//!   disables nothing. Both hold only where the expression does not wrap in the array.
//! - A tile is a smaller array: its origin is applied to the coefficients as that of a region is, which leaves trees of
//!   five levels, and the trees of several expressions work side by side in a vector.
//!
//! What is left is done as the definition does it, bit by bit.

use super::arithmetic::constant_bit;
use super::delivery::{Delivery, ExpressionEffect};
use super::evaluator::{Evaluator, LinearStreams, Trees, VectorPlace};
use super::tile::{self, ACROSS, EMPTY, HEIGHT, TILES, Tile, WIDTH, any};
use crate::isa::LINEAR_BITS;
use crate::simd::{SimdVector, VectorKernel};
use pxpl5_wire::Linear;

/// Most expressions of a run: as many as have their trees in the widest vector.
pub(super) const EXPRESSIONS: usize = 8;

/// Bits of a column's number in its tile.
const LEVELS: usize = 5;
/// Columns of a tile, and rows, whose number has bit `l`.
const NUMBERS: [u32; LEVELS] = [0xaaaa_aaaa, 0xcccc_cccc, 0xf0f0_f0f0, 0xff00_ff00, 0xffff_0000];

/// Instructions that follow each other.
#[derive(Clone, Debug, Default)]
pub(super) struct InstructionRun {
    pub(super) steps: Vec<RunStep>,
    /// Over the array's own columns and rows.
    pub(super) expressions: Vec<Linear>,
    /// Words of the list.
    pub(super) words: usize,
}

/// An instruction of a run.
#[derive(Clone, Debug)]
pub(super) struct RunStep {
    pub(super) input: BitOrigin,
    pub(super) delivery: Delivery,
}

/// Where bits come from.
#[derive(Clone, Copy, Debug)]
pub(super) enum BitOrigin {
    /// An expression of the run.
    Expression(usize),
    Constant(ConstantBits),
}

impl RunStep {
    /// The expression of the run whose sign disables, where that is what the instruction does.
    #[inline(always)]
    const fn disables_by_sign_of(&self) -> Option<usize> {
        match (self.input, self.delivery.effect) {
            (BitOrigin::Expression(i), ExpressionEffect::DisableNegative) => Some(i),
            _ => None,
        }
    }
}

/// A run in all tiles.
pub(super) struct RunTiles<'a> {
    pub(super) run: &'a InstructionRun,
    pub(super) tiles: &'a mut [Tile],
}

impl VectorKernel for RunTiles<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: SimdVector>(self) {
        let signs = self.run.signs::<V>();
        let disabled = self.run.disabled_at_once(&signs);
        let mut streams = TileStreams { streams: LinearStreams([[0; EXPRESSIONS]; LINEAR_BITS as usize]), ready: 0 };
        for (number, tile) in self.tiles.iter_mut().enumerate() {
            if disabled >> number & 1 == 1 {
                tile.enable = EMPTY;
            } else if tile.enabled() {
                streams.ready = 0;
                self.run.in_tile::<V>(&signs, &mut streams, number, tile);
            }
        }
    }
}

impl InstructionRun {
    pub(super) fn clear(&mut self) {
        self.steps.clear();
        self.expressions.clear();
        self.words = 0;
    }

    /// Of the expressions whose sign matters.
    #[inline(always)]
    fn signs<V: SimdVector>(&self) -> [Signs; EXPRESSIONS] {
        let mut signs = [Signs::default(); EXPRESSIONS];
        for step in &self.steps {
            if let Some(i) = step.disables_by_sign_of() {
                signs[i] = Signs::from_corners::<V>(&self.expressions[i]);
            }
        }
        signs
    }

    /// Tiles, one a bit, that the run disables before it does anything else.
    #[inline(always)]
    fn disabled_at_once(&self, signs: &[Signs; EXPRESSIONS]) -> u32 {
        let mut disabled = 0;
        for step in &self.steps {
            let Some(i) = step.disables_by_sign_of() else { break };
            disabled |= signs[i].negative;
        }
        disabled
    }

    #[inline(always)]
    fn in_tile<V: SimdVector>(
        &self,
        signs: &[Signs; EXPRESSIONS],
        streams: &mut TileStreams,
        number: usize,
        tile: &mut Tile,
    ) {
        for step in &self.steps {
            match step.input {
                BitOrigin::Constant(constant) => step.delivery.in_tile::<V, _>(&constant, 0, tile),
                BitOrigin::Expression(i) => {
                    if matches!(step.delivery.effect, ExpressionEffect::DisableNegative) {
                        if signs[i].negative >> number & 1 == 1 {
                            tile.enable = EMPTY;
                            return;
                        }
                        if signs[i].positive >> number & 1 == 1 {
                            continue;
                        }
                    }
                    while streams.ready <= i {
                        streams.run_trees::<V>(self, number);
                    }
                    step.delivery.in_tile::<V, _>(&streams.streams, i, tile);
                }
            }
            if !tile.enabled() {
                return;
            }
        }
    }
}

impl Delivery {
    /// In those vectors of a tile that have enabled pixels; the trees' streams stand in a word.
    #[inline(always)]
    fn in_tile<V: SimdVector, E: Evaluator>(&self, evaluator: &E, word: usize, tile: &mut Tile) {
        for row in (0..HEIGHT).step_by(V::LANES) {
            if any(&tile.enable[row / 2..][..V::LANES / 2]) {
                self.run_pixels::<V, E>(evaluator, tile, VectorPlace::in_tile(word, row));
            }
        }
    }
}

/// Where the sign of an expression is known without serial arithmetic.
#[derive(Clone, Copy, Debug, Default)]
struct Signs {
    /// Tiles, one a bit, in which it is negative everywhere.
    negative: u32,
    /// Tiles in which it is negative nowhere.
    positive: u32,
}

impl Signs {
    /// From the values at the corners of each tile; unknown where the expression wraps anywhere in the array.
    #[inline(always)]
    fn from_corners<V: SimdVector>(e: &Linear) -> Self {
        if wraps(e) {
            return Self::default();
        }
        let mut corners = [0; TILES];
        for (number, corner) in corners.iter_mut().enumerate() {
            let [left, top] = tile::origin(number);
            *corner = e.at(left as i32, top as i32) as u32;
        }
        let across = e.a * (WIDTH as i32 - 1);
        let down = e.b * (HEIGHT as i32 - 1);
        let largest = V::splat(across.max(0) + down.max(0));
        let smallest = V::splat(across.min(0) + down.min(0));
        let mut signs = Self::default();
        for first in (0..TILES).step_by(V::LANES) {
            let corner = V::load(&corners[first..]);
            signs.negative |= corner.add(largest).signs() << first;
            signs.positive |= (!corner.add(smallest).signs() & lanes::<V>()) << first;
        }
        signs
    }
}

const fn lanes<V: SimdVector>() -> u32 {
    u32::MAX >> (32 - V::LANES)
}

/// Whether an expression leaves 32 bits anywhere in the array.
#[inline(always)]
fn wraps(e: &Linear) -> bool {
    let last = (ACROSS * WIDTH - 1) as i64;
    let c = i64::from(e.c);
    let across = last * i64::from(e.a);
    let down = last * i64::from(e.b);
    let corners = [c, c + across, c + down, c + across + down];
    corners.iter().any(|corner| i32::try_from(*corner).is_err())
}

/// What the trees of a tile deliver for the expressions of a run, each in its word.
struct TileStreams {
    streams: LinearStreams,
    /// Expressions whose trees have run.
    ready: usize,
}

impl TileStreams {
    /// Runs the trees of as many expressions as a vector holds.
    #[inline(always)]
    fn run_trees<V: SimdVector>(&mut self, run: &InstructionRun, number: usize) {
        let [left, top] = tile::origin(number);
        let ready = self.ready + V::LANES / 2;
        let mut coefficients = [0; EXPRESSIONS];
        let mut constants = [0; EXPRESSIONS];
        for (i, e) in run.expressions.iter().skip(self.ready).take(V::LANES / 2).enumerate() {
            coefficients[i] = u64::from(e.b as u32) << 32 | u64::from(e.a as u32);
            constants[i] = u64::from(e.at(left as i32, top as i32) as u32) << 32;
        }
        let constants = V::load_words(&constants);
        let mut trees = Trees::new([V::load_words(&coefficients); 2], NUMBERS.map(|numbers| V::splat(numbers as i32)));
        for (t, words) in self.streams.0.iter_mut().enumerate() {
            trees.add(constants.bit(t as u32), t).store_words(&mut words[self.ready..]);
        }
        self.ready = ready;
    }
}

/// A constant, as though an expression were it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConstantBits {
    pub(super) value: u32,
    pub(super) signed: bool,
}

impl Evaluator for ConstantBits {
    type Carries<V: SimdVector> = ();

    #[inline(always)]
    fn start<V: SimdVector>() {}

    #[inline(always)]
    fn bit<V: SimdVector>(&self, t: usize, _: VectorPlace, (): &mut ()) -> V {
        V::load_words(&constant_bit(self.value, t, self.signed))
    }
}
