//! Slice volumes: for each slice, the points of the world that the slice represents.

use serde::{Deserialize, Serialize};

/// The rule for a point exactly on a boundary plane of a slice's volume. The volume is a double wedge around the axis.
/// The SpatialGL paper's rule "signs equal" is ambiguous for such a point.
///
/// The values `a` and `b` are the signed distances of the point from the two boundary planes. Both are positive in the
/// positive lobe: the half of the double wedge with horizontal coordinate u > 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TieRule {
    /// Each boundary plane belongs to only one of its two adjacent slices, the slice that begins at this plane. Every
    /// point off the axis is therefore in exactly one slice. This rule is not from the SpatialGL paper.
    #[default]
    HalfOpen,
    /// The rule as printed in the SpatialGL paper: the product of the distances is positive. No slice contains its
    /// boundary planes or the axis.
    ProductPositive,
    /// The rule as printed in the SpatialGL paper: the signs are equal, and zero counts as positive. A slice contains
    /// both planes of the positive lobe (half of the double wedge), no plane of the negative lobe, and the axis.
    SameSign,
    /// Points on a boundary plane belong to both lobes (halves of the double wedge), as with user clip planes. The
    /// product of the distances is not negative.
    Closed,
}

impl TieRule {
    pub const ALL: [(&'static str, Self); 4] = [
        ("half-open", Self::HalfOpen),
        ("product-positive", Self::ProductPositive),
        ("same-sign", Self::SameSign),
        ("closed", Self::Closed),
    ];
}

pxpl5_sim::parameters::named!(TieRule, "tie rule", TieRule::ALL);

impl TieRule {
    #[inline(always)]
    pub(crate) fn plus(self, a: f64, b: f64) -> bool {
        match self {
            Self::HalfOpen => (a >= 0.0) & (b > 0.0),
            Self::ProductPositive => (a > 0.0) & (b > 0.0),
            Self::SameSign | Self::Closed => (a >= 0.0) & (b >= 0.0),
        }
    }

    #[inline(always)]
    pub(crate) fn minus(self, a: f64, b: f64) -> bool {
        match self {
            Self::HalfOpen => (a <= 0.0) & (b < 0.0),
            Self::ProductPositive | Self::SameSign => (a < 0.0) & (b < 0.0),
            Self::Closed => (a <= 0.0) & (b <= 0.0),
        }
    }
}

/// The two boundary planes of a wedge. Both contain the axis y, so each plane is defined by its coefficients of x and
/// z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WedgePlanes {
    /// Coefficients of x and z of plane A. Points of the positive lobe (half of the double wedge) lie on the positive
    /// side of this plane.
    pub a: [f64; 2],
    /// Coefficients of x and z of plane B. Points of the positive lobe lie on the positive side of this plane.
    pub b: [f64; 2],
    /// Number of fraction bits in the evaluation of both planes at every sample, or `None` for double precision.
    pub fraction_bits: Option<u32>,
}

/// The test that decides if a point is in a wedge, given the point's distances from the two boundary planes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WedgeTest {
    /// Two user clip planes for each lobe (half of the double wedge), with one drawing pass per lobe. Fragments outside
    /// the planes are not generated.
    UserPlanes(TieRule),
    /// A point's distances from the two boundary planes are interpolated, and one test compares the signs of the
    /// distances.
    Shader(TieRule),
    /// A distance in pixels by which both boundary planes are moved outwards. The test then checks the sign of the
    /// product of a point's distances from the two moved planes.
    Parallel(f64),
    /// A bias in square pixels. The test multiplies a point's distances from the two boundary planes, adds the bias,
    /// and checks the sign of the sum.
    Hyperbolic(f64),
}

/// The part of space that a slice represents, expressed as a test of surface points between the near and far planes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SliceVolume {
    /// All points between the near and far planes.
    Frustum,
    /// A double wedge around the axis y: its planes, and its test.
    Wedge(WedgePlanes, WedgeTest),
    /// The volume |s| <= offset + slope |u|, bounded by clip planes. s is the distance from the slice, and u the
    /// horizontal distance from the axis. Each side of the axis has its own drawing pass.
    Taper {
        /// Half thickness of the volume at the axis, pixels.
        offset: f64,
        /// Growth of the half thickness, in pixels per pixel of distance from the axis.
        slope: f64,
    },
}

impl SliceVolume {
    /// Returns the number of times that the recorded commands are replayed for a slice.
    pub const fn passes(&self) -> u32 {
        match self {
            Self::Wedge(_, WedgeTest::UserPlanes(_)) | Self::Taper { .. } => 2,
            _ => 1,
        }
    }

    /// Returns true if clip planes reject all points outside the volume before fragments are generated.
    pub const fn clips_before_fragments(&self) -> bool {
        matches!(self, Self::Wedge(_, WedgeTest::UserPlanes(_)) | Self::Taper { .. })
    }

    /// Returns the two values of a vertex that the test of the slice volume compares. Both values are linear in space
    /// and can be interpolated.
    #[inline(always)]
    pub(crate) fn attributes(&self, world: [f64; 3], u: f64, s: f64) -> [f64; 2] {
        match self {
            Self::Frustum => [0.0, 0.0],
            Self::Wedge(planes, _) => [along(planes.a, world), along(planes.b, world)],
            Self::Taper { .. } => [u, s],
        }
    }

    pub(crate) fn test(&self, pass: u32) -> SampleTest {
        match *self {
            Self::Frustum => SampleTest::All,
            Self::Taper { offset, slope } => SampleTest::Taper { offset, slope, plus: pass == 0 },
            Self::Wedge(planes, test) => match test {
                WedgeTest::UserPlanes(ties) if pass == 0 => SampleTest::Plus(ties, planes.fraction_bits),
                WedgeTest::UserPlanes(ties) => SampleTest::Minus(ties, planes.fraction_bits),
                WedgeTest::Shader(ties) => SampleTest::Both(ties, planes.fraction_bits),
                WedgeTest::Parallel(q) => SampleTest::Parallel(q, planes.fraction_bits),
                WedgeTest::Hyperbolic(b) => SampleTest::Hyperbolic(b, planes.fraction_bits),
            },
        }
    }

    /// Returns true if a point belongs to the slice's volume in any pass.
    pub fn contains(&self, world: [f64; 3], u: f64, s: f64) -> bool {
        let [p, q] = self.attributes(world, u, s);
        (0..self.passes()).any(|pass| self.test(pass).accepts(p, q, 1.0))
    }
}

#[inline(always)]
fn along(plane: [f64; 2], world: [f64; 3]) -> f64 {
    world[0] * plane[0] + world[2] * plane[1]
}

/// The test of one sample in one pass. Its inputs are the homogeneous coordinate w and the interpolated values p and q
/// of the slice volume. All three are multiplied by the same positive factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SampleTest {
    All,
    Taper { offset: f64, slope: f64, plus: bool },
    Plus(TieRule, Option<u32>),
    Minus(TieRule, Option<u32>),
    Both(TieRule, Option<u32>),
    Parallel(f64, Option<u32>),
    Hyperbolic(f64, Option<u32>),
}

impl SampleTest {
    /// Returns true if the sample passes the test. This function is the reference model of the test.
    pub(crate) fn accepts(self, p: f64, q: f64, w: f64) -> bool {
        let (p, q, w) = self.rounded(p, q, w);
        match self {
            Self::All => true,
            Self::Taper { offset, slope, plus } => taper(p, q, w, offset, slope, plus),
            Self::Plus(ties, _) => ties.plus(p, q),
            Self::Minus(ties, _) => ties.minus(p, q),
            Self::Both(ties, _) => ties.plus(p, q) || ties.minus(p, q),
            Self::Parallel(offset, _) => parallel(p, q, w, offset),
            Self::Hyperbolic(bias, _) => hyperbolic(p, q, w, bias),
        }
    }

    pub(crate) const fn fraction_bits(self) -> Option<u32> {
        match self {
            Self::All | Self::Taper { .. } => None,
            Self::Plus(_, bits) | Self::Minus(_, bits) | Self::Both(_, bits) => bits,
            Self::Parallel(_, bits) | Self::Hyperbolic(_, bits) => bits,
        }
    }

    pub(crate) const fn without_rounding(self) -> Self {
        match self {
            Self::Plus(ties, _) => Self::Plus(ties, None),
            Self::Minus(ties, _) => Self::Minus(ties, None),
            Self::Both(ties, _) => Self::Both(ties, None),
            Self::Parallel(q, _) => Self::Parallel(q, None),
            Self::Hyperbolic(b, _) => Self::Hyperbolic(b, None),
            other => other,
        }
    }

    fn rounded(self, p: f64, q: f64, w: f64) -> (f64, f64, f64) {
        let Some(bits) = self.fraction_bits() else { return (p, q, w) };
        let scale = libm::ldexp(1.0, bits as i32);
        (libm::rint(p / w * scale) / scale, libm::rint(q / w * scale) / scale, 1.0)
    }
}

#[inline(always)]
pub(crate) fn taper(u: f64, s: f64, w: f64, offset: f64, slope: f64, plus: bool) -> bool {
    let side = if plus { u >= 0.0 } else { u < 0.0 };
    side & (s.abs() <= offset * w + slope * u.abs())
}

#[inline(always)]
pub(crate) fn parallel(a: f64, b: f64, w: f64, offset: f64) -> bool {
    let q = offset * w;
    ((a + q) * (b + q) >= 0.0) | ((a - q) * (b - q) >= 0.0)
}

#[inline(always)]
pub(crate) fn hyperbolic(a: f64, b: f64, w: f64, bias: f64) -> bool {
    a * b + bias * (w * w) >= 0.0
}
