//! Tests of the papers' statements about just-in-time pixels, latency and registration, from head to light on the whole
//! machine.

use crate::support::{self, video};
use pxpl5::compare::{CompareQuery, RowChoice, as_seen, edge_pictures, edge_scene, motion};
use pxpl5::limit::LimitQuery;
use pxpl5::scene::{Scene, builtin};
use pxpl5::tracking::Pose;
use pxpl5::tracking::motion::{Motion, Pan, Still, Synthetic};
use pxpl5::tracking::predict::PredictorKind;
use pxpl5::tracking::time::{NTSC_FIELD_PS, PS_PER_MS, PS_PER_S, seconds};
use pxpl5::tracking::tracker::{TrackerConfig, TrackerFault};
use pxpl5::{
    Aim, Budget, Experiment, ExperimentFile, Frameless, Head, Interpolation, Jitp, MachineConfig, Measured, Outcome,
    Percentiles, PeriodNumber, Pipeline, PipelineSettings, PixelErrors, Pixels, Registration, RenderingControl,
    Showing, Slats, Study, Viewpoint,
};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock};

/// A fast turn of the head, in degrees per second (JITP).
const PAN: f64 = 200.0;
/// Focal length, in pixels, of 640 pixels over 60 degrees.
const FOCAL_PX: f64 = 554.256_258_422_040_8;
/// An even field that is well after the start.
const FIELD: PeriodNumber = PeriodNumber(40);

fn head(motion: impl Motion + Send + Sync + 'static, tracker: TrackerConfig, kind: PredictorKind) -> Head {
    Head::new(Arc::new(motion), tracker, kind, 1).expect("the settings are in range")
}

/// Returns a head with perfect poses, so that only the times of drawing and of light differ.
fn perfect(motion: impl Motion + Send + Sync + 'static) -> Head {
    head(motion, TrackerConfig::ideal(), PredictorKind::ConstantVelocity)
}

fn small() -> Scene {
    edge_scene(0.0)
}

fn run(pipeline: impl Pipeline + 'static, head: Head, fields: u64) -> Outcome {
    Experiment::new(MachineConfig::small_hmd(), pipeline, small())
        .head(head)
        .fields(fields)
        .pixels(Pixels::Off)
        .run()
        .expect("the scene is small")
}

/// A run with strips of one line and a race with the beam, under a pan.
static STRIPS: LazyLock<Outcome> = LazyLock::new(|| under_a_pan(Viewpoint::Strip, true));

fn under_a_pan(viewpoint: Viewpoint, racing: bool) -> Outcome {
    run(Jitp { strip_rows: 1, ..Jitp::new(viewpoint, racing) }, perfect(Pan::at(PAN)), FIELD.0 + 2)
}

/// A run in which a field is drawn for one instant as in the paper: for its first pixel.
static CONVENTIONAL: LazyLock<Outcome> = LazyLock::new(|| {
    let jitp = Jitp { strip_rows: 1, ..Jitp::new(Viewpoint::Field, true) };
    run(jitp, perfect(Pan::at(PAN)).with_aim(Aim::FirstPixel), FIELD.0 + 2)
});

/// Returns the seconds between the beam's passes over two pixels of a field.
fn beam_s(outcome: &Outcome, from: (u32, u32), to: (u32, u32)) -> f64 {
    let [from_ps, to_ps] = [from, to].map(|(x, y)| video(outcome).when(x, y, FIELD).expect("visible").0 as f64);
    (to_ps - from_ps) * 1e-12
}

#[test]
fn j1_with_one_transform_a_field_the_last_pixel_has_an_error_of_33_pixels() {
    let outcome = &*CONVENTIONAL;
    let registration = Registration::of(outcome).expect("there is a head");
    let last = registration.at(320, 478, FIELD).expect("shown");
    let scan_s = beam_s(outcome, (0, 0), (320, 478));
    // The pixel lies below eye level, so a turn about the vertical axis moves it along a smaller circle.
    let level = FOCAL_PX / f64::hypot(FOCAL_PX, 478.5 - 240.0);
    let turn_deg = 2.0 * f64::asin((last.degrees / 2.0).to_radians().sin() / level).to_degrees();
    assert!((turn_deg - PAN * scan_s).abs() < 0.001, "{turn_deg} {}", PAN * scan_s);
    // The paper counts the time up to the next retrace, and 10 pixels for a degree.
    let whole_field_deg = turn_deg / scan_s * seconds(NTSC_FIELD_PS);
    assert!((whole_field_deg - 3.3).abs() < 0.05 && (whole_field_deg * 10.0 - 33.0).abs() < 0.5);
}

#[test]
fn j2_with_one_transform_a_line_the_error_over_a_line_is_0_13_pixels() {
    let outcome = &*STRIPS;
    let registration = Registration::of(outcome).expect("there is a head");
    let ends = [0, 639].map(|x| registration.at(x, 240, FIELD).expect("shown").degrees);
    let active_s = beam_s(outcome, (0, 240), (639, 240));
    let line_s = 4004.0 / 63.0 * 1e-6;
    let line_deg = (ends[0] + ends[1]) / active_s * line_s;
    assert!((line_deg - 0.013).abs() < 5e-4 && (line_deg * 10.0 - 0.13).abs() < 5e-3, "{line_deg}");
    let worst = PixelErrors::of(outcome).pixels.max;
    assert!(worst < 0.1, "each line is drawn for its middle, so half of that remains: {worst}");
}

#[test]
fn j4_a_vertical_edge_slants_by_speed_times_scan_time() {
    let outcome = &*CONVENTIONAL;
    let registration = Registration::of(outcome).expect("there is a head");
    for y in [0, 120, 240, 478] {
        let error = registration.at(320, y, FIELD).expect("shown").offset_px.x;
        // The middle of the picture lies half a pixel to the left of the middle of the pixel.
        let angle = f64::atan(0.5 / FOCAL_PX) + (PAN * beam_s(outcome, (0, 0), (320, y))).to_radians();
        let expected = 0.5 - FOCAL_PX * angle.tan();
        assert!((error - expected).abs() < 0.01, "line {y}: {error} {expected}");
    }
}

/// Returns the column right of the last white pixel of each row.
fn edge(picture: &image::RgbImage) -> Vec<f64> {
    (0..picture.height()).map(|row| right_of_white(picture, row)).collect()
}

fn right_of_white(picture: &image::RgbImage, row: u32) -> f64 {
    let last = (0..picture.width()).rev().find(|x| picture.get_pixel(*x, row)[0] > 100);
    last.map_or(0.0, |x| f64::from(x + 1))
}

/// Returns the slant of an edge: the pixels between first and last row of the fitted straight line.
fn slant(edge: &[f64]) -> f64 {
    let n = edge.len() as f64;
    let mean_row = (n - 1.0) / 2.0;
    let mean = edge.iter().sum::<f64>() / n;
    let mut up = 0.0;
    let mut down = 0.0;
    for (row, column) in edge.iter().enumerate() {
        up += (row as f64 - mean_row) * (column - mean);
        down += (row as f64 - mean_row).powi(2);
    }
    up / down * (n - 1.0)
}

#[test]
fn j4_the_pictures_of_an_edge_slant_as_the_published_pictures_do() {
    let plates = edge_pictures(&MachineConfig::small_hmd(), PAN).expect("the scene is small");
    let [conventional, conventional_seen, just_in_time, just_in_time_seen] =
        [&plates.conventional, &plates.conventional_seen, &plates.just_in_time, &plates.just_in_time_seen]
            .map(|picture| slant(&edge(picture)));
    // 239 lines of 4004/63 us at 200 deg/s are 3.038 degrees. The head turns left, so objects move right in the view.
    let turn = (PAN * 239.0 * 4004.0 / 63.0 * 1e-6).to_radians();
    let expected = FOCAL_PX * 2.0 * (turn / 2.0).tan();
    assert!(conventional.abs() < 1e-9, "drawn vertical: {conventional}");
    assert!((just_in_time - expected).abs() < 0.1, "drawn slanted: {just_in_time} {expected}");
    assert!((conventional_seen + expected).abs() < 0.3, "seen slanted: {conventional_seen} {expected}");
    assert!(just_in_time_seen.abs() < 0.1, "seen straight: {just_in_time_seen}");
}

#[test]
fn a_still_head_sees_no_distortion() {
    let outcome = &*STRIPS;
    let picture = image::RgbImage::from_fn(640, 240, |x, y| image::Rgb([x as u8, y as u8, (x / 3) as u8]));
    let still = Still(Pose::IDENTITY);
    assert_eq!(as_seen(&picture, FIELD, video(outcome), &still), picture);
}

/// Returns the number of views that are sampled for a field.
fn n_views(viewpoint: Viewpoint) -> usize {
    let outcome = under_a_pan(viewpoint, true);
    let sampled = outcome.head().expect("a head").sampled();
    sampled.iter().filter(|sample| sample.number.0 / 256 == FIELD.0).count()
}

#[test]
fn j5_scanline_rendering_takes_240_transforms_a_field() {
    // The paper counts about 256 lines, but only 240 lines of a field are visible.
    assert_eq!(
        (n_views(Viewpoint::Strip), n_views(Viewpoint::Field), n_views(Viewpoint::Dual(Interpolation::View))),
        (240, 1, 2)
    );
}

/// Returns the distance in pixels from the position in strips of one line, at the left edge, in the middle and at the
/// right edge.
fn beside_strips(interpolation: Interpolation) -> [f64; 3] {
    let [strip, dual] = [Viewpoint::Strip, Viewpoint::Dual(interpolation)].map(|viewpoint| {
        let outcome = under_a_pan(viewpoint, true);
        let registration = Registration::of(&outcome).expect("there is a head");
        [2, 320, 637].map(|x| registration.at(x, 240, FIELD).expect("shown").offset_px)
    });
    std::array::from_fn(|i| (dual[i] - strip[i]).length())
}

#[test]
fn interpolation_on_the_screen_is_wrong_at_the_edge_and_interpolation_in_eye_space_is_exact() {
    let screen = beside_strips(Interpolation::Screen);
    let view = beside_strips(Interpolation::View);
    // tan is interpolated over the 15.24 ms of the scan, which gives an error of f x turn^2 / 8 x 2 tan 30 / cos^2 30.
    let turn = (PAN * 239.82 * 4004.0 / 63.0 * 1e-6).to_radians();
    let expected = FOCAL_PX * turn * turn / 8.0 * 2.0 * 30f64.to_radians().tan() / 0.75;
    assert!((screen[0] / expected - 1.0).abs() < 0.1 && (screen[2] / expected - 1.0).abs() < 0.1, "{expected}");
    assert!(screen[1] < 0.01 && view.iter().all(|px| *px < 0.004));
}

#[test]
fn racing_the_beam_saves_one_field_and_every_viewpoint_is_drawn_in_time() {
    let fields = support::sample_or_all(30, 60);
    for pair in Jitp::all().chunks(2) {
        let [plain, racing] = [pair[0], pair[1]].map(|jitp| run(jitp, perfect(Pan::at(PAN)), fields));
        for outcome in [&plain, &racing] {
            let report = outcome.report();
            assert_eq!((report.missed_retraces, report.late_regions), (Some(0), 0), "{}", report.pipeline);
            assert!((report.updates_hz.expect("two pictures") - 59.94).abs() < 0.01);
        }
        let saved = plain.latency_ms().mean - racing.latency_ms().mean;
        assert!((saved - 16.683).abs() < 0.05, "{}: {saved}", plain.pipeline().name());
    }
}

#[test]
fn fields_with_late_lines_are_counted_as_missed() {
    // For each line, 417 triangles take a slave 9 ms, but only 12 x 63.6 us are available.
    let mig = builtin("mig").expect("built in");
    let outcome = Experiment::new(MachineConfig::small_hmd(), Jitp::new(Viewpoint::Strip, true), mig).fields(40).run();
    let report = outcome.expect("it runs").report();
    // The first 8 of 40 fields are the warm-up, and none of the others is complete.
    assert_eq!(report.missed_retraces, Some(32));
}

fn possible_in_a_line(preset: &str) -> u32 {
    let config = MachineConfig::preset(preset).expect("listed");
    let query = LimitQuery::of_papers(config, Jitp::new(Viewpoint::Strip, true)).expect("a pipeline of the papers");
    LimitQuery { looks_above: false, ..query }.run(&mut ()).expect("it runs on that machine").triangles
}

#[test]
fn more_renderers_allow_more_triangles_in_a_line() {
    let (small, large) = rayon::join(|| possible_in_a_line("small-hmd"), || possible_in_a_line("design-maximum"));
    // A renderer has 63.6 us for a column of a line. The copy takes 7.2 us, so 8 triangles of 6.45 us remain.
    assert!((6..=9).contains(&small), "{small}");
    assert!(large > 2 * small, "{large}");
}

/// Returns the latency from head to light in milliseconds, and the error in the middle of the picture in degrees. The
/// tracker has no noise.
fn latency_and_error(pipeline: impl Pipeline + 'static) -> (f64, f64) {
    let tracker =
        TrackerConfig { position_noise_m: 0.0, orientation_noise_deg: 0.0, ..TrackerConfig::optical_ceiling() };
    let outcome = run(pipeline, head(Synthetic::recorded_use(3), tracker, PredictorKind::None), 900);
    (Budget::of(&outcome).total_ms, PixelErrors::of(&outcome).centre_deg.mean)
}

#[test]
fn the_pixel_errors_of_pipelines_are_proportional_to_their_head_to_light_latencies() {
    let control = latency_and_error(RenderingControl::stereo());
    let slats = latency_and_error(Slats::split());
    // A frame of Rendering Control is visible for two fields, on average half a field later than its first light.
    let latencies = (control.0 + 16.683 / 2.0) / slats.0;
    assert!((control.1 / slats.1 / latencies - 1.0).abs() < 0.05);
}

#[test]
fn the_raster_offset_removes_the_error_of_a_pan_in_the_middle_but_not_at_the_edges() {
    let outcome = run(Slats::split(), head(Pan::at(PAN), TrackerConfig::ideal(), PredictorKind::ConstantVelocity), 90);
    let plain = PixelErrors::of(&outcome);
    let offset = PixelErrors::shown(&outcome, Showing::RasterOffset);
    assert!(offset.centre_px.max < 0.05, "{:?}", offset.centre_px);
    assert!(offset.pixels.max > 1.0, "a flat raster is shifted, not turned");
    assert!(offset.pixels.mean < plain.pixels.mean);
}

#[test]
fn frameless_blocks_are_drawn_once_per_pass_and_are_half_a_pass_old() {
    let frameless = Frameless::new();
    let outcome = run(frameless, perfect(Pan::at(20.0)), 60);
    let mut of_block: BTreeMap<u16, Vec<f64>> = BTreeMap::new();
    for arrival in &outcome.observation().arrivals {
        of_block.entry(arrival.target.region.0).or_default().push(arrival.last_part_at.0 as f64 * 1e-9);
    }
    assert_eq!(of_block.len(), frameless.blocks() as usize);
    let counts: Vec<usize> = of_block.values().map(Vec::len).collect();
    let least = counts.iter().min().copied().unwrap_or(0);
    let most = counts.iter().max().copied().unwrap_or(0);
    assert!(least > 10 && most - least <= 1, "without repetition: {least} to {most}");
    // At a random instant, the age of a block is half of the time between two of its updates.
    let gaps: Vec<f64> = of_block.values().flat_map(|times| times.windows(2).map(|w| w[1] - w[0])).collect();
    let age_ms = gaps.iter().map(|gap| gap * gap / 2.0).sum::<f64>() / gaps.iter().sum::<f64>();
    let pass_ms = 1e3 / outcome.report().updates_hz.expect("two pictures");
    assert!((age_ms / (pass_ms / 2.0) - 1.0).abs() < 0.05, "{age_ms} {pass_ms}");
}

/// Runs each of six failing trackers with one in 24 of the pipelines.
/// `PXPL5_ALL_CASES=1` runs every pipeline with all trackers.
#[test]
fn every_pipeline_continues_when_the_tracker_fails() {
    let faults = [
        vec![TrackerFault::Silence { from_ps: 0 }],
        vec![TrackerFault::Silence { from_ps: 300 * PS_PER_MS }],
        vec![
            TrackerFault::Dropout { from_ps: 200 * PS_PER_MS, to_ps: 700 * PS_PER_MS },
            TrackerFault::RandomDropout { probability: 0.5 },
        ],
        vec![
            TrackerFault::NotANumber { probability: 0.5 },
            TrackerFault::Jump { probability: 0.5, distance_m: 1e3, angle_deg: 170.0 },
        ],
    ];
    let late = TrackerConfig::optical_ceiling().with_latency_ps(PS_PER_S / 2);
    let trackers = faults
        .into_iter()
        .map(|faults| TrackerConfig { faults, ..TrackerConfig::fastrak() })
        .chain([late, TrackerConfig::flock_of_birds_on_patched_host()]);
    let registry = pxpl5::registry();
    let compared: Vec<_> = registry.pipelines().iter().filter(|entry| entry.compared).collect();
    for (number, tracker) in trackers.enumerate() {
        let head = Arc::new(head(Synthetic::recorded_use(2), tracker, PredictorKind::Kalman));
        let is_run = |index: usize| (index + number).is_multiple_of(24) || support::runs_all_cases();
        compared.par_iter().enumerate().filter(|(index, _)| is_run(*index)).for_each(|(_, entry)| {
            let pipeline = (entry.build)(&PipelineSettings::default());
            let experiment = Experiment::with(MachineConfig::small_hmd(), pipeline, Arc::new(small()));
            let outcome = experiment.head(Arc::clone(&head)).fields(45).pixels(Pixels::Off).run().expect(entry.name);
            let errors = PixelErrors::of(&outcome);
            let Percentiles { mean, max, .. } = errors.pixels;
            assert!(mean.is_finite() && max.is_finite() && errors.evaluated > 100, "{} {errors:?}", entry.name);
        });
    }
}

#[test]
fn a_comparison_has_all_pipelines_and_just_in_time_pixels_have_the_smallest_error() {
    let all = comparison(support::sample_or_all(48, 90)).run(&mut ()).expect("enough fields");
    let names: Vec<_> = all.pipelines.iter().map(|row| row.pipeline.as_str()).collect();
    assert_eq!(names.len(), 30);
    let json = serde_json::to_value(&all).expect("plain data");
    assert_eq!(json["pipelines"].as_array().map(Vec::len), Some(30));
    let mean = |name: &str| all.row(name).expect("a row").error.mean_px.mean;
    assert!(mean("ideal") < 1e-3 && mean("jitp-scanline-racing") < 0.1 && mean("jitp-dual-view-racing") < 0.1);
    // All pipelines aim at the middle of their display time. Two pipelines whose display time is one field have equal
    // errors, and a display time of two fields gives a larger error.
    assert!((mean("jitp-field-racing") / mean("slats-touched") - 1.0).abs() < 1e-3);
    assert!((mean("jitp-field") / mean("slats-touched") - 1.0).abs() < 1e-3);
    assert!(mean("jitp-field-racing") > 7.0 && mean("rendering-control") > 2.0 * mean("slats-touched"));
}

/// Returns a comparison under a pan past still walls, with a tracker without errors.
fn comparison(fields: u64) -> CompareQuery {
    let mut shared = ExperimentFile::new();
    let pan = format!("pan:{PAN}");
    let settings = [
        ("machine.preset", "small-hmd"),
        ("scene", "room"),
        ("head.motion", &pan),
        ("head.tracker", "ideal"),
        ("head.predict", "velocity"),
    ];
    for (key, value) in settings {
        shared.set(key, value, "test").expect("known");
    }
    shared.set("fields", i64::try_from(fields).expect("few"), "test").expect("known");
    CompareQuery { only: RowChoice::All, seeds: vec![1], ..CompareQuery::new(shared) }
}

#[test]
fn incomparable_settings_are_refused_with_the_expected_values() {
    for (text, says) in [
        ("pan:fast", "such as pan:200"),
        ("pan:fast", "`fast`"),
        ("pan:nan", "`nan`"),
        ("dance", "still, pan:DEG_PER_S"),
        ("no-such-file.csv", "no-such-file.csv cannot be opened"),
    ] {
        let error = motion(text).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains(says), "{text}: {error}");
    }
    let error = comparison(3).run(&mut ()).expect_err("too few");
    assert!(error.to_string().contains("found 3"), "{error}");
}
