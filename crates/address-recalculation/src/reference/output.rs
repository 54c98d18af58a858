//! The stages after the memories in the reference model: comparators and interpolation.

use super::arithmetic::multiply_unsigned;
use super::banks::BankedMemory;
use super::registers::{Candidate, Registers};
use crate::composition::{Composition, CompositionOrder};
use crate::face::TexelAddress;

pub(super) fn read(
    registers: &mut Registers,
    memories: &[BankedMemory],
    background: Option<&BankedMemory>,
    constant: u32,
) {
    let Some(footprint) = registers.footprint else { return };
    // Read the background first: empty texels of the other memories show it.
    registers.behind = [constant; 4];
    if let Some(memory) = background {
        let read = candidate(memory, &footprint.texels, [constant; 4]);
        registers.behind = read.colours;
    }
    registers.candidates =
        memories.iter().map(|memory| candidate(memory, &footprint.texels, registers.behind)).collect();
}

fn candidate(memory: &BankedMemory, texels: &[Option<TexelAddress>; 4], behind: [u32; 4]) -> Candidate {
    let mut read = Candidate { depths: [memory.farthest(); 4], colours: behind };
    for (k, texel) in texels.iter().enumerate() {
        let Some(cell) = texel.map(|texel| memory.read(texel)) else { continue };
        read.depths[k] = cell.depth;
        if cell.depth != memory.farthest() {
            read.colours[k] = memory.wide(cell);
        }
    }
    read
}

/// Simulates one level of the comparator tree. Of two neighbouring candidates the nearer candidate stays. At equal
/// depth, the first candidate stays.
///
/// A candidate without a neighbour passes unchanged.
pub(super) fn compare(registers: &mut Registers) {
    let pairs = registers.candidates.chunks(2);
    registers.candidates = pairs.map(|pair| pair.iter().copied().reduce(nearer).unwrap_or(pair[0])).collect();
}

fn nearer(first: Candidate, second: Candidate) -> Candidate {
    let mut nearest = first;
    for k in 0..4 {
        if second.depths[k] < first.depths[k] {
            nearest.depths[k] = second.depths[k];
            nearest.colours[k] = second.colours[k];
        }
    }
    nearest
}

pub(super) fn interpolate(composition: &Composition, registers: &mut Registers) {
    let Some(footprint) = registers.footprint else { return };
    let products = footprint.weights(composition.weight_bits);
    let weights = [0, 1, 2, 3].map(|k| footprint.texels[k].map(|_| u64::from(products[k])));
    let bits = 2 * composition.weight_bits;
    // Depths are rounded up, so a mean never counts as nearer than it is.
    for candidate in &mut registers.candidates {
        let depth = weighed(candidate.depths, weights, bits, Rounding::Up);
        candidate.depths = [depth; 4];
        candidate.colours = [mixed(candidate.colours, weights, bits); 4];
    }
    // The background is interpolated here only if no depth comparison preceded.
    if composition.order == CompositionOrder::InterpolationFirst {
        registers.behind = [mixed(registers.behind, weights, bits); 4];
    }
    registers.colour = registers.candidates.first().map_or(0, |candidate| candidate.colours[0]);
}

/// Returns the final colour of the pixel. If depths were interpolated before the comparison, the nearest candidate may
/// be empty, and then the background is visible.
pub(super) fn lit(composition: &Composition, registers: &Registers, memories: &[BankedMemory]) -> u32 {
    let farthest = memories.first().map_or(0, BankedMemory::farthest);
    match (composition.order, registers.candidates.first()) {
        (CompositionOrder::DepthFirst, _) | (_, None) => registers.colour,
        (CompositionOrder::InterpolationFirst, Some(nearest)) => {
            if nearest.depths[0] == farthest {
                registers.behind[0]
            } else {
                nearest.colours[0]
            }
        }
    }
}

#[derive(Clone, Copy)]
enum Rounding {
    Nearest,
    Up,
}

fn mixed(colours: [u32; 4], weights: [Option<u64>; 4], bits: u64) -> u32 {
    let channel = |shift: u32| weighed(colours.map(|colour| colour >> shift & 0xFF), weights, bits, Rounding::Nearest);
    channel(16) << 16 | channel(8) << 8 | channel(0)
}

/// Returns the weighted sum of four values. The weights add up to 2^bits. If a weight is `None`, returns the mean of
/// the other three values.
fn weighed(values: [u32; 4], weights: [Option<u64>; 4], bits: u64, rounding: Rounding) -> u32 {
    // If a texel is beyond a corner, take the mean of the other three texels.
    if weights.contains(&None) {
        let three: u64 = (0..4).filter(|k| weights[*k].is_some()).map(|k| u64::from(values[k])).sum();
        let remainder = three % 3;
        let more = match rounding {
            Rounding::Nearest => remainder == 2,
            Rounding::Up => remainder > 0,
        };
        return (three / 3 + u64::from(more)) as u32;
    }
    let sum: u64 = (0..4).map(|k| multiply_unsigned(u64::from(values[k]), weights[k].unwrap_or(0))).sum();
    let added = match rounding {
        Rounding::Nearest => (1 << bits) >> 1,
        Rounding::Up => (1 << bits) - 1,
    };
    ((sum + added) >> bits) as u32
}
