//! From eight bits to one on the pixel array: a threshold that stays in pixel memory, and one comparison a channel.

use pxpl5_renderer::Layout;
use pxpl5_renderer::isa::{ArrayInstruction, Operand, Test};
use pxpl5_wire::Word;

/// Bits of a threshold, which are those of a channel.
const THRESHOLD_BITS: u8 = 8;

/// The thresholds' place: the first bits of the scratch, which neither clears nor slice triangles touch. They are loaded once, when
/// the machine is switched on, and cost a volume nothing.
///
/// # Panics
/// If the layout has no scratch; that of Rendering Control with Phong shading has 124 bits.
#[must_use]
pub fn threshold_field(layout: &Layout) -> Operand {
    scratch(layout).part(0, THRESHOLD_BITS)
}

/// The bit of a channel (0 red, 1 green, 2 blue) after halftoning, behind the thresholds.
///
/// # Panics
/// As [`threshold_field`].
#[must_use]
pub fn lit_field(layout: &Layout, channel: u8) -> Operand {
    scratch(layout).part(THRESHOLD_BITS + channel, 1)
}

fn scratch(layout: &Layout) -> Operand {
    layout.plan().scratch.expect("pxpl5-volume: slices are drawn in a layout with scratch")
}

/// The program: for each channel, enable all, disable unless threshold < channel, store Enable.
#[must_use]
pub fn halftone_program(layout: &Layout) -> Vec<ArrayInstruction> {
    let of_channel = |channel: u8| {
        let compared =
            ArrayInstruction::Compare { test: Test::Less, a: threshold_field(layout), b: layout.component(channel) };
        [ArrayInstruction::EnableAll { label: 0 }, compared, ArrayInstruction::EnableStore(lit_field(layout, channel))]
    };
    (0..3).flat_map(of_channel).collect()
}

/// Clocks in which an array is busy with it: 3 x (6 + 12 + 6) = 72, from its instructions.
#[must_use]
pub fn halftone_clocks(layout: &Layout) -> u64 {
    halftone_program(layout).iter().map(|instruction| u64::from(instruction.clocks())).sum()
}

/// Words that it takes on the ring: 3 x (1 + 2 + 1) = 12.
#[must_use]
pub fn halftone_words(layout: &Layout) -> Vec<Word> {
    let mut words = Vec::new();
    halftone_program(layout).iter().for_each(|instruction| instruction.encode(&mut words));
    words
}
