//! What a context has recorded: vertices in the world, primitives of them, and how fragments combine. It knows no display.

use serde::{Deserialize, Serialize};

/// What becomes of several fragments on one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Combine {
    /// The last one drawn stays, as in GL without a depth test.
    #[default]
    Last,
    /// The larger of each channel, whatever the order.
    Max,
    /// The sum of each channel, at most 255, whatever the order.
    Add,
}

/// What a primitive's vertices make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    Triangle,
    /// Width in pixels of the image.
    Line(f64),
    /// Size in pixels of the slice.
    Point(f64),
}

/// One triangle, line or point of a recording; lines use two of the vertices, points one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Primitive {
    pub(crate) shape: Shape,
    pub(crate) vertices: [u32; 3],
    pub(crate) combine: Combine,
}

impl Primitive {
    pub(crate) fn corners(&self) -> &[u32] {
        let count = match self.shape {
            Shape::Triangle => 3,
            Shape::Line(_) => 2,
            Shape::Point(_) => 1,
        };
        &self.vertices[..count]
    }

    /// How far it reaches beyond its vertices around the axis of a display, pixels.
    pub(crate) fn extra(&self) -> f64 {
        if let Shape::Point(size) = self.shape { size / 2.0 } else { 0.0 }
    }
}

/// An immutable recording, replayed for every slice and every pass of every display.
///
/// Vertices are in the world, lit, and were transformed once when they were recorded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CommandBuffer {
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) colours: Vec<[f64; 3]>,
    pub(crate) primitives: Vec<Primitive>,
    pub(crate) background: [u8; 3],
}

/// A triangle as a renderer gets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommandTriangle {
    /// Its corners in the world, pixels.
    pub corners: [[f64; 3]; 3],
    /// Red, green and blue of each corner, lit, 0 to 255.
    pub colours: [[f64; 3]; 3],
}

impl CommandBuffer {
    /// How many vertices were transformed and lit.
    #[must_use]
    pub const fn vertices(&self) -> usize {
        self.positions.len()
    }

    /// Triangles, lines and points.
    #[must_use]
    pub const fn primitives(&self) -> usize {
        self.primitives.len()
    }

    /// Red, green and blue of what nothing is drawn on.
    #[must_use]
    pub const fn background(&self) -> [u8; 3] {
        self.background
    }

    /// The corners of every triangle in the world, in the order of drawing.
    pub fn triangles(&self) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
        let triangles = self.primitives.iter().filter(|primitive| primitive.shape == Shape::Triangle);
        triangles.map(|primitive| primitive.vertices.map(|i| self.positions[i as usize]))
    }

    /// A triangle by its number among the primitives; `None` of a line, a point, and beyond the last one.
    #[must_use]
    pub fn triangle(&self, primitive: u32) -> Option<CommandTriangle> {
        let primitive = self.primitives.get(primitive as usize)?;
        let is_triangle = primitive.shape == Shape::Triangle;
        is_triangle.then(|| CommandTriangle {
            corners: primitive.vertices.map(|i| self.positions[i as usize]),
            colours: primitive.vertices.map(|i| self.colours[i as usize]),
        })
    }

    /// The same primitives with another rule for several fragments on one pixel.
    #[must_use]
    pub fn combining(&self, combine: Combine) -> Self {
        let mut combining = self.clone();
        combining.primitives.iter_mut().for_each(|primitive| primitive.combine = combine);
        combining
    }

    /// The same primitives drawn in the opposite order.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let mut reversed = self.clone();
        reversed.primitives.reverse();
        reversed
    }

    /// Where the vertices are, in the world.
    #[must_use]
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    pub(crate) fn corners_of(&self, primitive: &Primitive) -> ([[f64; 3]; 3], usize) {
        let used = primitive.corners();
        let mut corners = [[0.0; 3]; 3];
        for (corner, i) in corners.iter_mut().zip(used) {
            *corner = self.positions[*i as usize];
        }
        (corners, used.len())
    }
}
