//! From the coordinates of a slice to its image: three projections, all of which leave the plane s = 0 where it is.

use crate::error::{SpatialError, require};
use glam::{DMat4, DVec4};
use serde::{Deserialize, Serialize};

/// Size of an image: width, then height, in pixels.
pub type Size = [u32; 2];

/// How what lies off a slice reaches its image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Projection {
    /// Along s. Loses every plane perpendicular to the screen.
    Orthographic,
    /// From an eye at (u, v, distance), pixels, in the coordinates of every slice, with a shear in pixels a pixel of s.
    Perspective {
        /// Place of the eye beside the axis of the image, pixels.
        eye: [f64; 2],
        /// Distance of the eye along +s, pixels.
        distance: f64,
        /// Shear across and up, pixels a pixel of s.
        shear: [f64; 2],
    },
    /// An eye and a shear drawn for each slice.
    Jittered(Jitter),
}

/// The law by which an eye and a shear are drawn for each slice: a pure function of the seed and the slice.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Jitter {
    /// Names the sequence; the same in all passes and volumes.
    pub seed: u64,
    /// Distance of the eye in radii of the display. Assumed 4, 2 to 16.
    pub eye_distance: f64,
    /// Radius of the disc in which the eye lies, in radii of the display. Assumed 0.5, 0 to 1.
    pub eye_radius: f64,
    /// Largest shift by the shear at the face of the slab, pixels. Assumed 0.5, 0 to 1.
    pub shear_px: f64,
}

impl Jitter {
    /// The assumed law with a seed: 4 R away, within R/2, half a pixel of shear at the face.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self { seed, eye_distance: 4.0, eye_radius: 0.5, shear_px: 0.5 }
    }
}

/// The eye of one slice; none for a projection along s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliceEye {
    /// Eye across, up and off the slice, pixels; `None` at infinity.
    pub eye: Option<[f64; 3]>,
    /// Shear across and up, pixels a pixel of s.
    pub shear: [f64; 2],
}

impl Projection {
    /// The eye and shear of a slice, for a display of this radius whose slices reach so far to near and far plane.
    #[must_use]
    pub fn eye(&self, slice: u32, radius: f64, reach: f64) -> SliceEye {
        match *self {
            Self::Orthographic => SliceEye { eye: None, shear: [0.0; 2] },
            Self::Perspective { eye: [u, v], distance, shear } => SliceEye { eye: Some([u, v, distance]), shear },
            Self::Jittered(jitter) => jitter.draw(slice, radius, reach),
        }
    }

    /// What it is called in options, tables and files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Orthographic => "orthographic",
            Self::Perspective { .. } => "perspective",
            Self::Jittered(_) => "jittered",
        }
    }

    pub(crate) fn check(&self, radius: f64, reach: f64) -> Result<(), SpatialError> {
        let (distance, others) = match *self {
            Self::Orthographic => return Ok(()),
            Self::Perspective { eye: [u, v], distance, shear: [x, y] } => (distance, [u, v, x, y]),
            Self::Jittered(j) => (j.eye_distance * radius, [j.eye_radius, j.shear_px, 0.0, 0.0]),
        };
        require(others.iter().all(|x| x.is_finite()), "projection", "finite numbers", format_args!("{others:?}"))?;
        let expected = format_args!("more than {reach} px, where the far plane is").to_string();
        require(distance.is_finite() && distance > reach, "jitter.eye_distance", expected, distance)
    }
}

impl Jitter {
    fn draw(&self, slice: u32, radius: f64, reach: f64) -> SliceEye {
        let eye = in_disc(self.seed, slice, 0, self.eye_radius * radius);
        let shear = in_disc(self.seed, slice, 2, self.shear_px / reach);
        SliceEye { eye: Some([eye[0], eye[1], self.eye_distance * radius]), shear }
    }
}

/// A point uniform in a disc around (0, 0).
fn in_disc(seed: u64, slice: u32, draw: u64, radius: f64) -> [f64; 2] {
    let r = radius * libm::sqrt(unit(seed, slice, draw));
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * unit(seed, slice, draw + 1));
    [r * cos, r * sin]
}

/// A number of [0, 1) with 53 bits, by the mixing function of splitmix64.
fn unit(seed: u64, slice: u32, draw: u64) -> f64 {
    let counter = (u64::from(slice) << 2) | draw;
    let hash = mix(mix(seed).wrapping_add(counter));
    (hash >> 11) as f64 / (1u64 << 53) as f64
}

/// The mixing function of splitmix64 (Steele, Lea and Flood 2014).
pub(crate) const fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

impl SliceEye {
    /// The matrix from (u, v, s, 1) to clip coordinates, depth 0 at the near plane to 1 at the far plane.
    #[must_use]
    pub fn clip_matrix(&self, size: Size, reach: f64) -> DMat4 {
        let half = [f64::from(size[0]) / 2.0, f64::from(size[1]) / 2.0];
        let [kx, ky] = self.shear;
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

    /// The rows from (u, v, s, 1) to homogeneous window coordinates: x to the right and y down in pixels, depth, w.
    ///
    /// The same map as [`Self::clip_matrix`] and the viewport, without the rounding of a division and a product by R.
    #[must_use]
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

/// A matrix from its rows.
pub(crate) fn matrix_of_rows(rows: [[f64; 4]; 4]) -> DMat4 {
    let [x, y, z, w] = rows.map(DVec4::from_array);
    DMat4::from_cols(x, y, z, w).transpose()
}

/// The rows to homogeneous window coordinates of any projection to clip coordinates.
pub(crate) fn window_of(projection: &DMat4, size: Size) -> [[f64; 4]; 4] {
    let rows = projection.transpose();
    let w = rows.w_axis;
    let half_width = f64::from(size[0]) / 2.0;
    let half_height = f64::from(size[1]) / 2.0;
    [(rows.x_axis + w) * half_width, (w - rows.y_axis) * half_height, rows.z_axis, w].map(|row| row.to_array())
}
