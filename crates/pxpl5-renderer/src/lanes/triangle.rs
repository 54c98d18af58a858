//! Fast drawing of triangles. Each step computes a vector of pixels, with masks instead of branches.

use super::bounds::{Area, Boxes, Edges, Spans};
use super::columns::Values;
use super::painter::{DepthTest, PaintTriangle, TrianglePainter, Walk};
use super::shape::{Shape, SingleRow};
use super::slim::SlimTriangles;
use super::template::{Template, next_enables_all};
use crate::command::{COMPONENTS_AT, DEPTH_AT, EDGES_AT};
use crate::simd::{SimdVector, VectorKernel};
use pxpl5_wire::format::{COLOUR_FRACTION_BITS, NORMAL_BITS, NORMAL_FRACTION_BITS};
use pxpl5_wire::{LANES, Linear, TriangleBatch, Word};
use std::ops::Range;

const WIDTH: usize = 128;

/// A linear expression in a form that is fast to evaluate for a vector of pixels anywhere in the array.
#[derive(Clone, Copy)]
struct Slope<V> {
    /// Values of the expression at the first pixels of the array's top row, one for each lane of the vector.
    begin: V,
    step: V,
    a: i32,
    b: i32,
}

impl<V: SimdVector> Slope<V> {
    /// Prepares an expression for fast evaluation. `left` and `top` are the coordinates of the array's upper left pixel
    /// in the picture.
    #[inline(always)]
    fn over(e: &Linear, [left, top]: [i32; 2]) -> Self {
        let Walk { value: begin, step } = Walk::start(e, left, top);
        Self { begin, step, a: e.a, b: e.b }
    }

    #[inline(always)]
    fn walk(&self, x: usize, y: usize) -> Walk<V> {
        let further = self.a.wrapping_mul(x as i32).wrapping_add(self.b.wrapping_mul(y as i32));
        Walk { value: self.begin.add(V::splat(further)), step: self.step }
    }
}

/// The expressions of a triangle that is wider than one vector. The first vector can begin at a different column in
/// each row.
struct WideTriangle<V> {
    edges: [Slope<V>; 3],
    depth: Slope<V>,
    components: [Slope<V>; 3],
}

pub(super) struct DrawTriangles<'a, const N: usize, P> {
    pub(super) words: &'a [Word],
    pub(super) template: &'a Template<N>,
    pub(super) painter: TrianglePainter<'a, P>,
}

/// Draws a batch of triangles without command words. Enable stays unchanged, because the next command overwrites Enable
/// before an instruction reads it.
pub(super) struct DrawBatch<'a, P> {
    pub(super) batch: &'a TriangleBatch<'a>,
    pub(super) painter: TrianglePainter<'a, P>,
}

/// Access to the depth, the colour or normal, and the object's colour of a triangle. The data are read only for
/// triangles that cover pixels. Expressions have the upper left pixel of the picture as origin of coordinates.
trait Surface {
    fn depth(&self) -> Linear;
    fn components(&self) -> [Linear; 3];
    /// Returns the colour of the triangle's object. The value is meaningless for a triangle with interpolated colour.
    fn colour(&self) -> Word;
}

impl<const N: usize> Surface for &[Word; N] {
    #[inline(always)]
    fn depth(&self) -> Linear {
        coefficients(self, DEPTH_AT)
    }

    #[inline(always)]
    fn components(&self) -> [Linear; 3] {
        let [p, q, r] = COMPONENTS_AT;
        [coefficients(self, p), coefficients(self, q), coefficients(self, r)]
    }

    /// Returns the last word of the command, which is the colour in Phong triangle commands.
    #[inline(always)]
    fn colour(&self) -> Word {
        self[N - 1]
    }
}

struct BatchSurface<'a> {
    batch: &'a TriangleBatch<'a>,
    i: usize,
}

impl Surface for BatchSurface<'_> {
    #[inline(always)]
    fn depth(&self) -> Linear {
        self.batch.planes[0].get(self.i)
    }

    #[inline(always)]
    fn components(&self) -> [Linear; 3] {
        let [_, p, q, r] = self.batch.planes;
        [p.get(self.i), q.get(self.i), r.get(self.i)]
    }

    #[inline(always)]
    fn colour(&self) -> Word {
        if let Some(colours) = &self.batch.colours { colours[self.i] } else { 0 }
    }
}

struct CurrentTriangle<S> {
    edges: [Linear; 3],
    surface: S,
    /// True if a later instruction can read the Enable bits of this triangle.
    keep: bool,
}

impl<const N: usize, P: PaintTriangle> VectorKernel for DrawTriangles<'_, N, P> {
    type Output = usize;

    #[inline(always)]
    fn run<V: SimdVector>(mut self) -> usize {
        let (commands, _) = self.words.as_chunks::<N>();
        let drawn = commands.iter().take_while(|command| self.template.fits(command)).count();
        // Each triangle overwrites Enable, so a later instruction can read only the Enable bits of the last triangle.
        let read_later = !next_enables_all(self.words.get(drawn * N));
        let mut left = drawn;
        for some in commands[..drawn].chunks(LANES) {
            let mut edges = Edges::default();
            take_edges(some, &mut edges);
            edges.localise(self.painter.origin);
            let boxes = Boxes::enclosing(&edges);
            for (i, words) in some.iter().enumerate() {
                left -= 1;
                let keep = read_later && left == 0;
                let triangle = CurrentTriangle { edges: edges.get(i), surface: words, keep };
                self.painter.triangle::<V, _>(&triangle, &boxes, i);
            }
        }
        drawn
    }
}

impl<P: PaintTriangle> VectorKernel for DrawBatch<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<V: SimdVector>(mut self) {
        let mut edges = Edges(*self.batch.edges);
        edges.localise(self.painter.origin);
        let boxes = Boxes::enclosing(&edges);
        // Slim triangles have their own code, which draws the whole triangle with one or a few vectors.
        let slim = SlimTriangles::among::<V>(&boxes, &edges, self.batch.planes, self.painter.origin);
        for i in 0..self.batch.len.min(LANES) {
            if slim.has(i) {
                slim.draw::<V, P>(&mut self.painter, self.batch, &edges, i);
                continue;
            }
            let surface = BatchSurface { batch: self.batch, i };
            let triangle = CurrentTriangle { edges: edges.get(i), surface, keep: false };
            self.painter.triangle::<V, _>(&triangle, &boxes, i);
        }
    }
}

impl<P: PaintTriangle> TrianglePainter<'_, P> {
    #[inline(always)]
    fn triangle<V: SimdVector, S: Surface>(&mut self, triangle: &CurrentTriangle<S>, boxes: &Boxes, i: usize) {
        let bounds = boxes.bounds(i, &triangle.edges);
        // Clear Enable, so that only the triangle's own pixels are set below.
        if triangle.keep {
            self.enable.emptied(bounds.map_or(0..0, |bounds| bounds.area.top..bounds.area.bottom));
        }
        let Some(bounds) = bounds else { return };
        self.paint.begin(triangle.surface.colour());
        let Area { left, right, top, bottom } = bounds.area;
        // Most triangles fit in one vector per row.
        if let Some(x) = one_vector(left, right, V::LANES) {
            self.narrow::<V, S>(triangle, x, top..bottom);
            return;
        }
        let wide = self.wide::<V, S>(triangle);
        // Wide triangles begin each row at a multiple of the vector's lanes.
        for first in (top..bottom).step_by(LANES) {
            let Spans { left, right } = bounds.spans(first);
            for (y, (left, right)) in (first..bottom).zip(left.iter().zip(right)) {
                self.row(&wide, y, *left as usize / V::LANES * V::LANES, right as usize, triangle.keep);
            }
        }
    }

    #[inline(always)]
    fn wide<V: SimdVector, S: Surface>(&self, triangle: &CurrentTriangle<S>) -> WideTriangle<V> {
        let [left, top] = self.origin;
        let [p, q, r] = triangle.surface.components();
        WideTriangle {
            edges: [
                Slope::over(&triangle.edges[0], [0, 0]),
                Slope::over(&triangle.edges[1], [0, 0]),
                Slope::over(&triangle.edges[2], [0, 0]),
            ],
            depth: Slope::over(&triangle.surface.depth(), [left, top]),
            components: [Slope::over(&p, [left, top]), Slope::over(&q, [left, top]), Slope::over(&r, [left, top])],
        }
    }

    /// Returns the values of an expression for a vector that begins at pixel (x, y) of the array. The expression has
    /// the upper left pixel of the picture as origin of coordinates.
    #[inline(always)]
    fn walk<V: SimdVector>(&self, e: &Linear, x: usize, y: usize) -> Walk<V> {
        let [left, top] = self.origin;
        Walk::start(e, left + x as i32, top + y as i32)
    }

    #[inline(always)]
    fn components<V: SimdVector>(&self, surface: &impl Surface, x: usize, y: usize) -> [Walk<V>; 3] {
        let [p, q, r] = surface.components();
        [self.walk(&p, x, y), self.walk(&q, x, y), self.walk(&r, x, y)]
    }

    /// Draws a triangle each of whose rows fits in one vector. The vectors begin at column `x`.
    ///
    /// Two rows are always drawn at a time, even if one of them lies outside the triangle. A branch to skip it would
    /// often be mispredicted, and would then take longer than the row.
    #[inline(always)]
    fn narrow<V: SimdVector, S: Surface>(&mut self, triangle: &CurrentTriangle<S>, x: usize, rows: Range<usize>) {
        let pairs = rows.len().div_ceil(2);
        let top = rows.start.min(WIDTH - 2 * pairs);
        let [mut first, mut second, mut third] = three::<V>(&triangle.edges, x, top);
        let [p, q, r] = [triangle.edges[0].b, triangle.edges[1].b, triangle.edges[2].b];
        let plane = triangle.surface.depth();
        let mut depth = self.walk::<V>(&plane, x, top);
        let deeper = plane.b;
        // Depth and edges advance by two rows at a time.
        for y in (0..pairs).map(|pair| top + 2 * pair) {
            let at = [y * WIDTH + x, (y + 1) * WIDTH + x];
            let lower = [first.below(p), second.below(q), third.below(r), depth.below(deeper)];
            let upper = self.test::<V, SingleRow>(at[0], [first, second, third], depth);
            let lower = self.test::<V, SingleRow>(at[1], [lower[0], lower[1], lower[2]], lower[3]);
            // Compute colours only if some pixel of either row passes.
            if V::any_of(upper.mask, lower.mask) {
                let walks = self.components::<V>(&triangle.surface, x, y);
                self.nearer(&upper, at[0], triangle.keep);
                self.paint.store::<V, SingleRow>(&walks, at[0], upper.mask);
                let walks = components_below(&triangle.surface, &walks);
                self.nearer(&lower, at[1], triangle.keep);
                self.paint.store::<V, SingleRow>(&walks, at[1], lower.mask);
            }
            first = first.below(2 * p);
            second = second.below(2 * q);
            third = third.below(2 * r);
            depth = depth.below(deeper.wrapping_mul(2));
        }
    }

    #[inline(always)]
    fn row<V: SimdVector>(&mut self, triangle: &WideTriangle<V>, y: usize, left: usize, right: usize, keep: bool) {
        let [p, q, r] = &triangle.edges;
        let [mut first, mut second, mut third] = [p.walk(left, y), q.walk(left, y), r.walk(left, y)];
        let mut depth = triangle.depth.walk(left, y);
        let [p, q, r] = &triangle.components;
        let mut walks = [p.walk(left, y), q.walk(left, y), r.walk(left, y)];
        // Store colours only if some pixel of the vector passes.
        for x in (left..right).step_by(V::LANES) {
            let at = y * WIDTH + x;
            let tested = self.test::<V, SingleRow>(at, [first, second, third], depth);
            if V::any_of(tested.mask, tested.mask) {
                self.nearer(&tested, at, keep);
                self.paint.store::<V, SingleRow>(&walks, at, tested.mask);
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

    #[inline(always)]
    fn nearer<V: SimdVector>(&mut self, tested: &DepthTest<V>, at: usize, keep: bool) {
        tested.new.store(tested.mask, tested.old, &mut self.z.0[at..]);
        if keep {
            V::store_mask(tested.mask, &mut self.enable.rows_in_use()[at..]);
        }
    }
}

#[inline(always)]
fn components_below<V: SimdVector>(surface: &impl Surface, [p, q, r]: &[Walk<V>; 3]) -> [Walk<V>; 3] {
    let [i, j, k] = surface.components();
    [p.below(i.b), q.below(j.b), r.below(k.b)]
}

/// Reads the edge expressions of several commands. The function must not be inlined. Otherwise, the compiler builds
/// each vector from single numbers, which takes longer.
#[inline(never)]
fn take_edges<const N: usize>(commands: &[[Word; N]], edges: &mut Edges) {
    for (i, words) in commands.iter().enumerate().take(LANES) {
        let [p, q, r] = EDGES_AT;
        edges.set(i, [coefficients(words, p), coefficients(words, q), coefficients(words, r)]);
    }
}

/// Returns the first column of a vector that covers the columns `left` to `right`, or `None` if one vector is too
/// short. If possible, the column is a multiple of `lanes`, the number of pixels of a vector.
#[inline(always)]
fn one_vector(left: usize, right: usize, lanes: usize) -> Option<usize> {
    let aligned = left / lanes * lanes;
    // If the aligned vector is too short, a vector that begins at `left` still ends inside the array.
    let begin = if right <= aligned + lanes { aligned } else { left };
    (right <= begin + lanes).then_some(begin)
}

#[inline(always)]
fn coefficients<const N: usize>(words: &[Word; N], at: usize) -> Linear {
    Linear { a: words[at] as i32, b: words[at + 1] as i32, c: words[at + 2] as i32 }
}

/// Returns the values of three expressions for a vector that begins at pixel (x, y) of the array. The three calls are
/// separate, because the compiler would not use vector instructions in a closure.
#[inline(always)]
fn three<V: SimdVector>(e: &[Linear; 3], x: usize, y: usize) -> [Walk<V>; 3] {
    let x = x as i32;
    let y = y as i32;
    [Walk::start(&e[0], x, y), Walk::start(&e[1], x, y), Walk::start(&e[2], x, y)]
}

#[inline(always)]
fn blend<V: SimdVector, S: Shape>(column: &mut Values, at: usize, mask: V::Mask, new: V) {
    let old = S::load::<V>(column, at);
    S::store(new, mask, old, column, at);
}

/// A painter that stores interpolated colours as 0x00RRGGBB.
pub(super) struct PaintGouraud<'a> {
    pub(super) colour: &'a mut Values,
}

impl PaintTriangle for PaintGouraud<'_> {
    #[inline(always)]
    fn begin(&mut self, _: Word) {}

    #[inline(always)]
    fn store<V: SimdVector, S: Shape>(&mut self, [red, green, blue]: &[Walk<V>; 3], at: usize, mask: V::Mask) {
        // One shift moves each component to its bits in the word.
        let red = red.value.shift_left(16 - COLOUR_FRACTION_BITS).and(V::splat(0xff_0000));
        let green = green.value.shift_right(COLOUR_FRACTION_BITS - 8).and(V::splat(0xff00));
        let blue = blue.value.shift_right(COLOUR_FRACTION_BITS).and(V::splat(0xff));
        blend::<V, S>(self.colour, at, mask, red.or(green).or(blue));
    }
}

pub(super) struct PaintPhong<'a> {
    pub(super) normal: [&'a mut Values; 3],
    pub(super) constant: u32,
    pub(super) colour: &'a mut Values,
}

impl PaintTriangle for PaintPhong<'_> {
    #[inline(always)]
    fn begin(&mut self, colour: Word) {
        self.constant = colour & 0xff_ffff;
    }

    #[inline(always)]
    fn store<V: SimdVector, S: Shape>(&mut self, walks: &[Walk<V>; 3], at: usize, mask: V::Mask) {
        let twelve = V::splat((1 << NORMAL_BITS) - 1);
        for (walk, column) in walks.iter().zip(self.normal.iter_mut()) {
            blend::<V, S>(column, at, mask, walk.value.shift_right(NORMAL_FRACTION_BITS).and(twelve));
        }
        blend::<V, S>(self.colour, at, mask, V::splat(self.constant as i32));
    }
}
