//! The recorded draw calls of a context: vertices in world coordinates, their primitives, and the rule for several
//! fragments on one pixel. Recorded draw calls do not depend on the display.

use serde::{Deserialize, Serialize};

/// The rule for the colour of a pixel with several fragments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Combine {
    /// The last fragment replaces earlier fragments, as in GL without a depth test.
    #[default]
    Last,
    /// Each channel is the maximum over all fragments. The order of drawing does not matter.
    Max,
    /// Each channel is the sum over all fragments, limited to 255. The order of drawing does not matter.
    Add,
}

impl Combine {
    pub const ALL: [(&'static str, Self); 3] = [("last", Self::Last), ("max", Self::Max), ("add", Self::Add)];
}

pxpl5_sim::parameters::named!(Combine, "way to combine slices", Combine::ALL);

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    Triangle,
    /// A line, with its width in pixels of the image.
    Line(f64),
    /// A point, with the side of its square in pixels of the slice.
    Point(f64),
}

/// A triangle, line or point of a command buffer. A line uses two vertices, and a point uses one.
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

    /// Returns the distance in pixels by which the primitive extends beyond its vertices: half the size of a point, and
    /// otherwise 0.
    pub(crate) fn extra(&self) -> f64 {
        if let Shape::Point(size) = self.shape { size / 2.0 } else { 0.0 }
    }
}

/// An immutable list of draw calls. The list is replayed for every slice and every pass, on any display.
///
/// Vertices are in world coordinates, and their colours include the lighting. Each vertex was transformed once, when
/// its draw call was recorded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CommandBuffer {
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) colours: Vec<[f64; 3]>,
    pub(crate) primitives: Vec<Primitive>,
    pub(crate) background: [u8; 3],
}

/// A recorded triangle with its lit colours, in the form that a renderer receives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommandTriangle {
    /// Corners in world coordinates, pixels.
    pub corners: [[f64; 3]; 3],
    /// Red, green and blue of each corner after lighting, 0 to 255.
    pub colours: [[f64; 3]; 3],
}

impl CommandBuffer {
    /// Returns the number of recorded vertices, which are already transformed and lit.
    pub const fn vertices(&self) -> usize {
        self.positions.len()
    }

    /// Returns the number of triangles, lines and points.
    pub const fn primitives(&self) -> usize {
        self.primitives.len()
    }

    /// Returns the colour of pixels without a fragment: red, green and blue.
    pub const fn background(&self) -> [u8; 3] {
        self.background
    }

    /// Returns the corners of every triangle in world coordinates, in the order of drawing.
    pub fn triangles(&self) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
        let triangles = self.primitives.iter().filter(|primitive| primitive.shape == Shape::Triangle);
        triangles.map(|primitive| primitive.vertices.map(|i| self.positions[i as usize]))
    }

    /// Returns the triangle with this index among all primitives. Returns `None` for a line, a point or an index beyond
    /// the last primitive.
    pub fn triangle(&self, primitive: u32) -> Option<CommandTriangle> {
        let primitive = self.primitives.get(primitive as usize)?;
        let is_triangle = primitive.shape == Shape::Triangle;
        is_triangle.then(|| CommandTriangle {
            corners: primitive.vertices.map(|i| self.positions[i as usize]),
            colours: primitive.vertices.map(|i| self.colours[i as usize]),
        })
    }

    #[must_use]
    pub fn combining(&self, combine: Combine) -> Self {
        let mut combining = self.clone();
        combining.primitives.iter_mut().for_each(|primitive| primitive.combine = combine);
        combining
    }

    /// Returns the same primitives in the opposite order of drawing.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let mut reversed = self.clone();
        reversed.primitives.reverse();
        reversed
    }

    /// Returns the positions of the vertices in world coordinates.
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
