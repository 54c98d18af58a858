//! PLY: the library reads header and rows; here is what rows mean, and where a faulty one stands.

use std::io::{BufRead, Cursor, ErrorKind};

use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};

use super::source::excerpt;
use super::{Mesh, Source};
use crate::config::DEFAULT_COLOUR;
use crate::error::{FilePlace, LoadError};
use crate::scene::Scene;

pub(super) fn read(source: &Source<'_>) -> Result<Scene, LoadError> {
    let mut rows = Rows::after_header(source)?;
    let mut mesh = Mesh::default();
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
    mesh.into_scene(source)
}

/// The rows of all elements, one after the other.
struct Rows<'a> {
    source: &'a Source<'a>,
    header: Header,
    cursor: Cursor<&'a [u8]>,
    /// Number of the next line, in an ASCII file.
    line: u64,
    text: String,
}

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
        Ok(Self { source, header, line, cursor, text: String::new() })
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
                if let Some(surplus) = surplus(&self.text, element) {
                    let expected = format!("the end of {}", row_of(element));
                    return Err(self.source.syntax(at, expected, excerpt(surplus)));
                }
                parser.read_ascii_element(&self.text, element)
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
            (Encoding::Ascii, _) => self.source.syntax(at, expected, excerpt(&self.text)),
        }
    }

    /// Blank lines are passed over.
    fn next_line(&mut self, element: &ElementDef) -> Result<(), LoadError> {
        loop {
            self.text.clear();
            let read = self.cursor.read_line(&mut self.text);
            if !matches!(read, Ok(1..)) {
                let at = self.place();
                return Err(self.source.truncated(at, row_of(element), "the end of the file"));
            }
            self.line += 1;
            if !self.text.trim().is_empty() {
                return Ok(());
            }
        }
    }

    fn vertices(&mut self, element: &ElementDef, mesh: &mut Mesh) -> Result<(), LoadError> {
        for axis in ["x", "y", "z"] {
            if !element.properties.contains_key(axis) {
                let expected = format!("a property {axis:?} of \"vertex\"");
                return Err(self.source.syntax(FilePlace::Line(1), expected, "none"));
            }
        }
        for _ in 0..element.count {
            let (at, row) = self.next::<VertexRow>(element)?;
            let position = self.source.coordinates(at, row.position)?;
            let normal = self.source.coordinates(at, row.normal)?;
            mesh.push(position.into(), DVec3::from_array(normal), row.colour);
        }
        Ok(())
    }

    fn faces(&mut self, element: &ElementDef, mesh: &mut Mesh) -> Result<(), LoadError> {
        let count = mesh.positions.len();
        for _ in 0..element.count {
            let (at, row) = self.next::<FaceRow>(element)?;
            if row.corners.len() < 3 {
                let found = format!("{}", row.corners.len());
                return Err(self.source.syntax(at, "a face of at least 3 corners", found));
            }
            let corners = row.corners.iter();
            let corners = corners.map(|&c| self.source.index(at, "vertices", c, count, c));
            mesh.fan(&corners.collect::<Result<Vec<u32>, _>>()?);
        }
        Ok(())
    }

    /// Corners of strips, which -1 parts: each but the first two of a strip ends a triangle, of which every other one is turned.
    fn strips(&mut self, element: &ElementDef, mesh: &mut Mesh) -> Result<(), LoadError> {
        let count = mesh.positions.len();
        for _ in 0..element.count {
            let (at, row) = self.next::<FaceRow>(element)?;
            for strip in row.corners.split(|&corner| corner == -1) {
                let corners = strip.iter().map(|&c| self.source.index(at, "vertices", c, count, c));
                let corners: Vec<u32> = corners.collect::<Result<_, _>>()?;
                for (n, three) in corners.windows(3).enumerate() {
                    let turned = n % 2;
                    mesh.triangles.push([three[turned], three[1 - turned], three[2]]);
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

struct FaceRow {
    corners: Vec<i64>,
}

impl PropertyAccess for FaceRow {
    fn new() -> Self {
        Self { corners: Vec::new() }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !matches!(name, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        self.corners = match property {
            Property::ListChar(list) => widen(list),
            Property::ListUChar(list) => widen(list),
            Property::ListShort(list) => widen(list),
            Property::ListUShort(list) => widen(list),
            Property::ListInt(list) => widen(list),
            Property::ListUInt(list) => widen(list),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

fn widen<T: Into<i64>>(list: Vec<T>) -> Vec<i64> {
    list.into_iter().map(Into::into).collect()
}

struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}
