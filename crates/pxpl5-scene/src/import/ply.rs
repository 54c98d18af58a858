//! Reader of PLY files. A library parses the header and binary rows. This module interprets the rows, parses ASCII rows
//! and finds the positions of errors.

mod row;

use pxpl5_sim::parameters::FileError;
use std::io::{Cursor, ErrorKind};
use std::str::{FromStr, SplitAsciiWhitespace};

use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};

use self::row::{FaceRow, Skipped, VertexRow, has_colours};
use super::Source;
use super::model::{Detail, Model, Places, Vertices, push_with_slow_growth};
use super::source::{MARK, excerpt, is_not_a_number, text};
use crate::error::FilePlace;

pub(super) fn read(source: &Source<'_>) -> Result<Model, FileError> {
    let mut rows = Rows::after_header(source)?;
    let mut mesh = Model::new(Places::Single(Vec::new()));
    let elements: Vec<ElementDef> = rows.header.elements.values().cloned().collect();
    // The longest legal list depends on the number of vertices.
    let last_vertices = elements.iter().rposition(|element| element.name == "vertex").unwrap_or_default();
    let announced = elements.iter().filter(|element| element.name == "vertex");
    rows.longest_list =
        announced.fold(LIST, |numbers, e| numbers.saturating_add(e.count.saturating_mul(LIST_PER_VERTEX)));
    // Elements may come in any order. Faces before the vertices are skipped and read at the end.
    let mut passed_over = Vec::new();
    for (number, element) in elements.iter().enumerate() {
        rows.check_length(element)?;
        match element.name.as_str() {
            "vertex" => rows.vertices(element, &mut mesh)?,
            "face" | "tristrips" if number < last_vertices => {
                passed_over.push((element, rows.cursor.position(), rows.line));
                rows.skip(element)?;
            }
            "face" => rows.faces(element, &mut mesh)?,
            "tristrips" => rows.strips(element, &mut mesh)?,
            _ => rows.skip(element)?,
        }
    }
    // Read the faces and strips that were skipped.
    rows.check_end()?;
    for (element, position, line) in passed_over {
        rows.cursor.set_position(position);
        rows.line = line;
        match element.name.as_str() {
            "face" => rows.faces(element, &mut mesh)?,
            _ => rows.strips(element, &mut mesh)?,
        }
    }
    if rows.has_both_colours {
        mesh.warnings.push("vertices and faces have colours: those of the vertices are drawn".to_owned());
    }
    Ok(mesh)
}

struct Rows<'a> {
    source: &'a Source<'a>,
    header: Header,
    cursor: Cursor<&'a [u8]>,
    /// Byte that ends each line of an ASCII file.
    end: u8,
    /// Line number of the next line of an ASCII file.
    line: u64,
    text: &'a str,
    /// Greatest allowed length of a list, computed from the number of vertices in the file. No valid face or strip of
    /// these vertices needs a longer list.
    longest_list: usize,
    /// True if the file has colours of vertices and of faces. The colours of faces are then ignored.
    has_both_colours: bool,
    coloured: Vertices,
}

/// The words of a row in a text file. The row continues on the next line until it has all its numbers.
struct Words<'w, 'a> {
    rows: &'w mut Rows<'a>,
    /// Words of the current line that are not read yet.
    line: SplitAsciiWhitespace<'a>,
}

impl<'a> Iterator for Words<'_, 'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        loop {
            match self.line.next() {
                None if self.rows.next_line() => self.line = self.rows.text.split_ascii_whitespace(),
                word => return word,
            }
        }
    }
}

/// Greatest length of a list in a file without vertices.
const LIST: usize = 1 << 16;
/// Number of items by which each vertex of a file raises the greatest length of a list. Assumed: if every triangle of a
/// closed surface is a strip of its own, the strips have 8 items per vertex.
const LIST_PER_VERTEX: usize = 8;

/// If no line `end_header` ends the header, the reader parses only this number of bytes, to find the error. The number
/// is assumed, and only needs to cover a few lines.
const HEADER: usize = 1 << 16;

/// Returns the header with LF at its line ends, the position after the header, and the byte that ends its lines. Bytes
/// that are not ASCII become underscores. Such bytes occur only in comments and names.
fn header_of(bytes: &[u8]) -> (String, usize, u8) {
    let begin = if bytes.starts_with(MARK) { MARK.len() } else { 0 };
    // If the first CR has no LF after it, lines end in CR alone.
    let end = match bytes[begin..].iter().position(|byte| matches!(byte, b'\r' | b'\n')) {
        Some(at) if bytes[begin + at] == b'\r' && bytes.get(begin + at + 1) != Some(&b'\n') => b'\r',
        _ => b'\n',
    };
    // Find the line `end_header`.
    let mut length = 0;
    let whole = bytes[begin..].split_inclusive(|byte| *byte == end).any(|line| {
        length += line.len();
        line.trim_ascii() == b"end_header"
    });
    let behind = if whole { begin + length } else { bytes.len().min(begin + HEADER) };
    let plain = |byte: &u8| match *byte {
        byte if byte == end => '\n',
        byte if byte.is_ascii() => char::from(byte),
        _ => '_',
    };
    let header: String = bytes[begin..behind].iter().map(plain).collect();
    // A blank line becomes a comment, so that the lines after it keep their numbers.
    let lines = header.split_inclusive('\n').map(|line| if line.trim().is_empty() { "comment -\n" } else { line });
    (lines.collect(), behind, end)
}

impl<'a> Rows<'a> {
    fn after_header(source: &'a Source<'a>) -> Result<Self, FileError> {
        let (text, behind, end) = header_of(source.bytes);
        // Parse the cleaned header with the library, and find the line of an error.
        let mut reader = Reader::new(Cursor::new(text.as_bytes()));
        let parsed = Parser::<VertexRow>::new().read_header(&mut reader);
        let line = reader.line() as u64;
        let header = parsed.map_err(|e| {
            let line = e.line().map_or(line, |line| line as u64);
            header_fault(source, &text, line.max(1), &e)
        })?;
        check_header(source, &text)?;
        let mut cursor = Cursor::new(source.bytes);
        // Rows are read from the original bytes.
        cursor.set_position(behind as u64);
        Ok(Self {
            source,
            header,
            cursor,
            end,
            line,
            text: "",
            longest_list: LIST,
            has_both_colours: false,
            coloured: Vertices::default(),
        })
    }

    fn place(&self) -> FilePlace {
        match self.header.encoding {
            Encoding::Ascii => FilePlace::Line(self.line),
            _ => FilePlace::Byte(self.cursor.position()),
        }
    }

    /// Returns an error if the rest of the file is too short for the announced number of rows. No memory has been
    /// allocated for these rows yet.
    fn check_length(&self, element: &ElementDef) -> Result<(), FileError> {
        let left = self.source.bytes.len() as u64 - self.cursor.position();
        let row = least_row_bytes(element, self.header.encoding);
        let need = element.count as u128 * u128::from(row);
        // The last line of an ASCII file may have no line end.
        if need <= u128::from(left) + 1 {
            return Ok(());
        }
        let expected = format!("{} rows of {:?} in at least {need} bytes", element.count, element.name);
        Err(self.source.truncated(self.place(), expected, format!("{left} bytes")))
    }

    fn next<E: PropertyAccess>(&mut self, element: &ElementDef) -> Result<(FilePlace, E), FileError> {
        let at = self.place();
        let parser = Parser::<E>::new();
        let row = match self.header.encoding {
            Encoding::Ascii => {
                if !self.next_line() {
                    return Err(self.source.truncated(at, row_of(element), "the end of the file"));
                }
                let at = FilePlace::Line(self.line - 1);
                return Ok((at, self.ascii_row(at, element)?));
            }
            Encoding::BinaryLittleEndian => parser.read_little_endian_element(&mut self.cursor, element),
            Encoding::BinaryBigEndian => parser.read_big_endian_element(&mut self.cursor, element),
        };
        row.map(|row| (at, row)).map_err(|e| self.row_fault(at, element, &e))
    }

    fn row_fault(&self, at: FilePlace, element: &ElementDef, error: &ParseError) -> FileError {
        match error.kind() {
            ErrorKind::UnexpectedEof => self.source.truncated(at, row_of(element), "the end of the file"),
            // All numbers exist, but a property has a type in the header that it cannot have.
            _ => self.source.syntax(at, row_of(element), message(error)),
        }
    }

    /// Parses the numbers of a row, which may continue on the next lines. The parser of the PLY library is not used,
    /// because it accepts neither `.5` nor `nan`.
    fn ascii_row<E: PropertyAccess>(&mut self, at: FilePlace, element: &ElementDef) -> Result<E, FileError> {
        let (source, first_line) = (self.source, self.text);
        let wrong = || source.syntax(at, row_of(element), excerpt(first_line));
        let begin = self.line;
        let mut words = Words { line: self.text.split_ascii_whitespace(), rows: self };
        let mut row = E::new();
        for (name, property) in &element.properties {
            // A list begins with its length.
            let value = match &property.data_type {
                PropertyType::Scalar(kind) => words.next().and_then(|word| scalar(kind, word)),
                PropertyType::List(_, kind) => {
                    let length = words.next().and_then(|word| word.parse().ok()).ok_or_else(wrong)?;
                    words.rows.check_list(at, length)?;
                    list(kind, &mut words, length)
                }
            };
            if row.set_property(name, value.ok_or_else(wrong)?) == PropertyAccessResult::UnsupportedType {
                let found = format!("the property {name:?} of type {:?}", property.data_type);
                return Err(source.syntax(at, row_of(element), found));
            }
        }
        // A row must not have more numbers than properties.
        match words.line.next() {
            None => Ok(row),
            // The first line has too few numbers, and the next line is not their continuation.
            Some(_) if words.rows.line > begin => Err(wrong()),
            Some(surplus) => Err(source.syntax(at, format!("the end of {}", row_of(element)), excerpt(surplus))),
        }
    }

    /// Reads the next line that is not blank. Returns false at the end of the file.
    fn next_line(&mut self) -> bool {
        loop {
            // The line extends to the next line end, or to the end of the file.
            let begin = self.cursor.position() as usize;
            let rest = &self.source.bytes[begin..];
            if rest.is_empty() {
                return false;
            }
            let length = rest.iter().position(|&byte| byte == self.end).map_or(rest.len(), |end| end + 1);
            self.cursor.set_position((begin + length) as u64);
            self.line += 1;
            let line = rest[..length].trim_ascii();
            if !line.is_empty() {
                self.text = text(line);
                return true;
            }
        }
    }

    /// Returns an error if a list is too long. The check comes before the list is copied. The copy of a long list
    /// with corners of one or two bytes would take many times the memory of the file.
    fn check_list(&self, at: FilePlace, length: usize) -> Result<(), FileError> {
        if length <= self.longest_list {
            return Ok(());
        }
        let expected =
            format!("a list of at most {} numbers, {LIST} and {LIST_PER_VERTEX} for each vertex", self.longest_list);
        Err(self.source.syntax(at, expected, length.to_string()))
    }

    fn vertices(&mut self, element: &ElementDef, mesh: &mut Model) -> Result<(), FileError> {
        // All three coordinates are required. Normals and colours are optional.
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
        let has_colours = has_colours(element);
        // Allocate the announced number of rows, which was checked against the length of the file.
        mesh.places.reserve_exact(element.count);
        mesh.normals.reserve_exact(if has_normals { element.count } else { 0 });
        mesh.colours.reserve_exact(if has_colours { element.count } else { 0 });
        for _ in 0..element.count {
            let (at, row) = self.next::<VertexRow>(element)?;
            mesh.places.push(self.source.coordinates(at, row.position)?.into());
            if has_normals {
                mesh.push_normal(at, DVec3::from_array(row.normal));
            }
            if has_colours {
                mesh.colours.push(row.colour());
            }
        }
        Ok(())
    }

    fn faces(&mut self, element: &ElementDef, mesh: &mut Model) -> Result<(), FileError> {
        let has_colours = has_colours(element);
        self.has_both_colours |= has_colours && !mesh.colours.is_empty();
        let has_colours = has_colours && mesh.colours.is_empty();
        for _ in 0..element.count {
            let (at, row) = self.next::<FaceRow>(element)?;
            if row.len() < 3 {
                let found = format!("{}", row.len());
                return Err(self.source.syntax(at, "a face of at least 3 corners", found));
            }
            self.check_list(at, row.len())?;
            mesh.check_reading(self.source, row.len() - 2)?;
            // Add triangles that all share the first corner. If the polygon is concave, replace them.
            let fan = mesh.triangles.len();
            let colour = has_colours.then(|| row.colour());
            let first = self.vertex(at, &row, 0, colour, mesh)?;
            let mut before = self.vertex(at, &row, 1, colour, mesh)?;
            for n in 2..row.len() {
                let corner = self.vertex(at, &row, n, colour, mesh)?;
                push_with_slow_growth(&mut mesh.triangles, [first, before, corner]);
                before = corner;
            }
            mesh.cut_polygon(fan);
        }
        Ok(())
    }

    /// Returns the vertex for a corner. If faces have colours, a point has one vertex for each colour of the faces
    /// around the point.
    fn vertex(
        &mut self,
        at: FilePlace,
        row: &FaceRow,
        n: usize,
        colour: Option<[u8; 3]>,
        mesh: &mut Model,
    ) -> Result<u32, FileError> {
        let point = self.corner(at, row, n, mesh)?;
        let Some([red, green, blue]) = colour else { return Ok(point) };
        // A point becomes one vertex for each colour of its faces.
        mesh.detail = Detail::Colour;
        Ok(self.coloured.of(&mut mesh.corners, (point, u32::from_le_bytes([red, green, blue, 0]))))
    }

    fn corner(&self, at: FilePlace, row: &FaceRow, n: usize, mesh: &Model) -> Result<u32, FileError> {
        let corner = row.corner(n);
        self.source.index(at, "vertices", corner, mesh.places.len(), corner)
    }

    /// Reads strips of corners, separated by -1. Every corner of a strip after the first two completes a triangle with
    /// the two corners before it. Every second triangle is reversed.
    fn strips(&mut self, element: &ElementDef, mesh: &mut Model) -> Result<(), FileError> {
        for _ in 0..element.count {
            let (at, row) = self.next::<FaceRow>(element)?;
            self.check_list(at, row.len())?;
            mesh.check_reading(self.source, row.len())?;
            let mut strip = Vec::with_capacity(3);
            let mut turned = 0;
            for n in 0..row.len() {
                // -1 begins a new strip.
                if row.corner(n) == -1 {
                    strip.clear();
                    turned = 0;
                    continue;
                }
                strip.push(self.corner(at, &row, n, mesh)?);
                // Swapping the first two corners of every second triangle gives all triangles the same orientation.
                if let [_, _, last] = strip[..] {
                    push_with_slow_growth(&mut mesh.triangles, [strip[turned], strip[1 - turned], last]);
                    strip.remove(0);
                    turned = 1 - turned;
                }
            }
        }
        Ok(())
    }

    fn check_end(&self) -> Result<(), FileError> {
        let rest = &self.source.bytes[self.cursor.position() as usize..];
        // Some programs pad a file with zeros.
        if rest.iter().all(|byte| byte.is_ascii_whitespace() || *byte == 0) {
            return Ok(());
        }
        let expected = "the end of the file after the last row that the header announces";
        let first = rest.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or_default();
        let found = String::from_utf8_lossy(&rest[first..rest.len().min(first + 40)]).into_owned();
        Err(self.source.syntax(self.place(), expected, excerpt(&found)))
    }

    fn skip(&mut self, element: &ElementDef) -> Result<(), FileError> {
        (0..element.count).try_for_each(|_| self.next::<Skipped>(element).map(|_| ()))
    }
}

/// Returns true if all coordinates of an element have types that single precision represents exactly.
fn has_single_places(element: &ElementDef) -> bool {
    let is_double = |axis: &str| {
        let kind = element.properties.get(axis).map(|property| &property.data_type);
        matches!(kind, Some(PropertyType::Scalar(ScalarType::Int | ScalarType::UInt | ScalarType::Double)))
    };
    !["x", "y", "z"].into_iter().any(is_double)
}

/// Returns a description of an element's rows, such as: a row of "vertex" (x y z).
fn row_of(element: &ElementDef) -> String {
    let properties: Vec<&str> = element.properties.keys().map(String::as_str).collect();
    let properties: String = properties.join(" ").chars().take(80).collect();
    format!("a row of {:?} ({properties})", element.name)
}

/// Checks two rules that the library does not check. The version must be 1.0, and an element must not have a property
/// twice.
fn check_header(source: &Source<'_>, header: &str) -> Result<(), FileError> {
    let mut properties = Vec::new();
    for (number, line) in (1..).zip(header.lines()) {
        // `properties` collects the properties of the current element.
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            ["format", _, version, ..] if *version != "1.0" => {
                return Err(source.syntax(FilePlace::Line(number), "version 1.0", excerpt(version)));
            }
            ["element", ..] => properties.clear(),
            ["property", .., name] if properties.contains(name) => {
                let expected = "a property that the element does not have yet";
                return Err(source.syntax(FilePlace::Line(number), expected, excerpt(line)));
            }
            ["property", .., name] => properties.push(name),
            _ => {}
        }
    }
    Ok(())
}

fn scalar(kind: &ScalarType, word: &str) -> Option<Property> {
    Some(match kind {
        ScalarType::Char => Property::Char(word.parse().ok()?),
        ScalarType::UChar => Property::UChar(word.parse().ok()?),
        ScalarType::Short => Property::Short(word.parse().ok()?),
        ScalarType::UShort => Property::UShort(word.parse().ok()?),
        ScalarType::Int => Property::Int(word.parse().ok()?),
        ScalarType::UInt => Property::UInt(word.parse().ok()?),
        ScalarType::Float if is_not_a_number(word) => Property::Float(f32::NAN),
        ScalarType::Double if is_not_a_number(word) => Property::Double(f64::NAN),
        ScalarType::Float => Property::Float(word.parse().ok()?),
        ScalarType::Double => Property::Double(word.parse().ok()?),
    })
}

fn list<'w>(kind: &ScalarType, words: &mut impl Iterator<Item = &'w str>, length: usize) -> Option<Property> {
    Some(match kind {
        ScalarType::Char => Property::ListChar(numbers(words, length)?),
        ScalarType::UChar => Property::ListUChar(numbers(words, length)?),
        ScalarType::Short => Property::ListShort(numbers(words, length)?),
        ScalarType::UShort => Property::ListUShort(numbers(words, length)?),
        ScalarType::Int => Property::ListInt(numbers(words, length)?),
        ScalarType::UInt => Property::ListUInt(numbers(words, length)?),
        ScalarType::Float => Property::ListFloat(numbers(words, length)?),
        ScalarType::Double => Property::ListDouble(numbers(words, length)?),
    })
}

fn numbers<'w, T: FromStr>(words: &mut impl Iterator<Item = &'w str>, length: usize) -> Option<Vec<T>> {
    let list: Vec<T> = words.take(length).map_while(|word| word.parse().ok()).collect();
    (list.len() == length).then_some(list)
}

fn header_fault(source: &Source<'_>, text: &str, line: u64, error: &ParseError) -> FileError {
    let at = FilePlace::Line(line);
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

/// Returns the PLY library's error message on one line, cut to 200 characters.
fn message(error: &ParseError) -> String {
    let words: Vec<String> = error.to_string().split_whitespace().map(str::to_owned).collect();
    words.join(" ").chars().take(200).collect()
}

/// Returns the least size of an element's row in bytes. The size is at least 1, even for rows without properties.
/// Otherwise a header could announce any number of such rows.
fn least_row_bytes(element: &ElementDef, encoding: Encoding) -> u64 {
    let widths = element.properties.values().map(|p| match (&p.data_type, encoding) {
        // In ASCII a number takes at least a digit and a space or line end.
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
