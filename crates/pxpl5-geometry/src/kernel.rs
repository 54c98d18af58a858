//! Set-up of triangles as code of the graphics processor: i860 assembly, and its memory layout.
//!
//! A [`Kernel`] reads triangles from the display list and writes renderer commands into bins, one bin for each region.
//! The steps are: transform, test against the guard band, light or normals, rounding to subpixels, planes, conversion
//! of a video frame's lines to a field's rows, and regions. The clipper, a separate program, handles triangles that are
//! not wholly inside the guard band. The kernel makes steep planes constant only in pieces of clipped triangles.
//!
//! ```text
//!   display list (96 bytes a triangle, --+
//!     or strips: 32 bytes a vertex)      |
//!   parameter block ---------------------+--> kernel --> command words, bins
//!                                               | ^
//!                                               v |
//!                                             clipper -> the same for pieces
//! ```
//!
//! The Rust code of this crate makes the same computation, so the Rust code and the i860 code give the same words, bit
//! for bit. The reciprocal of w is computed from a first approximation by two Newton steps, in single precision. A
//! matrix rotates the normals, which are not normalized again. Light is computed in the coordinates of the normals.
//! kernels/parameters.s defines registers and memory layouts. A [`Kernel`] concatenates source files, like a linker,
//! and defines constants. The conditions in the files (`.if`) use these constants to select lines. This crate neither
//! assembles nor runs the sources.

mod between;

pub use between::{ENDS_VIEW_WORDS, ENDS_WORDS};

use crate::newton::ROUND_DOUBLE;
use crate::transform::Turn;
use crate::{
    DEPTH_FAR, DEPTH_NEAR, Light, MAX_CLIP, NORMAL_UNIT, Transform, Triangle, Viewport, clip, light, screen, single,
};
use glam::Vec3;
use pxpl5_wire::{Lines, REGION_SIZE, RegionGrid, Word};

/// Version of the kernel's code, by its degree of optimization.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Schedule {
    /// Code like the output of a compiler without optimization. Every statement loads its operands from the stack frame
    /// and stores its result there. All functions are inlined, so the code exceeds the instruction cache.
    Straight,
    /// Code like the output of a good compiler of about 1990. The code has functions, loops, local variables in
    /// registers, and scalar operations (kernels/compiled_rules.md).
    Compiled,
    /// Hand-written code, in which the i860 starts two instructions per clock. The code has two loops over batches of
    /// vertices or triangles. Each loop fits the instruction cache.
    ///
    /// Most of the source lists single operations in order, without clocks and pipelines. This project's assembler
    /// assigns the operations to clocks. The i860's own assembler cannot do so.
    Dual,
}

/// The kind of values at the corners of a triangle, which planes interpolate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KernelSurface {
    /// Colours, which the kernel computes from light and normals.
    Gouraud,
    /// Colours from the display list.
    Precomputed,
    /// Normals in eye coordinates, from which the renderers compute colours (Phong shading).
    Phong,
}

/// Arrangement of the triangles in the display list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KernelList {
    /// Separate triangles with three corners each ([`display_list_words`]).
    Triangles,
    /// Strips, in which each vertex makes a triangle with the two vertices before it ([`vertex_words`]).
    Strips,
}

/// Size of the picture, and its division into regions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KernelPicture {
    /// An NTSC video frame: 640 x 480 pixels in regions of 128 x 128.
    Frame,
    /// An NTSC field: 640 x 240 pixels in regions of 128 x 120.
    Field,
    /// A video frame of any size in regions of 128 x 128, for example a face of a cube. The size is a parameter of the
    /// i860 code.
    Grid,
}

/// The choice of a kernel: its version, and the kinds of triangles and pictures that it handles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Kernel {
    /// Version of the code: without optimization, compiled or hand-written.
    pub schedule: Schedule,
    pub surface: KernelSurface,
    pub list: KernelList,
    pub picture: KernelPicture,
    /// True if the kernel sorts commands into the bins of the touched regions. False if every region receives the same
    /// list of commands.
    pub binned: bool,
    /// True if the kernel leaves out back faces.
    pub culls: bool,
    /// True if a kernel without bins also stores the bounding box of each command, for later searches.
    ///
    /// The boxes replace the table of bins. A box has four numbers in 1/16 px of the video frame: low x, high x, low y,
    /// high y.
    pub keeps_boxes: bool,
    /// True if one pass over the triangles makes the commands of both eyes (kernels/slats_rules.md).
    ///
    /// Compiled code for both eyes computes planes in single precision, like [`Transform::in_single_precision`].
    ///
    /// Register 19 then holds the address for the right eye's commands, and register 21 the address of the right eye's
    /// parameter block. Requires [`Kernel::can_serve_both_eyes`].
    pub both_eyes: bool,
}

/// First words of the instructions in a triangle's renderer command.
///
/// The order is: enable, edge, depth compare, depth load, three components, colour (Phong only).
pub type Heads = [Word; 8];

/// Number of words of a separate triangle in the display list.
pub const TRIANGLE_WORDS: usize = 24;

/// Number of words of a vertex of a strip in the display list.
pub const VERTEX_WORDS: usize = 8;

/// Number of words of a kernel's parameters.
pub const PARAMETER_WORDS: usize = 128;

/// The constant 1.5 * 2^23. If a number is added to this constant, the low bits of the sum hold the number, rounded to
/// an integer.
const ROUND_SINGLE: f32 = 12_582_912.0;
const TWO_23: f32 = 8_388_608.0;
const TWO_18: f32 = 262_144.0;

/// Constant from which the bits of the single-precision number 1.5 * 2^23 + n are subtracted. The subtraction reverses
/// the order of the integers n.
const FLIP: Word = 0x9700_0000;

const PARAMETERS: &str = include_str!("../kernels/parameters.s");
pub(crate) const PICTURE: &str = include_str!("../kernels/picture.s");
pub(crate) const NEWTON: &str = include_str!("../kernels/newton.s");
const SCALAR: &str = include_str!("../kernels/scalar.s");
const SCALAR_FUNCTIONS: &str = include_str!("../kernels/scalar_functions.s");
const BINS: &str = include_str!("../kernels/bins.s");
const VERTICES: &str = include_str!("../kernels/vertices.s");
const VERTICES_END: &str = include_str!("../kernels/vertices_end.s");

const SINGLE: [&str; 4] = [NEWTON, SCALAR, include_str!("../kernels/single.s"), SCALAR_FUNCTIONS];
const COMPILED: [&str; 5] = [NEWTON, SCALAR, include_str!("../kernels/compiled.s"), SCALAR_FUNCTIONS, BINS];

const DUAL: [&str; 7] = [
    include_str!("../kernels/dual.s"),
    VERTICES,
    include_str!("../kernels/vertices_surface.s"),
    VERTICES_END,
    include_str!("../kernels/setup.s"),
    BINS,
    include_str!("../kernels/dual_end.s"),
];

/// Sources for the right eye, if a kernel serves both eyes. The first loop then processes each batch of vertices twice.
/// The right eye uses the colours of the left eye.
const RIGHT_EYE: [&str; 3] = [VERTICES, VERTICES_END, include_str!("../kernels/right_eye.s")];

/// Returns an assembly source that defines each name as 1 or 0.
pub(crate) fn choices(each: &[(&str, bool)]) -> String {
    each.iter().map(|(name, holds)| format!("{name} = {}\n", u8::from(*holds))).collect()
}

impl Kernel {
    /// Returns the kernel for separate triangles and the picture of `viewport`.
    ///
    /// Returns `None` if no kernel has regions of this size. A kernel without bins exists only for NTSC video frames
    /// and fields.
    pub fn for_picture(schedule: Schedule, surface: KernelSurface, viewport: &Viewport, binned: bool) -> Option<Self> {
        let picture = KernelPicture::of(viewport).filter(|picture| binned || *picture != KernelPicture::Grid)?;
        let list = KernelList::Triangles;
        Some(Self { schedule, surface, list, picture, binned, culls: false, keeps_boxes: false, both_eyes: false })
    }

    /// Returns true if this kernel can make the commands of both eyes in one pass over the triangles.
    pub fn can_serve_both_eyes(&self) -> bool {
        self.surface == KernelSurface::Precomputed
            && self.schedule != Schedule::Straight
            && self.list == KernelList::Triangles
            && !self.binned
            && !self.keeps_boxes
            && (self.schedule == Schedule::Dual || self.picture == KernelPicture::Field)
    }

    fn is_single(&self) -> bool {
        self.both_eyes && self.schedule == Schedule::Compiled
    }

    /// Returns the source in i860 assembly. Execution begins at the label `start`.
    ///
    /// For [`Schedule::Dual`], the assembler of this project must first choose the order and registers of the parts
    /// without branches.
    pub fn source(&self) -> String {
        let choices = self.choices(false);
        let common = [&choices, PARAMETERS, include_str!("../kernels/list.s"), PICTURE];
        let own: &[&str] = match self.schedule {
            Schedule::Straight => &[NEWTON, include_str!("../kernels/straight.s"), BINS],
            Schedule::Compiled if self.both_eyes => &SINGLE,
            Schedule::Compiled => &COMPILED,
            // Rarely used code comes last. So the bins use other cache sets than the end of the second loop.
            Schedule::Dual if self.both_eyes => &[DUAL.as_slice(), &RIGHT_EYE].concat(),
            Schedule::Dual => &DUAL,
        };
        [&common, own].concat().join("\n")
    }

    /// Returns the source of the clipper, which is the same for all versions. Execution begins at the label `clipper`.
    ///
    /// [The parameters](Self::parameters) of the kernel contain the address of the clipper.
    pub fn clipper_source(&self) -> String {
        let choices = Self { schedule: Schedule::Compiled, both_eyes: false, ..*self }.choices(false);
        let clipper = include_str!("../kernels/clipper.s");
        [&choices, PARAMETERS, PICTURE, NEWTON, SCALAR, clipper, SCALAR_FUNCTIONS, BINS].join("\n")
    }

    /// Returns the constants, 0 or 1, by which the sources select lines. `between` is true for [triangles between two
    /// views](Self::between_source).
    fn choices(&self, between: bool) -> String {
        let surface = |surface| self.surface == surface;
        choices(&[
            ("GOURAUD", surface(KernelSurface::Gouraud)),
            ("PRECOMPUTED", surface(KernelSurface::Precomputed)),
            ("PHONG", surface(KernelSurface::Phong)),
            ("STRIPS", self.list == KernelList::Strips),
            ("FIELD", self.picture == KernelPicture::Field),
            ("GRID", self.picture == KernelPicture::Grid),
            ("BINNED", self.binned),
            ("BOXES", self.keeps_boxes),
            ("CULLED", self.culls),
            ("BOTH_EYES", self.both_eyes),
            ("SINGLE", self.is_single()),
            ("DUAL", self.schedule == Schedule::Dual),
            ("BETWEEN", between),
        ])
    }

    pub const fn command_bytes(&self) -> u32 {
        match self.surface {
            KernelSurface::Gouraud | KernelSurface::Precomputed => 120,
            KernelSurface::Phong => 128,
        }
    }

    /// Returns the kernel's parameters for a view. `clipper` is the address of the code for triangles that need
    /// clipping.
    pub fn parameters(
        &self,
        transform: &Transform,
        light: &Light,
        heads: &Heads,
        clipper: Word,
    ) -> [Word; PARAMETER_WORDS] {
        let mut words = ParameterWords([0; PARAMETER_WORDS]);
        let clip = transform.to_clip.rows();
        let normals = transform.normals.rows.map(normal_row);
        let guard = &transform.guard;
        let screen = &transform.to_screen;
        words.singles(0, clip.as_flattened());
        words.singles(64, &transform.to_clip.origin().to_array());
        words.singles(80, &[guard.x, guard.y, clip::MIN_W, MAX_CLIP]);
        words.singles(96, &[screen.scale, screen.centre.map(|centre| centre + ROUND_SINGLE)].concat());
        words.singles(112, &[2.0, ROUND_SINGLE]);
        words.integers(120, &[FLIP, transform.viewport.first_line()]);
        words.doubles(128, &self.doubles());
        words.integers(232, heads);
        words.doubles(264, &[1.5]);
        words.singles(272, normals.as_flattened());
        words.singles(320, &transform.normals.to_world(light.direction));
        words.singles(336, &[light.ambient, light.diffuse, 1.0, TWO_23, clip::MIN_W, MAX_CLIP]);
        words.integers(360, &[20 << 23]);
        // Without bins, planes refer to the picture's first line. With bins, they refer to line 0 of the frame, and the
        // conversion to a field's rows comes later.
        let line = if self.binned { 0 } else { transform.viewport.first_line() };
        words.singles(364, &[ROUND_SINGLE - 16.0 * line as f32]);
        words.doubles(368, &[ROUND_DOUBLE + f64::from(DEPTH_NEAR), 16.0 * ROUND_DOUBLE]);
        words.singles(384, &[2.0 * ROUND_SINGLE + 8.0]);
        let first_line = 16.0 * transform.viewport.first_line() as f32;
        let of_single = [single::BAND, DEPTH_NEAR as f32, 1.0 / 32.0, ROUND_SINGLE + first_line];
        for (word, at) in of_single.into_iter().zip([284, 300, 316, 332]) {
            words.singles(at, &[word]);
        }
        words.doubles(440, &[16.0, -16.0]);
        words.singles(456, &[screen::DEPTH_SCALE, 1.0 / 16.0, ROUND_DOUBLE as f32, TWO_18]);
        words.integers(472, &culled(transform.dropped));
        words.integers(480, &[clipper]);
        words.doubles(488, &[1.0 / 3.0]);
        let [last_x, last_y, columns] = size_words(transform.viewport());
        words.integers(496, &[last_x, last_y, columns, safe_distance(transform.viewport())]);
        self.sides().iter().zip([392, 416]).for_each(|((unit, less), at)| {
            words.doubles(at, &[*unit]);
            words.singles(at + 8, &[*unit as f32]);
            words.doubles(at + 16, &[*less]);
        });
        words.0
    }

    /// Returns the factor and the summand that convert a surface value to a plane's units, for the front and the back
    /// of a triangle.
    ///
    /// The summand adds half a unit for rounding. The summand also removes [`ROUND_SINGLE`], which an earlier step has
    /// added.
    fn sides(&self) -> [(f64, f64); 2] {
        let (units, half) = match self.surface {
            KernelSurface::Gouraud | KernelSurface::Precomputed => ([16.0, 16.0], screen::colour_value(0)),
            KernelSurface::Phong => ([64.0, -64.0], screen::NORMAL_HALF),
        };
        units.map(|unit| (unit, f64::from(half) - unit * f64::from(ROUND_SINGLE)))
    }

    fn doubles(&self) -> [f64; 13] {
        let two_52 = (1u64 << 52) as f64;
        let two_31 = f64::from(1u32 << 31);
        let surface = match self.surface {
            KernelSurface::Gouraud | KernelSurface::Precomputed => two_52,
            KernelSurface::Phong => two_52 + two_31,
        };
        // The order is defined in kernels/parameters.s.
        [
            2.0,
            f64::from(DEPTH_FAR - DEPTH_NEAR),
            f64::from(DEPTH_NEAR),
            0.5,
            two_52,
            surface,
            1.5 * two_52,
            1.0 / 16.0,
            16.0,
            two_52 + two_31,
            8.0,
            -7.5,
            -8.5,
        ]
    }
}

impl KernelPicture {
    pub(crate) fn of(viewport: &Viewport) -> Option<Self> {
        let grid = viewport.grid();
        match viewport.lines() {
            Lines::Field(_) => (grid == RegionGrid::FIELD).then_some(Self::Field),
            Lines::Frame if grid == RegionGrid::FRAME => Some(Self::Frame),
            Lines::Frame => {
                [grid.region_width, grid.region_height].iter().all(|size| *size == REGION_SIZE).then_some(Self::Grid)
            }
        }
    }
}

/// Returns the greatest x and the greatest y of the video frame, in subpixels, and the number of columns of regions.
pub(crate) const fn size_words(viewport: &Viewport) -> [Word; 3] {
    let grid = viewport.grid();
    [16 * grid.width - 1, 16 * viewport.frame_lines() - 1, grid.columns()]
}

/// Returns a distance from pixel (0, 0), in subpixels. A point within this distance along x and y is inside the guard
/// band.
///
/// The guard band is symmetric around the middle of the picture. On the left and at the top, its ends are nearer to
/// pixel (0, 0). One pixel is reserved for rounding.
fn safe_distance(viewport: &Viewport) -> Word {
    let size = viewport.grid().width.max(viewport.frame_lines());
    16 * (screen::GUARD_PIXELS as u32 - 2 - size)
}

/// A kernel's parameters under construction. Addresses are in bytes, as in kernels/parameters.s.
struct ParameterWords([Word; PARAMETER_WORDS]);

impl ParameterWords {
    fn integers(&mut self, at: usize, values: &[Word]) {
        self.0[at / 4..at / 4 + values.len()].copy_from_slice(values);
    }

    fn singles(&mut self, at: usize, values: &[f32]) {
        values.iter().enumerate().for_each(|(n, value)| self.0[at / 4 + n] = value.to_bits());
    }

    fn doubles(&mut self, at: usize, values: &[f64]) {
        values.iter().enumerate().for_each(|(n, value)| self.integers(at + 8 * n, &halves(*value)));
    }
}

/// Returns two masks, for XOR and AND, by which the kernel tests the winding. Applied to the high word of a triangle's
/// area, the masks give a negative number if the triangle is not drawn.
const fn culled(dropped: Option<Turn>) -> [Word; 2] {
    const SIGN: Word = 1 << 31;
    match dropped {
        None => [0, 0],
        // A positive area means clockwise.
        Some(Turn::Clockwise) => [SIGN, SIGN],
        Some(Turn::Counterclockwise) => [0, SIGN],
    }
}

/// Returns the source of the code that prepares a view (kernels/place.s). The labels of the source are `edit`, `reset`
/// and `place`.
///
/// The code at `place` writes all parameters that depend on a view or a light, for [`Kernel::parameters`] and for
/// [`crate::sphere_kernel`]. `single` selects the parameters of single.s.
pub fn place_source(single: bool) -> String {
    let choices = choices(&[("SINGLE", single)]);
    let [spheres, place] = [include_str!("../kernels/sphere_parameters.s"), include_str!("../kernels/place.s")];
    [&choices, PARAMETERS, spheres, NEWTON, place].join("\n")
}

/// Returns a row of the matrix that rotates normals, scaled to the units of normals in renderer commands.
fn normal_row(row: [f32; 3]) -> [f32; 4] {
    let [x, y, z] = row.map(|v| v * f32::from(NORMAL_UNIT));
    [x, y, z, 0.0]
}

/// Returns the two words of a double in the memory order of the i860, low half first.
pub(crate) const fn halves(value: f64) -> [Word; 2] {
    [value.to_bits() as Word, (value.to_bits() >> 32) as Word]
}

/// Returns the words of a separate triangle in the display list, with normals of unit length.
pub fn display_list_words(triangle: &Triangle) -> [Word; TRIANGLE_WORDS] {
    let mut words = [0; TRIANGLE_WORDS];
    for (n, corner) in words.chunks_exact_mut(VERTEX_WORDS).enumerate() {
        let vertex = vertex_words(triangle.positions[n], triangle.normals[n], triangle.colours[n], false);
        corner.copy_from_slice(&vertex);
    }
    words
}

/// Returns the words of a strip's vertex in the display list, with a normal of unit length.
///
/// `begins` is true for the first two vertices of a strip, which make no triangle. Every later vertex makes a triangle
/// with the two vertices before it. The order of these corners is the same for both windings.
pub fn vertex_words(position: Vec3, normal: Vec3, colour: [u8; 3], begins: bool) -> [Word; VERTEX_WORDS] {
    let [x, y, z] = position.to_array().map(f32::to_bits);
    let [nx, ny, nz] = light::unit_normal(normal).map(f32::to_bits);
    let [r, g, b] = colour.map(Word::from);
    [x, y, z, r << 16 | g << 8 | b, nx, ny, nz, Word::from(begins)]
}
