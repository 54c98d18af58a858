use pxpl5_wire::RegionId;
use serde::{Deserialize, Serialize};

/// A set of regions of one picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct RegionMask(u128);

impl RegionMask {
    /// Largest number of regions in a picture. The indices of the regions are 0 to 127.
    pub const CAPACITY: u32 = u128::BITS;

    pub const EMPTY: Self = Self(0);

    /// Returns the set that contains one region. The set is empty if the region's index is [`Self::CAPACITY`] or more.
    pub const fn only(region: RegionId) -> Self {
        if region.0 as u32 >= Self::CAPACITY {
            return Self::EMPTY;
        }
        Self(1 << region.0)
    }

    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    pub const fn len(self) -> u32 {
        self.0.count_ones()
    }

    pub const fn contains(self, region: RegionId) -> bool {
        Self::only(region).0 & self.0 != 0
    }

    /// Returns the set of all regions that are in this set, in `other`, or in both.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    pub(crate) const fn with_bits(bits: u128) -> Self {
        Self(bits)
    }

    /// Returns the set as bits. Bit n is set if region n is in the set.
    pub const fn bits(self) -> u128 {
        self.0
    }

    /// Returns the smallest rectangle of regions that contains the set, in a picture with `columns` regions across. For the
    /// regions that a triangle touches, these are the regions under its bounding box.
    #[must_use]
    pub fn rectangle(self, columns: u32) -> Self {
        let places = || self.iter().map(|region| (u32::from(region.0) % columns, u32::from(region.0) / columns));
        let ends = |all: Vec<u32>| Some(all.iter().min().copied()?..=all.iter().max().copied()?);
        let [across, down] =
            [places().map(|place| place.0).collect(), places().map(|place| place.1).collect()].map(ends);
        let (Some(across), Some(down)) = (across, down) else { return self };
        let all = down.flat_map(|row| across.clone().map(move |column| RegionId((row * columns + column) as u16)));
        all.fold(Self::EMPTY, |set, region| set.union(Self::only(region)))
    }

    /// Returns the regions of the set in ascending order.
    pub fn iter(self) -> impl Iterator<Item = RegionId> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let region = rest.trailing_zeros();
            rest &= rest.wrapping_sub(1);
            (region < Self::CAPACITY).then_some(RegionId(region as u16))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mask_iterates_its_regions_in_ascending_order() {
        let mask = [0, 5, 127].into_iter().fold(RegionMask::EMPTY, |m, r| m.union(RegionMask::only(RegionId(r))));
        let found: Vec<u16> = mask.iter().map(|r| r.0).collect();
        assert_eq!((mask.len(), found), (3, vec![0, 5, 127]));
        assert!(RegionMask::only(RegionId(128)).is_empty());
        assert!(!mask.contains(RegionId(128)));
    }

    #[test]
    fn the_rectangle_of_a_diagonal_of_three_regions_has_nine_regions() {
        let diagonal = [1, 7, 13].into_iter().fold(RegionMask::EMPTY, |m, r| m.union(RegionMask::only(RegionId(r))));
        let found: Vec<u16> = diagonal.rectangle(5).iter().map(|r| r.0).collect();
        assert_eq!(found, [1, 2, 3, 6, 7, 8, 11, 12, 13]);
        assert_eq!(RegionMask::EMPTY.rectangle(5), RegionMask::EMPTY);
    }
}
