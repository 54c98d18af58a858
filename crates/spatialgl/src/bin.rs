//! Binning finds, for each primitive, the groups of slices that can show it. It takes place once per volume and needs
//! only the signs of a few plane equations.
//!
//! A vertex has a code with one bit per plane, which is set if the vertex is on the positive side. The `and` of a
//! primitive's codes gives the planes that have it completely on their positive side. The complement of the `or` gives
//! those on whose negative side it is. A region of space is defined by such signs too, so a primitive cannot touch it
//! if one plane separates them.

use serde::{Deserialize, Serialize};

/// A convex region bounded by planes. The region is described by the signs that plane equations have at its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BinRegion {
    /// Signs of the plane equations in the region: bit i is set if the region lies on the positive side of plane i.
    pub signs: u32,
    /// Planes that bound the region: bit i is set if plane i bounds the region.
    pub bounds: u32,
    /// Number of the bit in [`SliceView::bins`](crate::SliceView::bins) that stands for the slices of this region.
    pub group: u32,
}

/// The planes and regions of space by which primitives are sorted into bins, with one bin for each group of slices.
#[derive(Clone, Debug, PartialEq)]
pub struct BinLayout {
    /// Planes (a, b, c, d). A point is on the positive side of a plane if a x + b y + c z + d >= 0.
    pub planes: Vec<[f64; 4]>,
    pub regions: Vec<BinRegion>,
    /// Greatest distance in pixels from a slice's exact volume at which the slice still shows points.
    pub tolerance: f64,
}

/// Choice of the planes by which primitives are sorted into bins (groups of slices).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Binning {
    /// No binning: every slice draws every primitive.
    Off,
    /// Each primitive is tested only against the two planes that bound a region, so the primitive gets into more bins
    /// than with all planes. This test is the first version in the SpatialGL paper.
    TwoPlanes,
    /// Each primitive is tested against all planes by which space is divided.
    #[default]
    AllPlanes,
}

impl Binning {
    pub const ALL: [(&'static str, Self); 3] =
        [("off", Self::Off), ("two-planes", Self::TwoPlanes), ("all-planes", Self::AllPlanes)];
}

pxpl5_sim::parameters::named!(Binning, "method of binning", Binning::ALL);

/// The distance from a plane within which a vertex counts as lying on both sides of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BinTolerance {
    /// The distance by which the display's clip enlarges the slice volumes. With this tolerance, no fragment is lost.
    #[default]
    OfTheClip,
    /// No tolerance, as in the SpatialGL paper. A vertex in a plane counts as lying only on the plane's positive side.
    /// Fragments are lost if the clip enlarges the slice volumes.
    Codes,
    /// A fixed distance in pixels, which does not depend on the clip.
    Pixels(f64),
}

impl BinTolerance {
    /// All tolerances except fixed distances, each with its name in options and files.
    pub const ALL: [(&'static str, Self); 2] = [("clip", Self::OfTheClip), ("codes", Self::Codes)];
}

pxpl5_sim::parameters::named!(BinTolerance, "tolerance of bins", BinTolerance::ALL);

impl BinLayout {
    /// Returns a layout with a single bin, which contains all primitives.
    pub fn one() -> Self {
        Self { planes: Vec::new(), regions: vec![BinRegion { signs: 0, bounds: 0, group: 0 }], tolerance: 0.0 }
    }

    /// Returns a layout of eight sectors of 45 degrees around y. The planes z, x, x - z and x + z are bits 0 to 3.
    /// Opposite sectors form one double wedge, which one group of slices draws.
    pub fn double_wedges(tolerance: f64) -> Self {
        let planes = vec![[0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0], [1.0, 0.0, -1.0, 0.0], [1.0, 0.0, 1.0, 0.0]];
        let sectors = SECTOR_SIGNS.iter().zip(SECTOR_BOUNDS).zip(0..);
        let regions = sectors.map(|((signs, bounds), j)| BinRegion { signs: *signs, bounds, group: j % 4 }).collect();
        Self { planes, regions, tolerance }
    }

    /// Returns the SpatialGL paper's code of a point: bit i is set if the equation of plane i is not negative at the
    /// point.
    pub fn code(&self, point: [f64; 3]) -> u32 {
        let bits = self.planes.iter().enumerate().map(|(i, plane)| u32::from(distance(plane, point) >= 0.0) << i);
        bits.fold(0, |code, bit| code | bit)
    }

    /// Returns the groups of slices, one bit each, that may show a primitive with these corners.
    ///
    /// `extra` pixels are added to the tolerance for a primitive that extends beyond its corners.
    pub fn groups(&self, corners: &[[f64; 3]], binning: Binning, tolerance: BinTolerance, extra: f64) -> u64 {
        let codes = Codes::of(self, corners, tolerance, extra);
        let touched = self.regions.iter().filter(|region| match binning {
            Binning::Off => true,
            Binning::TwoPlanes => !codes.misses(region.signs, region.bounds),
            Binning::AllPlanes => !codes.misses(region.signs, u32::MAX),
        });
        touched.fold(0, |groups, region| groups | 1 << region.group)
    }

    /// Returns the regions that a primitive with these corners may touch, with one bit for each region of the layout.
    /// The test uses all planes of the layout.
    pub fn touched_regions(&self, corners: &[[f64; 3]], tolerance: BinTolerance) -> u64 {
        let codes = Codes::of(self, corners, tolerance, 0.0);
        let touched = self.regions.iter().enumerate().filter(|(_, region)| !codes.misses(region.signs, u32::MAX));
        touched.fold(0, |found, (i, _)| found | 1 << i)
    }
}

/// Signs of the plane equations in each sector, from +x to +z. The binary digits stand for the planes x + z, x - z, x
/// and z, in this order.
const SECTOR_SIGNS: [u32; 8] = [0b1111, 0b1011, 0b1001, 0b0001, 0b0000, 0b0100, 0b0110, 0b1110];

/// The two planes that bound each sector, as a bit mask, in the order of `SECTOR_SIGNS`.
const SECTOR_BOUNDS: [u32; 8] = [0b0101, 0b0110, 0b1010, 0b1001, 0b0101, 0b0110, 0b1010, 0b1001];

/// The combined codes of a primitive, with one bit per plane. A bit of `and` is set if the whole primitive lies on the
/// positive side of the bit's plane. A bit of `or` is set if any part of the primitive lies on this side.
struct Codes {
    and: u32,
    or: u32,
    planes: u32,
}

impl Codes {
    fn of(layout: &BinLayout, corners: &[[f64; 3]], tolerance: BinTolerance, extra: f64) -> Self {
        let mut codes = Self { and: 0, or: 0, planes: (1 << layout.planes.len()) - 1 };
        for (i, plane) in layout.planes.iter().enumerate() {
            let mut least = f64::INFINITY;
            let mut most = f64::NEG_INFINITY;
            for corner in corners {
                let d = distance(plane, *corner);
                least = least.min(d);
                most = most.max(d);
            }
            // The distances of the corners bound the distances of the whole primitive.
            let (and, or) = sides(least, most, norm(plane), tolerance, layout.tolerance, extra);
            codes.and |= u32::from(and) << i;
            codes.or |= u32::from(or) << i;
        }
        codes
    }

    const fn misses(&self, signs: u32, bounds: u32) -> bool {
        let checked = self.planes & bounds;
        (self.and & !signs | !self.or & signs) & checked != 0
    }
}

/// Returns two booleans for one plane. The first is true if all of a primitive lies on the plane's positive side. The
/// second is true if any part of the primitive lies on this side.
///
/// A primitive that is nearer to the plane than the tolerance counts as lying on both sides, and the slices on both
/// sides draw it. This is necessary, because the rule for points on a boundary may assign it to either.
fn sides(least: f64, most: f64, norm: f64, tolerance: BinTolerance, clip: f64, extra: f64) -> (bool, bool) {
    let pixels = match tolerance {
        BinTolerance::Codes => return (least >= 0.0, most >= 0.0),
        BinTolerance::OfTheClip => clip,
        BinTolerance::Pixels(pixels) => pixels,
    };
    let slack = (pixels + extra) * norm;
    (least > slack, most >= -slack)
}

#[inline(always)]
fn distance(plane: &[f64; 4], point: [f64; 3]) -> f64 {
    plane[0] * point[0] + plane[1] * point[1] + plane[2] * point[2] + plane[3]
}

fn norm(plane: &[f64; 4]) -> f64 {
    libm::sqrt(plane[0] * plane[0] + plane[1] * plane[1] + plane[2] * plane[2])
}
