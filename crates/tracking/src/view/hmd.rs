//! The head-mounted display: its numbers, and the places of points in its flat pictures.

use std::fmt;

use glam::{DMat4, DVec2, DVec3, DVec4, Mat4};
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use serde::{Deserialize, Serialize};

use crate::config::HeadMountedView;
use crate::pose::Pose;
use crate::time::seconds;

/// Least distance of a point in front of the eye, m. A nearer point cannot be projected.
const NEAREST_M: f64 = 1e-6;

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
    /// Returns the display of the low-latency experiments of 1993 to 1995, with the numbers of [`HeadMountedView`]. The
    /// axes are parallel and there is no lens. Both are assumed: the papers print no angle between the axes, and the
    /// papers' pictures are not distorted before display.
    pub const fn unc() -> Self {
        let HeadMountedView { eye_separation_m, horizontal_fov_deg, width_px, height_px, near_m, far_m } =
            HeadMountedView::PAPERS;
        Self {
            eye_separation_m,
            horizontal_fov_deg,
            width_px: width_px as u32,
            height_px: height_px as u32,
            near_m,
            far_m,
            convergence_m: None,
            lens_distortion: 0.0,
        }
    }

    fn check(&self) -> Result<(), SettingError> {
        let Self { eye_separation_m, horizontal_fov_deg, near_m, far_m, .. } = *self;
        let (width_px, height_px) = (self.width_px.into(), self.height_px.into());
        HeadMountedView { eye_separation_m, horizontal_fov_deg, width_px, height_px, near_m, far_m }.check()?;
        SettingError::require(far_m > near_m, "far_m", "above near_m, at most 1e9", far_m)?;
        if let Some(metres) = self.convergence_m {
            let expected = "0.1 to 1e6, or none for parallel axes";
            SettingError::require((0.1..=1e6).contains(&metres), "convergence_m", expected, metres)?;
        }
        let lens = "0: the model shows flat pictures without a lens";
        SettingError::require(self.lens_distortion == 0.0, "lens_distortion", lens, self.lens_distortion)
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

/// A head-mounted display with checked numbers. Each picture is flat and centred on the optical axis of its eye. The
/// axes are parallel, or meet ahead of the head. Pixel (0, 0) is the upper left corner, with x to the right and y down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hmd {
    config: HmdConfig,
    /// Tangent of half the horizontal angle of view.
    half_width: f64,
    focal_px: f64,
}

/// Difference between the shown and the true position of a point in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misregistration {
    /// Shown position minus true position, px, x to the right and y down.
    pub offset_px: DVec2,
    /// Distance from the true position to the shown position, px.
    pub pixels: f64,
    /// Angle between the shown and the true direction of the point, seen from the eye, degrees.
    pub degrees: f64,
}

impl Hmd {
    /// Checks the numbers of a display and creates the display.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the first number that is out of its range.
    pub fn new(config: HmdConfig) -> Result<Self, SettingError> {
        config.check()?;
        let half_width = libm::tan(config.horizontal_fov_deg.to_radians() / 2.0);
        let focal_px = f64::from(config.width_px) / 2.0 / half_width;
        Ok(Self { config, half_width, focal_px })
    }

    /// Returns the display with the numbers of [`HmdConfig::unc`].
    pub fn unc() -> Self {
        Self::new(HmdConfig::unc()).expect("the table's values are in range")
    }

    /// Returns the same display with pictures of `width_px` x `height_px` pixels.
    ///
    /// # Panics
    ///
    /// Panics if a side has no pixels or more than 65,536.
    #[must_use]
    pub fn with_pixels(self, width_px: u32, height_px: u32) -> Self {
        Self::new(HmdConfig { width_px, height_px, ..self.config })
            .expect("a picture has 1 to 65,536 pixels on each side")
    }

    /// Returns the numbers of the display, all within their ranges.
    pub const fn config(&self) -> &HmdConfig {
        &self.config
    }

    /// Returns the focal length: the distance from the eye to the flat picture, in pixels. A direction at 45 degrees to
    /// the optical axis meets the picture at this distance from the middle.
    pub const fn focal_px(&self) -> f64 {
        self.focal_px
    }

    /// Returns the disparity, in pixels, of a point `depth_m` metres ahead: eye separation x focal length / depth. In
    /// the left picture the point is farther to the right than in the right picture, by this distance. The formula is
    /// for parallel axes.
    pub fn disparity_px(&self, depth_m: f64) -> f64 {
        self.config.eye_separation_m * self.focal_px / depth_m
    }

    /// Returns the middle of the picture, px from its upper left corner.
    pub fn centre_px(&self) -> DVec2 {
        DVec2::new(self.config.width_px.into(), self.config.height_px.into()) / 2.0
    }

    /// Returns the average number of pixels per degree over the width of the picture. The papers use this average,
    /// although a flat picture has fewer pixels per degree in the middle than at the edge.
    pub fn mean_px_per_deg(&self) -> f64 {
        f64::from(self.config.width_px) / self.config.horizontal_fov_deg
    }

    /// Projects a point in head axes (m, the view along -z) to its position in the picture, px. The position may lie
    /// outside the picture. Returns `None` for a point behind the eye.
    pub fn project(&self, point: DVec3) -> Option<DVec2> {
        let depth = -point.z;
        (depth > NEAREST_M).then(|| self.centre_px() + DVec2::new(point.x, -point.y) * (self.focal_px / depth))
    }

    /// Returns true if a position lies within the picture.
    pub fn contains(&self, place: DVec2) -> bool {
        let size = self.centre_px() * 2.0;
        (0.0..=size.x).contains(&place.x) && (0.0..=size.y).contains(&place.y)
    }

    /// Returns the error of a world point that was drawn for the pose `drawn_for` and is seen from the pose
    /// `seen_from`. Returns `None` if the point is behind the eye in either pose.
    pub fn misregistration_at(&self, world: DVec3, drawn_for: &Pose, seen_from: &Pose) -> Option<Misregistration> {
        let drawn = drawn_for.view_of(world);
        let seen = seen_from.view_of(world);
        let offset_px = self.project(drawn)? - self.project(seen)?;
        let degrees = angle_between(drawn, seen).to_degrees();
        Some(Misregistration { offset_px, pixels: offset_px.length(), degrees })
    }

    /// Returns the error of a late frame as the papers measure it. When the frame begins, the point lies `distance_m`
    /// ahead on the axis of view. The error is the offset of the drawn point from its true position when the frame is
    /// shown.
    pub fn centre_misregistration(&self, begun: &Pose, shown: &Pose, distance_m: f64) -> Option<Misregistration> {
        let point = begun.position + begun.orientation * (DVec3::NEG_Z * distance_m);
        self.misregistration_at(point, begun, shown)
    }

    pub(super) fn projection(&self) -> Mat4 {
        let HmdConfig { width_px, height_px, near_m: near, far_m: far, .. } = self.config;
        // Half the width and half the height of the picture at a distance of 1.
        let half_width = self.half_width;
        let half_height = half_width * f64::from(height_px) / f64::from(width_px);
        DMat4::from_cols(
            DVec4::new(1.0 / half_width, 0.0, 0.0, 0.0),
            DVec4::new(0.0, 1.0 / half_height, 0.0, 0.0),
            DVec4::new(0.0, 0.0, far / (near - far), -1.0),
            DVec4::new(0.0, 0.0, near * far / (near - far), 0.0),
        )
        .as_mat4()
    }
}

/// Returns the angle (degrees) through which a head turns during a span at constant speed.
pub fn drift_deg(deg_per_s: f64, span_ps: u64) -> f64 {
    deg_per_s * seconds(span_ps)
}

/// Returns the angle between two vectors, radians. The formula is accurate for small angles too.
pub(super) fn angle_between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config as table;
    use crate::motion::{Motion, Pan};
    use crate::rotation;
    use crate::time::{NTSC_FIELD_PS, PS_PER_MS, ntsc_lines_ps};

    #[test]
    fn the_edge_of_a_60_degree_view_is_30_degrees_off_the_axis() {
        let edge = rotation::about_y(-30f64.to_radians()) * DVec3::NEG_Z;
        let place = Hmd::unc().project(edge).unwrap();
        assert!((place - DVec2::new(640.0, 240.0)).length() < 1e-9);
    }

    #[test]
    fn a_higher_point_has_a_smaller_y_coordinate_on_the_screen() {
        assert!(Hmd::unc().project(DVec3::new(0.0, 0.1, -1.0)).unwrap().y < 240.0);
    }

    #[test]
    fn points_behind_the_eye_are_not_projected() {
        assert_eq!(Hmd::unc().project(DVec3::Z), None);
        assert_eq!(Hmd::unc().project(DVec3::X), None);
        let behind = Pose::facing(rotation::about_y(3.0));
        assert_eq!(Hmd::unc().misregistration_at(DVec3::NEG_Z, &Pose::IDENTITY, &behind), None);
    }

    // J1 and J2 of the published figures: 200 deg/s, 60 degrees, 600 px.
    #[test]
    fn with_one_transform_per_field_the_error_is_3_3_degrees_and_33_px() {
        let view = Hmd::unc().with_pixels(600, 480);
        let degrees = drift_deg(200.0, NTSC_FIELD_PS);
        assert!((degrees - 3.3).abs() < 0.05);
        assert!((degrees * view.mean_px_per_deg() - 33.0).abs() < 0.5);
        assert!((table::Ntsc::PAPERS.field * 1e9 - NTSC_FIELD_PS as f64).abs() < 1.0);
    }

    #[test]
    fn with_one_transform_per_scanline_the_error_is_0_013_degrees_and_0_13_px() {
        let view = Hmd::unc().with_pixels(600, 480);
        let degrees = drift_deg(200.0, ntsc_lines_ps(1));
        assert!((degrees - 0.013).abs() < 5e-4);
        assert!((degrees * view.mean_px_per_deg() - 0.13).abs() < 5e-3);
        assert!((table::Ntsc::PAPERS.line * 1e6 - ntsc_lines_ps(1) as f64).abs() < 1.0);
    }

    #[test]
    fn a_pan_moves_the_centre_by_the_focal_length_times_the_tangent() {
        let pan = Pan::at(200.0);
        let error = Hmd::unc().centre_misregistration(&pan.pose(0), &pan.pose(NTSC_FIELD_PS), 5.0).unwrap();
        let expected = 320.0 / 30f64.to_radians().tan() * drift_deg(200.0, NTSC_FIELD_PS).to_radians().tan();
        assert!((error.pixels - expected).abs() < 1e-9);
        assert!((error.degrees - drift_deg(200.0, NTSC_FIELD_PS)).abs() < 1e-9);
        assert!(error.offset_px.x < 0.0, "turning left, the point should have gone right");
    }

    #[test]
    fn errors_at_90_and_50_ms_have_the_ratio_1_8() {
        // 40 deg/s is the mean speed of recorded use. The tangent adds 0.1 %.
        let pan = Pan::at(40.0);
        let [at_90, at_50] = [90, 50]
            .map(|ms| Hmd::unc().centre_misregistration(&pan.pose(0), &pan.pose(ms * PS_PER_MS), 5.0).unwrap().pixels);
        assert!((at_90 / at_50 - 1.8).abs() < 0.004);
    }
}
