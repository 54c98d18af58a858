//! The projection of spheres: the part of a projection matrix that spheres need.

use crate::newton::reciprocal_double;
use crate::screen::{DEPTH_FAR, DEPTH_NEAR};
use crate::view::Columns;

/// Mapping from eye coordinates to pixels and depths, as needed for spheres.
///
/// Depth is `constant + slope u`, between 0 and 1. Let t be the distance along -Z. With a perspective projection, u is
/// 1/t. With a parallel projection, u is -t.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lens {
    /// True if the projection is parallel, so that distance does not change sizes.
    pub(crate) parallel: bool,
    /// Width and height of a pixel in units of eye coordinates. Under perspective, the values hold at distance 1 from
    /// the eye. The height is negative, because y increases downwards for pixels and upwards for the eye.
    pub(crate) step: [f64; 2],
    /// Number of pixels per unit of eye coordinates, along x and y. Under perspective, the numbers hold at distance 1
    /// from the eye.
    pub(crate) rate: [f64; 2],
    /// Eye x and y of the centre of the frame's pixel (0, 0), at distance 1 for a perspective projection.
    pub(crate) corner: [f64; 2],
    /// Coefficients of t and 1 in a linear expression of the distance t. The expression `near` is negative before the
    /// near plane, and the expression `far` is positive behind the far plane.
    ///
    /// With a parallel projection, the expressions are depth and depth - 1. With perspective, the expressions are these
    /// values times t.
    pub(crate) near: [f64; 2],
    pub(crate) far: [f64; 2],
    /// Largest distance t along -Z at which a point still counts as behind the eye.
    pub(crate) least: f64,
    /// Coefficients of the depth `base + reach u`, in units of the depth expression. [`Lens`] defines u.
    pub(crate) base: f64,
    pub(crate) reach: f64,
}

/// Distance from the near to the far plane, in units of the depth expression.
pub(crate) const DEPTH_RANGE: f64 = (DEPTH_FAR - DEPTH_NEAR) as f64;

/// Returns the centre of the frame's pixel (0, 0) in normalized device coordinates.
pub(crate) fn first_pixel(width: u32, lines: u32) -> [f64; 2] {
    [1.0 / f64::from(width) - 1.0, 1.0 - 1.0 / f64::from(lines)]
}

/// Returns two factors from normalized device coordinates to pixels: half the frame's width, and minus half its height.
pub(crate) fn half_frame(width: u32, lines: u32) -> [f64; 2] {
    [f64::from(width) * 0.5, f64::from(lines) * -0.5]
}

impl Lens {
    /// Creates a lens from a perspective or parallel projection along -Z. The projection may be off centre. Returns
    /// `None` for other matrices.
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

    /// Returns true if a point at distance t along -Z is between the eye and the near plane, or behind the eye.
    pub(crate) fn is_before_near(&self, t: f64) -> bool {
        t <= self.least || self.near[0] * t + self.near[1] < 0.0
    }

    /// Returns true if a point at distance t along -Z is behind the far plane. Under perspective, t must be positive.
    pub(crate) fn is_beyond_far(&self, t: f64) -> bool {
        self.far[0] * t + self.far[1] > 0.0
    }

    /// Returns the depth at distance t along -Z, in units of the depth expression.
    pub(crate) fn depth(&self, t: f64) -> f64 {
        let u = if self.parallel { -t } else { reciprocal_double(t) };
        self.base + self.reach * u
    }

    /// Returns the pixel coordinates of a point (x, y) of the plane t = 1 in eye coordinates. Under a parallel
    /// projection, the point can be in any plane.
    pub(crate) fn pixel(&self, x: f64, y: f64) -> [f64; 2] {
        [(x - self.corner[0]) * self.rate[0], (y - self.corner[1]) * self.rate[1]]
    }
}
