//! Numbers of an accessor, which describes an array of vectors or indices in a buffer of a glTF file. A sparse accessor
//! also has a list of items that replace items of the array.

use pxpl5_sim::parameters::FileError;

use super::document::Document;
use super::json::{Accessor, View, Whole};

/// The type of the numbers of an accessor. A file states it by a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ComponentType {
    I8 = 5120,
    U8,
    I16,
    U16,
    U32 = 5125,
    F32,
}

impl ComponentType {
    const ALL: [Self; 6] = [Self::I8, Self::U8, Self::I16, Self::U16, Self::U32, Self::F32];

    fn of(number: Whole) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| *kind as usize == number.0)
    }

    const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

/// Items of one type at equal distances in a buffer.
#[derive(Clone, Copy)]
struct Items<'a> {
    bytes: &'a [u8],
    stride: usize,
    kind: ComponentType,
}

impl Items<'_> {
    /// Returns a component of an item as a number. The bounds were checked when the items were found.
    fn number(&self, item: usize, component: usize) -> f64 {
        let size = self.kind.size();
        let begin = item * self.stride + component * size;
        match (self.kind, &self.bytes[begin..begin + size]) {
            (ComponentType::I8, &[a]) => f64::from(a as i8),
            (ComponentType::U8, &[a]) => f64::from(a),
            (ComponentType::I16, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
            (ComponentType::U16, &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
            (ComponentType::U32, &[a, b, c, d]) => f64::from(u32::from_le_bytes([a, b, c, d])),
            (ComponentType::F32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => f64::NAN,
        }
    }
}

/// Numbers of an accessor, whose positions in buffers have been checked.
pub(super) struct Numbers<'a> {
    /// Numbers before the sparse replacements. `None` stands for zeros.
    base: Option<Items<'a>>,
    /// Indices in increasing order, the values that replace the items at these indices, and the number of indices.
    sparse: Option<(Items<'a>, Items<'a>, usize)>,
    pub(super) count: usize,
    pub(super) components: usize,
    /// Factor that converts a normalized integer into a fraction. The factor is 1 for all other numbers.
    factor: f64,
}

impl<'a> Numbers<'a> {
    /// Finds the numbers of the accessor with the index `index`.
    ///
    /// `components` are the allowed numbers of components of an item. `kinds` are the allowed types of components.
    ///
    /// # Errors
    ///
    /// Fails if the accessor or its buffer does not exist or is too short. Also fails if the type of the accessor is
    /// not allowed.
    pub(super) fn of(
        document: &'a Document<'_>,
        index: usize,
        components: &[usize],
        kinds: &[ComponentType],
    ) -> Result<Self, FileError> {
        let part = |name: &str| format!("accessors[{index}]{name}");
        let fail = |name: &str, expected: String, found: String| Err(document.source.part(part(name), expected, found));
        let accessor: Accessor = document.object("accessors", index)?;
        // Check the types of the numbers.
        let kind = match ComponentType::of(accessor.component_type) {
            Some(kind) if kinds.contains(&kind) => kind,
            Some(kind) => return fail(".componentType", format!("one of {kinds:?}"), format!("{kind:?}")),
            None => return fail(".componentType", format!("one of {kinds:?}"), "another number".into()),
        };
        let of_item = components_of(&accessor.shape);
        if !components.contains(&of_item) {
            return fail(".type", format!("one with {components:?} numbers"), format!("one with {of_item}"));
        }
        // Find the positions of the items in the buffer.
        let length = accessor.count.0;
        let item = (kind, of_item * kind.size());
        let base = match accessor.buffer_view {
            Some(view) => Some(items(document, &part(""), (view, accessor.byte_offset), length, item)?),
            None => None,
        };
        let sparse = sparse(document, &accessor, &part(".sparse"), length, item)?;
        if base.is_none() && sparse.is_none() {
            return fail(".bufferView", "a buffer view".into(), document.none());
        }
        let factor = if accessor.normalized { normalizing_factor(kind) } else { 1.0 };
        Ok(Self { base, sparse, count: length, components: of_item, factor })
    }

    /// Returns a component of an item. `item` must be less than `count`.
    pub(super) fn number(&self, item: usize, component: usize) -> f64 {
        if component >= self.components {
            return 0.0;
        }
        let number = match self.replacement(item) {
            Some((values, at)) => values.number(at, component),
            None => self.base.map_or(0.0, |base| base.number(item, component)),
        };
        // The lowest signed integer stands for -1, too.
        if self.factor == 1.0 { number } else { (number * self.factor).max(-1.0) }
    }

    pub(super) fn vector(&self, item: usize) -> [f64; 3] {
        std::array::from_fn(|component| self.number(item, component))
    }

    /// Finds the sparse value that replaces an item. The search bisects the sparse indices.
    fn replacement(&self, item: usize) -> Option<(Items<'a>, usize)> {
        let (indices, values, count) = self.sparse?;
        let [mut from, mut to] = [0, count];
        while from < to {
            let middle = from.midpoint(to);
            let index = indices.number(middle, 0) as usize;
            match index.cmp(&item) {
                std::cmp::Ordering::Equal => return Some((values, middle)),
                std::cmp::Ordering::Less => from = middle + 1,
                std::cmp::Ordering::Greater => to = middle,
            }
        }
        None
    }
}

fn items<'a>(
    document: &'a Document<'_>,
    part: &str,
    (Whole(view), Whole(offset)): (Whole, Whole),
    count: usize,
    (kind, bytes_of_item): (ComponentType, usize),
) -> Result<Items<'a>, FileError> {
    let fail = |part: String, expected: String, found: String| Err(document.source.part(part, expected, found));
    let described: View = document.object("bufferViews", view)?;
    let buffer = document.buffers.get(document.source, described.buffer.0)?;
    // The bytes of the view within its buffer.
    let (begin, length) = (described.byte_offset.0, described.byte_length.0);
    let Some(bytes) = begin.checked_add(length).and_then(|end| buffer.get(begin..end)) else {
        let expected = format!("{length} bytes at byte {begin} of buffer {}", described.buffer.0);
        return fail(format!("bufferViews[{view}]"), expected, format!("a buffer of {} bytes", buffer.len()));
    };
    // The items within the view. Without a stride, or with a stride of 0, they have no space between them.
    let stride = described.byte_stride.map_or(0, |stride| stride.0);
    let stride = if stride == 0 { bytes_of_item } else { stride };
    let need = match count.checked_sub(1) {
        None => Some(0),
        Some(steps) => steps.checked_mul(stride).and_then(|bytes| bytes.checked_add(bytes_of_item)),
    };
    let from = bytes.get(offset..);
    match (from, need) {
        (Some(bytes), Some(need)) if need <= bytes.len() => Ok(Items { bytes, stride, kind }),
        _ => {
            let expected = format!("{count} items of {bytes_of_item} bytes in bufferViews[{view}]");
            fail(part.to_owned(), expected, format!("{} bytes with an offset of {offset}", bytes.len()))
        }
    }
}

/// Finds the sparse replacements of an accessor. Checks that their indices increase and exist.
fn sparse<'a>(
    document: &'a Document<'_>,
    accessor: &Accessor,
    part: &str,
    length: usize,
    item: (ComponentType, usize),
) -> Result<Option<(Items<'a>, Items<'a>, usize)>, FileError> {
    let Some(sparse) = &accessor.sparse else { return Ok(None) };
    let count = sparse.count.0;
    let Some(kind) = ComponentType::of(sparse.indices.component_type) else {
        let expected = "an unsigned type of 1, 2 or 4 bytes";
        return Err(document.source.part(format!("{part}.indices.componentType"), expected, "another number"));
    };
    let place = (sparse.indices.buffer_view, sparse.indices.byte_offset);
    let indices = items(document, &format!("{part}.indices"), place, count, (kind, kind.size()))?;
    let place = (sparse.values.buffer_view, sparse.values.byte_offset);
    let values = items(document, &format!("{part}.values"), place, count, item)?;
    let mut least = 0;
    for i in 0..count {
        let index = indices.number(i, 0) as usize;
        if index < least || index >= length {
            let expected = format!("indices from 0 to {} in increasing order", length.saturating_sub(1));
            return Err(document.source.part(format!("{part}.indices"), expected, index.to_string()));
        }
        least = index + 1;
    }
    Ok(Some((indices, values, count)))
}

fn components_of(shape: &str) -> usize {
    match shape {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        _ => 0,
    }
}

fn normalizing_factor(kind: ComponentType) -> f64 {
    match kind {
        ComponentType::I8 => 1.0 / f64::from(i8::MAX),
        ComponentType::U8 => 1.0 / f64::from(u8::MAX),
        ComponentType::I16 => 1.0 / f64::from(i16::MAX),
        ComponentType::U16 => 1.0 / f64::from(u16::MAX),
        ComponentType::U32 => 1.0 / f64::from(u32::MAX),
        ComponentType::F32 => 1.0,
    }
}
