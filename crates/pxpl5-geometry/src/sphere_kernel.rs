//! Set-up of spheres as code of the graphics processor: i860 assembly, and its memory layout. [`crate::kernel`] is the
//! corresponding code for triangles.
//!
//! A [`SphereKernel`] reads the spheres of the display list, computes the words of the renderer commands and puts the
//! commands into bins. The steps are: centre and radius in eye coordinates, tests against the near and far plane,
//! conic, bounding box, regions, conic in fixed point, and planes of depth and surface. There is only one version of
//! the sphere code, in the style of the compiled triangle kernels. This version is used with every optimization level
//! of the triangle kernels. The Rust code of this crate makes the same computation, so the Rust code and the i860 code
//! give the same words, bit for bit.
//!
//! kernels/sphere_parameters.s defines the parameter block. On the processor, the code at the label `place` writes the
//! parameters that depend on the view ([`crate::kernel::place_source`]).

use crate::kernel::{self, KernelPicture, KernelSurface};
use crate::lens::{self, DEPTH_RANGE};
use crate::newton::ROUND_DOUBLE;
use crate::sphere::{MAX_COORDINATE, SLACK};
use crate::{DEPTH_NEAR, Light, Transform, Viewport, WorldSphere, sphere_setup};
use pxpl5_wire::{Word, format};

/// The choice of sphere code for a kind of shading and a kind of picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SphereKernel {
    /// Values that the kernel computes: lit colours, or normals for Phong shading.
    pub surface: KernelSurface,
    pub picture: KernelPicture,
    /// True if the kernel makes no bins, but stores the bounding box of each command for later searches.
    pub keeps_boxes: bool,
}

/// Number of words of a sphere in the display list.
pub const SPHERE_WORDS: usize = 8;

/// Number of words of a sphere kernel's parameters.
pub const SPHERE_PARAMETER_WORDS: usize = SIZE + 3;

/// Index, in the parameters, of a renderer command with zeros as operands. The kernel copies this command and fills in
/// the operands.
const TEMPLATE: usize = 110;

/// Index, in the parameters, of the picture's size. The size follows the longest renderer command.
const SIZE: usize = TEMPLATE + 53;

/// Number of words at the start of the parameters that depend on a view and a light.
pub const SPHERE_VIEW_WORDS: usize = 55;

impl SphereKernel {
    /// Returns the kernel for the picture of `viewport`, or `None` if no kernel has regions of this size.
    pub fn for_picture(surface: KernelSurface, viewport: &Viewport) -> Option<Self> {
        KernelPicture::of(viewport).map(|picture| Self { surface, picture, keeps_boxes: false })
    }

    /// Returns the kernel's source in i860 assembly. Execution begins at the label `spheres`.
    pub fn source(&self) -> String {
        let choices = kernel::choices(&[
            ("PHONG", self.surface == KernelSurface::Phong),
            ("FIELD", self.picture == KernelPicture::Field),
            ("GRID", self.picture == KernelPicture::Grid),
            ("BOXES", self.keeps_boxes),
            ("CULLED", false),
        ]);
        let parameters = include_str!("../kernels/sphere_parameters.s");
        [&choices, parameters, kernel::PICTURE, kernel::NEWTON, include_str!("../kernels/sphere.s")].join("\n")
    }

    pub const fn command_words(&self) -> usize {
        match self.surface {
            KernelSurface::Gouraud | KernelSurface::Precomputed => 53,
            KernelSurface::Phong => 38,
        }
    }

    /// Returns the kernel's parameters for a view, or `None` if the projection cannot show spheres.
    ///
    /// `command` is a renderer command with zeros as operands. For each sphere, the kernel copies this command and
    /// fills in the operands.
    pub fn parameters(
        &self,
        transform: &Transform,
        light: &Light,
        command: &[Word],
    ) -> Option<[Word; SPHERE_PARAMETER_WORDS]> {
        let lens = transform.lens.as_ref()?;
        let mut words = [0; SPHERE_PARAMETER_WORDS];
        let [x, y, z, _] = transform.to_eye.rows();
        let origin = transform.to_eye.origin().to_array();
        // Words 0 to 14 are the matrix and the eye's position, in single precision.
        let singles = [x, y, z].concat().into_iter().chain(origin).map(f32::to_bits);
        words.iter_mut().zip(singles).for_each(|(word, single)| *word = single);
        let [light_x, light_y, light_z] = light.direction.map(f64::from);
        let pairs = [lens.step, lens.rate, lens.corner, lens.near, lens.far].concat();
        let of_light = [light_x, light_y, light_z, light.ambient.into(), light.diffuse.into()];
        let depths = [lens.least, lens.base, lens.reach];
        // Words 16 to 53 are the projection and the light, in double precision.
        doubles(&mut words[16..], &[&[transform.to_eye.scale()], pairs.as_slice(), &depths, &of_light].concat());
        words[54] = Word::from(lens.parallel);
        words[55] = transform.viewport.first_line();
        // Words 56 to 109 are constants that depend only on the picture.
        doubles(&mut words[56..], &self.constants(&transform.viewport));
        words[TEMPLATE..SIZE].iter_mut().zip(command).for_each(|(word, of_command)| *word = *of_command);
        words[SIZE..].copy_from_slice(&kernel::size_words(&transform.viewport));
        Some(words)
    }

    fn constants(&self, viewport: &Viewport) -> [f64; 27] {
        let [width, lines] = [viewport.grid().width, viewport.frame_lines()];
        let half = lens::half_frame(width, lines);
        let first = lens::first_pixel(width, lines);
        let unit = f64::from(match self.surface {
            KernelSurface::Gouraud | KernelSurface::Precomputed => 1_u32 << format::COLOUR_FRACTION_BITS,
            KernelSurface::Phong => 1_u32 << format::NORMAL_FRACTION_BITS,
        });
        let near = f64::from(DEPTH_NEAR);
        // The order is defined in kernels/sphere_parameters.s.
        [
            half[0],
            half[1],
            1.0 / half[0],
            1.0 / half[1],
            first[0],
            first[1],
            2.0,
            0.5,
            1.5,
            ROUND_DOUBLE,
            1.0,
            4.0,
            -4.0,
            MAX_COORDINATE,
            SLACK,
            4096.0,
            sphere_setup::MAX_SLOPE,
            (1_u64 << 52) as f64,
            DEPTH_RANGE,
            near,
            near * 0.5,
            -f64::MAX,
            unit,
            unit * 0.5,
            256.0,
            511.0,
            0.25,
        ]
    }
}

fn doubles(words: &mut [Word], values: &[f64]) {
    for (pair, value) in words.chunks_exact_mut(2).zip(values) {
        pair.copy_from_slice(&kernel::halves(*value));
    }
}

/// Returns the words of a sphere in the display list.
pub fn sphere_words(sphere: &WorldSphere) -> [Word; SPHERE_WORDS] {
    let [x, y, z] = sphere.centre.to_array().map(f32::to_bits);
    let [r, g, b] = sphere.colour.map(Word::from);
    [x, y, z, sphere.radius.to_bits(), r << 16 | g << 8 | b, 0, 0, 0]
}
