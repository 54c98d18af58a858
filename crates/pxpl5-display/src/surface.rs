//! Surfaces of displays and their counters.

use pxpl5_wire::{Eye, REGION_SIZE, RegionGrid};
use serde::Serialize;

/// A visible picture of a display: an eye's picture, a face of a cube, or a slice of a volume.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Surface {
    /// Short name, used in file names: `left`.
    pub label: &'static str,
    /// Name in timelines and traces: `left frame buffer`.
    pub title: &'static str,
    /// Number of visible pixels of a line.
    pub width: u32,
    /// Number of visible lines.
    pub height: u32,
}

impl Surface {
    /// Returns the surfaces of `count` frame buffers of one size: a single picture, or two eyes.
    #[must_use]
    pub fn of_frame_buffers(count: usize, width: u32, height: u32) -> Vec<Self> {
        let titles = if count == 1 { ["frame buffer"; 2] } else { ["left frame buffer", "right frame buffer"] };
        let eyes = Eye::BOTH.into_iter().zip(titles).take(count);
        eyes.map(|(eye, title)| Self { label: eye.name(), title, width, height }).collect()
    }

    /// Returns the division of the whole surface into regions of a renderer's size.
    #[must_use]
    pub const fn grid(&self) -> RegionGrid {
        RegionGrid { width: self.width, height: self.height, region_width: REGION_SIZE, region_height: REGION_SIZE }
    }

    /// Returns the letter for the surface in timelines: `L`.
    #[must_use]
    pub fn letter(&self) -> char {
        self.label.chars().next().unwrap_or(' ').to_ascii_uppercase()
    }

    /// Returns the name for legends without room for the title: `left eye` for an eye, else the label.
    #[must_use]
    pub fn legend(&self) -> String {
        let is_eye = Eye::BOTH.into_iter().any(|eye| eye.name() == self.label);
        if is_eye { format!("{} eye", self.label) } else { self.label.to_owned() }
    }
}

/// A counter of a display.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Counter {
    /// Name of the counter in reports and sweeps.
    pub name: &'static str,
    /// Value of the counter for the whole run.
    pub count: u64,
}

impl Counter {
    /// Name of the counter of lines that were overwritten before the display had shown them. Displays that show whole
    /// buffers do not have it.
    pub const LINES_NEVER_SHOWN: &'static str = "lines never shown";
}
