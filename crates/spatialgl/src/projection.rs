//! Projections from the coordinates of a slice to its image. No projection moves the points of the slice itself, at
//! distance s = 0.

use glam::{DMat4, DVec4};
use pxpl5_sim::mix;
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};

/// The size of an image: width, then height, in pixels.
pub type Size = [u32; 2];

/// The projection that maps points near a slice to the slice's image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Projection {
    /// Parallel projection along the normal of the slice. Surfaces perpendicular to the slice become lines.
    Orthographic,
    /// Projection with a shear from an eye at (u, v, distance), in pixels of the slice's coordinates. All slices have
    /// the same eye.
    Perspective {
        /// Horizontal and vertical position of the eye relative to the axis of the image, in pixels.
        eye: [f64; 2],
        distance: f64,
        /// Horizontal and vertical shear, in pixels per pixel of s, the distance from the slice.
        shear: [f64; 2],
    },
    /// Projection with a random eye position and a random shear, chosen anew for each slice.
    Jittered(Jitter),
}

/// Seed and limits of the random eye position and shear of each slice. The random numbers depend only on the seed and
/// the index of the slice.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Jitter {
    /// Seed of the random sequence. The seed is the same in all passes and volumes.
    pub seed: u64,
    /// Distance of the eye from the slice in radii of the display. The value 4 is assumed (2 to 16).
    pub eye_distance: f64,
    /// Radius of the disc in which the eye lies, in radii of the display. The value 0.5 is assumed (0 to 1).
    pub eye_radius: f64,
    /// Greatest shift of a point by the shear, at the near or far plane of the slice, in pixels. The value 0.5 is
    /// assumed (0 to 1).
    pub shear_px: f64,
}

impl Jitter {
    /// Returns the assumed limits with this seed. The eye is four display radii away, within a disc of half a radius.
    /// The shear shifts points at the slice's near and far planes by at most half a pixel.
    pub const fn new(seed: u64) -> Self {
        Self { seed, eye_distance: 4.0, eye_radius: 0.5, shear_px: 0.5 }
    }
}

/// The eye and the shear with which a slice is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliceEye {
    /// Position of the eye: horizontal and vertical position, and distance from the slice, in pixels. `None` for an eye
    /// at infinity (a projection along the normal of the slice).
    pub eye: Option<[f64; 3]>,
    /// Horizontal and vertical shear, in pixels per pixel of s, the distance from the slice.
    pub shear: [f64; 2],
}

impl Projection {
    /// Returns the eye and shear of a slice. `radius` is the display's radius. `reach` is the distance from the slice
    /// to the near and far planes.
    pub fn eye(&self, slice: u32, radius: f64, reach: f64) -> SliceEye {
        match *self {
            Self::Orthographic => SliceEye { eye: None, shear: [0.0; 2] },
            Self::Perspective { eye: [u, v], distance, shear } => SliceEye { eye: Some([u, v, distance]), shear },
            Self::Jittered(jitter) => jitter.draw(slice, radius, reach),
        }
    }

    pub const fn name(&self) -> &'static str {
        match self {
            Self::Orthographic => "orthographic",
            Self::Perspective { .. } => "perspective",
            Self::Jittered(_) => "jittered",
        }
    }

    pub(crate) fn check(&self, radius: f64, reach: f64) -> Result<(), SettingError> {
        let (distance, others) = match *self {
            Self::Orthographic => return Ok(()),
            Self::Perspective { eye: [u, v], distance, shear: [x, y] } => (distance, [u, v, x, y]),
            Self::Jittered(j) => (j.eye_distance * radius, [j.eye_radius, j.shear_px, 0.0, 0.0]),
        };
        SettingError::require(
            others.iter().all(|x| x.is_finite()),
            "projection",
            "finite numbers",
            format_args!("{others:?}"),
        )?;
        let expected = format_args!("more than {reach} px, where the far plane is").to_string();
        SettingError::require(distance.is_finite() && distance > reach, "jitter.eye_distance", expected, distance)
    }
}

impl Jitter {
    fn draw(&self, slice: u32, radius: f64, reach: f64) -> SliceEye {
        let eye = in_disc(self.seed, slice, 0, self.eye_radius * radius);
        let shear = in_disc(self.seed, slice, 2, self.shear_px / reach);
        SliceEye { eye: Some([eye[0], eye[1], self.eye_distance * radius]), shear }
    }
}

/// Returns a random point, uniformly distributed in a disc around (0, 0).
fn in_disc(seed: u64, slice: u32, draw: u64, radius: f64) -> [f64; 2] {
    let r = radius * libm::sqrt(unit(seed, slice, draw));
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * unit(seed, slice, draw + 1));
    [r * cos, r * sin]
}

/// Returns a random number in [0, 1) with 53 bits from the mixing function of splitmix64.
fn unit(seed: u64, slice: u32, draw: u64) -> f64 {
    let counter = (u64::from(slice) << 2) | draw;
    let hash = mix(mix(seed).wrapping_add(counter));
    (hash >> 11) as f64 / (1u64 << 53) as f64
}

impl SliceEye {
    /// Returns the matrix from the slice's coordinates (u, v, s, 1) to clip coordinates. The depth is 0 at the near
    /// plane and 1 at the far plane.
    pub fn clip_matrix(&self, size: Size, reach: f64) -> DMat4 {
        let half = [f64::from(size[0]) / 2.0, f64::from(size[1]) / 2.0];
        let [kx, ky] = self.shear;
        // A projection along s divides by 1. For an eye at distance d, w is the distance d - s.
        let rows = match self.eye {
            None => [
                [1.0 / half[0], 0.0, kx / half[0], 0.0],
                [0.0, 1.0 / half[1], ky / half[1], 0.0],
                depth_row(None, reach),
                [0.0, 0.0, 0.0, 1.0],
            ],
            Some([eu, ev, d]) => [
                [d / half[0], 0.0, (d * kx - eu) / half[0], 0.0],
                [0.0, d / half[1], (d * ky - ev) / half[1], 0.0],
                depth_row(Some(d), reach),
                [0.0, 0.0, -1.0, d],
            ],
        };
        matrix_of_rows(rows)
    }

    /// Returns the rows of the matrix from the slice's coordinates (u, v, s, 1) to homogeneous window coordinates.
    /// These coordinates are x to the right and y down, both in pixels, depth, and w.
    ///
    /// The result equals [`Self::clip_matrix`] followed by the viewport. This function avoids the rounding of a
    /// division by half the image's size and of a multiplication by the same number.
    pub fn window_rows(&self, size: Size, reach: f64) -> [[f64; 4]; 4] {
        let middle = [f64::from(size[0]) / 2.0, f64::from(size[1]) / 2.0];
        let [kx, ky] = self.shear;
        match self.eye {
            None => {
                [[1.0, 0.0, kx, middle[0]], [0.0, -1.0, -ky, middle[1]], depth_row(None, reach), [0.0, 0.0, 0.0, 1.0]]
            }
            Some([eu, ev, d]) => [
                [d, 0.0, d * kx - eu - middle[0], middle[0] * d],
                [0.0, -d, ev - d * ky - middle[1], middle[1] * d],
                depth_row(Some(d), reach),
                [0.0, 0.0, -1.0, d],
            ],
        }
    }
}

fn depth_row(distance: Option<f64>, reach: f64) -> [f64; 4] {
    match distance {
        None => [0.0, 0.0, -1.0 / (2.0 * reach), 0.5],
        Some(d) => [0.0, 0.0, -(d + reach) / (2.0 * reach), (d + reach) / 2.0],
    }
}

pub(crate) fn matrix_of_rows(rows: [[f64; 4]; 4]) -> DMat4 {
    let [x, y, z, w] = rows.map(DVec4::from_array);
    DMat4::from_cols(x, y, z, w).transpose()
}

/// Returns the rows of the matrix that transforms eye coordinates to homogeneous window coordinates. `projection`
/// transforms eye coordinates to clip coordinates.
pub(crate) fn window_of(projection: &DMat4, size: Size) -> [[f64; 4]; 4] {
    let rows = projection.transpose();
    let w = rows.w_axis;
    let half_width = f64::from(size[0]) / 2.0;
    let half_height = f64::from(size[1]) / 2.0;
    [(rows.x_axis + w) * half_width, (w - rows.y_axis) * half_height, rows.z_axis, w].map(|row| row.to_array())
}
