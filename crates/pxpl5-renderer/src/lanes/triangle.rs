//! Triangles by values: a vector of pixels at a time, masks instead of branches.

use super::bounds::Bounds;
use super::columns::Values;
use crate::array::PIXELS;
use crate::simd::{Kernel, Vector};
use pxpl5_wire::Linear;
use pxpl5_wire::format::{COLOUR_FRACTION_BITS, NORMAL_BITS, NORMAL_FRACTION_BITS};

const WIDTH: usize = 128;

/// A linear expression at some pixels in a row.
#[derive(Clone, Copy)]
pub(super) struct Walk<V> {
    value: V,
    step: V,
}

impl<V: Vector> Walk<V> {
    #[inline(always)]
    fn start(e: &Linear, x: usize, y: usize) -> Self {
        Self { value: V::ramp(e.at(x as i32, y as i32), e.a), step: V::splat(e.a.wrapping_mul(V::LANES as i32)) }
    }

    #[inline(always)]
    fn advance(&mut self) {
        self.value = self.value.add(self.step);
    }
}

/// What a command stores in the pixels that pass.
pub(super) trait Paint {
    /// Expressions that it walks along.
    fn components(&self) -> &[Linear; 3];
    /// Stores pixels from index `at` where the mask is true.
    fn store<V: Vector>(&mut self, walks: &[Walk<V>; 3], at: usize, mask: V::Mask);
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
    fn run<V: Vector>(mut self) {
        let Some(bounds) = Bounds::of(&self.edges) else { return };
        for y in bounds.area.top..bounds.area.bottom {
            let (left, right) = bounds.row(y);
            self.row::<V>(y, left / V::LANES * V::LANES, right);
        }
    }
}

impl<P: Paint> DrawTriangle<'_, P> {
    #[inline(always)]
    fn row<V: Vector>(&mut self, y: usize, left: usize, right: usize) {
        let [mut first, mut second, mut third] = three::<V>(&self.edges, left, y);
        let mut depth = Walk::<V>::start(&self.depth, left, y);
        let mut walks = three::<V>(self.paint.components(), left, y);
        for x in (left..right).step_by(V::LANES) {
            let at = y * WIDTH + x;
            let inside = first.value.or(second.value).or(third.value);
            let (old, new) = (V::load(&self.z.0[at..]), depth.value.shift_right(self.z_shift.into()));
            let mask = inside.passes(new, old);
            new.store(mask, old, &mut self.z.0[at..]);
            self.paint.store(&walks, at, mask);
            if let Some(enable) = &mut self.enable {
                V::store_mask(mask, &mut enable[at..]);
            }
            first.advance();
            second.advance();
            third.advance();
            depth.advance();
            walks[0].advance();
            walks[1].advance();
            walks[2].advance();
        }
    }
}

/// Written out, because a closure over an array would be compiled apart, without the vector unit's features.
#[inline(always)]
fn three<V: Vector>(e: &[Linear; 3], x: usize, y: usize) -> [Walk<V>; 3] {
    [Walk::start(&e[0], x, y), Walk::start(&e[1], x, y), Walk::start(&e[2], x, y)]
}

#[inline(always)]
fn blend<V: Vector>(column: &mut Values, at: usize, mask: V::Mask, new: V) {
    let old = V::load(&column.0[at..]);
    new.store(mask, old, &mut column.0[at..]);
}

/// Interpolated colour.
pub(super) struct Gouraud<'a> {
    pub(super) components: [Linear; 3],
    pub(super) colour: &'a mut Values,
}

impl Paint for Gouraud<'_> {
    #[inline(always)]
    fn components(&self) -> &[Linear; 3] {
        &self.components
    }

    #[inline(always)]
    fn store<V: Vector>(&mut self, [red, green, blue]: &[Walk<V>; 3], at: usize, mask: V::Mask) {
        // Each component goes to its place in one shift.
        let red = red.value.shift_left(16 - COLOUR_FRACTION_BITS).and(V::splat(0xff_0000));
        let green = green.value.shift_right(COLOUR_FRACTION_BITS - 8).and(V::splat(0xff00));
        let blue = blue.value.shift_right(COLOUR_FRACTION_BITS).and(V::splat(0xff));
        blend(self.colour, at, mask, red.or(green).or(blue));
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
    #[inline(always)]
    fn components(&self) -> &[Linear; 3] {
        &self.components
    }

    #[inline(always)]
    fn store<V: Vector>(&mut self, walks: &[Walk<V>; 3], at: usize, mask: V::Mask) {
        let twelve = V::splat((1 << NORMAL_BITS) - 1);
        for (walk, column) in walks.iter().zip(self.normal.iter_mut()) {
            blend(column, at, mask, walk.value.shift_right(NORMAL_FRACTION_BITS).and(twelve));
        }
        blend(self.colour, at, mask, V::splat(self.constant as i32));
    }
}
