//! Halftoning on the pixel array, from eight bits to one bit per channel. Each channel is compared with a threshold in
//! pixel memory.

use pxpl5_renderer::Layout;
use pxpl5_renderer::isa::{ArrayInstruction, Operand, Test};
use pxpl5_wire::Word;

/// Number of bits of a dither threshold. A colour channel has the same number of bits.
const THRESHOLD_BITS: u8 = 8;

/// Returns the location of the threshold in pixel memory: the first bits of the scratch memory. Clears and slice
/// triangles do not change these bits. The thresholds are loaded once at start-up, so loading takes no time per volume.
///
/// # Panics
/// Panics if the layout has no scratch memory. The layout of Rendering Control with Phong shading has 124 bits of
/// scratch.
pub fn threshold_field(layout: &Layout) -> Operand {
    scratch(layout).part(0, THRESHOLD_BITS)
}

/// Returns the location of a channel's bit after halftoning (0 red, 1 green, 2 blue). These bits follow the threshold
/// in pixel memory.
///
/// # Panics
/// The same as [`threshold_field`].
pub fn lit_field(layout: &Layout, channel: u8) -> Operand {
    scratch(layout).part(THRESHOLD_BITS + channel, 1)
}

fn scratch(layout: &Layout) -> Operand {
    layout.plan().scratch.expect("pxpl5-volume: slices are drawn in a layout with scratch")
}

/// Returns the halftone program. For each channel, the program enables all pixels, disables the pixels with threshold
/// >= channel, and stores the Enable bit.
pub fn halftone_program(layout: &Layout) -> Vec<ArrayInstruction> {
    let of_channel = |channel: u8| {
        let compared =
            ArrayInstruction::Compare { test: Test::Less, a: threshold_field(layout), b: layout.component(channel) };
        [ArrayInstruction::EnableAll { label: 0 }, compared, ArrayInstruction::EnableStore(lit_field(layout, channel))]
    };
    (0..3).flat_map(of_channel).collect()
}

/// Returns the number of clocks of the halftone program on an array: 3 x (6 + 12 + 6) = 72, computed from its
/// instructions.
pub fn halftone_clocks(layout: &Layout) -> u64 {
    halftone_program(layout).iter().map(|instruction| u64::from(instruction.clocks())).sum()
}

/// Returns the number of words that the halftone program has on the ring: 3 x (1 + 2 + 1) = 12.
pub fn halftone_words(layout: &Layout) -> Vec<Word> {
    let mut words = Vec::new();
    halftone_program(layout).iter().for_each(|instruction| instruction.encode(&mut words));
    words
}
