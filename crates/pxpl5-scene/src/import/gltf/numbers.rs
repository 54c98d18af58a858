//! Numbers of an accessor, which describes an array of vectors or indices in a buffer of a glTF file. A sparse accessor
//! also has a list of items that replace items of the array.

use gltf_json::accessor::{Accessor, ComponentType, Type};
use gltf_json::validation::Checked;
use pxpl5_sim::parameters::FileError;

use super::document::Document;

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
        let Some(accessor) = document.root.accessors.get(index) else {
            return fail("", "an accessor with this index".into(), count(document.root.accessors.len(), "accessors"));
        };
        // Check the types of the numbers.
        let kind = match accessor.component_type {
            Checked::Valid(kind) if kinds.contains(&kind.0) => kind.0,
            Checked::Valid(kind) => {
                return fail(".componentType", format!("one of {kinds:?}"), format!("{:?}", kind.0));
            }
            Checked::Invalid => return fail(".componentType", format!("one of {kinds:?}"), "another number".into()),
        };
        let of_item = match accessor.type_ {
            Checked::Valid(kind) => components_of(kind),
            Checked::Invalid => 0,
        };
        if !components.contains(&of_item) {
            return fail(".type", format!("one with {components:?} numbers"), format!("one with {of_item}"));
        }
        // Find the positions of the items in the buffer.
        let length = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        let item = (kind, of_item * kind.size());
        let base = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.unwrap_or_default().0;
                Some(items(document, &part(""), view.value(), offset, length, item)?)
            }
            None => None,
        };
        let sparse = sparse(document, accessor, &part(".sparse"), length, item)?;
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
    view: usize,
    offset: u64,
    count: usize,
    (kind, bytes_of_item): (ComponentType, usize),
) -> Result<Items<'a>, FileError> {
    let fail = |part: String, expected: String, found: String| Err(document.source.part(part, expected, found));
    let Some(described) = document.root.buffer_views.get(view) else {
        let found = self::count(document.root.buffer_views.len(), "buffer views");
        return fail(format!("bufferViews[{view}]"), "a buffer view with this index".into(), found);
    };
    let buffer = document.buffers.get(document.source, described.buffer.value())?;
    // The bytes of the view within its buffer.
    let begin = described.byte_offset.unwrap_or_default().0;
    let end = begin.checked_add(described.byte_length.0);
    let range = usize::try_from(begin).ok().zip(end.and_then(|end| usize::try_from(end).ok()));
    let Some(bytes) = range.and_then(|(begin, end)| buffer.get(begin..end)) else {
        let expected =
            format!("{} bytes at byte {begin} of buffer {}", described.byte_length.0, described.buffer.value());
        return fail(format!("bufferViews[{view}]"), expected, format!("a buffer of {} bytes", buffer.len()));
    };
    // The items within the view. Without a stride, or with a stride of 0, they have no space between them.
    let stride = described.byte_stride.map_or(0, |stride| stride.0);
    let stride = if stride == 0 { bytes_of_item } else { stride };
    let need = match count.checked_sub(1) {
        None => Some(0),
        Some(steps) => steps.checked_mul(stride).and_then(|bytes| bytes.checked_add(bytes_of_item)),
    };
    let from = usize::try_from(offset).ok().and_then(|offset| bytes.get(offset..));
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
    let count = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
    let Checked::Valid(kind) = sparse.indices.component_type else {
        let expected = "an unsigned type of 1, 2 or 4 bytes";
        return Err(document.source.part(format!("{part}.indices.componentType"), expected, "another number"));
    };
    let of_indices = (kind.0, kind.0.size());
    let at = format!("{part}.indices");
    let indices =
        items(document, &at, sparse.indices.buffer_view.value(), sparse.indices.byte_offset.0, count, of_indices)?;
    let values = &sparse.values;
    let at = format!("{part}.values");
    let values = items(document, &at, values.buffer_view.value(), values.byte_offset.0, count, item)?;
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

const fn components_of(kind: Type) -> usize {
    match kind {
        Type::Scalar => 1,
        Type::Vec2 => 2,
        Type::Vec3 => 3,
        Type::Vec4 | Type::Mat2 => 4,
        Type::Mat3 => 9,
        Type::Mat4 => 16,
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

fn count(count: usize, noun: &str) -> String {
    format!("{count} {noun}")
}
