//! The reference model: every register of every stage, clock by clock.
//!
//! ```text
//! table - multiply - add - add - face - divide x q - address - memory - compare x log2 n - interpolate -> light
//! ```
//!
//! A pixel enters at each clock. Each stage takes one clock, and the pixel is displayed after the last stage. Products
//! are sums of partial products. Quotients are computed bit by bit. Texels come from banks. A tree of comparators finds
//! the nearest texel.
//!
//! The reference model shares with the fast model only the names of faces and the format of words.

mod arithmetic;
mod banks;
mod output;
mod registers;

pub use banks::BankedMemory;

use crate::address::{AddressUnit, Footprint};
use crate::composition::{Composition, CompositionOrder};
use crate::config::ArpConfig;
use crate::face::CubeFace;
use crate::lens::LensTable;
use crate::orientation::MatrixWords;
use arithmetic::{Divider, multiply, multiply_unsigned, signed};
use registers::Registers;
use std::collections::VecDeque;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Table,
    Multiply,
    AddFirst,
    AddSecond,
    Face,
    Divide,
    Address,
    Memory,
    Compare,
    Interpolate,
}

/// A pixel that leaves the last stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutputPixel {
    /// Column and line of the pixel in the frame.
    pub pixel: [u32; 2],
    /// Displayed colour, 0x00RRGGBB.
    pub colour: u32,
    /// The four texels from which the pixel was computed, with their weights.
    pub footprint: Footprint,
}

/// The pipeline between the video scan and the display memories, register by register.
#[derive(Clone, Debug)]
pub struct ReferencePipeline {
    table: LensTable,
    unit: AddressUnit,
    composition: Composition,
    vector_bits: u64,
    matrix_bits: u64,
    stages: Vec<Stage>,
    /// The pixel in each stage, in the order of the stages. `None` marks a stage without a pixel.
    inside: VecDeque<Option<Registers>>,
}

impl ReferencePipeline {
    pub fn new(config: &ArpConfig, table: LensTable) -> Self {
        let timing = &config.timing;
        let first = [Stage::Table, Stage::Multiply, Stage::AddFirst, Stage::AddSecond, Stage::Face];
        let divide = vec![Stage::Divide; timing.quotient_bits as usize];
        let compare = vec![Stage::Compare; timing.compare_stages() as usize];
        // The order of composition decides the order of the last stages.
        let last = match config.order {
            CompositionOrder::DepthFirst => [compare, vec![Stage::Interpolate]],
            CompositionOrder::InterpolationFirst => [vec![Stage::Interpolate], compare],
        };
        let stages = [first.to_vec(), divide, vec![Stage::Address, Stage::Memory], last.concat()].concat();
        Self {
            table,
            unit: AddressUnit::new(timing),
            composition: config.composition(),
            vector_bits: timing.vector_bits,
            matrix_bits: timing.matrix_bits,
            inside: vec![None; stages.len()].into(),
            stages,
        }
    }

    /// Returns the number of stages from reading the table to displaying the pixel.
    pub fn stages(&self) -> usize {
        self.stages.len()
    }

    /// Simulates one clock. All pixels advance by one stage, and the pixel that leaves the last stage is returned.
    ///
    /// `entering` is the new pixel with the orientation that was read for this pixel. `memories` and `background` are
    /// the buffers that are visible at this clock.
    pub fn clock(
        &mut self,
        entering: Option<([u32; 2], MatrixWords)>,
        memories: &[BankedMemory],
        background: Option<&BankedMemory>,
    ) -> Option<OutputPixel> {
        // Shift all pixels by one stage.
        self.inside.push_front(entering.map(|(pixel, matrix)| Registers::of(pixel, matrix)));
        self.inside.truncate(self.stages.len());
        // All stages work in parallel.
        for place in 0..self.stages.len() {
            if let Some(mut registers) = self.inside[place].take() {
                self.work(self.stages[place], &mut registers, memories, background);
                self.inside[place] = Some(registers);
            }
        }
        let last = self.inside.back()?.as_ref()?;
        let colour = output::lit(&self.composition, last, memories);
        last.footprint.map(|footprint| OutputPixel { pixel: last.pixel, colour, footprint })
    }

    fn work(
        &self,
        stage: Stage,
        registers: &mut Registers,
        memories: &[BankedMemory],
        background: Option<&BankedMemory>,
    ) {
        match stage {
            Stage::Table => registers.vector = self.table.entry(registers.pixel[0], registers.pixel[1]).map(i64::from),
            Stage::Multiply => self.multiply(registers),
            Stage::AddFirst => self.add_first(registers),
            Stage::AddSecond => self.add_second(registers),
            Stage::Face => self.select_face(registers),
            Stage::Divide => {
                let bits = self.sum_bits() + 2;
                registers.dividers.iter_mut().for_each(|divider| divider.step(bits));
            }
            Stage::Address => registers.footprint = Some(self.address(registers)),
            Stage::Memory => output::read(registers, memories, background, self.composition.background),
            Stage::Compare => output::compare(registers),
            Stage::Interpolate => output::interpolate(&self.composition, registers),
        }
    }

    /// Returns the number of bits in a sum of three products: one more than the bits of a product.
    const fn sum_bits(&self) -> u64 {
        self.vector_bits + self.matrix_bits + 1
    }

    fn multiply(&self, registers: &mut Registers) {
        let bits = [self.vector_bits, self.matrix_bits];
        for row in 0..3 {
            for column in 0..3 {
                let word = i64::from(registers.matrix.0[row][column]);
                registers.products[row][column] = multiply(registers.vector[column], word, bits);
            }
        }
    }

    fn add_first(&self, registers: &mut Registers) {
        for row in 0..3 {
            let [first, second, _] = registers.products[row];
            registers.sums[row] = signed(first + second, self.sum_bits());
        }
    }

    fn add_second(&self, registers: &mut Registers) {
        for row in 0..3 {
            registers.sums[row] = signed(registers.sums[row] + registers.products[row][2], self.sum_bits());
        }
    }

    /// Selects the face with comparators. Multiplexers and sign changers then compute the components along the face's
    /// axes.
    fn select_face(&self, registers: &mut Registers) {
        let [x, y, z] = registers.sums;
        let longer = [x.abs() >= y.abs(), x.abs() >= z.abs(), y.abs() >= z.abs()];
        let (face, right, up) = match longer {
            [true, true, _] if x >= 0 => (CubeFace::PosX, z, y),
            [true, true, _] => (CubeFace::NegX, -z, y),
            [_, _, true] if y >= 0 => (CubeFace::PosY, x, z),
            [_, _, true] => (CubeFace::NegY, x, -z),
            _ if z >= 0 => (CubeFace::PosZ, -x, y),
            _ => (CubeFace::NegZ, x, y),
        };
        let forward = x.abs().max(y.abs()).max(z.abs());
        registers.face = face;
        // The dividers compute (1 + side / forward) / 2, so the divisor is twice the forward component.
        let divisor = (2 * forward) as u64;
        registers.dividers = [forward + right, forward - up].map(|dividend| Divider::new(dividend as u64, divisor));
    }

    /// Multiplies the two quotients, which are positions on the face from 0 to 1, by the number of texels along an
    /// edge. In each product, the bits above the binary point select the texel, and the bits below are the fraction for
    /// interpolation.
    fn address(&self, registers: &Registers) -> Footprint {
        let q = self.unit.quotient_bits;
        // Offset of the first position: guard texels and rounding, minus half a texel for interpolation.
        let inner = u64::from(self.unit.geometry.inner());
        let half = if self.unit.weight_bits == 0 { 0 } else { 1_i64 << (q - 1) };
        let first = (i64::from(self.unit.geometry.guard) << q) + (inner / 2) as i64 - half;
        let places = registers.dividers.map(|divider| first + multiply_unsigned(divider.quotient, inner) as i64);
        let whole = places.map(|place| place >> q);
        if self.unit.weight_bits == 0 {
            let here = self.unit.around(registers.face, whole, [0, 0]);
            return Footprint { texels: [here.texels[0]; 4], fractions: [0, 0], is_split: false };
        }
        // Round the fraction, which may become 1.
        let rounding = |place: i64| {
            let below = q - self.unit.weight_bits;
            let doubled = (place as u64 & ((1 << q) - 1)) << 1 >> below;
            ((doubled + 1) >> 1) as u32
        };
        self.unit.around(registers.face, whole, places.map(rounding))
    }
}
