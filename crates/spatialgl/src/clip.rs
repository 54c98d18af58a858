//! The six methods of clipping the scene to a slice on a swept display, with their near plane, far plane and bin
//! tolerance.

use crate::slice_volume::{SliceVolume, TieRule, WedgePlanes, WedgeTest};
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};

/// A method of clipping the scene to the volume of one slice. The slices are arranged around an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SliceClip {
    /// Clipping uses only the near and far planes of an orthographic projection. The clipped volume is a prism with the
    /// same thickness everywhere. The exact volume of a slice has this thickness only at the rim of the display.
    Prism,
    /// Each pass clips with two user clip planes. The volume of a slice is a double wedge around the axis, and each
    /// half (lobe) of the double wedge has its own pass.
    UserPlanes,
    /// The fragment program tests the product of the interpolated distances from the two boundary planes of the slice.
    /// This gives the exact volume in one pass.
    ShaderPlanes,
    /// Clip planes whose distance from the slice grows from q pixels at the axis to the exact half thickness at the
    /// rim. Each side of the axis has its own pass.
    Tapered(
        /// Half thickness q of the volume at the axis, in pixels.
        f64,
    ),
    /// The two boundary planes of the exact slice are moved outwards by q pixels.
    Parallel(
        /// Distance q by which the two planes are moved outwards, in pixels.
        f64,
    ),
    /// The fragment program tests the sign of a sum: the product of a point's distances from the two boundary planes,
    /// plus a bias b.
    Hyperbolic(
        /// Bias b that is added to the product of the distances, in square pixels.
        f64,
    ),
}

/// Distance by which the parallel and the tapered clip move planes outwards, in pixels. The value is assumed (0 to 2).
/// With half a pixel, the volume of a slice is at least one pixel thick everywhere.
pub const DEFAULT_OFFSET_PX: f64 = 0.5;

/// Bias of the hyperbolic clip, in square pixels. The assumed value (0 to 4) is the square of [`DEFAULT_OFFSET_PX`].
pub const DEFAULT_HYPERBOLIC_BIAS_PX2: f64 = 0.25;

/// Half of the wedge that one slice represents: sine, cosine and tangent of d/2, where d is the angle between slices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfWedge {
    pub sin: f64,
    pub cos: f64,
    pub tan: f64,
    /// Half the width of the image, in pixels.
    pub radius: f64,
}

impl HalfWedge {
    /// Returns half of the wedge of one slice, for a display with `slices` per turn and this radius in pixels.
    pub fn new(slices: u32, radius: f64) -> Self {
        let (sin, cos) = crate::angle::sin_cos_of_turn(1, 2 * slices);
        Self { sin, cos, tan: sin / cos, radius }
    }
}

impl SliceClip {
    /// All six methods with the default offset and bias, in the order of the SpatialGL paper.
    pub const ALL: [Self; 6] = [
        Self::Prism,
        Self::UserPlanes,
        Self::ShaderPlanes,
        Self::Tapered(DEFAULT_OFFSET_PX),
        Self::Parallel(DEFAULT_OFFSET_PX),
        Self::Hyperbolic(DEFAULT_HYPERBOLIC_BIAS_PX2),
    ];

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

    /// Returns the distance of the near and far planes from the slice, in pixels.
    pub fn reach(self, wedge: HalfWedge) -> f64 {
        let face = wedge.radius * wedge.sin;
        match self {
            Self::Parallel(q) => (face + q) / wedge.cos,
            Self::Hyperbolic(b) => libm::sqrt(face * face + b) / wedge.cos,
            _ => wedge.radius * wedge.tan,
        }
    }

    /// Returns the greatest distance in pixels from the exact wedge at which a slice still shows a point. Bins must
    /// allow for this distance.
    pub fn tolerance(self, wedge: HalfWedge) -> f64 {
        match self {
            Self::Prism => wedge.radius * wedge.tan,
            Self::UserPlanes | Self::ShaderPlanes => 0.0,
            Self::Tapered(q) | Self::Parallel(q) => q,
            Self::Hyperbolic(b) => libm::sqrt(b),
        }
    }

    /// Returns half the thickness of the slice's volume, in pixels, at the horizontal distance u from the axis.
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

    pub(crate) fn check(self, wedge: HalfWedge) -> Result<(), SettingError> {
        let (what, value, most) = match self {
            Self::Tapered(q) => ("clip.offset_px", q, wedge.radius * wedge.tan),
            Self::Parallel(q) => ("clip.offset_px", q, wedge.radius),
            Self::Hyperbolic(b) => ("clip.bias_px2", b, wedge.radius * wedge.radius),
            _ => return Ok(()),
        };
        SettingError::require((0.0..=most).contains(&value), what, format_args!("0 to {most}"), value)
    }
}

fn taper_slope(offset: f64, wedge: HalfWedge) -> f64 {
    (wedge.radius * wedge.tan - offset) / wedge.radius
}
