//! The regions that the triangles of a mesh touch, found once for all who hold some of them.

use crate::{RegionMask, SeenTriangle, SetupStats, Transform};
use pxpl5_wire::RegionId;

/// What binning finds of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// Nothing before it is clipped: see [`Transform::bin`].
    NeedsClipping,
    /// No area.
    Degenerate,
    /// It faces away, and such are culled.
    BackFacing,
    /// No region.
    Untouched,
    /// These regions.
    Regions(RegionMask),
}

impl Touch {
    /// The regions, if there are any; counts the screen triangle, or why it is none.
    #[inline(always)]
    pub const fn count(self, stats: &mut SetupStats) -> Option<RegionMask> {
        match self {
            Self::NeedsClipping => {}
            Self::Degenerate => stats.degenerate += 1,
            Self::BackFacing => stats.back_facing += 1,
            Self::Untouched => stats.untouched += 1,
            Self::Regions(regions) => {
                stats.screen_triangles += 1;
                return Some(regions);
            }
        }
        None
    }
}

/// What binning finds of the triangles of a mesh, four bytes each.
#[derive(Clone, Debug, Default)]
pub struct Touched {
    /// A region, one of the codes below, or [`SEVERAL`] and a place in `several`.
    codes: Vec<u32>,
    several: Vec<RegionMask>,
}

const SEVERAL: u32 = 1 << 31;
const NEEDS_CLIPPING: u32 = RegionMask::CAPACITY;
const DEGENERATE: u32 = NEEDS_CLIPPING + 1;
const BACK_FACING: u32 = NEEDS_CLIPPING + 2;
const UNTOUCHED: u32 = NEEDS_CLIPPING + 3;

impl Touched {
    /// What was found of triangle `i`.
    ///
    /// # Panics
    /// If there are not as many.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, i: usize) -> Touch {
        match self.codes[i] {
            NEEDS_CLIPPING => Touch::NeedsClipping,
            DEGENERATE => Touch::Degenerate,
            BACK_FACING => Touch::BackFacing,
            UNTOUCHED => Touch::Untouched,
            one if one < SEVERAL => Touch::Regions(RegionMask::only(RegionId(one as u16))),
            several => Touch::Regions(self.several[(several - SEVERAL) as usize]),
        }
    }

    fn push(&mut self, touch: Touch) {
        self.codes.push(match touch {
            Touch::NeedsClipping => NEEDS_CLIPPING,
            Touch::Degenerate => DEGENERATE,
            Touch::BackFacing => BACK_FACING,
            Touch::Untouched => UNTOUCHED,
            Touch::Regions(regions) if regions.len() == 1 => regions.bits().trailing_zeros(),
            Touch::Regions(regions) => {
                self.several.push(regions);
                SEVERAL + (self.several.len() - 1) as u32
            }
        });
    }
}

impl Transform {
    /// What [`Self::bin`] finds of triangles; `None` stands for one that needs clipping.
    #[must_use]
    pub fn touched(&self, triangles: impl Iterator<Item = Option<SeenTriangle>>) -> Touched {
        let mut all = Touched { codes: Vec::with_capacity(triangles.size_hint().0), several: Vec::new() };
        for triangle in triangles {
            all.push(triangle.map_or(Touch::NeedsClipping, |triangle| self.touch(triangle.0)));
        }
        all
    }
}
