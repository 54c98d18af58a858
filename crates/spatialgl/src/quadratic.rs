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
    #[must_use]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slice_volume::hyperbolic;
    use proptest::prelude::*;

    const WEDGE: fn() -> HalfWedge = || HalfWedge::new(396, 384.0);

    #[test]
    fn case_27_the_quadratic_of_a_plane_has_the_computed_coefficients_and_values() {
        let q = ClipQuadratic::of_plane([0.5, -0.25], -20.0, WEDGE(), 0.25);
        let expected = [-0.2499213, 0.2499843, -0.0624961, 19.9987413, -9.9993706, -399.7248255];
        for (found, expected) in [q.uu, q.uv, q.vv, q.u, q.v, q.one].into_iter().zip(expected) {
            assert!((found - expected).abs() < 6e-8, "{found}, not {expected}");
        }
        for (u, v, expected) in [(40.0, 0.0, 0.350_698), (39.0, -4.0, 0.095_742), (-200.0, -480.0, 2.767_447)] {
            assert!((q.at(u, v) - expected).abs() < 6e-7, "({u}, {v}): {}", q.at(u, v));
        }
    }

    /// Tests the number of fraction bits of the coefficients. S is the sine of half the angle between slices. With the
    /// 16 fraction bits of the renderers' format, S^2 would be 4 units, which is too coarse. With 26 bits, S^2 is 4,224
    /// units, and the quadratic fits into 48 bits.
    #[test]
    fn a_quadratic_with_26_fraction_bits_fits_into_48_bits_and_16_fraction_bits_are_too_coarse() {
        let square = WEDGE().sin * WEDGE().sin;
        assert!((square * f64::from(1 << 16) - 4.12).abs() < 0.01);
        assert!((square * f64::from(1 << 26) - 4_223.6).abs() < 0.1);
        assert!(768.0 * 768.0 * f64::from(1 << 26) < 2f64.powi(46));
    }

    proptest! {
        #[test]
        fn a_quadratic_has_the_sign_of_the_biased_product(
            corners in prop::array::uniform3(prop::array::uniform3(-300.0f64..300.0)),
            u in -384.0f64..384.0, v in -384.0f64..384.0, bias in 0.0f64..4.0,
        ) {
            let Some(q) = ClipQuadratic::of_corners(corners, WEDGE(), bias) else { return Ok(()) };
            let wedge = WEDGE();
            let [first, second, third] = corners;
            let weight = |p: [f64; 3], r: [f64; 3]| (p[0] - u) * (r[1] - v) - (p[1] - v) * (r[0] - u);
            let weights = [weight(second, third), weight(third, first), weight(first, second)];
            let area: f64 = weights.iter().sum();
            prop_assume!(area.abs() > 100.0);
            let s = (weights[0] * first[2] + weights[1] * second[2] + weights[2] * third[2]) / area;
            let a = u * wedge.sin + s * wedge.cos;
            let b = u * wedge.sin - s * wedge.cos;
            prop_assume!((a * b + bias).abs() > 1e-6 * (1.0 + s * s));
            prop_assert_eq!(q.at(u, v) >= 0.0, hyperbolic(a, b, 1.0, bias));
        }
    }
}
