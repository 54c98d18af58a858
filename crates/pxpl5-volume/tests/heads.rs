//! Tests of a head that moves in front of the volume: errors of a head-mounted display with latency, and errors of
//! voxels.

use pxpl5_scene::builtin;
use pxpl5_sim::parameters::PathSettings;
use pxpl5_volume::heads::{HeadComparison, HeadStudyConfig};
use pxpl5_volume::spatialgl::OneThread;
use pxpl5_volume::{ProjectionKind, Volume, VolumeSettings};
use std::sync::LazyLock;
use tracking::Pose;
use tracking::motion::{Motion, Pan, Slide, Still};

/// A volume of the Mig, a test scene of 417 triangles, with 36 orthographic slices of 128 x 96 pixels.
static VOLUME: LazyLock<Volume> = LazyLock::new(|| {
    let mut settings = VolumeSettings { projection: ProjectionKind::Orthographic, ..VolumeSettings::paper() };
    for (path, text) in [("display.slices", "36"), ("display.width", "128"), ("display.height", "96")] {
        settings.set(path, text, "test").expect("a setting");
    }
    Volume::draw(&settings, &builtin("mig").expect("built in"), &OneThread).expect("drawn")
});

const QUESTION: HeadStudyConfig = HeadStudyConfig { latency_ms: Some(50.0), seconds: 1.0, instants: 11 };

fn study(motion: &dyn Motion, question: &HeadStudyConfig) -> pxpl5_volume::heads::HeadStudy {
    let before = HeadComparison::new(&VOLUME, motion, question.latency_ms).expect("valid");
    before.study(question).expect("valid")
}

/// Checks that the head-mounted display has no error for a still head, and that the voxels still have errors.
#[test]
fn a_still_head_has_no_error_of_latency() {
    let study = study(&Still(Pose::IDENTITY), &QUESTION);
    assert_eq!(study.samples.len(), 11);
    for sample in &study.samples {
        assert_eq!(sample.hmd_worst_deg, Some(0.0));
        assert!(sample.voxel_mean_deg > 0.0);
        assert!((sample.distance_mm - 508.0).abs() < 1e-6, "{sample:?}");
        assert!(sample.azimuth_deg.abs() < 1e-6 && sample.elevation_deg.abs() < 1e-6, "{sample:?}");
    }
}

/// Checks a head that slides to the right at 0.4 m/s, which is 20 mm in 50 ms. At a distance of 508 mm the error is
/// atan(20/508) = 2.25 degrees for the middle. The mean over points around the middle is about the same. The errors
/// grow with the latency.
#[test]
fn the_error_of_a_sliding_head_is_its_movement_over_the_distance() {
    let slide = Slide::right_at(0.4);
    let short = HeadStudyConfig { seconds: 0.01, ..QUESTION };
    let first = study(&slide, &short).samples[0];
    let expected = (20.0f64 / 508.0).atan().to_degrees();
    let found = first.hmd_mean_deg.expect("ahead");
    assert!((found / expected - 1.0).abs() < 0.1, "{found}, not about {expected}");
    let later = study(&slide, &HeadStudyConfig { latency_ms: Some(100.0), ..short }).samples[0];
    assert!(later.hmd_mean_deg > first.hmd_mean_deg);
    assert!(later.azimuth_deg > first.azimuth_deg, "to the right is towards +x of the volume");
}

/// Checks a head that turns by 60 degrees a second, with a latency of 50 ms. The error is exactly 3 degrees, seen from
/// the head. The eyes are 31 mm beside the axis of the turn.
#[test]
fn the_error_of_a_rotating_head_is_its_rate_times_the_latency() {
    let first = study(&Pan::at(60.0), &HeadStudyConfig { seconds: 0.01, ..QUESTION }).samples[0];
    let found = first.hmd_mean_deg.expect("ahead");
    assert!((found - 3.0).abs() < 0.2, "{found}");
}

/// Checks the distance between points and their voxels. In the plane of a slice, it is at most half a pixel along both
/// edges. Across the plane it is at most half the distance to the next slice. At the rim this is 64 px x sin(5 degrees)
/// = 5.58 px, because 36 slices are 10 degrees apart. One pixel is 254/128 mm.
#[test]
fn the_distance_of_a_point_from_its_voxel_is_at_most_the_size_of_a_voxel() {
    let study = study(&Still(Pose::IDENTITY), &QUESTION);
    let pixel_mm = 254.0 / 128.0;
    assert!((study.voxel_mm - pixel_mm).abs() < 1e-12);
    let most_mm = pixel_mm * (0.5f64 + 64.0 * 5.0f64.to_radians().sin());
    let least_distance_mm = 508.0 - 127.0;
    let sample = study.samples[0];
    let most_deg = (most_mm.hypot(pixel_mm / 2.0) / least_distance_mm).atan().to_degrees();
    assert!(sample.voxel_worst_deg <= most_deg, "{} > {most_deg}", sample.voxel_worst_deg);
    assert!(sample.voxel_mean_mm > 0.2 * pixel_mm, "{sample:?}");
    // A cell of 8 x 8 pixels, seen from a distance of 508 mm.
    let cell = 2.0 * (4.0 * pixel_mm / 508.0).atan().to_degrees();
    assert!((sample.dither_cell_deg - cell).abs() < 1e-9);
}

#[test]
fn the_picture_of_each_eye_shows_both_displays() {
    let slide = Slide::right_at(0.4);
    let before = HeadComparison::new(&VOLUME, &slide, Some(50.0)).expect("valid");
    let at = before.film_instants(&QUESTION, 3).expect("valid")[2];
    let exposure = before.exposure(at, 64, &OneThread).expect("seen");
    let picture = before.picture(at, 64, exposure, &OneThread).expect("seen");
    assert_eq!(picture.dimensions(), (128, 128));
    let lit = |left: u32, top: u32| {
        let places = (top..top + 64).flat_map(|y| (left..left + 64).map(move |x| (x, y)));
        places.filter(|(x, y)| picture.get_pixel(*x, *y).0 != [0; 3]).count()
    };
    for (left, top) in [(0, 0), (64, 0), (0, 64), (64, 64)] {
        assert!(lit(left, top) > 50, "nothing at {left}, {top}");
    }
}

#[test]
fn the_latency_of_a_volume_is_the_drawing_time_plus_three_quarters_of_a_rotation() {
    let late = VOLUME.latency_ms().expect("a GPU drew it");
    assert!((late - 1e3 / VOLUME.time().serial_hz() - 50.0).abs() < 1e-9, "three quarters of a turn of 66.7 ms");
    let study = study(&Still(Pose::IDENTITY), &HeadStudyConfig { latency_ms: None, ..QUESTION });
    assert_eq!((study.latency_is, study.volume_latency_ms), ("the volume's", Some(late)));
    assert!((study.latency_ms - late).abs() < 1e-6);
}

#[test]
fn impossible_settings_are_refused() {
    let still = Still(Pose::IDENTITY);
    for latency in [-1.0, f64::NAN, 1e9] {
        let error = HeadComparison::new(&VOLUME, &still, Some(latency)).expect_err("refused").to_string();
        assert!(error.contains("latency") && error.contains("0 to 10000"), "{error}");
    }
    let before = HeadComparison::new(&VOLUME, &still, Some(0.0)).expect("valid");
    for (question, part) in [
        (HeadStudyConfig { seconds: 0.0, ..QUESTION }, "length"),
        (HeadStudyConfig { seconds: f64::NAN, ..QUESTION }, "length"),
        (HeadStudyConfig { instants: 1, ..QUESTION }, "instants"),
    ] {
        let error = before.study(&question).expect_err("refused").to_string();
        assert!(error.contains(part), "{error}");
    }
}
