//! Construction of solids from cross-sections.

use std::ops::Range;

use glam::DVec3;

use crate::edit::Hinge;
use crate::import::Mesh;
use crate::scene::{Frame, Structure};

pub(super) type Colour = [u8; 3];

/// A mesh that is built from parts. Each part has its own normals.
#[derive(Default)]
pub(super) struct Solid {
    pub(super) mesh: Mesh,
    pub(super) structures: Vec<Structure>,
}

impl Solid {
    /// Ends the current structure. The structure contains everything added since the end of the previous structure.
    pub(super) fn end_structure(&mut self, name: &str, hinge: Option<Hinge>) {
        let (vertex, triangle) = self.structures.last().map_or((0, 0), |s| (s.vertices.end, s.triangles.end));
        self.structures.push(Structure {
            name: name.to_owned(),
            vertices: vertex..self.mesh.positions.len(),
            triangles: triangle..self.mesh.triangles.len(),
            spheres: 0..0,
            frame: Frame::World,
            hinge,
            culls_back_faces: false,
        });
    }

    /// Adds a surface between successive closed cross-sections with equal numbers of points. The normals of the surface
    /// are smooth along the cross-sections and from one cross-section to the next.
    ///
    /// The points run anticlockwise as seen from the last cross-section. For n points and m cross-sections the surface
    /// has 2 n (m - 1) triangles.
    pub(super) fn skin(&mut self, sections: &[Vec<DVec3>], colour: Colour) {
        let mut part = Mesh::default();
        for section in sections {
            for &point in section {
                part.push(point, DVec3::ZERO, colour);
            }
        }
        // Join each section with the next, side by side.
        let sides = sections[0].len() as u32;
        for ring in 0..sections.len() as u32 - 1 {
            for side in 0..sides {
                let next = (side + 1) % sides;
                let low = ring * sides;
                let high = (ring + 1) * sides;
                part.fan(&[low + side, low + next, high + next, high + side]);
            }
        }
        self.append(part);
    }

    /// Adds a surface between successive closed cross-sections. Each side of the cross-sections gives a band, which has
    /// smooth normals along its length. The edges between bands are sharp.
    pub(super) fn plates(&mut self, sections: &[Vec<DVec3>], colour: Colour) {
        let sides = sections[0].len();
        for side in 0..sides {
            let next = (side + 1) % sides;
            let strip: Vec<[DVec3; 2]> = sections.iter().map(|s| [s[side], s[next]]).collect();
            self.strip(&strip, colour);
        }
    }

    /// Adds a band of quadrilaterals between successive pairs of points, with smooth normals along the band.
    pub(super) fn strip(&mut self, rungs: &[[DVec3; 2]], colour: Colour) {
        let mut part = Mesh::default();
        for &[left, right] in rungs {
            part.push(left, DVec3::ZERO, colour);
            part.push(right, DVec3::ZERO, colour);
        }
        for i in 0..rungs.len() as u32 - 1 {
            part.fan(&[2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2]);
        }
        self.append(part);
    }

    /// Adds a flat polygon of n points as n - 2 triangles. The points run anticlockwise seen from outside.
    pub(super) fn face(&mut self, points: &[DVec3], colour: Colour) {
        let mut part = Mesh::default();
        let corners: Vec<u32> = points.iter().map(|&p| part.push(p, DVec3::ZERO, colour)).collect();
        part.fan(&corners);
        self.append(part);
    }

    /// Adds a cone from a closed cross-section to a tip, with one triangle for each point of the cross-section. The
    /// points run anticlockwise seen from the tip.
    pub(super) fn cone(&mut self, section: &[DVec3], tip: DVec3, colour: Colour) {
        let mut part = Mesh::default();
        for &point in section {
            part.push(point, DVec3::ZERO, colour);
        }
        let tip = part.push(tip, DVec3::ZERO, colour);
        let sides = section.len() as u32;
        for side in 0..sides {
            part.fan(&[side, (side + 1) % sides, tip]);
        }
        self.append(part);
    }

    /// Calls `chosen` with the position of each vertex in `range`. If the result is true, the vertex gets `colour`.
    pub(super) fn paint(&mut self, range: Range<usize>, colour: Colour, chosen: impl Fn(DVec3) -> bool) {
        for vertex in range {
            if chosen(self.mesh.positions[vertex]) {
                self.mesh.colours[vertex] = colour;
            }
        }
    }

    pub(super) fn append(&mut self, mut part: Mesh) {
        part.complete_normals();
        let base = self.mesh.positions.len() as u32;
        self.mesh.positions.append(&mut part.positions);
        self.mesh.normals.append(&mut part.normals);
        self.mesh.colours.append(&mut part.colours);
        let triangles = part.triangles.iter().map(|t| t.map(|corner| corner + base));
        self.mesh.triangles.extend(triangles);
    }
}
