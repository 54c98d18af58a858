//! Reader of STL files, ASCII and binary.
//!
//! The existing library stl_io is not used, for three reasons. Its errors lack the line number. The library reads a
//! binary file as text if the header begins with `solid`. The library also refuses normals that are not numbers.

use glam::DVec3;
use pxpl5_sim::parameters::FileError;

use super::Source;
use super::model::{Model, Places, counted, push_with_slow_growth};
use super::source::{MARK, excerpt, without_padding};
use crate::error::FilePlace;

/// Number of bytes before the first triangle of a binary file: a header of 80 bytes and the number of triangles.
const HEADER: usize = 84;
/// Number of bytes of a binary triangle: a normal and three corners of three numbers each, and two attribute bytes.
const TRIANGLE: usize = 50;

pub(super) fn read(source: &Source<'_>) -> Result<Model, FileError> {
    let found = source.bytes.len() as u64;
    match announced_bytes(source.bytes) {
        // Some programs begin the header of a binary file with `solid`. Such a file has a length that fits.
        Some(bytes) if bytes == found => read_binary(source, bytes),
        _ if is_text(source.bytes) => read_text(source),
        // A few more bytes than announced do no harm, but a count of 0 is wrong then.
        Some(bytes) if bytes < found && bytes > HEADER as u64 => read_binary(source, bytes),
        Some(bytes) if bytes > found => {
            let expected = format!("{} triangles in {bytes} bytes", (bytes - HEADER as u64) / TRIANGLE as u64);
            Err(source.truncated(FilePlace::Byte(HEADER as u64), expected, format!("{found} bytes")))
        }
        Some(bytes) => {
            let expected = "the end of the file behind the last triangle that the header announces";
            Err(source.syntax(FilePlace::Byte(bytes), expected, format!("{} more bytes", found - bytes)))
        }
        None => {
            let expected = format!("text that begins with \"solid\", or a binary header of {HEADER} bytes");
            Err(source.syntax(FilePlace::Byte(0), expected, format!("{found} other bytes")))
        }
    }
}

/// Returns the length that a binary file must have by its header. `None` for a file without a whole header.
fn announced_bytes(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER - 4..HEADER)?.try_into().ok()?;
    Some(HEADER as u64 + u64::from(u32::from_le_bytes(count)) * TRIANGLE as u64)
}

/// Returns true for a file that begins with the word `solid` and has no zero bytes where a binary file has its count.
fn is_text(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(MARK).unwrap_or(bytes).trim_ascii_start();
    let begins = text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    begins
        && !bytes
            .get(HEADER - 4..HEADER)
            .is_some_and(|count| count.contains(&0) && without_padding(bytes).len() > HEADER)
}

/// Adds a triangle with three new vertices. Each of these vertices later gets the normal of the triangle.
fn push_flat(model: &mut Model, corners: [[f64; 3]; 3]) {
    let first = model.places.len() as u32;
    corners.into_iter().for_each(|corner| model.places.push(DVec3::from_array(corner)));
    push_with_slow_growth(&mut model.triangles, [first, first + 1, first + 2]);
}

fn read_binary(source: &Source<'_>, end: u64) -> Result<Model, FileError> {
    let triangles = source.bytes[HEADER..end as usize].chunks_exact(TRIANGLE);
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
    if end < source.bytes.len() as u64 {
        let what = counted(source.bytes.len() - end as usize, "byte");
        model.warnings.push(format!("{what} after the last triangle that the header announces: not read"));
    }
    Ok(model)
}

/// The words of a text file from a position on. Words may be separated by any white space.
#[derive(Clone, Copy)]
struct Words<'a> {
    rest: &'a [u8],
    line: u64,
    /// Byte that ends a line.
    end: u8,
}

impl<'a> Words<'a> {
    fn of(source: &Source<'a>) -> Self {
        let rest = without_padding(source.bytes.strip_prefix(MARK).unwrap_or(source.bytes));
        Self { rest, line: 1, end: if rest.contains(&b'\n') { b'\n' } else { b'\r' } }
    }

    /// Moves to the next word and returns it. It is empty at the end of the file.
    fn next(&mut self) -> &'a [u8] {
        self.skip_space();
        let length = self.rest.iter().position(u8::is_ascii_whitespace).unwrap_or(self.rest.len());
        let word;
        (word, self.rest) = self.rest.split_at(length);
        word
    }

    fn skip_space(&mut self) {
        let length = self.rest.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(self.rest.len());
        self.line += self.rest[..length].iter().filter(|byte| **byte == self.end).count() as u64;
        self.rest = &self.rest[length..];
    }

    /// Skips these words if they come next, in upper or lower case.
    fn takes(&mut self, words: &[&str]) -> bool {
        let mut ahead = *self;
        let are_next = words.iter().all(|word| ahead.next().eq_ignore_ascii_case(word.as_bytes()));
        if are_next {
            *self = ahead;
        }
        are_next
    }

    fn expect(&mut self, source: &Source<'_>, words: [&[&str]; 2], expected: &str) -> Result<(), FileError> {
        if words.into_iter().any(|words| self.takes(words)) {
            return Ok(());
        }
        self.skip_space();
        let at = FilePlace::Line(self.line);
        if self.rest.is_empty() {
            return Err(source.truncated(at, expected, "the end of the file"));
        }
        let line = self.rest.split(|byte| *byte == self.end).next().unwrap_or_default();
        Err(source.syntax(at, expected, excerpt(&String::from_utf8_lossy(line))))
    }

    /// Skips the rest of a line up to a facet or a solid. Names of solids may have any words.
    fn skip_name(&mut self) {
        let mut ahead = *self;
        let is_keyword = |mut at: Self| at.takes(&["facet", "normal"]) || at.takes_solid();
        while !is_keyword(*self) && !ahead.next().is_empty() && ahead.line == self.line {
            *self = ahead;
        }
    }

    /// Skips the word that begins or ends a solid.
    fn takes_solid(&mut self) -> bool {
        self.takes(&["solid"]) || self.takes(&["endsolid"]) || self.takes(&["end", "solid"])
    }
}

fn read_text(source: &Source<'_>) -> Result<Model, FileError> {
    let mut model = Model::new(Places::Double(Vec::new()));
    let mut words = Words::of(source);
    loop {
        if words.takes_solid() {
            words.skip_name();
            continue;
        }
        words.skip_space();
        // The last `endsolid` may be missing, but no triangle may be cut.
        if words.rest.is_empty() {
            return Ok(model);
        }
        words.expect(source, [&["facet", "normal"], &["facet"]], "\"facet normal x y z\" or \"endsolid\"")?;
        // The numbers of the normal are not used. NaN is common there.
        (0..3).for_each(|_| {
            let mut ahead = words;
            if !ahead.next().eq_ignore_ascii_case(b"outer") {
                words = ahead;
            }
        });
        words.expect(source, [&["outer", "loop"]; 2], "\"outer loop\"")?;
        let mut corners = [[0.0; 3]; 3];
        for corner in &mut corners {
            words.expect(source, [&["vertex"]; 2], "\"vertex x y z\"")?;
            let place = vertex(source, &mut words)?;
            *corner = source.coordinates(FilePlace::Line(words.line), place)?;
        }
        words.expect(source, [&["endloop"], &["end", "loop"]], "\"endloop\" after three vertices")?;
        words.expect(source, [&["endfacet"], &["end", "facet"]], "\"endfacet\"")?;
        push_flat(&mut model, corners);
    }
}

fn vertex(source: &Source<'_>, words: &mut Words<'_>) -> Result<[f64; 3], FileError> {
    let mut place = [0.0; 3];
    for (number, axis) in place.iter_mut().zip(["x", "y", "z"]) {
        let word = words.next();
        *number = source.number(FilePlace::Line(words.line), axis, word)?;
    }
    Ok(place)
}
