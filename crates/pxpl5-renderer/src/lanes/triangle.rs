//! Triangles by values: a vector of pixels at a time, masks instead of branches.

use super::bounds::{Area, Boxes, Edges, SIDE_BY_SIDE};
use super::columns::Values;
use super::enable::Enable;
use super::template::{Template, starts_anew};
use crate::command::{COLOUR_AT, COMPONENTS_AT, DEPTH_AT, EDGES_AT, PHONG_WORDS, TRIANGLE_WORDS};
use crate::simd::{SimdVector, VectorKernel};
use pxpl5_wire::format::{COLOUR_FRACTION_BITS, NORMAL_BITS, NORMAL_FRACTION_BITS};
use pxpl5_wire::{Linear, Word};
use std::ops::Range;

const WIDTH: usize = 128;

/// A linear expression at some pixels in a row.
#[derive(Clone, Copy)]
pub(super) struct Walk<V> {
    value: V,
    step: V,
}

impl<V: SimdVector> Walk<V> {
    #[inline(always)]
    fn start(e: &Linear, x: i32, y: i32) -> Self {
        Self { value: V::ramp(e.at(x, y), e.a), step: V::splat(e.a.wrapping_mul(V::LANES as i32)) }
    }

    /// Some rows below, in all of which together the expression grows by `b`.
    #[inline(always)]
    fn below(&self, b: i32) -> Self {
        Self { value: self.value.add(V::splat(b)), step: self.step }
    }

    #[inline(always)]
    fn advance(&mut self) {
        self.value = self.value.add(self.step);
    }
}

/// What commands of `N` words store in the pixels that pass.
pub(super) trait PaintTriangle<const N: usize> {
    /// Takes what the command has besides expressions.
    fn begin(&mut self, words: &[Word; N]);
    /// Stores pixels from index `at` where the mask is true.
    fn store<V: SimdVector>(&mut self, walks: &[Walk<V>; 3], at: usize, mask: V::Mask);
}

/// All triangles of one kind at the start of `words`, as many as follow each other. Gives their number.
pub(super) struct DrawTriangles<'a, const N: usize, P> {
    pub(super) words: &'a [Word],
    pub(super) template: &'a Template<N>,
    /// Column and row of the picture that the array begins with.
    pub(super) origin: [i32; 2],
    pub(super) z_shift: u8,
    pub(super) z: &'a mut Values,
    pub(super) paint: P,
    pub(super) enable: &'a mut Enable,
}

/// A triangle being drawn.
struct CurrentTriangle<'a, const N: usize> {
    /// Over the array's own columns and rows.
    edges: [Linear; 3],
    words: &'a [Word; N],
    /// Somebody looks at Enable afterwards.
    keep: bool,
}

/// The depth test of a vector of pixels.
struct Tested<V: SimdVector> {
    old: V,
    new: V,
    mask: V::Mask,
}

impl<const N: usize, P: PaintTriangle<N>> VectorKernel for DrawTriangles<'_, N, P> {
    type Output = usize;

    #[inline(always)]
    fn run<V: SimdVector>(mut self) -> usize {
        let (commands, _) = self.words.as_chunks::<N>();
        let drawn = commands.iter().take_while(|command| self.template.fits(command)).count();
        // Whoever follows a triangle, but for the last, is one.
        let read_later = !starts_anew(self.words.get(drawn * N));
        let mut left = drawn;
        for some in commands[..drawn].chunks(SIDE_BY_SIDE) {
            let mut edges = Edges::default();
            take_edges(some, &mut edges);
            edges.localise(self.origin);
            let boxes = Boxes::enclosing(&edges);
            for (i, command) in some.iter().enumerate() {
                left -= 1;
                self.triangle::<V>(command, edges.get(i), &boxes, i, read_later && left == 0);
            }
        }
        drawn
    }
}

impl<const N: usize, P: PaintTriangle<N>> DrawTriangles<'_, N, P> {
    /// Triangle `i` of those with these boxes; `keep` says that somebody looks at Enable afterwards.
    #[inline(always)]
    fn triangle<V: SimdVector>(&mut self, words: &[Word; N], edges: [Linear; 3], boxes: &Boxes, i: usize, keep: bool) {
        let bounds = boxes.bounds(i, &edges);
        if keep {
            self.enable.emptied(bounds.map_or(0..0, |bounds| bounds.area.top..bounds.area.bottom));
        }
        let Some(bounds) = bounds else { return };
        let triangle = CurrentTriangle { edges, words, keep };
        self.paint.begin(words);
        let Area { left, right, top, bottom } = bounds.area;
        if let Some(x) = one_vector(left, right, V::LANES) {
            self.narrow::<V>(&triangle, x, top..bottom);
            return;
        }
        for y in top..bottom {
            let (left, right) = bounds.row(y);
            self.row::<V>(&triangle, y, left / V::LANES * V::LANES, right);
        }
    }

    /// The expression that stands at `at` among the words.
    #[inline(always)]
    fn walk<V: SimdVector>(&self, words: &[Word; N], at: usize, x: usize, y: usize) -> Walk<V> {
        let [a, b, c] = coefficients(words, at);
        let [left, top] = self.origin;
        Walk::start(&Linear { a, b, c }, left + x as i32, top + y as i32)
    }

    #[inline(always)]
    fn components<V: SimdVector>(&self, words: &[Word; N], x: usize, y: usize) -> [Walk<V>; 3] {
        let [i, j, k] = COMPONENTS_AT;
        [self.walk(words, i, x, y), self.walk(words, j, x, y), self.walk(words, k, x, y)]
    }

    /// One vector a row, from column `x`; two rows at a time, since branches that nobody can foretell cost more than a row
    /// outside of the triangle.
    #[inline(always)]
    fn narrow<V: SimdVector>(&mut self, triangle: &CurrentTriangle<N>, x: usize, rows: Range<usize>) {
        let pairs = rows.len().div_ceil(2);
        let top = rows.start.min(WIDTH - 2 * pairs);
        let [mut first, mut second, mut third] = three::<V>(&triangle.edges, x, top);
        let [p, q, r] = [triangle.edges[0].b, triangle.edges[1].b, triangle.edges[2].b];
        let mut depth = self.walk::<V>(triangle.words, DEPTH_AT, x, top);
        let deeper = triangle.words[DEPTH_AT + 1] as i32;
        for y in (0..pairs).map(|pair| top + 2 * pair) {
            let at = [y * WIDTH + x, (y + 1) * WIDTH + x];
            let lower = [first.below(p), second.below(q), third.below(r), depth.below(deeper)];
            let upper = self.test(at[0], [first, second, third], depth);
            let lower = self.test(at[1], [lower[0], lower[1], lower[2]], lower[3]);
            if V::any_of(upper.mask, lower.mask) {
                let walks = self.components::<V>(triangle.words, x, y);
                self.nearer(&upper, at[0], triangle.keep);
                self.paint.store(&walks, at[0], upper.mask);
                let walks = self.components_below(triangle.words, &walks);
                self.nearer(&lower, at[1], triangle.keep);
                self.paint.store(&walks, at[1], lower.mask);
            }
            first = first.below(2 * p);
            second = second.below(2 * q);
            third = third.below(2 * r);
            depth = depth.below(deeper.wrapping_mul(2));
        }
    }

    #[inline(always)]
    fn components_below<V: SimdVector>(&self, words: &[Word; N], [p, q, r]: &[Walk<V>; 3]) -> [Walk<V>; 3] {
        let [i, j, k] = COMPONENTS_AT.map(|at| words[at + 1] as i32);
        [p.below(i), q.below(j), r.below(k)]
    }

    #[inline(always)]
    fn row<V: SimdVector>(&mut self, triangle: &CurrentTriangle<N>, y: usize, left: usize, right: usize) {
        let [mut first, mut second, mut third] = three::<V>(&triangle.edges, left, y);
        let mut depth = self.walk::<V>(triangle.words, DEPTH_AT, left, y);
        let mut walks = self.components::<V>(triangle.words, left, y);
        for x in (left..right).step_by(V::LANES) {
            let at = y * WIDTH + x;
            let tested = self.test(at, [first, second, third], depth);
            if V::any_of(tested.mask, tested.mask) {
                self.nearer(&tested, at, triangle.keep);
                self.paint.store(&walks, at, tested.mask);
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

    /// Where no edge is negative and the depth is nearer.
    #[inline(always)]
    fn test<V: SimdVector>(&self, at: usize, [p, q, r]: [Walk<V>; 3], depth: Walk<V>) -> Tested<V> {
        let old = V::load(&self.z.0[at..]);
        let new = depth.value.shift_right(self.z_shift.into());
        Tested { old, new, mask: p.value.or(q.value).or(r.value).passes(new, old) }
    }

    #[inline(always)]
    fn nearer<V: SimdVector>(&mut self, tested: &Tested<V>, at: usize, keep: bool) {
        tested.new.store(tested.mask, tested.old, &mut self.z.0[at..]);
        if keep {
            V::store_mask(tested.mask, &mut self.enable.rows_in_use()[at..]);
        }
    }
}

/// Not inlined: the compiler would put vectors together number by number.
#[inline(never)]
fn take_edges<const N: usize>(commands: &[[Word; N]], edges: &mut Edges) {
    for (i, words) in commands.iter().enumerate().take(SIDE_BY_SIDE) {
        let [p, q, r] = EDGES_AT;
        edges.set(i, [coefficients(words, p), coefficients(words, q), coefficients(words, r)]);
    }
}

/// Where one vector that holds all the columns begins: at a multiple of its lanes, if that is possible. `None` where they
/// are too many.
#[inline(always)]
fn one_vector(left: usize, right: usize, lanes: usize) -> Option<usize> {
    let aligned = left / lanes * lanes;
    let begin = if right <= aligned + lanes { aligned } else { left.min(WIDTH - lanes) };
    (right <= begin + lanes).then_some(begin)
}

#[inline(always)]
fn coefficients<const N: usize>(words: &[Word; N], at: usize) -> [i32; 3] {
    [words[at] as i32, words[at + 1] as i32, words[at + 2] as i32]
}

/// Written out, because a closure over an array would be compiled apart, without the vector unit's features.
#[inline(always)]
fn three<V: SimdVector>(e: &[Linear; 3], x: usize, y: usize) -> [Walk<V>; 3] {
    let x = x as i32;
    let y = y as i32;
    [Walk::start(&e[0], x, y), Walk::start(&e[1], x, y), Walk::start(&e[2], x, y)]
}

#[inline(always)]
fn blend<V: SimdVector>(column: &mut Values, at: usize, mask: V::Mask, new: V) {
    let old = V::load(&column.0[at..]);
    new.store(mask, old, &mut column.0[at..]);
}

/// Stores interpolated colour, as 0x00RRGGBB.
pub(super) struct PaintGouraud<'a> {
    pub(super) colour: &'a mut Values,
}

impl PaintTriangle<TRIANGLE_WORDS> for PaintGouraud<'_> {
    #[inline(always)]
    fn begin(&mut self, _: &[Word; TRIANGLE_WORDS]) {}

    #[inline(always)]
    fn store<V: SimdVector>(&mut self, [red, green, blue]: &[Walk<V>; 3], at: usize, mask: V::Mask) {
        // Each component goes to its place in one shift.
        let red = red.value.shift_left(16 - COLOUR_FRACTION_BITS).and(V::splat(0xff_0000));
        let green = green.value.shift_right(COLOUR_FRACTION_BITS - 8).and(V::splat(0xff00));
        let blue = blue.value.shift_right(COLOUR_FRACTION_BITS).and(V::splat(0xff));
        blend(self.colour, at, mask, red.or(green).or(blue));
    }
}

/// Interpolated normals and the object's colour.
pub(super) struct PaintPhong<'a> {
    pub(super) normal: [&'a mut Values; 3],
    pub(super) constant: u32,
    pub(super) colour: &'a mut Values,
}

impl PaintTriangle<PHONG_WORDS> for PaintPhong<'_> {
    #[inline(always)]
    fn begin(&mut self, words: &[Word; PHONG_WORDS]) {
        self.constant = words[COLOUR_AT] & 0xff_ffff;
    }

    #[inline(always)]
    fn store<V: SimdVector>(&mut self, walks: &[Walk<V>; 3], at: usize, mask: V::Mask) {
        let twelve = V::splat((1 << NORMAL_BITS) - 1);
        for (walk, column) in walks.iter().zip(self.normal.iter_mut()) {
            blend(column, at, mask, walk.value.shift_right(NORMAL_FRACTION_BITS).and(twelve));
        }
        blend(self.colour, at, mask, V::splat(self.constant as i32));
    }
}
