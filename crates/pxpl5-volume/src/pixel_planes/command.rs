//! The command that draws a triangle in a slice: three edge functions, the clip function (a hyperbola) and three
//! colours. The multiplier trees of the renderers evaluate all these functions.

use pxpl5_renderer::Layout;
use pxpl5_renderer::isa::{ArrayInstruction, Expression, ExpressionUse};
use pxpl5_wire::format::{COLOUR_FRACTION_BITS, SUBPIXEL_BITS};
use pxpl5_wire::{Linear, Quadratic, Word};
use spatialgl::{ClipQuadratic, HalfWedge, Size};

/// Number of fraction bits in the coefficients of the clip function (a hyperbola). A coefficient contains the term S^2,
/// where S is the sine of half the angle between slices. With the usual 16 bits, S^2 would be only 4 units. With 26
/// bits, S^2 is 4,224 units, and values inside a display of 768 px fit into 48 bits (derived).
pub const CLIP_FRACTION_BITS: u32 = 26;

/// A corner of a triangle, with its position rounded to the sub-pixel grid of the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliceCorner {
    /// Column and row from the top left of the image, in sixteenths of a pixel.
    pub place: [i32; 2],
    /// Distance of the corner from the slice, pixels.
    pub off: f64,
    /// Red, green and blue, 0 to 255.
    pub colour: [f64; 3],
}

/// A triangle in one slice, without depth. The triangle covers the pixels that lie inside all edges and at which the
/// clip function (a hyperbola) is not negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SliceTriangle {
    /// Edge functions, which are `>= 0` inside the triangle. The functions include the rule for pixels exactly on an
    /// edge.
    pub edges: [Linear; 3],
    /// The clip function A B + b on the triangle's plane, with [`CLIP_FRACTION_BITS`]. A and B are the distances from
    /// the boundary planes, and b is the bias.
    pub clip: Quadratic,
    /// Linear functions for red, green and blue. The coefficients have as many fraction bits as colours in ring
    /// messages.
    pub colour: [Linear; 3],
}

const STEPS: f64 = (1 << SUBPIXEL_BITS) as f64;

/// Largest coefficient of the clip function (a hyperbola), in units of the last fraction bit. Double precision cannot
/// represent every integer beyond this limit.
const LARGEST_COEFFICIENT: f64 = (1u64 << 53) as f64;

impl SliceTriangle {
    /// Creates the command for three corners in the image of a slice. Returns `None` for a triangle without area, or if
    /// the coefficients of its planes have too many bits for the machine.
    pub fn of_corners(corners: [SliceCorner; 3], size: Size, wedge: HalfWedge, bias: f64) -> Option<Self> {
        let [a, b, c] = corners.map(|corner| corner.place.map(i64::from));
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0 {
            return None;
        }
        let orientation = area.signum();
        let edges = [edge(b, c, orientation, size)?, edge(c, a, orientation, size)?, edge(a, b, orientation, size)?];
        let clip = clip(&corners, size, wedge, bias)?;
        let colour = |channel: usize| gradient(&corners, area as f64, channel);
        Some(Self { edges, clip, colour: [colour(0), colour(1), colour(2)] })
    }

    /// Returns the array instructions of the command, in the order of execution.
    pub fn program(&self, layout: &Layout) -> Vec<ArrayInstruction> {
        let mut program = vec![ArrayInstruction::EnableAll { label: 0 }];
        let disable = |expression| ArrayInstruction::Evaluate { expression, usage: ExpressionUse::DisableNegative };
        program.extend(self.edges.map(|edge| disable(Expression::Linear(edge))));
        program.push(disable(Expression::Quadratic(self.clip)));
        let shift = COLOUR_FRACTION_BITS as u8;
        for (i, plane) in (0..).zip(self.colour) {
            let usage = ExpressionUse::Load { field: layout.component(i), shift };
            program.push(ArrayInstruction::Evaluate { expression: Expression::Linear(plane), usage });
        }
        program
    }

    /// Returns the number of clocks in which an array executes the command. The number is the same for all operands.
    pub fn clocks(layout: &Layout) -> u32 {
        Self::default().program(layout).iter().map(ArrayInstruction::clocks).sum()
    }

    /// Returns the number of ring words of the command.
    pub fn words(layout: &Layout) -> usize {
        let mut words = Vec::new();
        Self::default().encode(layout, &mut words);
        words.len()
    }

    /// Appends the ring words of the command to `out`.
    pub fn encode(&self, layout: &Layout, out: &mut Vec<Word>) {
        self.program(layout).iter().for_each(|instruction| instruction.encode(out));
    }
}

/// Returns the exact edge function from one corner to the next, in units of 1/256 px^2, evaluated at the middle of each
/// pixel. One unit is subtracted if samples exactly on the edge belong to the neighbouring triangle.
fn edge(from: [i64; 2], to: [i64; 2], orientation: i64, [width, height]: Size) -> Option<Linear> {
    let steps = 1i64 << SUBPIXEL_BITS;
    let middle = steps / 2;
    let a = orientation * (from[1] - to[1]);
    let b = orientation * (to[0] - from[0]);
    let has_its_samples = a > 0 || (a == 0 && b > 0);
    let c = a * (middle - from[0]) + b * (middle - from[1]) - i64::from(!has_its_samples);
    let largest = (a * steps).abs() * i64::from(width) + (b * steps).abs() * i64::from(height) + c.abs();
    let fits = largest < 1 << 31;
    fits.then_some(Linear { a: (a * steps) as i32, b: (b * steps) as i32, c: c as i32 })
}

/// Returns the clip function (a hyperbola) on the triangle's plane as a quadratic, converted from coordinates of the
/// slice to pixels.
fn clip(corners: &[SliceCorner; 3], size: Size, wedge: HalfWedge, bias: f64) -> Option<Quadratic> {
    let [half_width, half_height] = size.map(|side| f64::from(side) / 2.0);
    let local = corners.map(|corner| {
        let [x, y] = corner.place.map(|place| f64::from(place) / STEPS);
        [x - half_width, half_height - y, corner.off]
    });
    let q = ClipQuadratic::of_corners(local, wedge, bias)?;
    // Substitute u = x + p and v = r - y at the middle of pixel (x, y).
    let p = 0.5 - half_width;
    let r = half_height - 0.5;
    let coefficients = [
        q.uu,
        -q.uv,
        q.vv,
        2.0 * q.uu * p + q.uv * r + q.u,
        -q.uv * p - 2.0 * q.vv * r - q.v,
        q.uu * p * p + q.uv * p * r + q.vv * r * r + q.u * p + q.v * r + q.one,
    ];
    // Round to units of the fixed-point format.
    let units = coefficients.map(|value| (value * f64::from(1 << CLIP_FRACTION_BITS)).round());
    if units.iter().any(|value| value.is_nan() || value.abs() > LARGEST_COEFFICIENT) {
        return None;
    }
    let [xx, xy, yy, x, y, one] = units.map(|value| value as i64);
    Some(Quadratic { xx, xy, yy, x, y, one })
}

/// Returns a colour channel as a linear function over the triangle. Half a level is added, so that truncation rounds to
/// the nearest level. If the triangle is so thin that the gradient has too many bits, the mean of the corners replaces
/// the linear function.
fn gradient(corners: &[SliceCorner; 3], area: f64, channel: usize) -> Linear {
    let one = f64::from(1 << COLOUR_FRACTION_BITS);
    let value = corners.map(|corner| corner.colour[channel]);
    let place = corners.map(|corner| corner.place.map(|place| f64::from(place) / STEPS));
    let along = |axis: usize| [place[1][axis] - place[0][axis], place[2][axis] - place[0][axis]];
    let rise = [value[1] - value[0], value[2] - value[0]];
    let x = along(0);
    let y = along(1);
    // Solve for the plane through the three values.
    let area_px = area / (STEPS * STEPS);
    let a = (rise[0] * y[1] - rise[1] * y[0]) / area_px;
    let b = (rise[1] * x[0] - rise[0] * x[1]) / area_px;
    let c = value[0] - a * (place[0][0] - 0.5) - b * (place[0][1] - 0.5) + 0.5;
    let planes = [a, b, c].map(|coefficient| (coefficient * one).round());
    if planes.iter().any(|plane| plane.abs() > f64::from(1 << 30)) {
        let mean = value.iter().sum::<f64>() / 3.0;
        return Linear::constant(((mean + 0.5) * one) as i32);
    }
    let [a, b, c] = planes.map(|plane| plane as i32);
    Linear { a, b, c }
}
