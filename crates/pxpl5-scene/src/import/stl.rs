//! Reader of STL files, ASCII and binary.
//!
//! The existing library stl_io is not used, for three reasons. Its errors lack the line number. The library reads a
//! binary file as text if the header begins with `solid`. The library also refuses normals that are not numbers.

use glam::DVec3;
use pxpl5_sim::parameters::FileError;

use super::Source;
use super::model::{Model, Places, counted, push_with_slow_growth};
use super::source::{MARK, excerpt, is_not_a_number, text};
use crate::error::FilePlace;

/// Number of bytes before the first triangle of a binary file: a header of 80 bytes and the number of triangles.
const HEADER: usize = 84;
/// Number of bytes of a binary triangle: a normal and three corners of three numbers each, and two attribute bytes.
const TRIANGLE: usize = 50;

pub(super) fn read(source: &Source<'_>) -> Result<Model, FileError> {
    match announced_bytes(source.bytes) {
        // Some programs begin the header of a binary file with `solid`, so only the length of the file shows the
        // format.
        Some(bytes) if bytes == source.bytes.len() as u64 => read_binary(source),
        _ if begins_as_text(source.bytes) => read_text(source),
        Some(bytes) if bytes > source.bytes.len() as u64 => {
            let expected = format!("{} triangles in {bytes} bytes", (bytes - HEADER as u64) / TRIANGLE as u64);
            let found = format!("{} bytes", source.bytes.len());
            Err(source.truncated(FilePlace::Byte(HEADER as u64), expected, found))
        }
        Some(bytes) => {
            let expected = "the end of the file behind the last triangle that the header announces";
            let found = format!("{} more bytes", source.bytes.len() as u64 - bytes);
            Err(source.syntax(FilePlace::Byte(bytes), expected, found))
        }
        None => {
            let expected = format!("text that begins with \"solid\", or a binary header of {HEADER} bytes");
            Err(source.syntax(FilePlace::Byte(0), expected, format!("{} other bytes", source.bytes.len())))
        }
    }
}

/// Returns the length that a binary file must have by its header. `None` for a file without a whole header.
fn announced_bytes(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER - 4..HEADER)?.try_into().ok()?;
    Some(HEADER as u64 + u64::from(u32::from_le_bytes(count)) * TRIANGLE as u64)
}

fn begins_as_text(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(MARK).unwrap_or(bytes).trim_ascii_start();
    bytes.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
}

/// Adds a triangle with three new vertices. Each of these vertices later gets the normal of the triangle.
fn push_flat(model: &mut Model, corners: [[f64; 3]; 3]) {
    let first = model.places.len() as u32;
    corners.into_iter().for_each(|corner| model.places.push(DVec3::from_array(corner)));
    push_with_slow_growth(&mut model.triangles, [first, first + 1, first + 2]);
}

fn read_binary(source: &Source<'_>) -> Result<Model, FileError> {
    let triangles = source.bytes[HEADER..].chunks_exact(TRIANGLE);
    let mut model = Model::new(Places::Single(Vec::new()));
    model.places.reserve_exact(3 * triangles.len());
    model.triangles.reserve_exact(triangles.len());
    let mut with_attributes = 0;
    for (number, bytes) in triangles.enumerate() {
        let mut corners = [[0.0; 3]; 3];
        for (i, corner) in corners.iter_mut().enumerate() {
            // The first 12 bytes are the normal.
            let begin = 12 + 12 * i;
            let numbers = bytes[begin..begin + 12].chunks_exact(4);
            for (number, four) in corner.iter_mut().zip(numbers) {
                *number = f32::from_le_bytes([four[0], four[1], four[2], four[3]]).into();
            }
            let at = HEADER + number * TRIANGLE + begin;
            *corner = source.coordinates(FilePlace::Byte(at as u64), *corner)?;
        }
        with_attributes += usize::from(bytes[TRIANGLE - 2..] != [0, 0]);
        push_flat(&mut model, corners);
    }
    if with_attributes > 0 {
        let what = counted(with_attributes, "triangle");
        model.warnings.push(format!("attributes of {what} are not read: some programs write colours there"));
    }
    Ok(model)
}

#[derive(Clone, Copy, PartialEq)]
enum Expects {
    Solid,
    Facet,
    Loop,
    Vertex(usize),
    EndLoop,
    EndFacet,
}

impl Expects {
    const fn describe(self) -> &'static str {
        match self {
            Self::Solid => "\"solid\"",
            Self::Facet => "\"facet normal x y z\" or \"endsolid\"",
            Self::Loop => "\"outer loop\"",
            Self::Vertex(_) => "\"vertex x y z\"",
            Self::EndLoop => "\"endloop\" after three vertices",
            Self::EndFacet => "\"endfacet\"",
        }
    }
}

fn read_text(source: &Source<'_>) -> Result<Model, FileError> {
    let mut model = Model::new(Places::Double(Vec::new()));
    let mut expects = Expects::Solid;
    let mut corners = [[0.0; 3]; 3];
    let mut last = 1;
    for (number, line) in source.lines() {
        let at = FilePlace::Line(number);
        last = number;
        let words: [&[u8]; 5] = {
            let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
            std::array::from_fn(|_| words.next().unwrap_or_default())
        };
        if words[0].is_empty() {
            continue;
        }
        let is = |n: usize, word: &str| words[n].eq_ignore_ascii_case(word.as_bytes());
        expects = match expects {
            Expects::Solid if is(0, "solid") => Expects::Facet,
            // The numbers of the normal are not used. NaN is common there.
            Expects::Facet if is(0, "facet") => Expects::Loop,
            Expects::Facet if is(0, "endsolid") => Expects::Solid,
            Expects::Loop if is(0, "outer") && is(1, "loop") => Expects::Vertex(0),
            Expects::Vertex(n) if is(0, "vertex") => {
                corners[n] = source.coordinates(at, vertex(source, at, [words[1], words[2], words[3]])?)?;
                if n == 2 { Expects::EndLoop } else { Expects::Vertex(n + 1) }
            }
            Expects::EndLoop if is(0, "endloop") => Expects::EndFacet,
            Expects::EndFacet if is(0, "endfacet") => {
                push_flat(&mut model, corners);
                Expects::Facet
            }
            _ => return Err(source.syntax(at, expects.describe(), excerpt(&String::from_utf8_lossy(line)))),
        };
    }
    // The last `endsolid` may be missing, but no triangle may be cut.
    if !matches!(expects, Expects::Solid | Expects::Facet) {
        return Err(source.truncated(FilePlace::Line(last), expects.describe(), "the end of the file"));
    }
    Ok(model)
}

fn vertex(source: &Source<'_>, at: FilePlace, words: [&[u8]; 3]) -> Result<[f64; 3], FileError> {
    let mut place = [0.0; 3];
    for ((number, word), axis) in place.iter_mut().zip(words).zip(["x", "y", "z"]) {
        let word = text(word);
        *number = match word.parse() {
            _ if is_not_a_number(word) => f64::NAN,
            Ok(number) => number,
            Err(_) => return Err(source.syntax(at, format!("a number for {axis}"), excerpt(word))),
        };
    }
    Ok(place)
}
