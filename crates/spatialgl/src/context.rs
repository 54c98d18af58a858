//! The programming interface, which is similar to OpenGL: a drawing state, vertices and draw calls. The interface does
//! not depend on any display.

use crate::command::{Combine, CommandBuffer, Primitive, Shape};
use glam::{DMat4, DVec3};
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A vertex, in the coordinates of its object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColouredVertex {
    /// Position in the object's coordinates. The unit is the pixel if the model-view matrix is the identity.
    pub position: DVec3,
    /// Normal of the surface, of any length. The normal matters only with lighting.
    pub normal: DVec3,
    pub colour: [u8; 3],
}

impl ColouredVertex {
    /// Creates a vertex without a normal.
    pub const fn new(position: DVec3, colour: [u8; 3]) -> Self {
        Self { position, normal: DVec3::ZERO, colour }
    }
}

/// A buffer of checked vertices: every position and normal is finite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexBuffer {
    vertices: Vec<ColouredVertex>,
}

impl VertexBuffer {
    /// Creates a buffer after checking its vertices.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the first vertex with a coordinate that is infinite or NaN.
    pub fn new(vertices: Vec<ColouredVertex>) -> Result<Self, SettingError> {
        for (index, vertex) in vertices.iter().enumerate() {
            for (what, value) in [("position", vertex.position), ("normal", vertex.normal)] {
                if !value.is_finite() {
                    let name = format!("vertex {index}");
                    return Err(SettingError::scene(&name, format_args!("a finite {what}"), value));
                }
            }
        }
        Ok(Self { vertices })
    }

    pub const fn len(&self) -> usize {
        self.vertices.len()
    }

    pub const fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }
}

/// The rule by which a sequence of vertices forms primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Topology {
    Points,
    Lines,
    /// Each vertex after the first ends a line that begins at the previous vertex.
    LineStrip,
    Triangles,
    /// Each vertex from the third on forms a triangle with the two preceding vertices.
    TriangleStrip,
    /// Each vertex from the third on forms a triangle with the first vertex and the previous vertex.
    TriangleFan,
}

/// A directional light that shines on both sides of a surface, because a volume is seen from all sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoSidedLight {
    /// Direction towards the light source in world coordinates, of any length except zero.
    pub direction: DVec3,
    /// Fraction of a surface's colour that is visible without light.
    pub ambient: f64,
    /// Fraction of a surface's colour that perpendicular light adds.
    pub diffuse: f64,
}

/// The drawing state, and the draw calls recorded since the last call of [`DrawContext::present`]. The method `present`
/// returns the recorded draw calls and does not change the drawing state.
#[derive(Clone, Debug)]
pub struct DrawContext {
    /// Matrix from object to world coordinates. The matrix must scale uniformly if there is a light.
    pub model_view: DMat4,
    /// Side of the square that represents a point, in pixels of the slice.
    pub point_size: f64,
    /// Width of lines, in pixels of the image.
    pub line_width: f64,
    /// Light source of the scene. With `None`, colours stay unchanged.
    pub light: Option<TwoSidedLight>,
    pub combine: Combine,
    recording: CommandBuffer,
}

impl Default for DrawContext {
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

impl DrawContext {
    /// Discards the recorded draw calls, and fills every slice with a colour.
    pub fn clear(&mut self, colour: [u8; 3]) {
        self.recording = CommandBuffer { background: colour, ..CommandBuffer::default() };
    }

    /// Draws a sequence of vertices. Vertices at the end that form no complete primitive are ignored.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the range exceeds the buffer, or if the matrix is not finite. A point size and a
    /// line width must be above zero.
    pub fn draw(&mut self, buffer: &VertexBuffer, range: Range<usize>, topology: Topology) -> Result<(), SettingError> {
        let vertices = buffer.len();
        let Some(run) = buffer.vertices.get(range.clone()) else {
            let Range { start, end } = range;
            let reason = format_args!("vertices {start}..{end}: expected a range within 0..{vertices}");
            return Err(SettingError::combination(reason));
        };
        self.check_state(topology)?;
        let first = self.push_vertices(run);
        self.assemble(topology, run.len(), |i| first + i as u32);
        Ok(())
    }

    /// Draws the vertices at these indices, in the order of the list.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the first index beyond the buffer. All errors of [`Self::draw`] can also occur.
    pub fn draw_indexed(
        &mut self,
        buffer: &VertexBuffer,
        indices: &[u32],
        topology: Topology,
    ) -> Result<(), SettingError> {
        let vertices = buffer.len();
        if let Some(at) = indices.iter().position(|i| *i as usize >= vertices) {
            let name = format!("index {at}");
            return Err(SettingError::scene(&name, format_args!("below {vertices}"), indices[at]));
        }
        self.check_state(topology)?;
        let first = self.push_vertices(&buffer.vertices);
        self.assemble(topology, indices.len(), |i| first + indices[i]);
        Ok(())
    }

    /// Returns the draw calls recorded so far, and starts a new list.
    pub fn present(&mut self) -> CommandBuffer {
        std::mem::take(&mut self.recording)
    }

    fn check_state(&self, topology: Topology) -> Result<(), SettingError> {
        SettingError::require(self.model_view.is_finite(), "model_view", "a finite matrix", self.model_view)?;
        let (what, size) = match topology {
            Topology::Points => ("point_size", self.point_size),
            Topology::Lines | Topology::LineStrip => ("line_width", self.line_width),
            _ => return Ok(()),
        };
        SettingError::require(size.is_finite() && size > 0.0, what, "a finite size above 0 px", size)
    }

    fn push_vertices(&mut self, vertices: &[ColouredVertex]) -> u32 {
        let first = self.recording.positions.len() as u32;
        for vertex in vertices {
            let world = self.model_view.transform_point3(vertex.position);
            self.recording.positions.push(world.to_array());
            self.recording.colours.push(self.lit(vertex));
        }
        first
    }

    fn lit(&self, vertex: &ColouredVertex) -> [f64; 3] {
        let colour = vertex.colour.map(f64::from);
        let Some(light) = &self.light else { return colour };
        let normal = self.model_view.transform_vector3(vertex.normal).normalize_or_zero();
        let facing = normal.dot(light.direction.normalize_or_zero()).abs();
        colour.map(|channel| (channel * (light.ambient + light.diffuse * facing)).clamp(0.0, 255.0))
    }

    fn assemble(&mut self, topology: Topology, count: usize, vertex: impl Fn(usize) -> u32) {
        // Incomplete primitives at the end are left out.
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
