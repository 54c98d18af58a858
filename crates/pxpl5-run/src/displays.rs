//! The built-in displays: the displays of the papers, two current displays, and a display whose parameters the user
//! sets.

use crate::registry::DisplayEntry;
use address_recalculation::ArpConfig;
use pxpl5_framebuffer::{FrameBufferConfig, HiResConfig, LcdConfig, OledConfig, PanelConfig};

pub(crate) fn entries() -> Vec<DisplayEntry> {
    vec![
        DisplayEntry { name: "ntsc", config: || Box::new(FrameBufferConfig::NTSC) },
        DisplayEntry { name: "hires", config: || Box::new(HiResConfig::PAPERS) },
        DisplayEntry { name: "oled-90", config: || Box::new(OledConfig::PAPERS) },
        DisplayEntry { name: "lcd-120", config: || Box::new(LcdConfig::PAPERS) },
        DisplayEntry { name: "panel", config: || Box::new(PanelConfig::PAPERS) },
        DisplayEntry { name: "arp", config: || Box::new(ArpConfig::MACHINE) },
    ]
}
