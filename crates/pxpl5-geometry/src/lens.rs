//! The part of a projection matrix that spheres need.

use crate::newton::reciprocal_double;
use crate::screen::{DEPTH_FAR, DEPTH_NEAR};
use crate::view::Columns;

/// A projection from eye coordinates to pixels and depths, for spheres.
///
/// Let t be the distance from the eye along -Z. A depth from 0 to 1 is `constant + slope u`. Here u is 1/t with
/// perspective, and -t with a parallel projection.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lens {
    pub(crate) parallel: bool,
    /// Width and height of a pixel in eye coordinates, at distance 1 if there is perspective. The height is negative,
    /// because pixels count downwards.
    pub(crate) step: [f64; 2],
    /// Number of pixels per unit of eye coordinates along x and y, at distance 1 if there is perspective.
    pub(crate) rate: [f64; 2],
    /// x and y of the centre of pixel (0, 0) in eye coordinates, at distance 1 if there is perspective.
    pub(crate) corner: [f64; 2],
    /// Coefficients (of t, of 1) of an expression of the distance t that is negative before the near plane. The
    /// expression of `far` is positive behind the far plane.
    ///
    /// With a parallel projection, the two expressions are depth and depth - 1. With perspective, they are t depth and
    /// t (depth - 1).
    pub(crate) near: [f64; 2],
    pub(crate) far: [f64; 2],
    /// Largest distance t at which a point still counts as behind the eye.
    pub(crate) least: f64,
    /// Coefficients of the depth `base + reach u` in fixed point.
    pub(crate) base: f64,
    pub(crate) reach: f64,
}

pub(crate) const DEPTH_RANGE: f64 = (DEPTH_FAR - DEPTH_NEAR) as f64;

/// Returns the centre of pixel (0, 0) in normalized device coordinates.
pub(crate) fn first_pixel(width: u32, lines: u32) -> [f64; 2] {
    [1.0 / f64::from(width) - 1.0, 1.0 - 1.0 / f64::from(lines)]
}

/// Returns the factors from normalized device coordinates to pixels: half the width, and minus half the height.
pub(crate) fn half_frame(width: u32, lines: u32) -> [f64; 2] {
    [f64::from(width) * 0.5, f64::from(lines) * -0.5]
}

impl Lens {
    /// Creates a lens from a perspective or parallel projection along -Z, or returns `None` for other matrices.
    pub(crate) fn from_projection(projection: &Columns, width: u32, lines: u32) -> Option<Self> {
        // Only matrices without rotation and shear are supported.
        if !projection.is_zero_at(&[(0, 1), (1, 0), (2, 0), (2, 1), (3, 0), (3, 1)]) {
            return None;
        }
        let parallel = match (projection.cell(3, 2), projection.cell(3, 3)) {
            (-1.0, 0.0) if projection.is_zero_at(&[(0, 3), (1, 3)]) => false,
            (0.0, 1.0) if projection.is_zero_at(&[(0, 2), (1, 2)]) => true,
            _ => return None,
        };
        // For both kinds of projection, compute the same four numbers.
        let [shift_x, shift_y, slope, constant] = if parallel {
            [-projection.cell(0, 3), -projection.cell(1, 3), projection.cell(2, 2), projection.cell(2, 3)]
        } else {
            [projection.cell(0, 2), projection.cell(1, 2), projection.cell(2, 3), -projection.cell(2, 2)]
        };
        let scale = [projection.cell(0, 0), projection.cell(1, 1)];
        let inverse = scale.map(reciprocal_double);
        let half = half_frame(width, lines);
        let first = first_pixel(width, lines);
        let lens = Self {
            parallel,
            step: [inverse[0] * (1.0 / half[0]), inverse[1] * (1.0 / half[1])],
            rate: [scale[0] * half[0], scale[1] * half[1]],
            corner: [(first[0] + shift_x) * inverse[0], (first[1] + shift_y) * inverse[1]],
            near: if parallel { [-slope, constant] } else { [constant, slope] },
            far: if parallel { [-slope, constant - 1.0] } else { [constant - 1.0, slope] },
            least: if parallel { -f64::MAX } else { 0.0 },
            base: f64::from(DEPTH_NEAR) + DEPTH_RANGE * constant,
            reach: DEPTH_RANGE * slope,
        };
        // A mirrored or reversed projection is not supported.
        (scale.iter().all(|scale| *scale > 0.0) && slope < 0.0).then_some(lens)
    }

    pub(crate) fn is_before_near(&self, t: f64) -> bool {
        t <= self.least || self.near[0] * t + self.near[1] < 0.0
    }

    pub(crate) fn is_beyond_far(&self, t: f64) -> bool {
        self.far[0] * t + self.far[1] > 0.0
    }

    pub(crate) fn depth(&self, t: f64) -> f64 {
        let u = if self.parallel { -t } else { reciprocal_double(t) };
        self.base + self.reach * u
    }

    /// Returns the pixel of a point (x, y) in the plane t = 1. With a parallel projection, the pixel is the same for
    /// every t.
    pub(crate) fn pixel(&self, x: f64, y: f64) -> [f64; 2] {
        [(x - self.corner[0]) * self.rate[0], (y - self.corner[1]) * self.rate[1]]
    }
}
