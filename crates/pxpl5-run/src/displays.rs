//! The displays of the papers: one line for each.

use crate::registry::DisplayEntry;
use address_recalculation::ArpConfig;
use pxpl5_framebuffer::FrameBufferConfig;
use pxpl5_hires::HiResConfig;

pub(crate) fn entries() -> Vec<DisplayEntry> {
    vec![
        DisplayEntry { name: "ntsc", config: || Box::new(FrameBufferConfig::NTSC) },
        DisplayEntry { name: "hires", config: || Box::new(HiResConfig::PAPERS) },
        DisplayEntry { name: "arp", config: || Box::new(ArpConfig::MACHINE) },
    ]
}
