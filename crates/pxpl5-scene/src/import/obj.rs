//! Wavefront OBJ.
//!
//! Read here and not by a library: the well-kept one, tobj, reports no line, no expectation and no finding.

use std::hash::{BuildHasher, RandomState};

use glam::DVec3;
use hashbrown::HashTable;

use super::Source;
use super::model::{Corner, Model, Places, direction};
use super::source::excerpt;
use crate::error::{FilePlace, LoadError};

pub(super) fn read(source: &Source<'_>) -> Result<Model, LoadError> {
    let mut reader = Reader::new(source)?;
    for (number, line) in source.lines()? {
        reader.line(FilePlace::Line(number), line)?;
    }
    let mut model = reader.model;
    model.corners.shrink_to_fit();
    Ok(model)
}

struct Reader<'a> {
    source: &'a Source<'a>,
    /// The vertices by their corners, in 5 bytes each: the corners themselves are the model's. Looked up only, never walked, so
    /// its order shows nowhere.
    vertices: HashTable<u32>,
    hasher: RandomState,
    model: Model,
}

/// How many of what there are in a file: the lists of a model are as long from the begin, since lists that grow are copied.
#[derive(Default)]
struct Counts {
    points: usize,
    normals: usize,
    triangles: usize,
}

impl Counts {
    /// Looks at the words of all lines and at no number.
    fn of(source: &Source<'_>) -> Result<Self, LoadError> {
        let mut counts = Self::default();
        for (_, line) in source.lines()? {
            let mut words = words(line);
            match words.next() {
                Some("v") => counts.points += 1,
                Some("vn") => counts.normals += 1,
                Some("f") => counts.triangles += words.count().saturating_sub(2),
                _ => {}
            }
        }
        Ok(counts)
    }
}

/// The words of a line in front of its comment.
fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split('#').next().unwrap_or_default().split_whitespace()
}

impl<'a> Reader<'a> {
    fn new(source: &'a Source<'a>) -> Result<Self, LoadError> {
        let counts = Counts::of(source)?;
        let mut model = Model::new(Places::Double(Vec::new()));
        model.places.reserve_exact(counts.points);
        model.normals.reserve_exact(counts.normals);
        model.triangles.reserve_exact(counts.triangles);
        Ok(Self { source, vertices: HashTable::new(), hasher: RandomState::new(), model })
    }

    fn line(&mut self, at: FilePlace, line: &str) -> Result<(), LoadError> {
        let mut words = words(line);
        match words.next() {
            Some("v") => self.model.places.push(self.vector(at, words)?),
            Some("vn") => self.model.normals.push(direction(self.vector(at, words)?)),
            Some("f") => self.face(at, line, words)?,
            // Texture coordinates, groups, objects, materials, smoothing groups, curves.
            _ => {}
        }
        Ok(())
    }

    /// Cuts a polygon into triangles that share its first corner.
    fn face<'w>(&mut self, at: FilePlace, line: &str, words: impl Iterator<Item = &'w str>) -> Result<(), LoadError> {
        let mut known = [0; 2];
        let mut count = 0;
        for word in words {
            let corner = self.corner(at, word)?;
            match count {
                0 | 1 => known[count] = corner,
                _ => {
                    self.model.triangles.push([known[0], known[1], corner]);
                    known[1] = corner;
                }
            }
            count += 1;
        }
        if count < 3 {
            let found = format!("{count} in {}", excerpt(line.split('#').next().unwrap_or_default()));
            return Err(self.source.syntax(at, "a face of at least 3 corners", found));
        }
        Ok(())
    }

    fn vector<'w>(&self, at: FilePlace, mut words: impl Iterator<Item = &'w str>) -> Result<DVec3, LoadError> {
        let mut v = [0.0; 3];
        for (x, axis) in v.iter_mut().zip(["x", "y", "z"]) {
            let word = words.next().unwrap_or_default();
            *x = word.parse().map_err(|_| {
                let expected = format!("a number for {axis}");
                self.source.syntax(at, expected, excerpt(word))
            })?;
        }
        self.source.coordinates(at, v).map(DVec3::from_array)
    }

    /// A corner is point, point/texture, point//normal or point/texture/normal.
    fn corner(&mut self, at: FilePlace, word: &str) -> Result<u32, LoadError> {
        let mut fields = word.splitn(3, '/');
        let point = fields.next().unwrap_or_default();
        let point = self.index(at, "vertices", point, self.model.places.len())?;
        let normal = match fields.nth(1) {
            None | Some("") => 0,
            Some(normal) => self.index(at, "normals", normal, self.model.normals.len())? + 1,
        };
        Ok(self.vertex((point, normal)))
    }

    /// The vertex of a corner: a new one where there is none yet.
    fn vertex(&mut self, corner: Corner) -> u32 {
        let corners = &mut self.model.corners;
        let hash = self.hasher.hash_one(corner);
        if let Some(&known) = self.vertices.find(hash, |&vertex| corners[vertex as usize] == corner) {
            return known;
        }
        let next = corners.len() as u32;
        if corners.len() == corners.capacity() {
            // By an eighth, not twice: a file can consist of corners.
            corners.reserve_exact(corners.len() / 8 + 1024);
        }
        corners.push(corner);
        let hasher = &self.hasher;
        self.vertices.insert_unique(hash, next, |&vertex| hasher.hash_one(corners[vertex as usize]));
        next
    }

    /// 1 is the first of the file; -1 the last so far.
    fn index(&self, at: FilePlace, what: &'static str, word: &str, count: usize) -> Result<u32, LoadError> {
        let written: i64 =
            word.parse().map_err(|_| self.source.syntax(at, format!("an index of {what}"), excerpt(word)))?;
        let zero_based = if written < 0 { written.saturating_add(count as i64) } else { written - 1 };
        self.source.index(at, what, zero_based, count, written)
    }
}
