//! A shifted raster, compared with the formula for a head that rotates steadily about one axis.
//!
//! A picture is drawn for the middle of its field, at time a. When the beam is at t, the shift is f tan(v (t - a)).

use crate::support::{after, beam, experiment, focal_px, retrace};
use glam::{DQuat, DVec3};
use image::{Rgb, RgbImage};
use pxpl5_measure::{Measured, PixelErrors, RasterOffsets, Showing};
use pxpl5_run::{Aim, Head, Outcome, Raster, WARM_UP_PERIODS};
use pxpl5_wire::PeriodNumber;
use std::sync::Arc;
use tracking::Pose;
use tracking::motion::{Motion, Pan, from_fn};
use tracking::predict::PredictorKind;
use tracking::time::PS_PER_MS;
use tracking::tracker::TrackerConfig;

const FIELDS: u64 = 30;

const RAD_PER_S: f64 = 2.0;

/// Returns the motion of a head that rotates about an axis of the world: to the left about y, or upwards about x.
fn turning(axis: DVec3) -> impl Motion + Send + Sync + 'static {
    // The start is chosen so that the head looks straight ahead in a field in the middle of the run.
    from_fn(move |seconds| Pose::facing(DQuat::from_axis_angle(axis, RAD_PER_S * (seconds - 0.35))))
}

fn run(axis: DVec3, raster: Raster) -> Outcome {
    let head = Head::new(Arc::new(turning(axis)), TrackerConfig::ideal(), PredictorKind::ConstantVelocity, 1);
    let head = head.expect("in range").with_aim(Aim::Middle).with_raster(raster);
    experiment("jitp-field", "full-screen:2").head(head).fields(FIELDS).run().expect("two triangles")
}

/// Returns the angle of rotation since the instant for which a field's picture is drawn.
fn turned(field: u64, row: u64, x: u64) -> f64 {
    let aim = (beam(field, 0, 0) + beam(field, 239, 639)) / 2.0;
    RAD_PER_S * (beam(field, row, x) - aim)
}

/// Returns a screen in which the colour of each pixel encodes its position.
fn places() -> RgbImage {
    RgbImage::from_fn(640, 480, |x, y| Rgb([1 + (x / 256) as u8, x as u8, (y / 2) as u8]))
}

/// Shifts every pixel of a field, and compares its source with the source from the formula.
fn check(axis: DVec3, field: u64, from: impl Fn(u64, u64, f64) -> [f64; 2]) {
    let outcome = run(axis, Raster::Vdrt);
    let offsets = RasterOffsets::of(&outcome).expect("it is shifted");
    let screen = places();
    let mut shifted = RgbImage::from_pixel(640, 480, Rgb([255; 3]));
    offsets.shift_rows(&screen, PeriodNumber(field), &mut shifted);
    let mut compared = 0;
    for (row, x) in (0..240_u64).step_by(7).flat_map(|row| (0..640_u64).map(move |x| (row, x))) {
        let y = (2 * row + field % 2) as u32;
        assert_eq!(shifted.get_pixel(x as u32, y ^ 1), &Rgb([255; 3]), "the other field's rows stay");
        let place = from(row, x, focal_px(640.0) * turned(field, row, x).tan());
        if place.iter().any(|place| (place - place.floor() - 0.5).abs() < 0.01) {
            continue;
        }
        let [column, line] = place.map(|place| place.round() as i64);
        let inside = (0..640).contains(&column) && (0..240).contains(&line);
        let expected =
            if inside { *screen.get_pixel(column as u32, 2 * line as u32 + (field % 2) as u32) } else { Rgb([0; 3]) };
        assert_eq!(shifted.get_pixel(x as u32, y), &expected, "{x} {row} of field {field}: from {place:?}");
        compared += 1;
    }
    assert!(compared > 20_000, "{compared}");
}

#[test]
fn during_a_pan_a_shifted_raster_takes_every_pixel_from_its_rotated_column() {
    for field in [20, 21] {
        check(DVec3::Y, field, |row, x, shift| [x as f64 - shift, row as f64]);
    }
}

#[test]
fn during_a_nod_the_rows_of_a_field_move_by_half_as_many_rows_as_the_frame() {
    for field in [20, 21] {
        check(DVec3::X, field, |row, x, shift| [x as f64, row as f64 - shift / 2.0]);
    }
}

#[test]
fn before_the_first_picture_rows_are_not_shifted_and_after_the_run_no_offset_exists() {
    let outcome = run(DVec3::Y, Raster::Vdrt);
    let offsets = RasterOffsets::of(&outcome).expect("it is shifted");
    let screen = places();
    let mut shifted = RgbImage::new(640, 480);
    offsets.shift_rows(&screen, PeriodNumber(0), &mut shifted);
    assert!(shifted.enumerate_pixels().all(|(x, y, pixel)| y % 2 == 1 || pixel == screen.get_pixel(x, y)));
    assert!(offsets.field(PeriodNumber(0)).is_none() && offsets.field(PeriodNumber(FIELDS)).is_none());
    assert!(offsets.field(PeriodNumber(FIELDS - 2)).is_some());
    assert!(RasterOffsets::of(&run(DVec3::Y, Raster::Plain)).is_none());
}

/// Returns the mean error of the 25 evaluated pixels of each field.
fn mean_px(drawn_at: impl Fn(f64, f64) -> f64) -> f64 {
    let grid = |size: u64| (0..5).map(move |i| (2 * i + 1) * size / 10);
    let fields = WARM_UP_PERIODS..FIELDS;
    let pixels = fields.flat_map(|field| grid(480).flat_map(move |y| grid(640).map(move |x| (field, y / 2, x))));
    let errors = pixels.map(|(field, row, x)| {
        let [right, up] = [x as f64 + 0.5 - 320.0, 240.0 - ((2 * row + field % 2) as f64 + 0.5)];
        let angle = turned(field, row, x);
        let [seen_right, seen_up] = after(drawn_at(right, angle), up, angle, focal_px(640.0));
        (seen_right - right).hypot(seen_up - up)
    });
    let errors: Vec<f64> = errors.collect();
    errors.iter().sum::<f64>() / errors.len() as f64
}

#[test]
fn a_shifted_raster_leaves_the_difference_between_shift_and_rotation() {
    let plain = mean_px(|right, _| right);
    let shifted = mean_px(|right, angle| right - focal_px(640.0) * angle.tan());
    assert!(shifted < plain / 5.0, "{shifted} of {plain}");
    for (raster, expected) in [(Raster::Plain, plain), (Raster::Vdrt, shifted)] {
        let outcome = run(DVec3::Y, raster);
        let found = outcome.pixel_errors().expect("a head");
        assert!((found.pixels.mean / expected - 1.0).abs() < 1e-3, "{raster:?}: {} for {expected}", found.pixels.mean);
    }
}

/// The ideal reference is drawn for every pixel's own instant, so an exactly predicted rotation leaves no error.
#[test]
fn an_ideal_view_of_a_steady_rotation_has_no_error() {
    let errors = PixelErrors::shown(&run(DVec3::Y, Raster::Plain), Showing::Ideal);
    assert_eq!(errors.evaluated, 25 * (FIELDS - WARM_UP_PERIODS));
    assert!(errors.pixels.max < 1e-6 && errors.degrees.max < 1e-6, "{errors:?}");
}

#[test]
fn every_evaluated_field_has_errors_of_all_its_pixels_and_the_time_of_its_retrace() {
    let errors = run(DVec3::Y, Raster::Plain).pixel_errors().expect("a head");
    let fields: Vec<u64> = errors.by_field.iter().map(|error| error.field.0).collect();
    assert_eq!(fields, (WARM_UP_PERIODS..FIELDS).collect::<Vec<_>>());
    for error in &errors.by_field {
        let retrace_s = retrace(error.field.0);
        assert!((error.time_s - retrace_s).abs() < 1e-9, "{error:?}");
        let row = 240.0 + (error.field.0 % 2) as f64;
        let [right, up] = [320.5 - 320.0, 240.0 - (row + 0.5)];
        let [seen_right, seen_up] = after(right, up, turned(error.field.0, 120, 320), focal_px(640.0));
        assert!((error.centre_px - (seen_right - right).hypot(seen_up - up)).abs() < 1e-6, "{error:?}");
    }
    let mean = |of: fn(&pxpl5_measure::FieldMisregistration) -> f64| {
        errors.by_field.iter().map(of).sum::<f64>() / fields.len() as f64
    };
    assert!((mean(|error| error.mean_px) - errors.pixels.mean).abs() < 1e-9);
    assert!((mean(|error| error.centre_px) - errors.centre_px.mean).abs() < 1e-9);
    assert_eq!((errors.all_px.len() as u64, errors.behind, errors.empty), (errors.evaluated, 0, 0));
}

/// The head rotates at 1,450 deg/s, and its reports are 100 ms late.
///
/// It turns by at least 145 degrees until the first pixel of a picture is lit, and by less than 240 degrees until the
/// last pixel is lit. All content is then behind the eye, which sees 30 degrees to each side.
#[test]
fn a_point_behind_the_eye_has_an_angle_and_the_diagonal_of_the_picture_as_its_error() {
    let fields = 45;
    let late = TrackerConfig::ideal().with_latency_ps(100 * PS_PER_MS);
    let head = Head::new(Arc::new(Pan::at(1_450.0)), late, PredictorKind::None, 1).expect("in range");
    let outcome = experiment("jitp-field", "full-screen:2").head(head).fields(fields).run().expect("two triangles");
    let errors = outcome.pixel_errors().expect("a head");
    let all = 25 * (fields - WARM_UP_PERIODS);
    assert_eq!((errors.evaluated, errors.outside, errors.behind), (all, all, all));
    // The picture has 640 by 480 pixels. A pixel at its edge is up to 38.7 degrees off the axis.
    assert!(
        (errors.pixels.mean - 800.0).abs() < 1e-9 && (errors.pixels.max - 800.0).abs() < 1e-9,
        "{:?}",
        errors.pixels
    );
    assert!(errors.degrees.mean > 120.0 && errors.degrees.max <= 180.0, "{:?}", errors.degrees);
}
