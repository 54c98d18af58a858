//! The properties of one row of a PLY file.

use crate::config::DEFAULT_COLOUR;
use ply_rs_bw::ply::{ElementDef, Property, PropertyAccess, PropertyAccessResult};

/// Names that files use for red, green and blue. Each entry is one convention.
const COLOURS: [[&str; 3]; 3] =
    [["red", "green", "blue"], ["diffuse_red", "diffuse_green", "diffuse_blue"], ["r", "g", "b"]];

pub(super) fn has_colours(element: &ElementDef) -> bool {
    COLOURS.as_flattened().iter().any(|name| element.properties.contains_key(*name))
}

/// The colour of a row. Its components are integers from 0 to 255 or fractions from 0 to 1.
#[derive(Default)]
struct Colour {
    parts: Option<[f64; 3]>,
    are_fractions: bool,
}

impl Colour {
    fn set(&mut self, name: &str, property: &Property) -> PropertyAccessResult {
        let Some(part) = COLOURS.iter().find_map(|names| names.iter().position(|candidate| *candidate == name)) else {
            return PropertyAccessResult::Ignored;
        };
        let Some(value) = number(property) else { return PropertyAccessResult::UnsupportedType };
        self.are_fractions |= matches!(property, Property::Float(_) | Property::Double(_));
        self.parts.get_or_insert([0.0; 3])[part] = value;
        PropertyAccessResult::Set
    }

    /// Returns the colour as bytes. Floating-point numbers stand for bytes if all are whole and one is above 1.
    fn bytes(&self) -> [u8; 3] {
        let Some(parts) = self.parts else { return DEFAULT_COLOUR };
        let are_bytes = parts.iter().all(|part| part.fract() == 0.0) && parts.iter().any(|part| *part > 1.0);
        let full = if self.are_fractions && !are_bytes { 255.0 } else { 1.0 };
        parts.map(|part| (part * full + 0.5) as u8)
    }
}

/// The properties of a vertex that the reader uses.
pub(super) struct VertexRow {
    pub(super) position: [f64; 3],
    pub(super) normal: [f64; 3],
    colour: Colour,
}

impl VertexRow {
    pub(super) fn colour(&self) -> [u8; 3] {
        self.colour.bytes()
    }
}

impl PropertyAccess for VertexRow {
    fn new() -> Self {
        Self { position: [0.0; 3], normal: [0.0; 3], colour: Colour::default() }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let slot = match name {
            "x" => &mut self.position[0],
            "y" => &mut self.position[1],
            "z" => &mut self.position[2],
            "nx" => &mut self.normal[0],
            "ny" => &mut self.normal[1],
            "nz" => &mut self.normal[2],
            _ => return self.colour.set(name, &property),
        };
        let Some(value) = number(&property) else {
            return PropertyAccessResult::UnsupportedType;
        };
        *slot = value;
        PropertyAccessResult::Set
    }
}

fn number(property: &Property) -> Option<f64> {
    Some(match *property {
        Property::Char(x) => f64::from(x),
        Property::UChar(x) => f64::from(x),
        Property::Short(x) => f64::from(x),
        Property::UShort(x) => f64::from(x),
        Property::Int(x) => f64::from(x),
        Property::UInt(x) => f64::from(x),
        Property::Float(x) => f64::from(x),
        Property::Double(x) => x,
        _ => return None,
    })
}

/// The corners of a face in the integer type of the file. A conversion of one-byte indices to a type with more bytes
/// would multiply the memory.
pub(super) struct FaceRow {
    corners: Property,
    has_corners: bool,
    colour: Colour,
}

impl PropertyAccess for FaceRow {
    fn new() -> Self {
        Self { corners: Property::ListUChar(Vec::new()), has_corners: false, colour: Colour::default() }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        // Without the usual names, the first list of integers has the corners.
        let is_named = matches!(name, "vertex_indices" | "vertex_index");
        match property {
            Property::ListChar(_)
            | Property::ListUChar(_)
            | Property::ListShort(_)
            | Property::ListUShort(_)
            | Property::ListInt(_)
            | Property::ListUInt(_) => {
                if is_named || !self.has_corners {
                    self.corners = property;
                    self.has_corners = true;
                }
            }
            _ if is_named => return PropertyAccessResult::UnsupportedType,
            _ => return self.colour.set(name, &property),
        }
        PropertyAccessResult::Set
    }
}

impl FaceRow {
    pub(super) fn colour(&self) -> [u8; 3] {
        self.colour.bytes()
    }

    pub(super) fn len(&self) -> usize {
        match &self.corners {
            Property::ListChar(list) => list.len(),
            Property::ListUChar(list) => list.len(),
            Property::ListShort(list) => list.len(),
            Property::ListUShort(list) => list.len(),
            Property::ListInt(list) => list.len(),
            Property::ListUInt(list) => list.len(),
            _ => 0,
        }
    }

    pub(super) fn corner(&self, n: usize) -> i64 {
        match &self.corners {
            Property::ListChar(list) => list[n].into(),
            Property::ListUChar(list) => list[n].into(),
            Property::ListShort(list) => list[n].into(),
            Property::ListUShort(list) => list[n].into(),
            Property::ListInt(list) => list[n].into(),
            Property::ListUInt(list) => list[n].into(),
            _ => -1,
        }
    }
}

/// A row whose properties are not read.
pub(super) struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}
