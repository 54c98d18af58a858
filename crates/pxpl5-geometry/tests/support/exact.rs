//! Exact geometry in integers of any length, from the same 32-bit floating-point input as the pipeline.
//!
//! Every f32 is an integer times 2^-149, so no division is needed if all clip coordinates of a triangle have a common
//! scale. Coverage, depth and colour at a pixel are ratios of integers that are linear in the pixel's coordinates. The
//! method is homogeneous rasterization (Olano and Greer, *Triangle scan conversion using 2D homogeneous coordinates*,
//! 1997).

use super::{HEIGHT, WIDTH};
use glam::{Mat4, Vec3};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, ToPrimitive, Zero};
use pxpl5_geometry::{Triangle, ViewTransform};

/// The linear form `a x + b y + c` at pixel (x, y).
#[derive(Clone, Debug)]
pub struct Form {
    pub a: BigInt,
    pub b: BigInt,
    pub c: BigInt,
}

impl Form {
    pub fn at(&self, x: i32, y: i32) -> BigInt {
        &self.a * x + &self.b * y + &self.c
    }

    /// Returns the sum of `weights[i] * forms[i]`.
    fn sum(forms: &[Self; 3], weights: &[BigInt; 3]) -> Self {
        let [f, g, h] = forms;
        Self {
            a: weighted([&f.a, &g.a, &h.a], weights),
            b: weighted([&f.b, &g.b, &h.b], weights),
            c: weighted([&f.c, &g.c, &h.c], weights),
        }
    }

    fn negated(self) -> Self {
        Self { a: -self.a, b: -self.b, c: -self.c }
    }

    /// Narrows a range of x to the pixels at which the form at row y is at least `least`.
    fn narrow(&self, y: i32, least: i32, range: &mut [i32; 2]) {
        let needed: BigInt = BigInt::from(least) - &self.b * y - &self.c;
        if self.a.is_zero() {
            if needed.is_positive() {
                *range = [0, -1];
            }
        } else if self.a.is_positive() {
            range[0] = range[0].max(pixel(&needed.div_ceil(&self.a)));
        } else {
            range[1] = range[1].min(pixel(&needed.div_floor(&self.a)));
        }
    }

    /// Returns 1 if a pixel centre on the line is outside, else 0. The tie rule includes only top and left edges.
    fn least(&self) -> i32 {
        let top_left = self.a.is_positive() || (self.a.is_zero() && self.b.is_positive());
        i32::from(!top_left)
    }
}

fn weighted(values: [&BigInt; 3], weights: &[BigInt; 3]) -> BigInt {
    values.iter().zip(weights).map(|(value, weight)| *value * weight).sum()
}

/// Converts a number to a pixel coordinate. A number outside the frame becomes a coordinate beyond the same side of the
/// frame.
fn pixel(number: &BigInt) -> i32 {
    number.to_i32().unwrap_or(if number.is_negative() { -1 } else { WIDTH })
}

/// Returns a ratio as a floating-point number, with an error of about 2^-40.
pub fn ratio(numerator: &BigInt, denominator: &BigInt) -> f64 {
    let scaled = (numerator << 40_u32).div_floor(denominator);
    scaled.to_f64().unwrap_or(f64::MAX) / (1_u64 << 40) as f64
}

/// Returns an f32 times 2^149. Infinities and NaN do not occur in cases.
pub fn fixed(v: f32) -> BigInt {
    let bits = v.to_bits();
    let exponent = (bits >> 23) & 0xff;
    let mantissa = bits & 0x7f_ffff;
    assert!(exponent != 0xff, "the oracle takes finite numbers only");
    let magnitude = match exponent {
        0 => BigInt::from(mantissa),
        _ => BigInt::from(mantissa | 0x80_0000) << (exponent - 1),
    };
    if v.is_sign_negative() { -magnitude } else { magnitude }
}

fn times(matrix: &Mat4, v: &[BigInt; 4]) -> [BigInt; 4] {
    let columns = matrix.to_cols_array_2d();
    std::array::from_fn(|row| (0..4).map(|k| fixed(columns[k][row]) * &v[k]).sum())
}

/// Returns the clip coordinates of a point, times 2^447.
pub fn clip(view: &ViewTransform, point: Vec3) -> [BigInt; 4] {
    let world = [point.x, point.y, point.z, 1.0].map(fixed);
    times(&view.projection, &times(&view.model_view, &world))
}

/// A triangle's coverage, depth and colour on the frame, without any rounding.
#[derive(Clone, Debug)]
pub struct ExactTriangle {
    edges: [Form; 3],
    /// Numerator of the depth, whose denominator is `scale`.
    depth: Form,
    colour: [Form; 3],
    scale: BigInt,
    /// True if neither the near nor the far plane cuts the triangle, so that colours are linear on the screen.
    pub whole: bool,
    /// Clip coordinates on a common scale.
    pub corners: [[BigInt; 4]; 3],
}

impl ExactTriangle {
    /// Creates the exact triangle. Returns `None` if the triangle is seen edge-on or has no area, so that it covers no
    /// pixel.
    pub fn new(view: &ViewTransform, triangle: &Triangle) -> Option<Self> {
        let corners = reduced(triangle.positions.map(|p| clip(view, p)));
        let screen: [[BigInt; 3]; 3] = std::array::from_fn(|i| {
            let [x, y, _, w] = &corners[i];
            [(w + x) * WIDTH, (w - y) * HEIGHT, w * 2]
        });
        let mut edges = [[1, 2], [2, 0], [0, 1]].map(|[from, to]| {
            let [x, y, w] = cross(&screen[from], &screen[to]);
            Form { a: &x * 2, b: &y * 2, c: x + y + w * 2 }
        });
        let mut scale = dot(&screen[0], &cross(&screen[1], &screen[2]));
        if scale.is_zero() {
            return None;
        }
        if scale.is_negative() {
            scale = -scale;
            edges = edges.map(Form::negated);
        }
        let depth = Form::sum(&edges, &corners.clone().map(|[_, _, z, _]| z));
        let colour = std::array::from_fn(|i| {
            let weights = std::array::from_fn(|k| &corners[k][3] * triangle.colours[k][i]);
            Form::sum(&edges, &weights)
        });
        let whole = corners.iter().all(|[_, _, z, w]| !z.is_negative() && z <= w);
        Some(Self { edges, depth, colour, scale, whole, corners })
    }

    /// Returns the first and last covered pixel of a row of the frame. The row is empty if the first pixel is greater
    /// than the last pixel.
    pub fn span(&self, y: i32) -> [i32; 2] {
        let mut range = [0, WIDTH - 1];
        for edge in &self.edges {
            edge.narrow(y, edge.least(), &mut range);
        }
        self.depth.narrow(y, 0, &mut range);
        let to_far = Form { a: -&self.depth.a, b: -&self.depth.b, c: &self.scale - &self.depth.c };
        to_far.narrow(y, 0, &mut range);
        range
    }

    /// Returns the depth from 0 to 1 at a pixel.
    pub fn depth(&self, x: i32, y: i32) -> f64 {
        ratio(&self.depth.at(x, y), &self.scale)
    }

    /// Returns true if this triangle is nearer than another at a pixel.
    pub fn nearer_than(&self, other: &Self, x: i32, y: i32) -> bool {
        self.depth.at(x, y) * &other.scale < other.depth.at(x, y) * &self.scale
    }

    /// Returns a colour component from 0 to 255 at a pixel.
    pub fn colour(&self, component: usize, x: i32, y: i32) -> f64 {
        ratio(&self.colour[component].at(x, y), &self.scale)
    }
}

/// Removes the power of two that is common to all coordinates. The results do not depend on this power.
fn reduced(corners: [[BigInt; 4]; 3]) -> [[BigInt; 4]; 3] {
    let shift = corners.iter().flatten().filter_map(BigInt::trailing_zeros).min().unwrap_or(0);
    corners.map(|c| c.map(|v| v >> shift))
}

pub fn cross(a: &[BigInt; 3], b: &[BigInt; 3]) -> [BigInt; 3] {
    [[1, 2], [2, 0], [0, 1]].map(|[i, j]| &a[i] * &b[j] - &a[j] * &b[i])
}

fn dot(a: &[BigInt; 3], b: &[BigInt; 3]) -> BigInt {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
