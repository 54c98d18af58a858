//! The six methods of clipping to a slice on a swept display, with their near plane, far plane and bins.

use crate::error::{SpatialError, require};
use crate::slice_volume::{SliceVolume, TieRule, WedgePlanes, WedgeTest};
use serde::{Deserialize, Serialize};

/// A method of clipping the scene to the volume of a slice that is swept around an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SliceClip {
    /// Only the near and far planes of an orthographic projection: a prism with the slice's thickness at the rim.
    Prism,
    /// Two user clip planes per pass, with one pass for each lobe of the double wedge.
    UserPlanes,
    /// The product of two interpolated clip planes in the fragment program: the exact volume in one pass.
    ShaderPlanes,
    /// Planes from a half thickness of q pixels at the axis to the exact thickness at the rim, with one pass for each
    /// side.
    Tapered(
        /// Half thickness q at the axis, pixels.
        f64,
    ),
    /// Both boundary planes, moved outwards by q pixels.
    Parallel(
        /// Offset q of both planes, pixels.
        f64,
    ),
    /// The product of both boundary planes plus a bias b.
    Hyperbolic(
        /// Bias b of the product, square pixels.
        f64,
    ),
}

/// Offset of the parallel and the tapered clip, pixels. Assumed, 0 to 2: with half a pixel, no slab is thinner than one
/// pixel.
pub const DEFAULT_OFFSET_PX: f64 = 0.5;

/// Bias of the hyperbolic clip, square pixels. Assumed, 0 to 4: the square of [`DEFAULT_OFFSET_PX`].
pub const DEFAULT_HYPERBOLIC_BIAS_PX2: f64 = 0.25;

/// Half the wedge of one slice: sine, cosine and tangent of d/2, where d is the angle between slices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfWedge {
    /// Sine of half the angle between slices, S = sin(d/2).
    pub sin: f64,
    /// Cosine of half the angle between slices, C = cos(d/2).
    pub cos: f64,
    /// Tangent of half the angle between slices, T = tan(d/2).
    pub tan: f64,
    /// Radius of the display, which is half the width of the image, pixels.
    pub radius: f64,
}

impl HalfWedge {
    /// Returns the half wedge of a display with `slices` per turn and this radius in pixels.
    #[must_use]
    pub fn new(slices: u32, radius: f64) -> Self {
        let (sin, cos) = crate::angle::sin_cos_of_turn(1, 2 * slices);
        Self { sin, cos, tan: sin / cos, radius }
    }
}

impl SliceClip {
    /// All six methods with the default offset and bias, in the order of the paper.
    pub const ALL: [Self; 6] = [
        Self::Prism,
        Self::UserPlanes,
        Self::ShaderPlanes,
        Self::Tapered(DEFAULT_OFFSET_PX),
        Self::Parallel(DEFAULT_OFFSET_PX),
        Self::Hyperbolic(DEFAULT_HYPERBOLIC_BIAS_PX2),
    ];

    /// Returns the name of the method in options, tables and files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Prism => "prism",
            Self::UserPlanes => "user-planes",
            Self::ShaderPlanes => "exact",
            Self::Tapered(_) => "tapered",
            Self::Parallel(_) => "parallel",
            Self::Hyperbolic(_) => "hyperbolic",
        }
    }

    /// Returns the distance of the near and far planes from the slice, pixels (h_max of the specification).
    #[must_use]
    pub fn reach(self, wedge: HalfWedge) -> f64 {
        let face = wedge.radius * wedge.sin;
        match self {
            Self::Parallel(q) => (face + q) / wedge.cos,
            Self::Hyperbolic(b) => libm::sqrt(face * face + b) / wedge.cos,
            _ => wedge.radius * wedge.tan,
        }
    }

    /// Returns the greatest distance from the exact wedge at which a slice still shows a point, pixels. Bins must allow
    /// for this distance.
    #[must_use]
    pub fn tolerance(self, wedge: HalfWedge) -> f64 {
        match self {
            Self::Prism => wedge.radius * wedge.tan,
            Self::UserPlanes | Self::ShaderPlanes => 0.0,
            Self::Tapered(q) | Self::Parallel(q) => q,
            Self::Hyperbolic(b) => libm::sqrt(b),
        }
    }

    /// Returns the half thickness of the slice at a distance u from the axis, pixels.
    #[must_use]
    pub fn half_thickness(self, wedge: HalfWedge, u: f64) -> f64 {
        let exact = u.abs() * wedge.tan;
        match self {
            Self::Prism => wedge.radius * wedge.tan,
            Self::UserPlanes | Self::ShaderPlanes => exact,
            Self::Tapered(q) => q + u.abs() * taper_slope(q, wedge),
            Self::Parallel(q) => exact + q / wedge.cos,
            Self::Hyperbolic(b) => libm::sqrt(u * u * wedge.sin * wedge.sin + b) / wedge.cos,
        }
    }

    /// Returns the volume of a slice with these boundary planes.
    #[must_use]
    pub fn volume(self, planes: WedgePlanes, ties: TieRule, wedge: HalfWedge) -> SliceVolume {
        match self {
            Self::Prism => SliceVolume::Frustum,
            Self::UserPlanes => SliceVolume::Wedge(planes, WedgeTest::UserPlanes(ties)),
            Self::ShaderPlanes => SliceVolume::Wedge(planes, WedgeTest::Shader(ties)),
            Self::Tapered(offset) => SliceVolume::Taper { offset, slope: taper_slope(offset, wedge) },
            Self::Parallel(q) => SliceVolume::Wedge(planes, WedgeTest::Parallel(q)),
            Self::Hyperbolic(b) => SliceVolume::Wedge(planes, WedgeTest::Hyperbolic(b)),
        }
    }

    pub(crate) fn check(self, wedge: HalfWedge) -> Result<(), SpatialError> {
        let (what, value, most) = match self {
            Self::Tapered(q) => ("clip.offset_px", q, wedge.radius * wedge.tan),
            Self::Parallel(q) => ("clip.offset_px", q, wedge.radius),
            Self::Hyperbolic(b) => ("clip.bias_px2", b, wedge.radius * wedge.radius),
            _ => return Ok(()),
        };
        require((0.0..=most).contains(&value), what, format_args!("0 to {most}"), value)
    }
}

fn taper_slope(offset: f64, wedge: HalfWedge) -> f64 {
    (wedge.radius * wedge.tan - offset) / wedge.radius
}
