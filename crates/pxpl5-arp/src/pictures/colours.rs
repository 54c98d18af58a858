//! Colours that represent display memories.

/// Colours for display memories 0 to 7. People with colour blindness can distinguish these colours.
pub(crate) const MEMORY_COLOURS: [u32; 8] =
    [0x00D5_5E00, 0x00E6_9F00, 0x0000_9E73, 0x0056_B4E9, 0x0000_72B2, 0x00CC_79A7, 0x00F0_E442, 0x0099_9999];
