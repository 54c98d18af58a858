//! Tests of pictures that a device moves to the newest pose. Expected values come from formulas for a head that rotates
//! or slides at a constant speed.
//!
//! The tracker is ideal and the predictor is exact for such motions, so only the instants of the poses cause errors.

use crate::support::{after, beam, experiment, focal_px};
use glam::DQuat;
use image::RgbImage;
use pxpl5_framebuffer::PanelConfig;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{EyeReport, Measured, PixelErrors, Showing, reproject};
use pxpl5_run::{
    Every, Experiment, Head, Outcome, Pixels, Raster, RenderingControl, Reprojection, WARM_UP_PERIODS, Warp,
};
use pxpl5_scene::builtin;
use pxpl5_sim::Time;
use pxpl5_wire::SurfaceId;
use pxpl5_wire::display::DisplayConfig;
use std::sync::Arc;
use tracking::Pose;
use tracking::motion::{Motion, Slide, from_fn};
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;
use tracking::view::Hmd;

const FIELDS: u64 = 30;

/// Returns the motion of a head that rotates to the left at a constant rate, in radians per second.
fn turning(rad_per_s: f64) -> impl Motion + Send + Sync + 'static {
    from_fn(move |seconds| Pose::facing(DQuat::from_rotation_y(rad_per_s * (seconds - 0.35))))
}

fn head(motion: impl Motion + Send + Sync + 'static) -> Head {
    let head = Head::new(Arc::new(motion), TrackerConfig::ideal(), PredictorKind::ConstantVelocity, 1);
    head.expect("in range")
}

/// Runs a pipeline that draws each field for one pose, at the instant at which its middle is displayed.
fn fields(head: Head, scene: &str) -> Outcome {
    experiment("jitp-field", scene).head(head).fields(FIELDS).run().expect("it is small")
}

const fn device(by: Warp, every: Every) -> Showing {
    Showing::Reprojected(Reprojection::new(by, every))
}

/// Returns the instant for which the picture of a field is drawn, in seconds.
fn aim(field: u64) -> f64 {
    (beam(field, 0, 0) + beam(field, 239, 639)) / 2.0
}

/// Returns the instant for which the pose of a part of a field is predicted, in seconds: halfway between the lighting
/// of its first and last pixel.
fn middle_of(every: Every, field: u64, row: u64) -> f64 {
    // The number of the line in the frame. A field lights every second line.
    let line = 2 * row + field % 2;
    let [from, to] = match every {
        Every::Field => [0, 239],
        Every::Strip => [line / 128 * 64, (line / 128 * 64 + 63).min(239)],
        Every::Line => [row, row],
    };
    (beam(field, from, 0) + beam(field, to, 639)) / 2.0
}

/// Returns the pixels of a field at which errors are evaluated.
fn grid() -> impl Iterator<Item = (u64, u64, u64)> {
    let places = |size: u64| (0..5).map(move |i| (2 * i + 1) * size / 10);
    let of_field = move |field| places(480).flat_map(move |y| places(640).map(move |x| (field, y / 2, x)));
    (WARM_UP_PERIODS..FIELDS).flat_map(of_field)
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    values.iter().sum::<f64>() / values.len() as f64
}

/// Returns the mean distance, in pixels, that content moves from the instant of its pose until it is lit.
fn turned_px(rate: f64, every: Every) -> f64 {
    let f = focal_px(640.0);
    mean(grid().map(|(field, row, x)| {
        let [right, up] = [x as f64 + 0.5 - 320.0, 240.0 - ((2 * row + field % 2) as f64 + 0.5)];
        let angle = rate * (beam(field, row, x) - middle_of(every, field, row));
        let [seen_right, seen_up] = after(right, up, angle, f);
        (seen_right - right).hypot(seen_up - up)
    }))
}

#[test]
fn after_reprojection_the_error_is_the_rotation_from_the_pose_of_the_device_to_the_light() {
    let outcome = fields(head(turning(2.0)), "full-screen:2");
    for by in [Warp::Rotation, Warp::Depth] {
        for every in [Every::Field, Every::Strip, Every::Line] {
            let errors = PixelErrors::shown(&outcome, device(by, every));
            let expected = turned_px(2.0, every);
            assert_eq!(errors.evaluated, 25 * (FIELDS - WARM_UP_PERIODS), "{by:?} {every:?}");
            let found = errors.pixels.mean;
            assert!((found / expected - 1.0).abs() < 2e-3, "{by:?} {every:?}: {found} for {expected}");
        }
    }
    // A line takes 52 us: less than a twentieth of a pixel at 115 degrees a second.
    assert!(turned_px(2.0, Every::Line) < 0.05 && turned_px(2.0, Every::Field) > 4.0);
}

#[test]
fn a_shift_equals_a_rotation_only_in_the_middle_of_the_picture() {
    let outcome = fields(head(turning(2.0)), "full-screen:2");
    let shift = PixelErrors::shown(&outcome, device(Warp::Shift, Every::Line));
    let turn = PixelErrors::shown(&outcome, device(Warp::Rotation, Every::Line));
    assert!((shift.centre_px.mean - turn.centre_px.mean).abs() < 1e-3);
    assert!(shift.pixels.mean > 5.0 * turn.pixels.mean, "{} {}", shift.pixels.mean, turn.pixels.mean);
}

/// The expected share covers all pixels of each field whose source lies beyond the edge: `f tan(atan(x / f) - a)`, with x
/// from the middle. A narrow band at an edge must count as a wide one does.
#[test]
fn the_empty_share_is_the_part_rotated_in_from_beyond_the_edge() {
    for rate in [0.5, 2.0, 8.0] {
        let outcome = fields(head(turning(rate)), "full-screen:2");
        let f = focal_px(640.0);
        let pixels = || (WARM_UP_PERIODS..FIELDS).flat_map(|field| (0..240).map(move |row| (field, row)));
        let beyond = mean(pixels().flat_map(|(field, row)| {
            let angle = rate * (middle_of(Every::Line, field, row) - aim(field));
            (0..640).map(move |x| {
                let [right, up] = [f64::from(x) + 0.5 - 320.0, 240.0 - ((2 * row + field % 2) as f64 + 0.5)];
                let [from_right, from_up] = after(right, up, -angle, f);
                f64::from(u8::from(from_right.abs() > 320.0 || from_up.abs() > 240.0))
            })
        }));
        for by in [Warp::Rotation, Warp::Depth] {
            let found = EyeReport::shown(&outcome, device(by, Every::Line)).expect("a device");
            let share = found.reprojection.expect("a device").empty_share.expect("checked");
            let most = if by == Warp::Depth { 0.005 } else { 0.002 };
            assert!((share - beyond).abs() < most, "{rate} rad/s, {by:?}: {share} of {beyond}");
        }
    }
}

#[test]
fn a_device_without_depth_reports_its_rates_and_no_hidden_share() {
    let outcome = fields(head(turning(8.0)), "full-screen:2");
    let found = EyeReport::shown(&outcome, device(Warp::Rotation, Every::Line)).expect("a device");
    let found = found.reprojection.expect("a device");
    // Without depths, the hidden parts of the scene are unknown.
    assert_eq!(found.disoccluded_share, None);
    let pixels_per_s = 640.0 * 240.0 * 60_000.0 / 1_001.0;
    assert!((found.pixels_per_s / pixels_per_s - 1.0).abs() < 1e-6, "{}", found.pixels_per_s);
    assert!((found.poses_per_s / (240.0 * 60_000.0 / 1_001.0) - 1.0).abs() < 1e-6, "{}", found.poses_per_s);
}

/// The content lies on a plane at a distance z before the head, which slides along the plane. In a time t, the content
/// moves by f v t / z.
#[test]
fn without_depth_reprojection_leaves_the_error_of_a_translation_and_with_depth_only_a_line_time() {
    const M_PER_S: f64 = 0.5;
    const DISTANCE_M: f64 = 2.0;
    let slide = head(Slide::right_at(M_PER_S)).evaluated_at(DISTANCE_M).expect("in range");
    let outcome = fields(slide, "full-screen:2");
    let left = |pose_at: fn(u64, u64) -> f64| {
        let px_per_s = focal_px(640.0) * M_PER_S / DISTANCE_M;
        mean(grid().map(|(field, row, x)| px_per_s * (beam(field, row, x) - pose_at(field, row)).abs()))
    };
    let rotation = PixelErrors::shown(&outcome, device(Warp::Rotation, Every::Line)).pixels.mean;
    let depth = PixelErrors::shown(&outcome, device(Warp::Depth, Every::Line)).pixels.mean;
    let without = left(|field, _| aim(field));
    let with = left(|field, row| middle_of(Every::Line, field, row));
    assert!((rotation / without - 1.0).abs() < 1e-3, "{rotation} for {without}");
    assert!((depth / with - 1.0).abs() < 2e-3, "{depth} for {with}");
    assert!(without > 100.0 * with);
}

/// Runs a panel display of one region, on which each picture is drawn for the time at which its own period is lit.
fn on_panel(config: PanelConfig, rate: f64) -> Outcome {
    let config = PanelConfig { width: 128, height: 96, refresh_hz: 30, ..config };
    let machine = MachineConfig { displays: vec![Box::new(config)], ..MachineConfig::small_hmd() };
    let scene = builtin("full-screen:2").expect("built in");
    let experiment = Experiment::new(machine, RenderingControl::mono(), scene).head(head(turning(rate)));
    experiment.fields(FIELDS).pixels(Pixels::Off).run().expect("it is small")
}

/// Returns the error, in pixels, in the middle of a picture that is lit `seconds` after the instant for which it was
/// drawn.
fn off_px(seconds: f64, rate: f64) -> f64 {
    // The position of the middle of the middle pixel.
    let [seen_right, seen_up] = after(0.5, -0.5, rate * seconds, focal_px(128.0));
    (seen_right - 0.5).hypot(seen_up + 0.5)
}

#[test]
fn a_global_display_is_correct_everywhere_and_a_rolling_one_in_the_middle_of_its_scan() {
    const RATE: f64 = 1.0;
    let [rolling, global] = [0, 1].map(|scan| {
        let outcome = on_panel(PanelConfig { scan, ..PanelConfig::PAPERS }, RATE);
        outcome.pixel_errors().expect("a head")
    });
    assert!(global.evaluated > 0 && global.pixels.max < 1e-3, "{}", global.pixels.max);
    // A pixel lights at an instant proportional to its number in the scan of 96 lines of 128 pixels. The picture is
    // drawn for half of the last pixel's number.
    let places = |size: u64| (0..5).map(move |i| (2 * i + 1) * size / 10);
    let pixels = places(96).flat_map(|y| places(128).map(move |x| (x, y)));
    let expected = mean(pixels.map(|(x, y)| {
        let part = ((y * 128 + x) as f64 - 12_287.0 / 2.0) / 12_288.0;
        let [right, up] = [x as f64 + 0.5 - 64.0, 48.0 - (y as f64 + 0.5)];
        let [seen_right, seen_up] = after(right, up, RATE * part / 30.0, focal_px(128.0));
        (seen_right - right).hypot(seen_up - up)
    }));
    assert!((rolling.pixels.mean / expected - 1.0).abs() < 1e-3, "{} for {expected}", rolling.pixels.mean);
}

#[test]
fn persistence_delays_the_centre_of_light_by_half_and_smears_over_its_whole_time() {
    const RATE: f64 = 1.0;
    for (persistence_us, response_us) in [(4_000, 0), (20_000, 0), (2_000, 1_000)] {
        let config = PanelConfig { scan: 1, persistence_us, response_us, ..PanelConfig::PAPERS };
        let outcome = on_panel(config, RATE);
        let errors = outcome.pixel_errors().expect("a head");
        let [p, r] = [persistence_us, response_us].map(|us| us as f64 * 1e-6);
        let centre = off_px(p / 2.0 + r, RATE);
        assert!((errors.centre_px.mean - centre).abs() < 1e-3, "{} for {centre}", errors.centre_px.mean);
        let lighting_ms = outcome.report().head.expect("a head").end_to_end.lighting_ms;
        assert!((lighting_ms - (p / 2.0 + r) * 1e3).abs() < 1e-9, "{lighting_ms}");
        let smear = EyeReport::shown(&outcome, Showing::Plain).and_then(|eye| eye.smear_px).expect("it smears");
        // The error is v t in the middle. Towards the edge it grows with the tangent: by up to 1 + tan^2(24 degrees).
        let width = (p * p + 12.0 * r * r).sqrt();
        let in_the_middle = 2.0 * focal_px(128.0) * (RATE * width / 2.0).tan();
        let mean_factor = smear.mean / in_the_middle;
        assert!((1.0..1.15).contains(&mean_factor), "{} of {in_the_middle}", smear.mean);
        assert_eq!(smear.n, errors.evaluated);
    }
}

#[test]
fn a_plain_raster_without_persistence_has_no_report_of_the_eye() {
    let outcome = fields(head(turning(1.0)), "full-screen:2");
    assert_eq!(EyeReport::shown(&outcome, Showing::Plain), None);
    assert_eq!(outcome.report().eye, None);
    assert!(!serde_json::to_string(&outcome.report()).expect("numbers").contains("\"eye\""));
}

/// VDRT is reported as a device. No pixel is empty, because its picture counts as drawn beyond the edge of the screen.
#[test]
fn vdrt_is_reported_as_a_reprojection_device_without_empty_pixels() {
    assert_eq!(Raster::Vdrt.reprojection(), Some(Reprojection::VDRT));
    let outcome = fields(head(turning(2.0)).with_raster(Raster::Vdrt), "full-screen:2");
    let eye = outcome.report().eye.expect("a device").reprojection.expect("a device");
    assert_eq!((eye.device, eye.checked_pixels), (Reprojection::VDRT, 16 * 12 * (FIELDS - WARM_UP_PERIODS)));
    assert!(eye.pose_age_ms.mean > 0.0);
    assert_eq!(outcome.pixel_errors().expect("a head").empty, 0, "its picture goes on beyond the edge");
}

/// With delayed video, only the tracker's error remains. An ideal tracker has no error, for any latency.
#[test]
fn delayed_video_has_no_error_with_an_ideal_tracker_of_any_latency() {
    let late = TrackerConfig::ideal().with_latency_ps(50_000_000_000);
    let head = Head::new(Arc::new(turning(2.0)), late, PredictorKind::None, 1).expect("in range");
    let outcome = fields(head, "full-screen:2");
    let delayed = PixelErrors::shown(&outcome, Showing::DelayedVideo);
    assert!(delayed.evaluated > 0 && delayed.pixels.max < 1e-6, "{:?}", delayed.pixels);
    let plain = PixelErrors::shown(&outcome, Showing::Plain);
    assert!(plain.pixels.mean > focal_px(640.0) * 0.1, "{}: 50 ms of 2 rad/s and more", plain.pixels.mean);
}

/// Returns true if a pixel has nearly the same colour as all of its neighbours.
fn is_flat(picture: &RgbImage, x: u32, y: u32) -> bool {
    let near = |a: u32, b: u32| picture.get_pixel_checked(a, b).map(|pixel| pixel.0);
    let here = picture.get_pixel(x, y).0;
    let beside = [(x.wrapping_sub(1), y), (x + 1, y), (x, y.wrapping_sub(1)), (x, y + 1)];
    beside.iter().all(|(a, b)| near(*a, *b).is_some_and(|other| alike(other, here)))
}

fn alike(a: [u8; 3], b: [u8; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 8)
}

#[test]
fn rotating_an_ideal_picture_gives_the_ideal_picture_of_the_rotated_head() {
    let outcome = fields(head(turning(1.0)), "gallery");
    let views = outcome.head().expect("a head");
    let [before, now] = [Time(300_000_000_000), Time(350_000_000_000)];
    let [drawn, expected] = [before, now].map(|at| outcome.ideal_picture(SurfaceId(0), at).expect("an eye"));
    let moved = reproject(drawn.image(), &Hmd::unc(), Warp::Rotation, &views.truth(before), &views.truth(now));
    let (moved, empty) = moved.expect("the size of the view");
    let flat = |(x, y, _): &(u32, u32, &image::Rgb<u8>)| {
        moved.get_pixel(*x, *y).0 != [0; 3] && is_flat(expected.image(), *x, *y) && is_flat(&moved, *x, *y)
    };
    let compared: Vec<bool> = moved
        .enumerate_pixels()
        .filter(flat)
        .map(|(x, y, pixel)| alike(pixel.0, expected.image().get_pixel(x, y).0))
        .collect();
    let same = compared.iter().filter(|same| **same).count();
    let differs = drawn.image().pixels().zip(expected.image().pixels()).filter(|(a, b)| !alike(a.0, b.0)).count();
    // 0.05 rad are 28 pixels of the middle column and more towards the edges: 28 to 40 of 640 columns are empty.
    assert!((28 * 480..45 * 480).contains(&empty), "{empty}");
    assert!(compared.len() > 150_000, "{}", compared.len());
    assert!(differs > 30_000, "{differs}");
    assert!(same as f64 > 0.995 * compared.len() as f64, "{same} of {}; {differs} differed before", compared.len());
}

/// A device with depth, one pose per line and no latency must be as accurate as the reference, which draws every pixel
/// for its own instant.
#[test]
fn reprojection_with_depth_at_every_line_has_errors_only_at_hidden_parts() {
    let sliding = head(Slide::right_at(1.0));
    let outcome = fields(sliding, "gallery");
    let setting = Reprojection { by: Warp::Depth, every: Every::Line, latency_us: 0 };
    let errors = PixelErrors::shown(&outcome, Showing::Reprojected(setting));
    let eye =
        EyeReport::shown(&outcome, Showing::Reprojected(setting)).and_then(|eye| eye.reprojection).expect("a device");
    let plain = PixelErrors::of(&outcome);
    assert!(errors.evaluated > 400 && errors.pixels.max < 0.1, "{} {}", errors.evaluated, errors.pixels.max);
    assert!(plain.pixels.mean > 10.0 * errors.pixels.mean, "{} {}", plain.pixels.mean, errors.pixels.mean);
    let share = eye.disoccluded_share.expect("depth");
    assert!((0.0..0.05).contains(&share), "{share}");
}

#[test]
fn a_global_panel_takes_one_pose_for_each_period() {
    let config = PanelConfig { scan: 1, ..PanelConfig::PAPERS };
    let display = config.build(&[pxpl5_wire::NodeId(1)], pxpl5_sim::Span::from_ns(50)).expect("it can be built");
    assert_eq!(display.light().scan, pxpl5_wire::display::ScanOrder::Global);
    let outcome = on_panel(config, 1.0);
    for every in [Every::Field, Every::Strip, Every::Line] {
        let eye = EyeReport::shown(&outcome, device(Warp::Rotation, every)).and_then(|eye| eye.reprojection);
        assert!((eye.expect("a device").poses_per_s - 30.0).abs() < 1e-9, "{every:?}");
    }
}
