//! What binning can find.

use crate::regions::RegionMask;
use crate::stats::SetupStats;
use pxpl5_wire::RegionId;

/// What binning finds of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// Not known before it is clipped, which [`crate::Transform::bin`] does.
    NeedsClipping,
    /// It has no area after snapping.
    Degenerate,
    /// It faces away, and such are culled.
    BackFacing,
    /// It touches no region: off the screen, or between pixel centres.
    Untouched,
    /// It touches this region alone.
    Region(RegionId),
    /// These regions, more than one.
    Regions(RegionMask),
}

impl Touch {
    #[inline(always)]
    pub(crate) const fn from_mask(regions: RegionMask) -> Self {
        match regions.len() {
            0 => Self::Untouched,
            1 => Self::Region(RegionId(regions.bits().trailing_zeros() as u16)),
            _ => Self::Regions(regions),
        }
    }

    /// The regions, if there are any; counts the screen triangle, or why it is none.
    #[inline(always)]
    pub const fn count(self, stats: &mut SetupStats) -> Option<RegionMask> {
        match self {
            Self::NeedsClipping => {}
            Self::Degenerate => stats.degenerate += 1,
            Self::BackFacing => stats.back_facing += 1,
            Self::Untouched => stats.untouched += 1,
            Self::Region(region) => {
                stats.screen_triangles += 1;
                return Some(RegionMask::only(region));
            }
            Self::Regions(regions) => {
                stats.screen_triangles += 1;
                return Some(regions);
            }
        }
        None
    }
}
