//! The operands of the renderer's commands for spheres, computed from a conic and a plane.

use crate::conic::{self, FixedConic};
use crate::newton::{reciprocal_root, root, whole};
use crate::screen::DEPTH_NEAR;
use crate::sphere::ScreenSphere;
use crate::{Light, SetupStats, Viewport};
use pxpl5_wire::{Linear, Quadratic, REGION_SIZE, format};

/// Silhouette and depth of a sphere, with which the renderer computes for each pixel:
///
/// ```text
/// root  = floor(sqrt((silhouette >> root_shift) & (2^24 - 1)))
/// depth = (depth - (root << depth_shift)) >> Z_FRACTION_BITS
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SphereSetup {
    /// Silhouette expression, which is at least 0 at the pixels inside the sphere. Within the sphere's regions, the
    /// value fits 48 bits.
    ///
    /// The unit of the expression differs from sphere to sphere. With the chosen unit, the square root needs no factor.
    pub silhouette: Quadratic,
    /// Number of low bits of the silhouette expression that the square root ignores, 0 to 24.
    pub root_shift: u8,
    /// Depth of the plane through the silhouette, with [`format::Z_FRACTION_BITS`] fraction bits. The plane includes a
    /// correction for the rounding of the root.
    pub depth: Linear,
    /// Number of bits by which the square root is shifted to the left before its subtraction from the depth: 0 to 20.
    pub depth_shift: u8,
}

/// A sphere for Gouraud shading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GouraudSphere {
    pub setup: SphereSetup,
    /// Linear parts of red, green and blue, to which a multiple of the square root is added, with
    /// [`format::COLOUR_FRACTION_BITS`] fraction bits.
    pub rgb: [Linear; 3],
    /// Factors of the square root, 0 to 511, for red, green and blue: component = limit(linear + ((root >> 4) * factor
    /// >> 8)).
    pub root_factor: [u16; 3],
}

/// A sphere for Phong shading. The z component of a pixel's normal is `root >> 2`, in the same scale as x and y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PhongSphere {
    pub setup: SphereSetup,
    /// x and y of the normal in eye coordinates, with [`format::NORMAL_FRACTION_BITS`] fraction bits.
    pub normal: [Linear; 2],
    /// Red, green and blue of the whole sphere, 0 to 255 each.
    pub colour: [u8; 3],
}

/// Steepest slope of a plane per pixel. Steeper slopes do not fit 32 bits.
pub(crate) const MAX_SLOPE: f64 = 2_147_483_648.0;

struct Slope {
    origin: [f64; 2],
    value: f64,
    slope: [f64; 2],
}

impl Slope {
    /// Converts the plane to fixed point, modulo 2^32. The result is most exact at the pixel `pixel`.
    ///
    /// A plane with a slope above 2^31 is made constant and counted in [`SetupStats::flattened_planes`].
    fn fixed(&self, pixel: [i32; 2], stats: &mut SetupStats) -> Linear {
        if !self.slope.iter().all(|s| s.abs() < MAX_SLOPE) {
            stats.flattened_planes += 1;
            return Linear::constant(modulo_2_32(self.value));
        }
        let offset: [f64; 2] = std::array::from_fn(|i| f64::from(pixel[i]) - self.origin[i]);
        let there = (self.value + self.slope[0] * offset[0]) + self.slope[1] * offset[1];
        let [a, b] = self.slope.map(modulo_2_32);
        let back = a.wrapping_mul(pixel[0]).wrapping_add(b.wrapping_mul(pixel[1]));
        Linear { a, b, c: modulo_2_32(there).wrapping_sub(back) }
    }
}

fn modulo_2_32(value: f64) -> i32 {
    whole(value) as i32
}

/// Limits a factor to 0 to 511, the range of the sphere command. NaN becomes 0.
#[allow(clippy::manual_clamp, reason = "`clamp` would leave a NaN")]
fn limited(factor: f64) -> i64 {
    whole(factor.max(0.0).min(511.0))
}

fn rows(linear: Linear, viewport: &Viewport) -> Linear {
    crate::screen::for_rows(linear, viewport)
}

fn frame_line(viewport: &Viewport, row: u32) -> i32 {
    (row * viewport.line_step() + viewport.first_line()) as i32
}

impl ScreenSphere {
    /// Returns the pixels of all regions that the sphere touches, as a rectangle that may extend beyond the picture.
    fn rectangle(&self, viewport: &Viewport) -> [[i32; 2]; 2] {
        let grid = viewport.grid();
        let corners = self.regions.iter().map(|r| grid.rectangle(r));
        let bounds = corners.fold([[u32::MAX, 0], [u32::MAX, 0]], |[x, y], [left, top, ..]| {
            [[x[0].min(left), x[1].max(left)], [y[0].min(top), y[1].max(top)]]
        });
        let [[left, right], [top, bottom]] = bounds;
        [
            [left as i32, (right + REGION_SIZE - 1) as i32],
            [frame_line(viewport, top), frame_line(viewport, bottom + REGION_SIZE - 1)],
        ]
    }

    /// Returns the pixel at which the sphere's planes are most exact: the middle of the sphere's visible part.
    fn middle(&self, rectangle: [[i32; 2]; 2]) -> [i32; 2] {
        std::array::from_fn(|i| {
            let [first, last] = rectangle[i].map(f64::from);
            whole(self.ellipse.peak[i].clamp(first, last)) as i32
        })
    }

    fn common(&self, viewport: &Viewport, stats: &mut SetupStats) -> (SphereSetup, FixedConic) {
        let rectangle = self.rectangle(viewport);
        let middle = self.middle(rectangle);
        let conic = self.conic.fixed(self.ellipse.value, rectangle, middle);
        let [value, slope_x, slope_y] = self.depth;
        // Roots are rounded down, so depths are too large by up to one step. If the plane is half a step nearer, the
        // error is at most half a step in both directions. The plane must not move in front of depth 0.
        let half_step = conic::power_of_two(i32::from(conic.depth_shift) - 1);
        let room = (self.front - f64::from(DEPTH_NEAR) * 0.5).max(0.0);
        let plane = Slope { origin: self.conic.origin, value: value - half_step.min(room), slope: [slope_x, slope_y] };
        let step = viewport.line_step();
        let first = viewport.first_line();
        let setup = SphereSetup {
            silhouette: conic::for_rows(conic.quadratic, step.into(), first.into()),
            root_shift: conic.root_shift,
            depth: rows(plane.fixed(middle, stats), viewport),
            depth_shift: conic.depth_shift,
        };
        (setup, conic)
    }

    /// Returns the plane `scale[0] * x + scale[1] * y + value`, where x and y are components of the sphere's unit
    /// normal.
    fn tilt(&self, scale: [f64; 2], value: f64) -> Slope {
        let [per_x, per_y] = self.ellipse.per_half_size();
        Slope { origin: self.ellipse.peak, value, slope: [scale[0] * per_x, -scale[1] * per_y] }
    }

    /// Computes the operands for Gouraud shading.
    ///
    /// The square root gives the component of the normal towards the eye. Linear expressions approximate the other
    /// components, so a pixel that faces away from the light is darker than ambient light. Light from behind the sphere
    /// adds nothing.
    pub fn gouraud(&self, viewport: &Viewport, light: &Light, stats: &mut SetupStats) -> GouraudSphere {
        let (setup, conic) = self.common(viewport, stats);
        let direction = light.direction.map(f64::from);
        let [across, up, towards] = self.axes.map(|axis| crate::view::dot(axis, direction));
        let middle = self.middle(self.rectangle(viewport));
        let unit = f64::from(1_u32 << format::COLOUR_FRACTION_BITS);
        let ambient = f64::from(light.ambient);
        let diffuse = f64::from(light.diffuse);
        let rgb = self.colour.map(|c| {
            let full = f64::from(c) * unit;
            let scale = [across, up].map(|l| full * diffuse * l);
            let plane = self.tilt(scale, full * ambient + unit * 0.5);
            rows(plane.fixed(middle, stats), viewport)
        });
        // Reciprocal of the greatest value of the root's upper bits. The upper bits are the root without its lowest
        // four bits.
        let per_root = reciprocal_root(self.ellipse.value) * conic::power_of_two(i32::from(conic.depth_shift) + 4);
        let root_factor = self.colour.map(|c| {
            let factor = f64::from(c) * diffuse * towards * 256.0 * per_root;
            limited(factor) as u16
        });
        GouraudSphere { setup, rgb, root_factor }
    }

    pub fn phong(&self, viewport: &Viewport, stats: &mut SetupStats) -> PhongSphere {
        let (setup, conic) = self.common(viewport, stats);
        let middle = self.middle(self.rectangle(viewport));
        let unit = f64::from(1_u32 << format::NORMAL_FRACTION_BITS);
        // This is the root at the middle of the sphere. At this point, the z component of the normal is a quarter of
        // the root.
        let greatest = root(self.ellipse.value) * conic::power_of_two(-i32::from(conic.depth_shift));
        let scale = greatest * 0.25 * unit;
        let normal = [[scale, 0.0], [0.0, scale]].map(|scale| {
            let plane = self.tilt(scale, unit * 0.5);
            rows(plane.fixed(middle, stats), viewport)
        });
        PhongSphere { setup, normal, colour: self.colour }
    }
}
