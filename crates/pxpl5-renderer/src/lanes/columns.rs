//! Pixel memory of the fast array. Every bit field of the layout is stored as a column, an array with one 32-bit word
//! for each pixel.

use crate::array::{PIXELS, Plane};
use crate::command::{ShadeFields, SphereScratch};
use crate::controller::FieldBits;
use crate::isa::{MEMORY_BITS, Operand};
use crate::layout::Layout;

/// One word for each pixel. The words are aligned to cache lines for fast vector access.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Values(pub(super) [u32; PIXELS]);

/// A column: an array with one word for each pixel. The word holds the bits `first .. first + width` of the pixel's
/// memory.
#[derive(Clone, Debug)]
struct FieldColumn {
    first: usize,
    width: usize,
    values: Box<Values>,
}

/// All 208 bits of pixel memory as columns (arrays with one word for each pixel). A column begins at every bit at which
/// a bit field of the layout begins or ends.
#[derive(Clone, Debug)]
pub(super) struct PixelColumns {
    columns: Vec<FieldColumn>,
    /// Index of the column (array of words) that holds each bit of pixel memory.
    column_of: [u8; MEMORY_BITS as usize],
}

/// The part of a bit field that one column (array of words) holds. The part has `width` bits. It begins at bit `low` of
/// the column and at bit `at` of the bit field.
#[derive(Clone, Copy, Debug)]
struct FieldPiece {
    column: usize,
    low: usize,
    at: usize,
    width: usize,
}

impl PixelColumns {
    pub(super) fn new(layout: &Layout) -> Self {
        let columns: Vec<_> = cuts(layout).windows(2).map(|cut| column(cut[0], cut[1])).collect();
        let mut column_of = [0; MEMORY_BITS as usize];
        for (i, column) in columns.iter().enumerate() {
            column_of[column.first..column.first + column.width].fill(i as u8);
        }
        Self { columns, column_of }
    }

    /// Returns the index of the column (array of words) that holds the `width` bits of pixel memory from bit `first`
    /// on. Returns `None` if no column holds exactly these bits.
    pub(super) fn find(&self, first: usize, width: usize) -> Option<usize> {
        let index = usize::from(*self.column_of.get(first)?);
        let column = &self.columns[index];
        (column.first == first && column.width == width).then_some(index)
    }

    pub(super) fn values(&self, index: usize) -> &Values {
        &self.columns[index].values
    }

    pub(super) fn values_mut(&mut self, index: usize) -> &mut Values {
        &mut self.columns[index].values
    }

    /// Returns several columns (arrays of words) for modification, or `None` if two indices are equal.
    pub(super) fn many_mut<const N: usize>(&mut self, indices: [usize; N]) -> Option<[&mut Values; N]> {
        let columns = self.columns.get_disjoint_mut(indices).ok()?;
        Some(columns.map(|column| &mut *column.values))
    }

    pub(super) fn clear(&mut self) {
        for column in &mut self.columns {
            column.values.0.fill(0);
        }
    }

    pub(super) fn plane(&self, bit: usize) -> Plane {
        let column = &self.columns[usize::from(self.column_of[bit])];
        let low = bit - column.first;
        std::array::from_fn(|i| plane_word(&column.values.0[64 * i..64 * i + 64], low))
    }

    pub(super) fn set_plane(&mut self, bit: usize, plane: &Plane) {
        let column = &mut self.columns[usize::from(self.column_of[bit])];
        let low = bit - column.first;
        for (pixel, value) in column.values.0.iter_mut().enumerate() {
            let new = (plane[pixel / 64] >> (pixel % 64) & 1) as u32;
            *value = *value & !(1 << low) | new << low;
        }
    }

    /// Reads a bit field of all pixels into `out`. Values are sign-extended or zero-extended to 64 bits, as the bit
    /// field requires.
    pub(super) fn gather(&self, field: FieldBits, out: &mut [u64]) {
        out.fill(0);
        for piece in self.pieces(field) {
            let mask = ones(piece.width);
            let values = &self.columns[piece.column].values.0;
            for (out, value) in out.iter_mut().zip(values.iter()) {
                *out |= (u64::from(*value) >> piece.low & mask) << piece.at;
            }
        }
        if field.signed {
            let unused = 64 - field.width;
            out.iter_mut().for_each(|v| *v = ((*v << unused) as i64 >> unused) as u64);
        }
    }

    /// Stores the low bits of `values` in the pixels whose `mask` is 255. In all other pixels, the mask must be 0.
    pub(super) fn scatter(&mut self, field: FieldBits, values: &[u64], mask: &[u8]) {
        for piece in self.pieces(field) {
            let bits = (ones(piece.width) << piece.low) as u32;
            let column = self.columns[piece.column].values.0.iter_mut();
            for ((old, new), enable) in column.zip(values).zip(mask) {
                let taken = if *enable == 0 { 0 } else { bits };
                let new = ((new >> piece.at) << piece.low) as u32;
                *old = *old & !taken | new & taken;
            }
        }
    }

    fn pieces(&self, field: FieldBits) -> Vec<FieldPiece> {
        let mut out = Vec::new();
        let mut bit = field.first;
        while bit < field.end() {
            let index = usize::from(self.column_of[bit]);
            let column = &self.columns[index];
            let low = bit - column.first;
            let width = (column.width - low).min(field.end() - bit);
            out.push(FieldPiece { column: index, low, at: bit - field.first, width });
            bit += width;
        }
        out
    }
}

/// Returns bit `low` of 64 pixels as one word. The bit of the first pixel is the lowest bit of the word.
fn plane_word(pixels: &[u32], low: usize) -> u64 {
    pixels.iter().enumerate().fold(0, |word, (x, value)| word | u64::from(value >> low & 1) << x)
}

const fn ones(width: usize) -> u64 {
    u64::MAX >> (64 - width)
}

fn column(first: usize, end: usize) -> FieldColumn {
    FieldColumn { first, width: end - first, values: Box::new(Values([0; PIXELS])) }
}

/// Returns the first bit of each column (array of words). A column begins at every bit at which a bit field of the
/// layout begins or ends. Columns of more than 32 bits are cut.
fn cuts(layout: &Layout) -> Vec<usize> {
    let mut cuts = vec![0, MEMORY_BITS as usize];
    // First and last bits of the layout's fields.
    for range in layout.ranges() {
        cuts.extend([range.first as usize, (range.first + range.width) as usize]);
    }
    // x, y and z of a normal are read separately.
    for context in 0..layout.plan().contexts {
        let base = usize::from(layout.context_base(context));
        for normal in (0..3).filter_map(|i| layout.normal(i)) {
            cuts.push(base + usize::from(normal.address));
        }
    }
    // First and last bits of the scratch fields.
    cuts.extend(temporaries(layout).iter().flat_map(|field| {
        let first = usize::from(field.address);
        [first, first + usize::from(field.width)]
    }));
    cuts.sort_unstable();
    cuts.dedup();
    split_wide(&cuts)
}

/// Returns the temporary bit fields that the programs of commands use, with absolute addresses.
fn temporaries(layout: &Layout) -> Vec<Operand> {
    let sphere = SphereScratch::in_layout(layout).map(|s| vec![s.z, s.root]);
    let shade = ShadeFields::in_layout(layout).map(|f| vec![f.a, f.b, f.c, f.root, f.diffuse, f.specular]);
    [sphere.unwrap_or_default(), shade.unwrap_or_default()].concat()
}

fn split_wide(cuts: &[usize]) -> Vec<usize> {
    let mut out = vec![0];
    for pair in cuts.windows(2) {
        out.extend((pair[0]..pair[1]).skip(1).filter(|bit| (bit - pair[0]).is_multiple_of(32)));
        out.push(pair[1]);
    }
    out
}

/// Indices of the columns (arrays of words) that hold the bit fields of one context, the part of pixel memory for one
/// region.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContextColumns {
    pub(super) base: u8,
    pub(super) colour: usize,
    pub(super) z: usize,
    pub(super) normal: Option<[usize; 3]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_columns_of_pixel_memory_cover_every_bit_once_in_every_layout() {
        let layouts = [Layout::rendering_control_phong(), Layout::slats(), Layout::slats_quarters()];
        for layout in layouts {
            let columns = PixelColumns::new(&layout).columns;
            let mut next = 0;
            for column in &columns {
                assert_eq!(column.first, next);
                assert!((1..=32).contains(&column.width));
                next += column.width;
            }
            assert_eq!(next, MEMORY_BITS as usize);
        }
    }

    #[test]
    fn a_bit_field_across_columns_is_read_back() {
        let mut columns = PixelColumns::new(&Layout::slats());
        let field = FieldBits { first: 20, width: 30, signed: true };
        let values: Vec<u64> = (0..PIXELS as u64).map(|i| i.wrapping_mul(0x9e37_79b9_7f4a_7c15)).collect();
        columns.scatter(field, &values, &[255; PIXELS]);
        let mut back = vec![0; PIXELS];
        columns.gather(field, &mut back);
        let expected: Vec<_> = values.iter().map(|v| ((v << 34) as i64 >> 34) as u64).collect();
        assert_eq!(back, expected);
    }
}
