use crate::REGION_SIZE;
use serde::{Deserialize, Serialize};

/// An eye of the viewer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Eye {
    /// The left eye, or the only eye of a picture without stereo.
    Left,
    /// The right eye. The second frame buffer shows the picture of this eye.
    Right,
}

impl Eye {
    /// Both eyes, in the order in which the pipelines draw them.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// Returns the index of the eye: 0 for left, 1 for right.
    #[inline]
    pub const fn index(self) -> usize {
        self as usize
    }

    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

pxpl5_sim::parameters::named!(Eye, "eye", Eye::BOTH.map(|eye| (eye.name(), eye)));

/// The number of a visible surface, counted over all displays of a machine in order. With a single NTSC display, the
/// number equals the index of the eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SurfaceId(pub u16);

impl SurfaceId {
    #[inline]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

impl From<Eye> for SurfaceId {
    fn from(eye: Eye) -> Self {
        Self(eye as u16)
    }
}

/// The number of a region in a picture, counted row by row from the top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct RegionId(pub u16);

/// The division of a picture into a grid of regions.
///
/// All lengths are in pixels. Regions in the last column and row can be smaller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct RegionGrid {
    pub width: u32,
    /// Height of the picture in drawn lines, for example 240 for a field.
    pub height: u32,
    /// Width of a region in pixels, at most 128.
    pub region_width: u32,
    /// Height of a region in pixels, at most 128.
    pub region_height: u32,
}

impl RegionGrid {
    /// A whole NTSC video frame of 640 x 480 in 5 x 4 regions of 128 x 128. The last row has 96 lines (TR94).
    pub const FRAME: Self = Self { width: 640, height: 480, region_width: 128, region_height: 128 };

    /// One NTSC field of 640 x 240 in 5 x 2 regions of 128 x 120 (TR94).
    pub const FIELD: Self = Self { width: 640, height: 240, region_width: 128, region_height: 120 };

    #[inline]
    pub const fn columns(&self) -> u32 {
        self.width.div_ceil(self.region_width)
    }

    /// Returns the number of rows of regions. The regions of the last row can be cut off at the bottom.
    #[inline]
    pub const fn rows(&self) -> u32 {
        self.height.div_ceil(self.region_height)
    }

    #[inline]
    pub const fn regions(&self) -> u32 {
        self.columns() * self.rows()
    }

    /// Returns left, top, width and height of a region in pixels.
    pub const fn rectangle(&self, region: RegionId) -> [u32; 4] {
        let column = region.0 as u32 % self.columns();
        let row = region.0 as u32 / self.columns();
        let left = column * self.region_width;
        let top = row * self.region_height;
        [left, top, min(self.region_width, self.width - left), min(self.region_height, self.height - top)]
    }

    /// Returns left, top, width and height of a region in pixels, for a grid and a region from a message. Returns
    /// `None` if the grid or the region is invalid. The grid must not be empty or larger than `width` x `height`, and
    /// must contain the region. The region must have at least one pixel, and at most as many pixels as a renderer's
    /// array.
    pub const fn rectangle_within(&self, region: RegionId, width: u32, height: u32) -> Option<[u32; 4]> {
        // Check the grid before any division by its sizes.
        let fits = 0 < self.width && self.width <= width && 0 < self.height && self.height <= height;
        if !fits || self.region_width == 0 || self.region_height == 0 {
            return None;
        }
        // A message can contain a grid whose number of regions exceeds 32 bits.
        if region.0 as u64 >= self.columns() as u64 * self.rows() as u64 {
            return None;
        }
        let [left, top, w, h] = self.rectangle(region);
        if w <= REGION_SIZE && h <= REGION_SIZE { Some([left, top, w, h]) } else { None }
    }
}

const fn min(a: u32, b: u32) -> u32 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_has_20_regions_that_cover_it_once() {
        let pixels: u32 = (0..20).map(|i| RegionGrid::FRAME.rectangle(RegionId(i))).map(|r| r[2] * r[3]).sum();
        assert_eq!((RegionGrid::FRAME.regions(), pixels), (20, 640 * 480));
        assert_eq!(RegionGrid::FRAME.rectangle(RegionId(19)), [512, 384, 128, 96]);
    }

    #[test]
    fn the_region_of_a_message_is_checked_before_use() {
        let within = |grid: RegionGrid, region: u16| grid.rectangle_within(RegionId(region), 640, 480);
        let frame = RegionGrid::FRAME;
        assert_eq!(within(frame, 19), Some([512, 384, 128, 96]));
        assert_eq!(within(frame, 20), None);
        for grid in [
            RegionGrid { width: 641, ..frame },
            RegionGrid { height: u32::MAX, region_height: 1, ..frame },
            RegionGrid { width: 0, ..frame },
            RegionGrid { region_width: 0, ..frame },
            RegionGrid { region_height: 0, ..frame },
            RegionGrid { region_width: 129, ..frame },
            RegionGrid { region_height: u32::MAX, ..frame },
        ] {
            assert_eq!(within(grid, 0), None, "{grid:?}");
        }
    }

    #[test]
    fn a_field_region_is_fifteen_messages_of_pixels() {
        assert_eq!(RegionGrid::FIELD.regions(), 10);
        let [_, _, w, h] = RegionGrid::FIELD.rectangle(RegionId(9));
        assert_eq!(w * h, 15 * crate::MAX_MESSAGE_WORDS);
    }
}
