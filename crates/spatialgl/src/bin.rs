//! Binning: which primitives can touch which groups of slices, found once a volume from the signs of a few planes.
//!
//! A vertex has a code, one bit a plane: on its positive side or not. The `and` of a primitive's codes are the planes on
//! whose positive side it lies wholly, the complement of the `or` those on whose negative side. A region is the signs that
//! its points have; a primitive cannot touch it if it lies wholly on the other side of one of its planes.

use serde::{Deserialize, Serialize};

/// A convex region between planes: the signs that its points have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BinRegion {
    /// Bit i: its points lie on the positive side of plane i.
    pub signs: u32,
    /// Bit i: plane i bounds it.
    pub bounds: u32,
    /// The group that it belongs to, as bit number of [`SliceView::bins`](crate::SliceView::bins).
    pub group: u32,
}

/// The planes and regions by which a display has primitives sorted.
#[derive(Clone, Debug, PartialEq)]
pub struct BinLayout {
    /// Planes (a, b, c, d): positive where a x + b y + c z + d >= 0.
    pub planes: Vec<[f64; 4]>,
    /// The regions that they divide space into.
    pub regions: Vec<BinRegion>,
    /// How far outside its exact volume a slice shows anything, pixels.
    pub tolerance: f64,
}

/// Whether and by how many planes primitives are sorted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Binning {
    /// Every slice draws everything.
    Off,
    /// Only the planes that bound a region decide: weaker, as in the first version of the paper.
    TwoPlanes,
    /// All planes of the layout decide for each region.
    #[default]
    AllPlanes,
}

/// How far from a plane a vertex counts for both its sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BinTolerance {
    /// As far as the display's clip dilates its slices, so that nothing is lost.
    #[default]
    OfTheClip,
    /// The paper's codes: zero is positive, and nothing lies on both sides. Loses fragments of dilated clips.
    Codes,
    /// So many pixels, whatever the clip is.
    Pixels(f64),
}

impl BinLayout {
    /// One bin of everything.
    #[must_use]
    pub fn one() -> Self {
        Self { planes: Vec::new(), regions: vec![BinRegion { signs: 0, bounds: 0, group: 0 }], tolerance: 0.0 }
    }

    /// Eight sectors of 45 degrees around y by the planes z, x, x - z and x + z (bits 0 to 3); opposite sectors are one
    /// double wedge, and so one group.
    #[must_use]
    pub fn double_wedges(tolerance: f64) -> Self {
        let planes = vec![[0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0], [1.0, 0.0, -1.0, 0.0], [1.0, 0.0, 1.0, 0.0]];
        let sectors = SECTOR_SIGNS.iter().zip(SECTOR_BOUNDS).zip(0..);
        let regions = sectors.map(|((signs, bounds), j)| BinRegion { signs: *signs, bounds, group: j % 4 }).collect();
        Self { planes, regions, tolerance }
    }

    /// The paper's code of a point: bit i is set where plane i is not negative.
    #[must_use]
    pub fn code(&self, point: [f64; 3]) -> u32 {
        let bits = self.planes.iter().enumerate().map(|(i, plane)| u32::from(distance(plane, point) >= 0.0) << i);
        bits.fold(0, |code, bit| code | bit)
    }

    /// The groups, one bit each, that a primitive of these corners may touch.
    ///
    /// `extra` pixels are added to the tolerance, for a primitive that is larger than its corners.
    #[must_use]
    pub fn groups(&self, corners: &[[f64; 3]], binning: Binning, tolerance: BinTolerance, extra: f64) -> u64 {
        let codes = Codes::of(self, corners, tolerance, extra);
        let touched = self.regions.iter().filter(|region| match binning {
            Binning::Off => true,
            Binning::TwoPlanes => !codes.misses(region.signs, region.bounds),
            Binning::AllPlanes => !codes.misses(region.signs, u32::MAX),
        });
        touched.fold(0, |groups, region| groups | 1 << region.group)
    }

    /// The regions, one bit each in their order, that a primitive of these corners may touch by all planes.
    #[must_use]
    pub fn touched_regions(&self, corners: &[[f64; 3]], tolerance: BinTolerance) -> u64 {
        let codes = Codes::of(self, corners, tolerance, 0.0);
        let touched = self.regions.iter().enumerate().filter(|(_, region)| !codes.misses(region.signs, u32::MAX));
        touched.fold(0, |found, (i, _)| found | 1 << i)
    }
}

/// Signs of the sectors from +x to +z, bit 3 (x + z) first when written in binary.
const SECTOR_SIGNS: [u32; 8] = [0b1111, 0b1011, 0b1001, 0b0001, 0b0000, 0b0100, 0b0110, 0b1110];

/// The two planes that bound each sector.
const SECTOR_BOUNDS: [u32; 8] = [0b0101, 0b0110, 0b1010, 0b1001, 0b0101, 0b0110, 0b1010, 0b1001];

/// Planes on whose positive side a primitive lies wholly, and those on whose positive side it lies in part.
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

/// Whether all of a primitive, and whether any of it, lies on the positive side.
///
/// With a tolerance, only what is strictly beyond it is on one side: a triangle in a bin plane is drawn by the slices of
/// both sides, since the half-open rule may give it to either.
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
