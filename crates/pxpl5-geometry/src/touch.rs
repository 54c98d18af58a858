use crate::regions::RegionMask;
use crate::stats::SetupStats;
use pxpl5_wire::RegionId;

/// The regions that one triangle touches, or the reason why the triangle is not drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// The triangle needs clipping. [`crate::Transform::bin`] clips the triangle and finds its regions.
    NeedsClipping,
    /// The triangle has no area after rounding to subpixels.
    Degenerate,
    /// The triangle is a back face and must not be drawn ([`crate::Culling::Back`]).
    BackFacing,
    /// The triangle touches no region, because it is off the screen or between pixel centres.
    Untouched,
    /// The triangle touches only this region.
    Region(RegionId),
    /// The triangle touches these regions, at least two.
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

    /// Returns the touched regions, or `None` if the triangle is not drawn. Counts the screen triangle, or the reason
    /// why the triangle is not drawn.
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
