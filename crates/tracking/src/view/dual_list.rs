//! The dual display list of just-in-time pixels. Every vertex is transformed for two instants: the start T0 and the end
//! T1 of a field. Between these instants, the vertex is at P(t) = P1 s + P0 (1 - s) with s = (t - T0) / (T1 - T0). The
//! papers define P in two ways: as the position on the screen, or as the position in the view before the perspective
//! divide.

use glam::{DVec2, DVec3};

use super::Hmd;

/// Interpolates a vertex between its positions on the screen at the times T0 and T1. `start` and `end` are the vertex
/// in head axes (m) at these times. Returns `None` if the vertex is behind the eye at T0 or T1.
pub fn screen_space(view: &Hmd, start: DVec3, end: DVec3, s: f64) -> Option<DVec2> {
    Some(view.project(start)?.lerp(view.project(end)?, s))
}

/// Interpolates a vertex between its positions in head axes at the times T0 and T1, then projects the result. Returns
/// `None` if the result is behind the eye.
pub fn view_space(view: &Hmd, start: DVec3, end: DVec3, s: f64) -> Option<DVec2> {
    view.project(start.lerp(end, s))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Motion, Pan};
    use crate::rotation;
    use crate::time::{NTSC_FIELD_PS, ntsc_lines_ps};

    type Interpolate = fn(&Hmd, DVec3, DVec3, f64) -> Option<DVec2>;

    /// Returns the greatest error of interpolation in pixels, for a head that turns at 200 deg/s for `span_ps`. Only
    /// points within `half_width` pixels of the picture's middle count. The picture is 600 pixels and 60 degrees wide.
    fn worst(interpolate: Interpolate, span_ps: u64, half_width: f64) -> f64 {
        let steps = (0..=40).flat_map(|step| (-340..=340).map(move |tenth_deg| (step, tenth_deg)));
        steps
            .filter_map(|(step, tenth_deg)| error(interpolate, span_ps, half_width, step, tenth_deg))
            .fold(0.0, f64::max)
    }

    fn error(interpolate: Interpolate, span_ps: u64, half_width: f64, step: u64, tenth_deg: i32) -> Option<f64> {
        let view = Hmd::unc().with_pixels(600, 480);
        let point = rotation::about_y(f64::from(tenth_deg) / 573.0) * DVec3::NEG_Z * 4.0;
        let truth = view.project(seen_in_pan(point, span_ps * step / 40))?;
        let guess = interpolate(&view, seen_in_pan(point, 0), seen_in_pan(point, span_ps), step as f64 / 40.0)?;
        ((truth.x - 300.0).abs() <= half_width).then(|| guess.distance(truth))
    }

    /// Returns a point in the axes of a head that turns at 200 deg/s, in metres.
    fn seen_in_pan(point: DVec3, t_ps: u64) -> DVec3 {
        Pan::at(200.0).pose(t_ps).view_of(point)
    }

    #[test]
    fn screen_interpolation_has_an_error_of_0_34_px_at_the_edge() {
        // tan is interpolated: f x turn^2 / 8 x 2 tan 30 / cos^2 30 = 0.339 px over a whole field.
        let error = worst(screen_space, NTSC_FIELD_PS, 300.0);
        assert!((error - 0.34).abs() < 0.005, "{error}");
    }

    #[test]
    fn screen_interpolation_has_no_error_in_the_middle() {
        // Within 1 px of the middle tan is straight to the third order: f x turn^3 / 36 = 0.003 px.
        let error = worst(screen_space, NTSC_FIELD_PS, 1.0);
        assert!(error < 0.004, "{error}");
    }

    #[test]
    fn interpolation_in_eye_space_has_an_error_below_0_002_px() {
        // The error is atan(u tan h) - u h, where h is half the turn. The chord of an arc, seen from its centre, runs
        // ahead by turn^3 / (36 sqrt 3) at most. The edge of a flat picture magnifies this by f / cos^2 30. T1 is the
        // end of the visible field, 240 lines after T0. Over a whole field, with the retrace, the error would reach
        // 0.0022 px.
        for (span_ps, limit) in [(ntsc_lines_ps(240), 0.002), (NTSC_FIELD_PS, 0.0022)] {
            let turn = 200f64.to_radians() * span_ps as f64 / 1e12;
            let expected = 300.0 / 30f64.to_radians().tan() / 0.75 * turn.powi(3) / (36.0 * 3f64.sqrt());
            let error = worst(view_space, span_ps, 300.0);
            assert!(error < limit && (error / expected - 1.0).abs() < 0.1, "{error} {expected}");
        }
    }

    #[test]
    fn both_interpolations_are_exact_at_the_ends_of_the_field() {
        let view = Hmd::unc();
        let start = DVec3::new(0.3, 0.2, -2.0);
        let end = DVec3::new(0.1, 0.3, -3.0);
        for interpolate in [screen_space, view_space] {
            assert_eq!(interpolate(&view, start, end, 0.0), view.project(start));
            assert!(interpolate(&view, start, end, 1.0).unwrap().distance(view.project(end).unwrap()) < 1e-12);
        }
    }

    #[test]
    fn a_vertex_that_passes_behind_the_eye_has_no_interpolated_position() {
        let view = Hmd::unc();
        assert_eq!(screen_space(&view, DVec3::NEG_Z, DVec3::Z, 0.1), None);
        assert!(view_space(&view, DVec3::NEG_Z, DVec3::Z, 0.1).is_some());
        assert_eq!(view_space(&view, DVec3::NEG_Z, DVec3::Z, 0.9), None);
    }
}
