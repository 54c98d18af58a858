use serde::{Deserialize, Serialize};

/// The expression `a x + b y + c` at the integer pixel (x, y) of the screen, in 32-bit two's complement (sums wrap).
///
/// It applies to the centre of the pixel, so code that computes `c` must include the offset from the pixel's corner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Linear {
    /// Increase of the value from a pixel to its right neighbour.
    pub a: i32,
    /// Increase of the value from a pixel to the pixel below.
    pub b: i32,
    /// Value of the expression at pixel (0, 0).
    pub c: i32,
}

impl Linear {
    pub const fn constant(c: i32) -> Self {
        Self { a: 0, b: 0, c }
    }

    pub const fn at(&self, x: i32, y: i32) -> i32 {
        let ax = self.a.wrapping_mul(x);
        ax.wrapping_add(self.b.wrapping_mul(y)).wrapping_add(self.c)
    }
}

/// Number of triangles whose expressions are stored side by side. Eight `f64` values, one for each triangle, fill the
/// widest vector register of host processors.
pub const LANES: usize = 8;

/// The linear expressions of [`LANES`] triangles, with one array for each coefficient.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinearLanes {
    pub a: [i32; LANES],
    pub b: [i32; LANES],
    pub c: [i32; LANES],
}

impl LinearLanes {
    /// Returns the expression of triangle `i`.
    ///
    /// # Panics
    /// Panics if `i` is not below [`LANES`].
    #[inline(always)]
    pub const fn get(&self, i: usize) -> Linear {
        Linear { a: self.a[i], b: self.b[i], c: self.c[i] }
    }
}

/// Up to [`LANES`] triangles with the expressions of their renderer commands.
#[derive(Clone, Copy, Debug)]
pub struct TriangleBatch<'a> {
    /// Number of triangles in the batch, at most [`LANES`].
    pub len: usize,
    /// Edge expressions of the triangles. A pixel is covered if all three values are at least 0.
    pub edges: &'a [LinearLanes; 3],
    /// Plane expressions of the triangles. The first expression is the depth. The other three expressions are red,
    /// green and blue, or the components x, y and z of the normal.
    pub planes: &'a [LinearLanes; 4],
    /// Colours 0x00RRGGBB of triangles with normals, or `None` for triangles with colour expressions.
    pub colours: Option<[u32; LANES]>,
}

/// The expression `xx x^2 + xy x y + yy y^2 + x x + y y + one` at the integer pixel (x, y). Sums wrap in 64-bit two's
/// complement.
///
/// The machine's evaluator computes `A x^2 + B x y + C y^2 + D x + E y + F` (F89). Two words per coefficient are
/// assumed, because 32 bits do not have both the range of a screen and the precision for the silhouette of a small
/// sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Quadratic {
    /// Coefficient of x squared, A in F89.
    pub xx: i64,
    /// Coefficient of x y, B in F89.
    pub xy: i64,
    /// Coefficient of y squared, C in F89.
    pub yy: i64,
    /// Coefficient of x, D in F89.
    pub x: i64,
    /// Coefficient of y, E in F89.
    pub y: i64,
    /// Constant term, F in F89.
    pub one: i64,
}

impl Quadratic {
    pub const fn at(&self, x: i32, y: i32) -> i64 {
        let px = x as i64;
        let py = y as i64;
        // Horner's scheme, with wrapping sums as in the machine.
        let row = self.xx.wrapping_mul(px).wrapping_add(self.xy.wrapping_mul(py)).wrapping_add(self.x);
        let column = self.yy.wrapping_mul(py).wrapping_add(self.y);
        row.wrapping_mul(px).wrapping_add(column.wrapping_mul(py)).wrapping_add(self.one)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_expression_is_exact_modulo_two_to_the_32() {
        let e = Linear { a: i32::MAX, b: -7, c: i32::MIN };
        let exact = i64::from(i32::MAX) * 639 - 7 * 479 + i64::from(i32::MIN);
        assert_eq!(e.at(639, 479), exact as i32);
    }

    #[test]
    fn a_circle_is_zero_on_its_rim_and_positive_inside() {
        // 25 - (x - 10)^2 - (y - 20)^2 expanded.
        let q = Quadratic { xx: -1, xy: 0, yy: -1, x: 20, y: 40, one: 25 - 100 - 400 };
        assert_eq!((q.at(10, 20), q.at(13, 24), q.at(15, 20)), (25, 0, 0));
        assert_eq!(q.at(16, 20), -11);
    }
}
