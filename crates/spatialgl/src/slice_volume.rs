//! Slice volumes: which points of the world a slice stands for.

use serde::{Deserialize, Serialize};

/// What happens to a point on a boundary plane of a wedge, where the paper's rule "signs equal" is ambiguous.
///
/// `a` and `b` are the signed distances from the two boundary planes, both positive in the lobe on the +u side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TieRule {
    /// Each plane belongs to the slice that begins with it: space off the axis is partitioned. Ours.
    #[default]
    HalfOpen,
    /// Printed: the product is positive. No slice has its planes or the axis.
    ProductPositive,
    /// Printed: equal signs, where zero counts as positive. Both planes of the + lobe, neither of the - lobe, and the axis.
    SameSign,
    /// Both planes belong to both lobes, as with user clip planes: the product is not negative.
    Closed,
}

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

/// The two boundary planes of a wedge: both contain the axis y, so a plane is its coefficients of x and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WedgePlanes {
    /// Coefficients of x and z: A, positive on the + lobe's side.
    pub a: [f64; 2],
    /// Coefficients of x and z: B, positive on the + lobe's side.
    pub b: [f64; 2],
    /// Fraction bits to which both are rounded at every sample; `None` for double precision.
    pub fraction_bits: Option<u32>,
}

/// How the two products of a wedge decide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WedgeTest {
    /// Two user clip planes for each lobe, one pass a lobe; what is outside is not even generated.
    UserPlanes(TieRule),
    /// Both planes interpolated, and one test of their signs.
    Shader(TieRule),
    /// Both planes moved outwards by q pixels before their product is taken.
    Parallel(f64),
    /// b square pixels added to the product.
    Hyperbolic(f64),
}

/// The part of space that a slice stands for, as a test of surface points, beside the near and far plane of its projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SliceVolume {
    /// Everything between the near and far plane.
    Frustum,
    /// A slab low <= s < high parallel to the slice, pixels.
    Slab {
        /// First s that belongs to it.
        low: f64,
        /// First s that does not any more.
        high: f64,
    },
    /// A double wedge around the axis y.
    Wedge(WedgePlanes, WedgeTest),
    /// |s| <= offset + slope |u|, one pass for each side of the axis, by clip planes.
    Taper {
        /// Half thickness at the axis, pixels.
        offset: f64,
        /// Growth of the half thickness, pixels a pixel of |u|.
        slope: f64,
    },
}

impl SliceVolume {
    /// How often the commands are replayed for a slice.
    #[must_use]
    pub const fn passes(&self) -> u32 {
        match self {
            Self::Wedge(_, WedgeTest::UserPlanes(_)) | Self::Taper { .. } => 2,
            _ => 1,
        }
    }

    /// Whether clip planes keep what is outside from being generated as fragments.
    #[must_use]
    pub const fn clips_before_fragments(&self) -> bool {
        matches!(self, Self::Wedge(_, WedgeTest::UserPlanes(_)) | Self::Taper { .. } | Self::Slab { .. })
    }

    /// The s of the slice's own plane: 0, or the middle of a slab.
    pub(crate) const fn middle(&self) -> f64 {
        match self {
            Self::Slab { low, high } => (*low + *high) / 2.0,
            _ => 0.0,
        }
    }

    /// The two values that a vertex carries for the test: linear in space, so that they can be interpolated.
    #[inline(always)]
    #[must_use]
    pub(crate) fn attributes(&self, world: [f64; 3], u: f64, s: f64) -> [f64; 2] {
        match self {
            Self::Frustum => [0.0, 0.0],
            Self::Slab { low, high } => [s - low, high - s],
            Self::Wedge(planes, _) => [along(planes.a, world), along(planes.b, world)],
            Self::Taper { .. } => [u, s],
        }
    }

    /// What decides in one of the passes.
    pub(crate) fn test(&self, pass: u32) -> SampleTest {
        match *self {
            Self::Frustum => SampleTest::All,
            Self::Slab { .. } => SampleTest::Slab,
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

    /// Whether a point belongs to the slice, in any pass.
    #[must_use]
    pub fn contains(&self, world: [f64; 3], u: f64, s: f64) -> bool {
        let [p, q] = self.attributes(world, u, s);
        (0..self.passes()).any(|pass| self.test(pass).accepts(p, q, 1.0))
    }
}

#[inline(always)]
fn along(plane: [f64; 2], world: [f64; 3]) -> f64 {
    world[0] * plane[0] + world[2] * plane[1]
}

/// The test of one pass at one sample, of the interpolated attributes p and q and of w, all with one positive factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SampleTest {
    All,
    Slab,
    Taper { offset: f64, slope: f64, plus: bool },
    Plus(TieRule, Option<u32>),
    Minus(TieRule, Option<u32>),
    Both(TieRule, Option<u32>),
    Parallel(f64, Option<u32>),
    Hyperbolic(f64, Option<u32>),
}

impl SampleTest {
    /// The literal test.
    pub(crate) fn accepts(self, p: f64, q: f64, w: f64) -> bool {
        let (p, q, w) = self.rounded(p, q, w);
        match self {
            Self::All => true,
            Self::Slab => p >= 0.0 && q > 0.0,
            Self::Taper { offset, slope, plus } => taper(p, q, w, offset, slope, plus),
            Self::Plus(ties, _) => ties.plus(p, q),
            Self::Minus(ties, _) => ties.minus(p, q),
            Self::Both(ties, _) => ties.plus(p, q) || ties.minus(p, q),
            Self::Parallel(offset, _) => parallel(p, q, w, offset),
            Self::Hyperbolic(bias, _) => hyperbolic(p, q, w, bias),
        }
    }

    /// Fraction bits that the planes are rounded to.
    pub(crate) const fn fraction_bits(self) -> Option<u32> {
        match self {
            Self::All | Self::Slab | Self::Taper { .. } => None,
            Self::Plus(_, bits) | Self::Minus(_, bits) | Self::Both(_, bits) => bits,
            Self::Parallel(_, bits) | Self::Hyperbolic(_, bits) => bits,
        }
    }

    /// The same test of planes that are rounded already.
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
