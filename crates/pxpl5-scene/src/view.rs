//! The head-mounted display, which converts the pose of a head into the matrices of its two eyes.

use glam::{DMat4, DQuat, DVec3, DVec4, Mat4};
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};
use tracking::Pose;

use crate::scene::Frame;
use crate::trig;
use std::fmt;

/// The eye for which a picture is drawn. In pairs of pictures, the left eye comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum EyePoint {
    /// The left eye, half the eye separation to the left of the head's position.
    Left,
    /// The right eye, half the eye separation to the right of the head's position.
    Right,
    /// The point between the two eyes, for a display with a single picture.
    Centre,
}

/// The matrices with which one eye's picture is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Eye for which the picture is drawn.
    pub eye: EyePoint,
    /// Matrix from world to eye coordinates, which only rotates and moves. Eye coordinates are right-handed with +y up,
    /// and the eye looks along -z.
    pub world_to_eye: Mat4,
    /// Matrix from head to eye coordinates, which only rotates and moves. Structures that are fixed to the head are
    /// drawn with this matrix.
    pub head_to_eye: Mat4,
    /// Matrix from eye to clip coordinates: -w <= x <= w (right), -w <= y <= w (up), 0 <= z <= w. The depth z/w grows
    /// from 0 at the near plane to 1 at the far plane.
    pub projection: Mat4,
}

impl View {
    /// Returns the matrix from the coordinates of `frame` (the world or the head) to eye coordinates.
    #[must_use]
    pub fn to_eye(&self, frame: Frame) -> Mat4 {
        match frame {
            Frame::World => self.world_to_eye,
            Frame::Head => self.head_to_eye,
        }
    }
}

/// Numbers of a head-mounted display in metres, degrees and pixels. [`Hmd::new`] checks the numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HmdConfig {
    /// Distance between the eyes, metres.
    pub eye_separation_m: f64,
    /// Angle between the left and the right edge of a picture, degrees.
    pub horizontal_fov_deg: f64,
    /// Number of pixels across a picture. Pixels are square.
    pub width_px: u32,
    /// Number of pixels from the top to the bottom of a picture. Pixels are square.
    pub height_px: u32,
    /// Distance from the eye to the near plane, metres. Nothing nearer is drawn.
    pub near_m: f64,
    /// Distance from the eye to the far plane, metres. Nothing farther away is drawn.
    pub far_m: f64,
    /// Distance from the head at which the optical axes of both eyes meet, metres. The axes are turned towards each
    /// other, and each picture is centred on its axis. `None` for parallel axes.
    #[serde(default)]
    pub convergence_m: Option<f64>,
    /// Radial distortion of the lens between eye and picture. The only possible value is 0: the model draws flat
    /// pictures and shows them without a lens.
    #[serde(default)]
    pub lens_distortion: f64,
}

impl HmdConfig {
    /// Returns the display of the low-latency experiments of 1993 to 1995.
    ///
    /// | number | value | provenance |
    /// |---|---|---|
    /// | picture | 640 x 480 | published TR94 |
    /// | field of view | 60 degrees | published in JITP's example, assumed here; 30 to 100 |
    /// | eye separation | 64 mm | assumed, mean of adults; 54 to 74 |
    /// | near, far | 0.05 m, 50 m | assumed; with 24 bits of depth a step at 1 m is 1.2 um |
    /// | convergence | parallel axes | assumed; the papers print no angle between the axes |
    /// | lens | none | assumed; the papers' pictures are not distorted before display |
    #[must_use]
    pub fn unc() -> Self {
        Self {
            eye_separation_m: 0.064,
            horizontal_fov_deg: 60.0,
            width_px: 640,
            height_px: 480,
            near_m: 0.05,
            far_m: 50.0,
            convergence_m: None,
            lens_distortion: 0.0,
        }
    }
}

/// Prints the numbers in one line, with the keys of an experiment file.
impl fmt::Display for HmdConfig {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { horizontal_fov_deg, eye_separation_m, near_m, far_m, convergence_m, lens_distortion, .. } = self;
        // Rounding hides the error of the conversion to millimetres.
        let eyes_mm = (eye_separation_m * 1e6).round() / 1e3;
        write!(f, "Display: {horizontal_fov_deg} degrees wide, eyes {eyes_mm} mm apart with ")?;
        match convergence_m {
            Some(metres) => write!(f, "axes that meet at {metres} m")?,
            None => write!(f, "parallel axes")?,
        }
        write!(f, ", near {near_m} m, far {far_m} m, ")?;
        if *lens_distortion == 0.0 { write!(f, "no lens (hmd.*)") } else { write!(f, "lens {lens_distortion} (hmd.*)") }
    }
}

/// A head-mounted display with checked numbers. Each picture is centred on the optical axis of its eye. The axes are
/// parallel, or meet ahead of the head.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hmd {
    config: HmdConfig,
    projection: Mat4,
}

impl Hmd {
    /// Checks the numbers of a display and creates the display.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the first number that is out of its range.
    pub fn new(config: HmdConfig) -> Result<Self, SettingError> {
        let c = &config;
        let separation = c.eye_separation_m;
        let fov = c.horizontal_fov_deg;
        SettingError::require((0.0..=1.0).contains(&separation), "eye_separation_m", "0 to 1", separation)?;
        SettingError::require((1.0..=170.0).contains(&fov), "horizontal_fov_deg", "1 to 170", fov)?;
        for (what, px) in [("width_px", c.width_px), ("height_px", c.height_px)] {
            SettingError::require((1..=65_536).contains(&px), what, "1 to 65536", f64::from(px))?;
        }
        SettingError::require((1e-6..=1e6).contains(&c.near_m), "near_m", "1e-6 to 1e6", c.near_m)?;
        let above_near = c.far_m > c.near_m && c.far_m <= 1e9;
        SettingError::require(above_near, "far_m", "above near_m, at most 1e9", c.far_m)?;
        if let Some(metres) = c.convergence_m {
            SettingError::require(
                (0.1..=1e6).contains(&metres),
                "convergence_m",
                "0.1 to 1e6, or none for parallel axes",
                metres,
            )?;
        }
        let lens = "0: the model shows flat pictures without a lens";
        SettingError::require(c.lens_distortion == 0.0, "lens_distortion", lens, c.lens_distortion)?;
        let projection = projection(c);
        Ok(Self { config, projection })
    }

    /// Returns the numbers of the display, all within their ranges.
    #[must_use]
    pub const fn config(&self) -> &HmdConfig {
        &self.config
    }

    /// Returns the matrices of the left and the right eye for this pose of the head.
    #[must_use]
    pub fn stereo(&self, head: &Pose) -> [View; 2] {
        [EyePoint::Left, EyePoint::Right].map(|eye| self.view(eye, head))
    }

    /// Returns the matrices of a single picture, seen from the point between the eyes, for this pose of the head.
    #[must_use]
    pub fn mono(&self, head: &Pose) -> View {
        self.view(EyePoint::Centre, head)
    }

    /// Returns the focal length: the distance from the eye to the flat picture, in pixels. A direction at 45 degrees to
    /// the optical axis meets the picture at this distance from the middle.
    #[must_use]
    pub fn focal_length_px(&self) -> f64 {
        f64::from(self.config.width_px) / 2.0 / half_width(&self.config)
    }

    /// Returns the disparity, in pixels, of a point `depth_m` metres ahead: eye separation x focal length / depth. In
    /// the left picture the point is farther to the right than in the right picture, by this distance. The formula is
    /// for parallel axes.
    #[must_use]
    pub fn disparity_px(&self, depth_m: f64) -> f64 {
        self.config.eye_separation_m * self.focal_length_px() / depth_m
    }

    fn view(&self, eye: EyePoint, head: &Pose) -> View {
        let half = self.config.eye_separation_m / 2.0;
        let right_of_head = match eye {
            EyePoint::Left => -half,
            EyePoint::Right => half,
            EyePoint::Centre => 0.0,
        };
        let shift = DMat4::from_translation(DVec3::new(-right_of_head, 0.0, 0.0));
        // The middle of the picture shows the point where the axes meet.
        let head_to_eye = match self.config.convergence_m {
            Some(metres) => turn_towards(-right_of_head, metres) * shift,
            None => shift,
        };
        View {
            eye,
            world_to_eye: (head_to_eye * world_to_head(head)).as_mat4(),
            head_to_eye: head_to_eye.as_mat4(),
            projection: self.projection,
        }
    }
}

/// Returns the rotation that moves a point onto the axis of view. The point lies `right` metres to the right and
/// `ahead` metres ahead. The function uses square roots instead of angles, so its result has the same bits on every
/// host.
fn turn_towards(right: f64, ahead: f64) -> DMat4 {
    let distance = (right * right + ahead * ahead).sqrt();
    let (sin, cos) = (right / distance, ahead / distance);
    DMat4::from_cols(
        DVec4::new(cos, 0.0, -sin, 0.0),
        DVec4::new(0.0, 1.0, 0.0, 0.0),
        DVec4::new(sin, 0.0, cos, 0.0),
        DVec4::new(0.0, 0.0, 0.0, 1.0),
    )
}

/// Returns the tangent of half the horizontal angle of view.
fn half_width(config: &HmdConfig) -> f64 {
    let (sin, cos) = trig::sin_cos_deg(config.horizontal_fov_deg / 2.0);
    sin / cos
}

fn projection(config: &HmdConfig) -> Mat4 {
    // Half the width and half the height of the picture at a distance of 1.
    let half_width = half_width(config);
    let half_height = half_width * f64::from(config.height_px) / f64::from(config.width_px);
    let near = config.near_m;
    let far = config.far_m;
    DMat4::from_cols(
        DVec4::new(1.0 / half_width, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 1.0 / half_height, 0.0, 0.0),
        DVec4::new(0.0, 0.0, far / (near - far), -1.0),
        DVec4::new(0.0, 0.0, near * far / (near - far), 0.0),
    )
    .as_mat4()
}

/// Returns the matrix from world to head coordinates, the inverse of the head's pose, in double precision. An
/// orientation of length zero counts as the identity.
fn world_to_head(head: &Pose) -> DMat4 {
    let q = head.orientation;
    let length = q.length();
    let q = if length > 0.0 { q / length } else { DQuat::IDENTITY };
    let back = q.conjugate();
    DMat4::from_rotation_translation(back, -(back * head.position))
}
