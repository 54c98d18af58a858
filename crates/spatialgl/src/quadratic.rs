//! The hyperbolic clip as a quadratic function over the plane of a triangle, in screen coordinates. The hyperbolic clip
//! multiplies the distances from both boundary planes of a slice, adds a bias, and tests the sign. Hardware that
//! evaluates quadratics can use this form, for example the renderers of Pixel-Planes 5. **Beyond the SpatialGL paper.**

use crate::clip::HalfWedge;

/// The quadratic Q(u, v) = uu u^2 + uv u v + vv v^2 + u u + v v + one. u and v are the horizontal and the vertical
/// coordinate in the slice. The slice contains the samples at which Q is not negative.
///
/// Q is the product of the distances from both boundary planes of the slice, u^2 S^2 - s^2 C^2, plus the bias b. Here s
/// is the distance from the slice, and the triangle lies in the plane s = a u + c v + d. S and C are the sine and the
/// cosine of half the angle between slices. Coordinates are pixels of the slice, and values are square pixels. The
/// projection is orthographic, but projections with a shear or from a perspective eye also give quadratics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipQuadratic {
    /// Coefficient of u^2, dimensionless.
    pub uu: f64,
    /// Coefficient of u v, dimensionless.
    pub uv: f64,
    /// Coefficient of v^2, dimensionless.
    pub vv: f64,
    /// Coefficient of u, pixels.
    pub u: f64,
    /// Coefficient of v, pixels.
    pub v: f64,
    /// Constant coefficient, square pixels.
    pub one: f64,
}

impl ClipQuadratic {
    /// Returns the quadratic for the plane s = a u + c v + offset and a bias of `bias` square pixels. `slope` is (a,
    /// c).
    pub fn of_plane(slope: [f64; 2], offset: f64, wedge: HalfWedge, bias: f64) -> Self {
        let [a, c] = slope;
        let sine = wedge.sin * wedge.sin;
        let cosine = wedge.cos * wedge.cos;
        Self {
            uu: sine - a * a * cosine,
            uv: -2.0 * a * c * cosine,
            vv: -c * c * cosine,
            u: -2.0 * a * offset * cosine,
            v: -2.0 * c * offset * cosine,
            one: bias - offset * offset * cosine,
        }
    }

    /// Returns the quadratic for the plane through three corners (u, v, s). Returns `None` if the plane is
    /// perpendicular to the slice.
    pub fn of_corners(corners: [[f64; 3]; 3], wedge: HalfWedge, bias: f64) -> Option<Self> {
        let [first, second, third] = corners;
        let along = |axis: usize| [second[axis] - first[axis], third[axis] - first[axis]];
        let u = along(0);
        let v = along(1);
        let s = along(2);
        let area = u[0] * v[1] - u[1] * v[0];
        if area == 0.0 {
            return None;
        }
        // Cramer's rule gives the slope of the plane.
        let slope = [(s[0] * v[1] - s[1] * v[0]) / area, (u[0] * s[1] - u[1] * s[0]) / area];
        let offset = first[2] - slope[0] * first[0] - slope[1] * first[1];
        Some(Self::of_plane(slope, offset, wedge, bias))
    }

    pub fn at(&self, u: f64, v: f64) -> f64 {
        self.uu * u * u + self.uv * u * v + self.vv * v * v + self.u * u + self.v * v + self.one
    }
}
