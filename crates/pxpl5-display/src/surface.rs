//! What somebody looks at.

use pxpl5_wire::{Eye, REGION_SIZE, RegionGrid};
use serde::Serialize;

/// A picture that somebody looks at: that of an eye, a face of a cube, a slice of a volume.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Surface {
    /// Short name, as in the names of files: `left`.
    pub label: &'static str,
    /// What it is called in timelines and traces: `left frame buffer`.
    pub title: &'static str,
    /// Visible pixels of a line.
    pub width: u32,
    /// Visible lines from top to bottom.
    pub height: u32,
}

impl Surface {
    /// The surfaces of as many frame buffers of one size: one, or those of two eyes.
    #[must_use]
    pub fn of_frame_buffers(count: usize, width: u32, height: u32) -> Vec<Self> {
        let titles = if count == 1 { ["frame buffer"; 2] } else { ["left frame buffer", "right frame buffer"] };
        let eyes = Eye::BOTH.into_iter().zip(titles).take(count);
        eyes.map(|(eye, title)| Self { label: eye.name(), title, width, height }).collect()
    }

    /// The whole surface in regions of a renderer's size.
    #[must_use]
    pub const fn grid(&self) -> RegionGrid {
        RegionGrid { width: self.width, height: self.height, region_width: REGION_SIZE, region_height: REGION_SIZE }
    }

    /// The letter that stands for it in timelines: `L`.
    #[must_use]
    pub fn letter(&self) -> char {
        self.label.chars().next().unwrap_or(' ').to_ascii_uppercase()
    }

    /// What it is called where a legend has no room for its title: `left eye`, and else its label.
    #[must_use]
    pub fn legend(&self) -> String {
        let is_eye = Eye::BOTH.into_iter().any(|eye| eye.name() == self.label);
        if is_eye { format!("{} eye", self.label) } else { self.label.to_owned() }
    }
}

/// Something that a display has counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Counter {
    /// What was counted, as reports and sweeps name it.
    pub name: &'static str,
    /// How many there were in the whole run.
    pub count: u64,
}

impl Counter {
    /// Name of the count of lines that were overwritten before the display had shown them, where a display counts them: not
    /// one that shows whole buffers.
    pub const LINES_NEVER_SHOWN: &'static str = "lines never shown";
}
