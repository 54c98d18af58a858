//! The programmer's side: state as in GL, vertices, and drawing, all of it independent of any display.

use crate::command::{Combine, CommandBuffer, Primitive, Shape};
use crate::error::{SpatialError, require};
use glam::{DMat4, DVec3};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// One vertex in the coordinates of its object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Place; pixels where the model-view matrix is the identity.
    pub position: DVec3,
    /// Direction off the surface; only light asks for it, at any length.
    pub normal: DVec3,
    /// Red, green and blue, 8 bits each.
    pub colour: [u8; 3],
}

impl Vertex {
    /// A vertex without a normal.
    #[must_use]
    pub const fn new(position: DVec3, colour: [u8; 3]) -> Self {
        Self { position, normal: DVec3::ZERO, colour }
    }
}

/// Checked vertices: every position and normal is finite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexBuffer {
    vertices: Vec<Vertex>,
}

impl VertexBuffer {
    /// Takes vertices in and checks that all of them can be drawn.
    ///
    /// # Errors
    ///
    /// [`SpatialError::NotFinite`] names the first one that has a coordinate without a value.
    pub fn new(vertices: Vec<Vertex>) -> Result<Self, SpatialError> {
        for (index, vertex) in vertices.iter().enumerate() {
            for (what, value) in [("position", vertex.position), ("normal", vertex.normal)] {
                if !value.is_finite() {
                    return Err(SpatialError::NotFinite { index, what, found: value.to_string() });
                }
            }
        }
        Ok(Self { vertices })
    }

    /// How many there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.vertices.len()
    }

    /// Whether there is none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }
}

/// How a run of vertices makes primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Topology {
    /// Each vertex is a point.
    Points,
    /// Each two vertices are a line.
    Lines,
    /// Each vertex but the first ends a line that begins at the one before.
    LineStrip,
    /// Each three vertices are a triangle.
    Triangles,
    /// Each vertex from the third on makes a triangle with the two before it.
    TriangleStrip,
    /// Each vertex from the third on makes a triangle with the first and the one before it.
    TriangleFan,
}

/// One directional light that lights both sides of a surface alike, since a volume is seen from all sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Towards the light, in the world, of any length but zero.
    pub direction: DVec3,
    /// Part of the colour that is seen without light.
    pub ambient: f64,
    /// Part of the colour that is added where light falls square.
    pub diffuse: f64,
}

/// State and recording. [`Context::present`] hands out what was recorded and begins anew; the state stays.
#[derive(Clone, Debug)]
pub struct Context {
    /// From object to world coordinates; a uniform scale at most, where light is used.
    pub model_view: DMat4,
    /// Side of the square that a point is, pixels of the slice.
    pub point_size: f64,
    /// Width of lines, pixels of the image.
    pub line_width: f64,
    /// The light; `None` shows colours as they are.
    pub light: Option<Light>,
    /// What becomes of several fragments on one pixel.
    pub combine: Combine,
    recording: CommandBuffer,
}

impl Default for Context {
    fn default() -> Self {
        Self {
            model_view: DMat4::IDENTITY,
            point_size: 1.0,
            line_width: 1.0,
            light: None,
            combine: Combine::Last,
            recording: CommandBuffer::default(),
        }
    }
}

impl Context {
    /// Forgets what was drawn before and fills every slice with a colour.
    pub fn clear(&mut self, colour: [u8; 3]) {
        self.recording = CommandBuffer { background: colour, ..CommandBuffer::default() };
    }

    /// Draws a run of vertices in their order. Vertices at the end that make no whole primitive are left out.
    ///
    /// # Errors
    ///
    /// [`SpatialError::Range`] if the range leaves the buffer; [`SpatialError::Setting`] if a point size or line width is
    /// not above zero or the matrix is not finite.
    pub fn draw(&mut self, buffer: &VertexBuffer, range: Range<usize>, topology: Topology) -> Result<(), SpatialError> {
        let vertices = buffer.len();
        let Some(run) = buffer.vertices.get(range.clone()) else {
            return Err(SpatialError::Range { start: range.start, end: range.end, vertices });
        };
        self.check_state(topology)?;
        let first = self.push_vertices(run);
        self.assemble(topology, run.len(), |i| first + i as u32);
        Ok(())
    }

    /// Draws the vertices that a list of indices names, in its order.
    ///
    /// # Errors
    ///
    /// [`SpatialError::Index`] names the first index beyond the buffer; otherwise as [`Self::draw`].
    pub fn draw_indexed(
        &mut self,
        buffer: &VertexBuffer,
        indices: &[u32],
        topology: Topology,
    ) -> Result<(), SpatialError> {
        let vertices = buffer.len();
        if let Some(at) = indices.iter().position(|i| *i as usize >= vertices) {
            return Err(SpatialError::Index { at, vertices, found: indices[at] });
        }
        self.check_state(topology)?;
        let first = self.push_vertices(&buffer.vertices);
        self.assemble(topology, indices.len(), |i| first + indices[i]);
        Ok(())
    }

    /// Ends the recording: what a display then draws.
    #[must_use]
    pub fn present(&mut self) -> CommandBuffer {
        std::mem::take(&mut self.recording)
    }

    fn check_state(&self, topology: Topology) -> Result<(), SpatialError> {
        require(self.model_view.is_finite(), "model_view", "a finite matrix", self.model_view)?;
        let (what, size) = match topology {
            Topology::Points => ("point_size", self.point_size),
            Topology::Lines | Topology::LineStrip => ("line_width", self.line_width),
            _ => return Ok(()),
        };
        require(size.is_finite() && size > 0.0, what, "a finite size above 0 px", size)
    }

    fn push_vertices(&mut self, vertices: &[Vertex]) -> u32 {
        let first = self.recording.positions.len() as u32;
        for vertex in vertices {
            let world = self.model_view.transform_point3(vertex.position);
            self.recording.positions.push(world.to_array());
            self.recording.colours.push(self.lit(vertex));
        }
        first
    }

    fn lit(&self, vertex: &Vertex) -> [f64; 3] {
        let colour = vertex.colour.map(f64::from);
        let Some(light) = &self.light else { return colour };
        let normal = self.model_view.transform_vector3(vertex.normal).normalize_or_zero();
        let facing = normal.dot(light.direction.normalize_or_zero()).abs();
        colour.map(|channel| (channel * (light.ambient + light.diffuse * facing)).clamp(0.0, 255.0))
    }

    fn assemble(&mut self, topology: Topology, count: usize, vertex: impl Fn(usize) -> u32) {
        let last = |needed: usize| (count + 1).saturating_sub(needed);
        match topology {
            Topology::Points => (0..count).for_each(|i| self.push(Shape::Point(self.point_size), [vertex(i); 3])),
            Topology::Lines => (0..last(2)).step_by(2).for_each(|i| self.push_line(vertex(i), vertex(i + 1))),
            Topology::LineStrip => (0..last(2)).for_each(|i| self.push_line(vertex(i), vertex(i + 1))),
            Topology::Triangles => {
                (0..last(3)).step_by(3).for_each(|i| self.push_triangle([vertex(i), vertex(i + 1), vertex(i + 2)]));
            }
            Topology::TriangleStrip => {
                (0..last(3)).for_each(|i| self.push_triangle([vertex(i), vertex(i + 1), vertex(i + 2)]));
            }
            Topology::TriangleFan => {
                (0..last(3)).for_each(|i| self.push_triangle([vertex(0), vertex(i + 1), vertex(i + 2)]));
            }
        }
    }

    fn push_triangle(&mut self, vertices: [u32; 3]) {
        self.push(Shape::Triangle, vertices);
    }

    fn push_line(&mut self, from: u32, to: u32) {
        self.push(Shape::Line(self.line_width), [from, to, to]);
    }

    fn push(&mut self, shape: Shape, vertices: [u32; 3]) {
        self.recording.primitives.push(Primitive { shape, vertices, combine: self.combine });
    }
}
