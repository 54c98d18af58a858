//! Skipping mode for runs, which are sequences of instructions with linear expressions or constants. It leaves out work
//! that changes no bit.
//!
//! No data flows from pixel to pixel. A tile can therefore execute all instructions of a run before the next tile
//! begins:
//!
//! - If all pixels of a tile are disabled, the tile does nothing, because instructions with expressions never enable
//!   pixels.
//! - If an edge expression is negative at all corners of a tile, the tile is disabled without simulation of adders. If
//!   it is negative at none, it disables no pixel. This holds only if the expression does not overflow 32 bits anywhere
//!   in the array.
//! - A tile's adder trees have five levels instead of seven, so a vector can hold those of several expressions side by
//!   side. The expression's value at the upper left pixel of the tile replaces the constant coefficient.
//!
//! The remaining work is done bit by bit, as in the reference mode.

use super::arithmetic::constant_bit;
use super::delivery::{Delivery, ExpressionEffect};
use super::evaluator::{Evaluator, LinearStreams, Trees, VectorPlace};
use super::tile::{self, ACROSS, EMPTY, HEIGHT, TILES, Tile, WIDTH, any};
use crate::isa::LINEAR_BITS;
use crate::simd::{SimdVector, VectorKernel};
use pxpl5_wire::Linear;

/// Largest number of expressions in an `InstructionRun`. The widest vector can hold the adder trees of eight.
pub(super) const EXPRESSIONS: usize = 8;

const LEVELS: usize = 5;
/// For each `l`, the columns (and rows) of a tile whose index has bit `l` set.
const NUMBERS: [u32; LEVELS] = [0xaaaa_aaaa, 0xcccc_cccc, 0xf0f0_f0f0, 0xff00_ff00, 0xffff_0000];

/// A sequence of instructions that one tile executes completely before another tile begins.
#[derive(Clone, Debug, Default)]
pub(super) struct InstructionRun {
    pub(super) steps: Vec<RunStep>,
    /// Linear expressions that the instructions use, with the upper left pixel of the array as origin of coordinates.
    pub(super) expressions: Vec<Linear>,
    pub(super) words: usize,
}

#[derive(Clone, Debug)]
pub(super) struct RunStep {
    pub(super) input: BitOrigin,
    pub(super) delivery: Delivery,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum BitOrigin {
    Expression(usize),
    Constant(ConstantBits),
}

impl RunStep {
    /// Returns the index of the expression whose sign disables pixels in this instruction. Returns `None` if the
    /// instruction is not *disable negative*.
    #[inline(always)]
    const fn disables_by_sign_of(&self) -> Option<usize> {
        match (self.input, self.delivery.effect) {
            (BitOrigin::Expression(i), ExpressionEffect::DisableNegative) => Some(i),
            _ => None,
        }
    }
}

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

    /// Returns, for each expression, the tiles in which all pixels have the same sign of the expression. There are no
    /// tiles for an expression whose sign disables no pixels.
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

    /// Returns the tiles in which the first instructions of this sequence disable all pixels. Bit n of the result
    /// stands for tile n.
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
                    // If the expression has the same sign in the whole tile, no adders are necessary.
                    if matches!(step.delivery.effect, ExpressionEffect::DisableNegative) {
                        if signs[i].negative >> number & 1 == 1 {
                            tile.enable = EMPTY;
                            return;
                        }
                        if signs[i].positive >> number & 1 == 1 {
                            continue;
                        }
                    }
                    // Run the trees of an expression only if the tile needs the expression.
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
    #[inline(always)]
    fn in_tile<V: SimdVector, E: Evaluator>(&self, evaluator: &E, word: usize, tile: &mut Tile) {
        for row in (0..HEIGHT).step_by(V::LANES) {
            if any(&tile.enable[row / 2..][..V::LANES / 2]) {
                self.run_pixels::<V, E>(evaluator, tile, VectorPlace::in_tile(word, row));
            }
        }
    }
}

/// Tiles in which all pixels have the same sign of an expression, so no serial arithmetic is necessary. Bit n stands
/// for tile n.
#[derive(Clone, Copy, Debug, Default)]
struct Signs {
    negative: u32,
    /// Tiles in which the expression is at least 0 at every pixel.
    positive: u32,
}

impl Signs {
    /// Finds the signs of an expression from the expression's values at the corners of each tile. If the expression
    /// overflows anywhere in the array, no sign is known.
    #[inline(always)]
    fn from_corners<V: SimdVector>(e: &Linear) -> Self {
        if wraps(e) {
            return Self::default();
        }
        // Values at the upper left pixel of each tile.
        let mut corners = [0; TILES];
        for (number, corner) in corners.iter_mut().enumerate() {
            let [left, top] = tile::origin(number);
            *corner = e.at(left as i32, top as i32) as u32;
        }
        // Across a tile, the value changes by at most these amounts.
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

/// Returns true if the value of an expression needs more than 32 bits at some pixel of the array.
#[inline(always)]
fn wraps(e: &Linear) -> bool {
    let last = (ACROSS * WIDTH - 1) as i64;
    let c = i64::from(e.c);
    let across = last * i64::from(e.a);
    let down = last * i64::from(e.b);
    let corners = [c, c + across, c + down, c + across + down];
    corners.iter().any(|corner| i32::try_from(*corner).is_err())
}

/// Output bits of the adder trees of one tile. For each clock, there is one word for each expression.
struct TileStreams {
    streams: LinearStreams,
    ready: usize,
}

impl TileStreams {
    /// Simulates the adder trees for the next expressions of the sequence, as many as fit in a vector.
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
