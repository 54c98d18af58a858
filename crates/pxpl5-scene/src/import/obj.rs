//! Reader of Wavefront OBJ files.
//!
//! The existing library tobj is not used, because its errors lack the line number, the expected content and the found
//! content.

use glam::{DVec3, Vec3};
use pxpl5_sim::parameters::FileError;

use super::Source;
use super::model::{Model, Places, Vertices, push_with_slow_growth};
use super::source::{excerpt, text};
use crate::config::DEFAULT_COLOUR;
use crate::error::FilePlace;

pub(super) fn read(source: &Source<'_>) -> Result<Model, FileError> {
    let mut reader = Reader::new(source)?;
    // Faces may come before the vertices that they refer to, so points are read first.
    for (number, line) in statements(source) {
        reader.point(FilePlace::Line(number), line)?;
    }
    for (number, line) in statements(source) {
        reader.surface(FilePlace::Line(number), line)?;
    }
    Ok(reader.finished())
}

struct Reader<'a> {
    source: &'a Source<'a>,
    counts: Counts,
    /// Number of points up to the current line. Negative indices count back from this number.
    points: usize,
    normals: usize,
    /// Smoothing group that the last `s` statement has set, with the number that corners store for the group. `None`
    /// for flat faces.
    smoothing: Option<u32>,
    vertices: Vertices,
    model: Model,
}

/// Numbers of points, normals and triangles in a file. The lists of a model are allocated with their final lengths,
/// because a growing list is copied.
#[derive(Default)]
struct Counts {
    points: usize,
    normals: usize,
    triangles: usize,
    /// Largest component of any colour in the file.
    brightest: f64,
    /// True if a component of a colour is not a whole number.
    has_fractions: bool,
    has_materials: bool,
}

impl Counts {
    /// Counts the points, normals and triangles of a file. Of each line, only the first word, the number of words and
    /// the numbers of a colour are read.
    fn of(source: &Source<'_>) -> Self {
        let mut counts = Self::default();
        for (_, line) in statements(source) {
            let mut words = words(line);
            match words.next() {
                Some(b"v") => {
                    counts.points += 1;
                    // Three coordinates come first. All colours together show the scale of each colour.
                    let mut parts = words.skip(3).take(3).filter_map(|word| text(word).parse::<f64>().ok());
                    let colour = [parts.next(), parts.next(), parts.next()];
                    for part in colour.into_iter().flatten().filter(|_| colour[2].is_some()) {
                        counts.brightest = counts.brightest.max(part);
                        counts.has_fractions |= part.fract() != 0.0;
                    }
                }
                Some(b"vn") => counts.normals += 1,
                // A face of n corners is cut into n - 2 triangles.
                Some(b"f") => counts.triangles += words.count().saturating_sub(2),
                Some(b"usemtl") => counts.has_materials = true,
                _ => {}
            }
        }
        counts
    }
}

/// Returns the statements of a file, each with the number of its first line. A line that ends in `\` continues on the
/// next line. A comment never continues, because a folder's path in a comment can end in `\`.
fn statements<'a>(source: &Source<'a>) -> impl Iterator<Item = (u64, &'a [u8])> {
    let mut lines = source.lines();
    let bytes = source.bytes;
    std::iter::from_fn(move || {
        let (number, first) = lines.next()?;
        let mut last = first;
        while last.trim_ascii_end().ends_with(b"\\") && code(last).len() == last.len() {
            match lines.next() {
                Some((_, line)) => last = line,
                None => break,
            }
        }
        // The lines are adjacent in the file, so the statement is one slice of its bytes.
        let begin = first.as_ptr() as usize - bytes.as_ptr() as usize;
        let end = last.as_ptr() as usize - bytes.as_ptr() as usize + last.len();
        Some((number, &bytes[begin..end]))
    })
}

/// Returns the part of a line before its comment. The `#` in `1.#QNAN` does not begin a comment.
fn code(line: &[u8]) -> &[u8] {
    let is_comment = |at: &usize| line[*at] == b'#' && (*at == 0 || line[at - 1] != b'.');
    &line[..(0..line.len()).find(is_comment).unwrap_or(line.len())]
}

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    code(line)
        .split(u8::is_ascii_whitespace)
        .map(|word| word.strip_suffix(b"\\").unwrap_or(word))
        .filter(|w| !w.is_empty())
}

impl<'a> Reader<'a> {
    fn new(source: &'a Source<'a>) -> Result<Self, FileError> {
        let counts = Counts::of(source);
        // Allocate the lists with their final lengths.
        let mut model = Model::new(Places::Double(Vec::new()));
        model.places.reserve_exact(counts.points);
        model.normals.reserve_exact(counts.normals);
        model.triangles.reserve_exact(counts.triangles);
        Ok(Self { source, counts, points: 0, normals: 0, smoothing: None, vertices: Vertices::default(), model })
    }

    fn finished(self) -> Model {
        let mut model = self.model;
        model.corners.shrink_to_fit();
        if self.counts.has_materials && model.colours.is_empty() {
            model.warnings.push("colours of materials (usemtl) are not read: faces have one colour".to_owned());
        }
        model
    }

    fn point(&mut self, at: FilePlace, line: &[u8]) -> Result<(), FileError> {
        let mut words = words(line);
        match words.next() {
            Some(b"v") => {
                let place = self.vector(at, &mut words)?;
                self.model.places.push(self.source.coordinates(at, place)?.into());
                self.colour(at, words)
            }
            Some(b"vn") => {
                let normal = self.vector(at, &mut words)?;
                self.model.push_normal(at, DVec3::from_array(normal));
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Reads a statement that defines a face or the shading of faces. Statements for texture coordinates, groups,
    /// objects, materials and curves are ignored.
    fn surface(&mut self, at: FilePlace, line: &[u8]) -> Result<(), FileError> {
        let mut words = words(line);
        match words.next() {
            Some(b"v") => self.points += 1,
            Some(b"vn") => self.normals += 1,
            Some(b"s") => self.smoothing = words.next().and_then(smoothing_group),
            Some(b"f") => self.face(at, line, words)?,
            _ => {}
        }
        Ok(())
    }

    fn face<'w>(&mut self, at: FilePlace, line: &[u8], words: impl Iterator<Item = &'w [u8]>) -> Result<(), FileError> {
        let first = self.model.triangles.len();
        // The normal of a flat face is computed after its corners are read. The normal will then get this index.
        let flat = self.model.normals.len() as u32 + 1;
        let mut needs_normal = false;
        let mut corners = [0; 2];
        let mut count = 0;
        // Add triangles that all share the first corner.
        for word in words {
            let (point, normal) = self.corner(at, word)?;
            needs_normal |= normal.is_none() && self.smoothing.is_none();
            let detail = normal.or(self.smoothing).unwrap_or(flat);
            let vertex = self.vertices.of(&mut self.model.corners, (point, detail));
            match count {
                0 | 1 => corners[count] = vertex,
                _ => {
                    self.model.triangles.push([corners[0], corners[1], vertex]);
                    corners[1] = vertex;
                }
            }
            count += 1;
        }
        if count < 3 {
            let found = format!("{count} in {}", excerpt(&String::from_utf8_lossy(code(line))));
            return Err(self.source.syntax(at, "a face of at least 3 corners", found));
        }
        // Add the normal of a flat face. If the polygon is concave, replace its triangles.
        if needs_normal {
            let normal = self.model.polygon_normal(first);
            push_with_slow_growth(&mut self.model.normals, normal);
        }
        self.model.cut_polygon(first);
        self.model.check_reading(self.source, 0)
    }

    fn vector<'w>(&self, at: FilePlace, words: &mut impl Iterator<Item = &'w [u8]>) -> Result<[f64; 3], FileError> {
        let mut v = [0.0; 3];
        for (x, axis) in v.iter_mut().zip(["x", "y", "z"]) {
            *x = self.source.number(at, axis, words.next().unwrap_or_default())?;
        }
        Ok(v)
    }

    /// Reads the colour that may follow the coordinates of a point. A single number after the coordinates is a weight
    /// and is ignored.
    fn colour<'w>(&mut self, at: FilePlace, mut words: impl Iterator<Item = &'w [u8]>) -> Result<(), FileError> {
        let found = [words.next(), words.next(), words.next()];
        let colour = match found {
            [Some(red), Some(green), Some(blue)] => {
                // Colours are bytes only if all are whole numbers. One fraction above 1 does not make them bytes.
                let full = if self.counts.brightest > 1.0 && !self.counts.has_fractions { 1.0 } else { 255.0 };
                let mut colour = [0; 3];
                for (part, (name, word)) in colour.iter_mut().zip([("red", red), ("green", green), ("blue", blue)]) {
                    *part = (self.source.number(at, name, word)? * full + 0.5) as u8;
                }
                colour
            }
            _ if self.model.colours.is_empty() => return Ok(()),
            _ => DEFAULT_COLOUR,
        };
        // Points before the first coloured point get the default colour.
        if self.model.colours.is_empty() {
            self.model.colours.reserve_exact(self.counts.points);
            self.model.colours.resize(self.model.places.len() - 1, DEFAULT_COLOUR);
        }
        self.model.colours.push(colour);
        Ok(())
    }

    /// Reads a corner in one of the forms point, point/texture, point//normal or point/texture/normal. Returns the
    /// indices of the point (from 0) and of the normal (from 1).
    fn corner(&self, at: FilePlace, word: &[u8]) -> Result<(u32, Option<u32>), FileError> {
        let mut fields = text(word).splitn(3, '/');
        let point = fields.next().unwrap_or_default();
        let point = self.index(at, "vertices", point, [self.points, self.counts.points])?;
        let normal = match fields.nth(1) {
            None | Some("") => return Ok((point, None)),
            Some(normal) => self.index(at, "normals", normal, [self.normals, self.counts.normals])? + 1,
        };
        let is_given = self.model.normals[normal as usize - 1] != Vec3::ZERO;
        Ok((point, is_given.then_some(normal)))
    }

    /// Parses an index. 1 is the first item of the file, and -1 is the last item before this line.
    fn index(
        &self,
        at: FilePlace,
        what: &'static str,
        word: &str,
        [so_far, all]: [usize; 2],
    ) -> Result<u32, FileError> {
        let written: i64 =
            word.parse().map_err(|_| self.source.syntax(at, format!("an index of {what}"), excerpt(word)))?;
        let zero_based = if written < 0 { written.saturating_add(so_far as i64) } else { written - 1 };
        self.source.index(at, what, zero_based, all, written)
    }
}

/// Parses the smoothing group of an `s` statement. Returns `None` if the statement turns smoothing off.
fn smoothing_group(word: &[u8]) -> Option<u32> {
    let group = match text(word).parse::<u64>() {
        Ok(group) => group,
        Err(_) => u64::from(!word.eq_ignore_ascii_case(b"off")),
    };
    // Numbers from 2^31 on are not used for normals.
    (group > 0).then_some(1 << 31 | group as u32)
}
