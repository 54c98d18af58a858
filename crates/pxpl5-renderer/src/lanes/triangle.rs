//! Triangles by values: eight pixels at a time, masks instead of branches.

use super::bounds::Bounds;
use crate::array::PIXELS;
use crate::simd::Kernel;
use pxpl5_wire::Linear;
use pxpl5_wire::format::{COLOUR_FRACTION_BITS, NORMAL_BITS, NORMAL_FRACTION_BITS};

/// Pixels of one step; 128 is a multiple.
const STEP: usize = 8;
const WIDTH: usize = 128;

pub(super) type Vector = [i32; STEP];

/// A column of pixel memory.
pub(super) type Values = [u32; PIXELS];

/// A linear expression at eight pixels in a row.
#[derive(Clone, Copy)]
pub(super) struct Walk {
    value: Vector,
    step: i32,
}

impl Walk {
    #[inline(always)]
    fn start(e: &Linear, x: usize, y: usize) -> Self {
        let first = e.at(x as i32, y as i32);
        Self {
            value: std::array::from_fn(|k| first.wrapping_add(e.a.wrapping_mul(k as i32))),
            step: e.a.wrapping_mul(STEP as i32),
        }
    }

    #[inline(always)]
    fn advance(&mut self) {
        self.value.iter_mut().for_each(|v| *v = v.wrapping_add(self.step));
    }
}

/// What a command stores in the pixels that pass.
pub(super) trait Paint {
    type Row;
    fn start(&self, x: usize, y: usize) -> Self::Row;
    /// Stores eight pixels from index `at` where the mask is all ones, and advances.
    fn store(&mut self, row: &mut Self::Row, at: usize, mask: &Vector);
}

/// A triangle over the array's own columns and rows.
pub(super) struct DrawTriangle<'a, P> {
    pub(super) edges: [Linear; 3],
    pub(super) depth: Linear,
    pub(super) z_shift: u8,
    pub(super) z: &'a mut Values,
    pub(super) paint: P,
    /// Where somebody looks at Enable afterwards; all zero on entry.
    pub(super) enable: Option<&'a mut [u8; PIXELS]>,
}

impl<P: Paint> Kernel for DrawTriangle<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run(mut self) {
        let Some(bounds) = Bounds::of(&self.edges) else { return };
        for y in bounds.area.top..bounds.area.bottom {
            let (left, right) = bounds.row(y);
            self.row(y, left / STEP * STEP, right);
        }
    }
}

impl<P: Paint> DrawTriangle<'_, P> {
    #[inline(always)]
    fn row(&mut self, y: usize, left: usize, right: usize) {
        let mut edges = self.edges.each_ref().map(|e| Walk::start(e, left, y));
        let mut depth = Walk::start(&self.depth, left, y);
        let mut paint = self.paint.start(left, y);
        for x in (left..right).step_by(STEP) {
            let at = (y * WIDTH + x) % PIXELS;
            let old: &mut [u32; STEP] = (&mut self.z[at..at + STEP]).try_into().expect("eight");
            let new = depth.value.map(|d| d as u32 >> self.z_shift);
            let mask: Vector = std::array::from_fn(|k| {
                let outside = (edges[0].value[k] | edges[1].value[k] | edges[2].value[k]) >> 31;
                let nearer = -i32::from(new[k] < old[k]);
                nearer & !outside
            });
            *old = std::array::from_fn(|k| select(mask[k], new[k], old[k]));
            self.paint.store(&mut paint, at, &mask);
            if let Some(enable) = &mut self.enable {
                enable[at..at + STEP].copy_from_slice(&mask.map(|m| m as u8));
            }
            edges.iter_mut().for_each(Walk::advance);
            depth.advance();
        }
    }
}

#[inline(always)]
const fn select(mask: i32, new: u32, old: u32) -> u32 {
    new & mask as u32 | old & !mask as u32
}

#[inline(always)]
fn blend(column: &mut Values, at: usize, mask: &Vector, new: [u32; STEP]) {
    let old: &mut [u32; STEP] = (&mut column[at..at + STEP]).try_into().expect("eight");
    *old = std::array::from_fn(|k| select(mask[k], new[k], old[k]));
}

/// Interpolated colour.
pub(super) struct Gouraud<'a> {
    pub(super) components: [Linear; 3],
    pub(super) colour: &'a mut Values,
}

impl Paint for Gouraud<'_> {
    type Row = [Walk; 3];

    #[inline(always)]
    fn start(&self, x: usize, y: usize) -> Self::Row {
        self.components.each_ref().map(|e| Walk::start(e, x, y))
    }

    #[inline(always)]
    fn store(&mut self, row: &mut Self::Row, at: usize, mask: &Vector) {
        let [red, green, blue] = row.each_ref().map(|walk| walk.value);
        let rgb = std::array::from_fn(|k| {
            let byte = |v: i32| v as u32 >> COLOUR_FRACTION_BITS & 255;
            byte(red[k]) << 16 | byte(green[k]) << 8 | byte(blue[k])
        });
        blend(self.colour, at, mask, rgb);
        row.iter_mut().for_each(Walk::advance);
    }
}

/// Interpolated normals and the object's colour.
pub(super) struct Phong<'a> {
    pub(super) components: [Linear; 3],
    pub(super) normal: [&'a mut Values; 3],
    pub(super) constant: u32,
    pub(super) colour: &'a mut Values,
}

impl Paint for Phong<'_> {
    type Row = [Walk; 3];

    #[inline(always)]
    fn start(&self, x: usize, y: usize) -> Self::Row {
        self.components.each_ref().map(|e| Walk::start(e, x, y))
    }

    #[inline(always)]
    fn store(&mut self, row: &mut Self::Row, at: usize, mask: &Vector) {
        for (walk, column) in row.iter_mut().zip(&mut self.normal) {
            let bits = walk.value.map(|v| v as u32 >> NORMAL_FRACTION_BITS & ((1 << NORMAL_BITS) - 1));
            blend(column, at, mask, bits);
            walk.advance();
        }
        blend(self.colour, at, mask, [self.constant; STEP]);
    }
}
