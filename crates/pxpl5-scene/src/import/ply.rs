//! PLY: the library reads header and rows; here is what rows mean, and where a faulty one stands.

use std::io::{Cursor, ErrorKind};

use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};

use super::Source;
use super::model::{Model, Places, check_triangles, direction};
use super::source::excerpt;
use crate::config::DEFAULT_COLOUR;
use crate::error::{FilePlace, LoadError};

pub(super) fn read(source: &Source<'_>) -> Result<Model, LoadError> {
    let mut rows = Rows::after_header(source)?;
    let mut mesh = Model::new(Places::Single(Vec::new()));
    let elements: Vec<ElementDef> = rows.header.elements.values().cloned().collect();
    for element in &elements {
        rows.check_length(element)?;
        match element.name.as_str() {
            "vertex" => rows.vertices(element, &mut mesh)?,
            "face" => rows.faces(element, &mut mesh)?,
            "tristrips" => rows.strips(element, &mut mesh)?,
            _ => rows.skip(element)?,
        }
    }
    rows.check_end()?;
    Ok(mesh)
}

/// The rows of all elements, one after the other.
struct Rows<'a> {
    source: &'a Source<'a>,
    header: Header,
    cursor: Cursor<&'a [u8]>,
    /// Number of the next line, in an ASCII file.
    line: u64,
    text: &'a str,
    /// Most numbers that a list may have: of so many vertices no face and no strips need more.
    longest_list: usize,
}

/// Numbers that a list may have whatever the file, and for each vertex on top of that. Assumed: strips of single triangles take 8
/// corners for each vertex of a closed surface.
const LIST: usize = 1 << 16;
const LIST_PER_VERTEX: usize = 8;

impl<'a> Rows<'a> {
    fn after_header(source: &'a Source<'a>) -> Result<Self, LoadError> {
        let mut reader = Reader::new(Cursor::new(source.bytes));
        let parsed = Parser::<VertexRow>::new().read_header(&mut reader);
        let line = reader.line() as u64;
        let cursor = reader.into_inner();
        source.text(cursor.position() as usize)?;
        let header = parsed.map_err(|e| {
            let line = e.line().map_or(line, |line| line as u64);
            header_fault(source, line.max(1), &e)
        })?;
        check_header(source, source.text(cursor.position() as usize)?)?;
        if header.encoding == Encoding::Ascii {
            source.text(source.bytes.len())?;
        }
        Ok(Self { source, header, line, cursor, text: "", longest_list: LIST })
    }

    fn place(&self) -> FilePlace {
        match self.header.encoding {
            Encoding::Ascii => FilePlace::Line(self.line),
            _ => FilePlace::Byte(self.cursor.position()),
        }
    }

    /// Refuses a count that the rest of the file cannot hold, before anything is read or allocated for it.
    fn check_length(&self, element: &ElementDef) -> Result<(), LoadError> {
        let left = self.source.bytes.len() as u64 - self.cursor.position();
        let row = least_row_bytes(element, self.header.encoding);
        let need = element.count as u128 * u128::from(row);
        // The last line of an ASCII file may lack its end.
        if need <= u128::from(left) + 1 {
            return Ok(());
        }
        let expected = format!("{} rows of {:?} in at least {need} bytes", element.count, element.name);
        Err(self.source.truncated(self.place(), expected, format!("{left} bytes")))
    }

    fn next<E: PropertyAccess>(&mut self, element: &ElementDef) -> Result<(FilePlace, E), LoadError> {
        let at = self.place();
        let parser = Parser::<E>::new();
        let row = match self.header.encoding {
            Encoding::Ascii => {
                self.next_line(element)?;
                lists(self.text, element).try_for_each(|length| self.check_list(at, length))?;
                if let Some(surplus) = surplus(self.text, element) {
                    let expected = format!("the end of {}", row_of(element));
                    return Err(self.source.syntax(at, expected, excerpt(surplus)));
                }
                parser.read_ascii_element(self.text, element)
            }
            Encoding::BinaryLittleEndian => parser.read_little_endian_element(&mut self.cursor, element),
            Encoding::BinaryBigEndian => parser.read_big_endian_element(&mut self.cursor, element),
        };
        row.map(|row| (at, row)).map_err(|e| self.row_fault(at, element, &e))
    }

    fn row_fault(&self, at: FilePlace, element: &ElementDef, error: &ParseError) -> LoadError {
        let expected = row_of(element);
        match (self.header.encoding, error.kind()) {
            (_, ErrorKind::UnexpectedEof) => self.source.truncated(at, expected, "the end of the file"),
            // The numbers are there, but the header gives a property a type that it cannot have.
            (_, ErrorKind::InvalidData) | (Encoding::BinaryLittleEndian | Encoding::BinaryBigEndian, _) => {
                self.source.syntax(at, expected, message(error))
            }
            (Encoding::Ascii, _) => self.source.syntax(at, expected, excerpt(self.text)),
        }
    }

    /// Blank lines are passed over.
    fn next_line(&mut self, element: &ElementDef) -> Result<(), LoadError> {
        loop {
            let begin = self.cursor.position() as usize;
            let rest = &self.source.bytes[begin..];
            if rest.is_empty() {
                let at = self.place();
                return Err(self.source.truncated(at, row_of(element), "the end of the file"));
            }
            let length = rest.iter().position(|&byte| byte == b'\n').map_or(rest.len(), |end| end + 1);
            self.cursor.set_position((begin + length) as u64);
            self.line += 1;
            // All of an ASCII file is text: the header's reader has looked.
            self.text = std::str::from_utf8(&rest[..length]).unwrap_or_default();
            if !self.text.trim().is_empty() {
                return Ok(());
            }
        }
    }

    /// Refuses a list before it is held twice: corners of a byte or two that go round and round take many times the file.
    fn check_list(&self, at: FilePlace, length: usize) -> Result<(), LoadError> {
        if length <= self.longest_list {
            return Ok(());
        }
        let expected =
            format!("a list of at most {} numbers, {LIST} and {LIST_PER_VERTEX} for each vertex", self.longest_list);
        Err(self.source.syntax(at, expected, length.to_string()))
    }

    fn vertices(&mut self, element: &ElementDef, mesh: &mut Model) -> Result<(), LoadError> {
        for axis in ["x", "y", "z"] {
            if !element.properties.contains_key(axis) {
                let expected = format!("a property {axis:?} of \"vertex\"");
                return Err(self.source.syntax(FilePlace::Line(1), expected, "none"));
            }
        }
        let first = mesh.places.len();
        if first == 0 && !has_single_places(element) {
            mesh.places = Places::Double(Vec::new());
        }
        let has = |names: [&str; 3]| names.iter().any(|name| element.properties.contains_key(*name));
        let has_normals = has(["nx", "ny", "nz"]);
        let has_colours = has(["red", "green", "blue"]) || has(["diffuse_red", "diffuse_green", "diffuse_blue"]);
        mesh.places.reserve_exact(element.count);
        mesh.normals.reserve_exact(if has_normals { element.count } else { 0 });
        mesh.colours.reserve_exact(if has_colours { element.count } else { 0 });
        for _ in 0..element.count {
            let (at, row) = self.next::<VertexRow>(element)?;
            mesh.places.push(self.source.coordinates(at, row.position)?.into());
            let normal = self.source.coordinates(at, row.normal)?;
            if has_normals {
                mesh.normals.push(direction(DVec3::from_array(normal)));
            }
            if has_colours {
                mesh.colours.push(row.colour);
            }
        }
        self.longest_list = LIST + LIST_PER_VERTEX * mesh.places.len();
        Ok(())
    }

    /// Cuts polygons into triangles that share their first corners.
    fn faces(&mut self, element: &ElementDef, mesh: &mut Model) -> Result<(), LoadError> {
        for _ in 0..element.count {
            let (at, row) = self.next::<FaceRow>(element)?;
            if row.len() < 3 {
                let found = format!("{}", row.len());
                return Err(self.source.syntax(at, "a face of at least 3 corners", found));
            }
            self.check_list(at, row.len())?;
            check_triangles(self.source, mesh.triangles.len(), row.len() - 2)?;
            let first = self.corner(at, &row, 0, mesh)?;
            let mut before = self.corner(at, &row, 1, mesh)?;
            for n in 2..row.len() {
                let corner = self.corner(at, &row, n, mesh)?;
                push(&mut mesh.triangles, [first, before, corner]);
                before = corner;
            }
        }
        Ok(())
    }

    fn corner(&self, at: FilePlace, row: &FaceRow, n: usize, mesh: &Model) -> Result<u32, LoadError> {
        let corner = row.corner(n);
        self.source.index(at, "vertices", corner, mesh.places.len(), corner)
    }

    /// Corners of strips, which -1 parts: each but the first two of a strip ends a triangle, of which every other one is turned.
    fn strips(&mut self, element: &ElementDef, mesh: &mut Model) -> Result<(), LoadError> {
        for _ in 0..element.count {
            let (at, row) = self.next::<FaceRow>(element)?;
            self.check_list(at, row.len())?;
            check_triangles(self.source, mesh.triangles.len(), row.len())?;
            let mut strip = Vec::with_capacity(3);
            let mut turned = 0;
            for n in 0..row.len() {
                if row.corner(n) == -1 {
                    strip.clear();
                    turned = 0;
                    continue;
                }
                strip.push(self.corner(at, &row, n, mesh)?);
                if let [_, _, last] = strip[..] {
                    push(&mut mesh.triangles, [strip[turned], strip[1 - turned], last]);
                    strip.remove(0);
                    turned = 1 - turned;
                }
            }
        }
        Ok(())
    }

    /// Behind the last row there is nothing but white space.
    fn check_end(&self) -> Result<(), LoadError> {
        let rest = &self.source.bytes[self.cursor.position() as usize..];
        if rest.iter().all(u8::is_ascii_whitespace) {
            return Ok(());
        }
        let expected = "the end of the file behind the last row that the header announces";
        let first = rest.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or_default();
        let found = String::from_utf8_lossy(&rest[first..rest.len().min(first + 40)]).into_owned();
        Err(self.source.syntax(self.place(), expected, excerpt(&found)))
    }

    fn skip(&mut self, element: &ElementDef) -> Result<(), LoadError> {
        (0..element.count).try_for_each(|_| self.next::<Skipped>(element).map(|_| ()))
    }
}

/// Adds a triangle to a list that grows by an eighth, not twice: a file can consist of them.
fn push(triangles: &mut Vec<[u32; 3]>, triangle: [u32; 3]) {
    if triangles.len() == triangles.capacity() {
        triangles.reserve_exact(triangles.len() / 8 + 1024);
    }
    triangles.push(triangle);
}

/// Whether single precision holds the places of an element's rows exactly.
fn has_single_places(element: &ElementDef) -> bool {
    let is_double = |axis: &str| {
        let kind = element.properties.get(axis).map(|property| &property.data_type);
        matches!(kind, Some(PropertyType::Scalar(ScalarType::Int | ScalarType::UInt | ScalarType::Double)))
    };
    !["x", "y", "z"].into_iter().any(is_double)
}

/// Such as: a row of "vertex" (x y z).
fn row_of(element: &ElementDef) -> String {
    let properties: Vec<&str> = element.properties.keys().map(String::as_str).collect();
    let properties: String = properties.join(" ").chars().take(80).collect();
    format!("a row of {:?} ({properties})", element.name)
}

/// What the library lets pass: a version that nobody has defined, and a property that an element has twice.
fn check_header(source: &Source<'_>, header: &str) -> Result<(), LoadError> {
    let mut known = Vec::new();
    for (number, line) in (1..).zip(header.lines()) {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            ["format", _, version, ..] if *version != "1.0" => {
                return Err(source.syntax(FilePlace::Line(number), "version 1.0", excerpt(version)));
            }
            ["element", ..] => known.clear(),
            ["property", .., name] if known.contains(name) => {
                let expected = "a property that the element does not have yet";
                return Err(source.syntax(FilePlace::Line(number), expected, excerpt(line)));
            }
            ["property", .., name] => known.push(name),
            _ => {}
        }
    }
    Ok(())
}

/// How long the lists of a row say that they are.
fn lists<'t>(row: &'t str, element: &'t ElementDef) -> impl Iterator<Item = usize> + 't {
    let mut words = row.split_whitespace();
    element.properties.values().filter_map(move |property| {
        let first = words.next()?;
        if !matches!(property.data_type, PropertyType::List(..)) {
            return None;
        }
        let count: usize = first.parse().ok()?;
        count.checked_sub(1).map(|last| words.nth(last));
        Some(count)
    })
}

/// What stands in a row behind the numbers of its element.
fn surplus<'t>(row: &'t str, element: &ElementDef) -> Option<&'t str> {
    let mut words = row.split_whitespace();
    for property in element.properties.values() {
        let first = words.next()?;
        if matches!(property.data_type, PropertyType::List(..)) {
            let count: usize = first.parse().ok()?;
            count.checked_sub(1).map(|last| words.nth(last));
        }
    }
    words.next()
}

fn header_fault(source: &Source<'_>, line: u64, error: &ParseError) -> LoadError {
    let at = FilePlace::Line(line);
    let text = String::from_utf8_lossy(source.bytes);
    match (error.kind(), text.lines().nth(line as usize - 1)) {
        (ErrorKind::UnexpectedEof, _) | (_, None) => {
            source.truncated(at, "a line of a PLY header", "the end of the file")
        }
        (_, Some(_)) if error.line().is_none() => {
            source.syntax(at, "a PLY header with a format of version 1.0", message(error))
        }
        (_, Some(text)) => source.syntax(at, "a line of a PLY header", excerpt(text)),
    }
}

/// The library's message on one line, cut.
fn message(error: &ParseError) -> String {
    let words: Vec<String> = error.to_string().split_whitespace().map(str::to_owned).collect();
    words.join(" ").chars().take(200).collect()
}

/// At least one, so that rows without properties cannot be announced without end.
fn least_row_bytes(element: &ElementDef, encoding: Encoding) -> u64 {
    let widths = element.properties.values().map(|p| match (&p.data_type, encoding) {
        // A digit, and a space or the line's end.
        (_, Encoding::Ascii) => 2,
        (PropertyType::Scalar(scalar) | PropertyType::List(scalar, _), _) => scalar_bytes(scalar),
    });
    widths.sum::<u64>().max(1)
}

fn scalar_bytes(scalar: &ScalarType) -> u64 {
    match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}

struct VertexRow {
    position: [f64; 3],
    normal: [f64; 3],
    colour: [u8; 3],
}

impl PropertyAccess for VertexRow {
    fn new() -> Self {
        Self { position: [0.0; 3], normal: [0.0; 3], colour: DEFAULT_COLOUR }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let slot = match name {
            "x" => &mut self.position[0],
            "y" => &mut self.position[1],
            "z" => &mut self.position[2],
            "nx" => &mut self.normal[0],
            "ny" => &mut self.normal[1],
            "nz" => &mut self.normal[2],
            _ => return self.set_colour(name, &property),
        };
        let Some(value) = number(&property) else {
            return PropertyAccessResult::UnsupportedType;
        };
        *slot = value;
        PropertyAccessResult::Set
    }
}

impl VertexRow {
    /// Integers from 0 to 255 or fractions from 0 to 1.
    fn set_colour(&mut self, name: &str, property: &Property) -> PropertyAccessResult {
        let slot = match name {
            "red" | "diffuse_red" => &mut self.colour[0],
            "green" | "diffuse_green" => &mut self.colour[1],
            "blue" | "diffuse_blue" => &mut self.colour[2],
            _ => return PropertyAccessResult::Ignored,
        };
        *slot = match (property, number(property)) {
            (Property::Float(_) | Property::Double(_), Some(value)) => (value * 255.0 + 0.5) as u8,
            (_, Some(value)) => value as u8,
            (_, None) => return PropertyAccessResult::UnsupportedType,
        };
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

/// Corners as the file has them: in a file of a byte each, another list of them would be many times as long.
struct FaceRow {
    corners: Property,
}

impl PropertyAccess for FaceRow {
    fn new() -> Self {
        Self { corners: Property::ListUChar(Vec::new()) }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !matches!(name, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        match property {
            Property::ListChar(_)
            | Property::ListUChar(_)
            | Property::ListShort(_)
            | Property::ListUShort(_)
            | Property::ListInt(_)
            | Property::ListUInt(_) => self.corners = property,
            _ => return PropertyAccessResult::UnsupportedType,
        }
        PropertyAccessResult::Set
    }
}

impl FaceRow {
    fn len(&self) -> usize {
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

    fn corner(&self, n: usize) -> i64 {
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

struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}
