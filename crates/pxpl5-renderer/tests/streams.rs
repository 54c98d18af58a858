//! Tests that any words from the ring can be decoded without a panic, and that decoded instructions encode to the same
//! words.

use proptest::prelude::*;
use pxpl5_renderer::isa::ArrayInstruction;
use pxpl5_renderer::{Command, Layout};

fn layouts() -> [Layout; 3] {
    [Layout::rendering_control_phong(), Layout::slats(), Layout::slats_quarters()]
}

/// Returns words that are often instructions. All opcodes have the same probability, and modifiers are small.
fn likely_word() -> impl Strategy<Value = u32> {
    let instruction =
        (0u32..64, 0u32..32, any::<u16>()).prop_map(|(op, modifier, low)| op << 24 | modifier << 16 | u32::from(low));
    prop_oneof![4 => instruction, 1 => any::<u32>(), 1 => 0u32..256]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_stream_is_refused_or_encodes_to_the_same_words(words in prop::collection::vec(likely_word(), 0..40)) {
        if let Ok(instructions) = ArrayInstruction::decode_all(&words) {
            let mut again = Vec::new();
            instructions.iter().for_each(|instruction| instruction.encode(&mut again));
            let read = ArrayInstruction::decode_all(&again).expect("what was written is read");
            prop_assert_eq!(format!("{read:?}"), format!("{instructions:?}"));
        }
    }

    #[test]
    fn a_command_at_any_place_of_any_stream_is_refused_or_ends_within_it(
        words in prop::collection::vec(likely_word(), 0..40),
        position in 0usize..60,
    ) {
        for layout in layouts() {
            if let Ok((_, used)) = Command::decode(&words, position, &layout) {
                prop_assert!(used > 0 && position + used <= words.len(), "{} of {}", position + used, words.len());
            }
        }
    }
}
