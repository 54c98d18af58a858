use crate::{Eye, REGION_SIZE, RegionGrid};
use serde::Serialize;

/// A visible picture of a display: an eye's picture, a face of a cube, or a slice of a volume.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Surface {
    /// Short name of the surface for file names, such as `left`.
    pub label: &'static str,
    /// Name of the surface in timelines and traces, such as `left frame buffer`.
    pub title: &'static str,
    /// Width of the surface in visible pixels.
    pub width: u32,
    /// Height of the surface in visible lines.
    pub height: u32,
}

impl Surface {
    /// Returns the surfaces of `count` frame buffers of the same size. A single frame buffer shows one picture, and two
    /// frame buffers show the pictures of the two eyes.
    pub fn of_frame_buffers(count: usize, width: u32, height: u32) -> Vec<Self> {
        let titles = if count == 1 { ["frame buffer"; 2] } else { ["left frame buffer", "right frame buffer"] };
        let eyes = Eye::BOTH.into_iter().zip(titles).take(count);
        eyes.map(|(eye, title)| Self { label: eye.name(), title, width, height }).collect()
    }

    /// Returns the grid of regions that covers the surface. Each region has the size of a renderer's pixel array.
    pub const fn grid(&self) -> RegionGrid {
        RegionGrid { width: self.width, height: self.height, region_width: REGION_SIZE, region_height: REGION_SIZE }
    }

    /// Returns the letter that stands for the surface in timelines, such as `L`.
    pub fn letter(&self) -> char {
        self.label.chars().next().unwrap_or(' ').to_ascii_uppercase()
    }

    /// Returns the name of the surface for legends that are too narrow for the title. For the picture of an eye, the
    /// name is `left eye` or `right eye`. For other surfaces, the name is the label.
    pub fn legend(&self) -> String {
        let is_eye = Eye::BOTH.into_iter().any(|eye| eye.name() == self.label);
        if is_eye { format!("{} eye", self.label) } else { self.label.to_owned() }
    }
}

/// A named count of events in a display.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Counter {
    /// Name of the counter in reports and sweeps.
    pub name: &'static str,
    /// Number of counted events in the whole run.
    pub count: u64,
}

impl Counter {
    /// Name of the counter of overwritten lines. New pixels replaced such a line before the display had shown the line.
    /// Displays that show only whole buffers do not have this counter.
    pub const LINES_NEVER_SHOWN: &'static str = "lines never shown";
}
