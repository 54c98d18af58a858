//! Wavefront OBJ.
//!
//! Read here and not by a library: the well-kept one, tobj, reports no line, no expectation and no finding.

use std::collections::HashMap;

use glam::DVec3;

use super::source::excerpt;
use super::{Mesh, Source};
use crate::config::DEFAULT_COLOUR;
use crate::error::{FilePlace, LoadError};
use crate::scene::Scene;

pub(super) fn read(source: &Source<'_>) -> Result<Scene, LoadError> {
    let mut reader = Reader::new(source);
    for (number, line) in source.lines()? {
        reader.line(FilePlace::Line(number), line)?;
    }
    reader.into_mesh().into_scene(source)
}

struct Reader<'a> {
    source: &'a Source<'a>,
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    /// Vertex of the mesh by its corner. Looked up only, never walked, so its order shows nowhere.
    vertices: HashMap<Corner, u32>,
    /// The corners in the order of their vertices.
    corners: Vec<Corner>,
    mesh: Mesh,
}

/// A point, and its normal counted from 1; 0 for none. Short, since a file can have many times more of them than points.
type Corner = (u32, u32);

impl<'a> Reader<'a> {
    fn new(source: &'a Source<'a>) -> Self {
        Self {
            source,
            points: Vec::new(),
            normals: Vec::new(),
            vertices: HashMap::new(),
            corners: Vec::new(),
            mesh: Mesh::default(),
        }
    }

    /// The vertices with their places and normals, when all of them are known and nothing is looked up any more.
    fn into_mesh(self) -> Mesh {
        let Self { points, normals, vertices, corners, mut mesh, .. } = self;
        drop(vertices);
        mesh.positions.reserve_exact(corners.len());
        for (point, normal) in corners {
            let direction = if normal == 0 { DVec3::ZERO } else { normals[normal as usize - 1] };
            mesh.push_on_point(point, points[point as usize], direction, DEFAULT_COLOUR);
        }
        mesh
    }

    fn line(&mut self, at: FilePlace, line: &str) -> Result<(), LoadError> {
        let line = line.split('#').next().unwrap_or_default();
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => self.points.push(self.vector(at, words)?),
            Some("vn") => self.normals.push(self.vector(at, words)?),
            Some("f") => {
                let corners = words.map(|word| self.corner(at, word));
                let corners: Vec<u32> = corners.collect::<Result<_, _>>()?;
                if corners.len() < 3 {
                    let found = format!("{} in {}", corners.len(), excerpt(line));
                    return Err(self.source.syntax(at, "a face of at least 3 corners", found));
                }
                self.mesh.fan(&corners);
            }
            // Texture coordinates, groups, objects, materials, smoothing groups, curves.
            _ => {}
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
        let point = self.index(at, "vertices", point, self.points.len())?;
        let normal = match fields.nth(1) {
            None | Some("") => 0,
            Some(normal) => self.index(at, "normals", normal, self.normals.len())? + 1,
        };
        Ok(self.vertex((point, normal)))
    }

    fn vertex(&mut self, corner: Corner) -> u32 {
        let next = self.corners.len() as u32;
        let vertex = *self.vertices.entry(corner).or_insert(next);
        if vertex == next {
            self.corners.push(corner);
        }
        vertex
    }

    /// 1 is the first of the file; -1 the last so far.
    fn index(&self, at: FilePlace, what: &'static str, word: &str, count: usize) -> Result<u32, LoadError> {
        let written: i64 =
            word.parse().map_err(|_| self.source.syntax(at, format!("an index of {what}"), excerpt(word)))?;
        let zero_based = if written < 0 { written.saturating_add(count as i64) } else { written - 1 };
        self.source.index(at, what, zero_based, count, written)
    }
}
