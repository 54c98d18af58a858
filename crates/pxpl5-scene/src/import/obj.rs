//! Wavefront OBJ.
//!
//! Read here and not by a library: the well-kept one, tobj, reports no line, no expectation and no finding.

use std::collections::HashMap;

use glam::DVec3;

use super::source::excerpt;
use super::{Mesh, Source};
use crate::config::DEFAULT_COLOUR;
use crate::error::{LoadError, Place};
use crate::scene::Scene;

pub(super) fn read(source: &Source<'_>) -> Result<Scene, LoadError> {
    let mut reader =
        Reader { source, points: Vec::new(), normals: Vec::new(), corners: HashMap::new(), mesh: Mesh::default() };
    for (number, line) in source.lines()? {
        reader.line(Place::Line(number), line)?;
    }
    // What faces refer to is not needed any more, and takes as much as the mesh.
    let Reader { mesh, .. } = { reader };
    mesh.into_scene(source)
}

struct Reader<'a> {
    source: &'a Source<'a>,
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    /// Vertex of the mesh by point and normal. Looked up only, never walked, so its order shows nowhere.
    corners: HashMap<(u32, Option<u32>), u32>,
    mesh: Mesh,
}

impl Reader<'_> {
    fn line(&mut self, at: Place, line: &str) -> Result<(), LoadError> {
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

    fn vector<'w>(&self, at: Place, mut words: impl Iterator<Item = &'w str>) -> Result<DVec3, LoadError> {
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
    fn corner(&mut self, at: Place, word: &str) -> Result<u32, LoadError> {
        let mut fields = word.splitn(3, '/');
        let point = fields.next().unwrap_or_default();
        let point = self.index(at, "vertices", point, self.points.len())?;
        let normal = match fields.nth(1) {
            None | Some("") => None,
            Some(normal) => Some(self.index(at, "normals", normal, self.normals.len())?),
        };
        Ok(self.vertex(point, normal))
    }

    fn vertex(&mut self, point: u32, normal: Option<u32>) -> u32 {
        let mesh = &mut self.mesh;
        *self.corners.entry((point, normal)).or_insert_with(|| {
            let vertex = mesh.positions.len() as u32;
            let direction = normal.map_or(DVec3::ZERO, |n| self.normals[n as usize]);
            let position = self.points[point as usize];
            mesh.push_on_point(point, position, direction, DEFAULT_COLOUR);
            vertex
        })
    }

    /// 1 is the first of the file; -1 the last so far.
    fn index(&self, at: Place, what: &'static str, word: &str, count: usize) -> Result<u32, LoadError> {
        let written: i64 =
            word.parse().map_err(|_| self.source.syntax(at, format!("an index of {what}"), excerpt(word)))?;
        let zero_based = if written < 0 { written.saturating_add(count as i64) } else { written - 1 };
        self.source.index(at, what, zero_based, count, written)
    }
}
