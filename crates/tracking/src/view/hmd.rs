use glam::{DVec2, DVec3};
use pxpl5_sim::parameters::{ParameterTable, SettingError};

use crate::config as table;
use crate::pose::Pose;
use crate::time::seconds;

/// Least distance of a point in front of the eye, m. A nearer point cannot be projected.
const NEAREST_M: f64 = 1e-6;

/// The flat picture of a head-mounted display, seen from one eye. Pixel (0, 0) is the upper left corner, with x to the
/// right and y down. The axis of view goes through the middle. Pixels are square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HmdView {
    width_px: f64,
    height_px: f64,
    horizontal_deg: f64,
    focal_px: f64,
}

/// The offset between the shown and the true position of a point in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misregistration {
    /// Shown position minus true position, px, x to the right and y down.
    pub offset_px: DVec2,
    /// Length of the offset, px.
    pub pixels: f64,
    /// Angle between the shown and the true direction of the point, seen from the eye, degrees.
    pub degrees: f64,
}

impl HmdView {
    /// Creates a view with a size of 1 to 16,384 px on each side and a horizontal angle of 1 to 170 degrees.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] if a size or the angle is out of range.
    pub fn new(width_px: u32, height_px: u32, horizontal_deg: f64) -> Result<Self, SettingError> {
        table::HeadMountedView { width: width_px.into(), height: height_px.into(), horizontal_angle: horizontal_deg }
            .check()?;
        let width_px = f64::from(width_px);
        let height_px = f64::from(height_px);
        let focal_px = width_px / 2.0 / libm::tan(horizontal_deg.to_radians() / 2.0);
        Ok(Self { width_px, height_px, horizontal_deg, focal_px })
    }

    /// Returns a view of 640 x 480 pixels with a horizontal angle of 60 degrees.
    pub fn ntsc() -> Self {
        Self::new(
            table::HeadMountedView::PAPERS.width as u32,
            table::HeadMountedView::PAPERS.height as u32,
            table::HeadMountedView::PAPERS.horizontal_angle,
        )
        .expect("the table's values are in range")
    }

    /// Returns the distance from the eye to the picture, in pixels.
    pub fn focal_px(&self) -> f64 {
        self.focal_px
    }

    /// Returns the angle between the left and the right edge of the picture, degrees.
    pub fn horizontal_deg(&self) -> f64 {
        self.horizontal_deg
    }

    /// Returns the middle of the picture, px from its upper left corner.
    pub fn centre_px(&self) -> DVec2 {
        DVec2::new(self.width_px, self.height_px) / 2.0
    }

    /// Returns the average number of pixels per degree over the width of the picture. The papers use this average,
    /// although a flat picture has fewer pixels per degree in the middle than at the edge.
    pub fn mean_px_per_deg(&self) -> f64 {
        self.width_px / self.horizontal_deg
    }

    /// Projects a point in head axes (m, the view along -z) to its position in the picture, px. The position may lie
    /// outside the picture. Returns `None` for a point behind the eye.
    pub fn project(&self, point: DVec3) -> Option<DVec2> {
        let depth = -point.z;
        (depth > NEAREST_M).then(|| self.centre_px() + DVec2::new(point.x, -point.y) * (self.focal_px / depth))
    }

    /// Returns true if a position lies within the picture.
    pub fn contains(&self, place: DVec2) -> bool {
        (0.0..=self.width_px).contains(&place.x) && (0.0..=self.height_px).contains(&place.y)
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
}

/// Returns the angle (degrees) through which a head turns during a span at constant speed.
pub fn drift_deg(deg_per_s: f64, span_ps: u64) -> f64 {
    deg_per_s * seconds(span_ps)
}

/// Returns the angle between two vectors, radians. Small angles keep full accuracy.
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
        let place = HmdView::ntsc().project(edge).unwrap();
        assert!((place - DVec2::new(640.0, 240.0)).length() < 1e-9);
    }

    #[test]
    fn up_is_a_smaller_y() {
        assert!(HmdView::ntsc().project(DVec3::new(0.0, 0.1, -1.0)).unwrap().y < 240.0);
    }

    #[test]
    fn behind_the_eye_there_is_no_picture() {
        assert_eq!(HmdView::ntsc().project(DVec3::Z), None);
        assert_eq!(HmdView::ntsc().project(DVec3::X), None);
        let behind = Pose::facing(rotation::about_y(3.0));
        assert_eq!(HmdView::ntsc().misregistration_at(DVec3::NEG_Z, &Pose::IDENTITY, &behind), None);
    }

    // J1 and J2 of the published figures: 200 deg/s, 60 degrees, 600 px.
    #[test]
    fn one_transform_a_field_is_3_3_degrees_and_33_px_off() {
        let view = HmdView::new(600, 480, 60.0).unwrap();
        let degrees = drift_deg(200.0, NTSC_FIELD_PS);
        assert!((degrees - 3.3).abs() < 0.05);
        assert!((degrees * view.mean_px_per_deg() - 33.0).abs() < 0.5);
        assert!((table::Ntsc::PAPERS.field * 1e9 - NTSC_FIELD_PS as f64).abs() < 1.0);
    }

    #[test]
    fn one_transform_a_scanline_is_0_013_degrees_and_0_13_px_off() {
        let view = HmdView::new(600, 480, 60.0).unwrap();
        let degrees = drift_deg(200.0, ntsc_lines_ps(1));
        assert!((degrees - 0.013).abs() < 5e-4);
        assert!((degrees * view.mean_px_per_deg() - 0.13).abs() < 5e-3);
        assert!((table::Ntsc::PAPERS.line * 1e6 - ntsc_lines_ps(1) as f64).abs() < 1.0);
    }

    #[test]
    fn a_pan_moves_the_centre_by_the_focal_length_times_the_tangent() {
        let pan = Pan::at(200.0);
        let error = HmdView::ntsc().centre_misregistration(&pan.pose(0), &pan.pose(NTSC_FIELD_PS), 5.0).unwrap();
        let expected = 320.0 / 30f64.to_radians().tan() * drift_deg(200.0, NTSC_FIELD_PS).to_radians().tan();
        assert!((error.pixels - expected).abs() < 1e-9);
        assert!((error.degrees - drift_deg(200.0, NTSC_FIELD_PS)).abs() < 1e-9);
        assert!(error.offset_px.x < 0.0, "turning left, the point should have gone right");
    }

    #[test]
    fn latencies_of_90_and_50_ms_err_as_1_8_to_1() {
        // At 40 deg/s, the mean speed of recorded use. The tangent adds 0.1 %.
        let pan = Pan::at(40.0);
        let [at_90, at_50] = [90, 50].map(|ms| {
            HmdView::ntsc().centre_misregistration(&pan.pose(0), &pan.pose(ms * PS_PER_MS), 5.0).unwrap().pixels
        });
        assert!((at_90 / at_50 - 1.8).abs() < 0.004);
    }

    #[test]
    fn views_without_pixels_or_angle_are_errors() {
        assert!(HmdView::new(0, 480, 60.0).is_err());
        assert!(HmdView::new(640, 480, 180.0).is_err());
        assert!(HmdView::new(640, 480, f64::NAN).is_err());
    }
}
