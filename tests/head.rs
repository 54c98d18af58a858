//! Tests of experiment files with a head, a tracker and a display. Their results must equal those of the comparison,
//! and their pictures must be correct.

use crate::support::video;
use glam::{DQuat, DVec3};
use pxpl5::compare::{CompareQuery, RowChoice, edge_scene};
use pxpl5::tracking::Pose;
use pxpl5::tracking::motion::{Motion, Pan, Still};
use pxpl5::tracking::predict::PredictorKind;
use pxpl5::tracking::tracker::TrackerConfig;
use pxpl5::tracking::view::Hmd;
use pxpl5::views::{Film, FilmSurfaces};
use pxpl5::{
    Aim, Experiment, ExperimentFile, Eye, Head, HeadPlace, Jitp, MachineConfig, Measured, PeriodNumber, Pixels, Plan,
    Raster, Study, Viewpoint,
};
use std::sync::Arc;

fn file(settings: &[(&str, &str)]) -> ExperimentFile {
    let mut file = ExperimentFile::new();
    for (path, value) in settings {
        file.set_text(&format!("{path}={value}"), "test").expect("known");
    }
    file
}

fn plan(settings: &[(&str, &str)]) -> Plan {
    file(settings).resolve().expect("an experiment")
}

#[test]
fn an_experiment_file_gives_the_same_numbers_as_the_comparison() {
    let shared = [
        ("scene", "full-screen:2"),
        ("fields", "40"),
        ("head.motion", "synthetic:3"),
        ("pixels", "off"),
        ("machine.preset", "small-hmd"),
    ];
    let rows = [
        ("rendering-control", "rendering-control", "plain"),
        ("slats", "slats", "plain"),
        ("frameless", "frameless", "plain"),
        ("jitp-field", "jitp-field", "plain"),
        ("jitp-scanline-racing", "jitp-scanline-racing", "plain"),
        ("jitp-dual-screen", "jitp-dual-screen", "plain"),
        ("jitp-dual-view-racing", "jitp-dual-view-racing", "plain"),
        ("vdrt", "slats", "vdrt"),
    ];
    let names = rows.iter().map(|(name, ..)| (*name).to_owned()).collect();
    let query = CompareQuery { only: RowChoice::Named(names), seeds: vec![1], ..CompareQuery::new(file(&shared)) };
    let comparison = query.run(&mut ()).expect("in range");
    for (name, pipeline, raster) in rows {
        let mut own = vec![("pipeline", pipeline), ("head.raster", raster)];
        own.extend((name == "vdrt").then_some(("binning", "touched")));
        let plan = plan(&[&shared[..], &own].concat());
        let experiment = plan.experiment(plan.load_scene().expect("built in"));
        // A comparison evaluates all rows over the same periods.
        let outcome = experiment.results_from(comparison.evaluated_from).run().expect("the scene is small");
        let report = outcome.report();
        let head = report.head.expect("a motion was given");
        let row = comparison.row(name).expect("a row for each");
        assert!(row.error.n > 0, "{name}");
        assert_eq!((head.error.pixels.mean, head.error.evaluated), (row.error.mean_px.mean, row.error.n), "{name}");
        assert_eq!((head.error.pixels.p99, head.end_to_end), (row.error.pixels.p99, row.end_to_end), "{name}");
        assert_eq!(report.updates_hz, Some(row.updates_hz.mean), "{name}");
        assert_eq!(head.end_to_end.n, row.head_to_light_ms.n, "{name}");
        assert!((head.end_to_end.total_ms - row.head_to_light_ms.mean).abs() < 1e-9, "{name}");
    }
}

/// Returns an experiment with a wall's edge straight ahead at time zero, under a pan. Each field is drawn for its first
/// instant, for one eye.
fn panned(deg_per_s: f64, raster: Raster, fields: u64) -> Experiment {
    let head = Head::new(Arc::new(Pan::at(deg_per_s)), TrackerConfig::ideal(), PredictorKind::ConstantVelocity, 1);
    let head = head.expect("in range").with_raster(raster).with_aim(Aim::FirstPixel);
    Experiment::new(MachineConfig::small_hmd(), Jitp::new(Viewpoint::Field, false), edge_scene(0.0))
        .head(head)
        .fields(fields)
}

/// Returns the column in which the wall ends, for each line of a field.
fn edges(picture: &image::RgbImage, field: PeriodNumber) -> Vec<f64> {
    let lines = (0..picture.height()).filter(|y| u64::from(y % 2) == field.0 % 2);
    lines.map(|y| edge(picture, y)).collect()
}

/// Returns the first column behind the wall in a line, or -1.
fn edge(picture: &image::RgbImage, y: u32) -> f64 {
    let behind = (1..picture.width()).find(|x| is_wall(picture, x - 1, y) && !is_wall(picture, *x, y));
    behind.map_or(-1.0, f64::from)
}

fn is_wall(picture: &image::RgbImage, x: u32, y: u32) -> bool {
    picture.get_pixel(x, y).0[0] > 100
}

#[test]
fn a_shifted_raster_shows_an_edge_at_its_position_when_each_line_lights() {
    const FIELD: PeriodNumber = PeriodNumber(20);
    let pan = Pan::at(30.0);
    let view = Hmd::unc();
    let [plain, vdrt] = [Raster::Plain, Raster::Vdrt].map(|raster| {
        let outcome = panned(30.0, raster, FIELD.0 + 2).run().expect("the scene is small");
        let video = *video(&outcome);
        let picture = outcome.picture(Eye::Left).expect("pixels when looked at");
        let found = edges(&picture, FIELD).into_iter().enumerate();
        let errors: Vec<f64> = found
            .map(|(row, column)| {
                let at = video.when(column as u32, 2 * row as u32 + (FIELD.0 % 2) as u32, FIELD).expect("visible");
                let edge = view.project(pan.pose(at.0).view_of(glam::DVec3::NEG_Z * 2.0)).expect("ahead");
                (column - edge.x).abs()
            })
            .collect();
        errors.iter().copied().fold(0.0, f64::max)
    });
    // Positions are whole columns: half a pixel of error in the picture, and half a pixel in the shift.
    assert!(vdrt <= 1.0, "{vdrt}");
    // The picture is drawn for the begin of the field. The end of the field is 15.3 ms later.
    let expected = 554.256 * (30.0 * 0.0153f64).to_radians().tan();
    assert!((plain - expected).abs() < 1.0, "{plain} {expected}");
}

#[test]
fn a_film_with_a_shifted_raster_shows_the_pictures_of_its_run() {
    let mut bytes = Vec::new();
    Film::new(panned(40.0, Raster::Vdrt, 30), PeriodNumber(10), 3, FilmSurfaces::One(Eye::Left.into()))
        .write(&[], &mut bytes)
        .expect("in range");
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("PNG");
    for field in 10..13 {
        let mut pixels = vec![0; reader.output_buffer_size()];
        reader.next_frame(&mut pixels).expect("a frame each field");
        let run = panned(40.0, Raster::Vdrt, field + 2).pixels(Pixels::Lazy).run().expect("the scene is small");
        assert!(run.picture(Eye::Left).expect("pixels").into_raw() == pixels, "field {field}");
    }
}

#[test]
fn slats_uses_a_report_no_older_than_the_report_interval_and_the_transfer_to_the_processors() {
    // A report that is sent at once waits for the retrace between zero and one interval. If reports were sent once a
    // field just after the retrace, each would wait for another field of 16.68 ms. A thousand reports a second come at
    // all phases of a field, so they wait for half an interval on average. The Fastrak's 120 reports a second come at
    // all phases only within 500 fields, and this run is shorter. Behind a host port that is polled 60 times a second,
    // reports always come at the same phase.
    for (tracker, least_ms, most_ms) in [("fastrak", 0.0, 1e3 / 120.0), ("ideal", 0.5, 0.5)] {
        let settings = [
            ("pipeline", "slats"),
            ("scene", "room"),
            ("fields", "300"),
            ("head.motion", "synthetic:1"),
            ("head.tracker", tracker),
            ("pixels", "off"),
        ];
        let plan = plan(&settings);
        let outcome = plan.experiment(plan.load_scene().expect("built in")).run().expect("four triangles");
        let budget = outcome.report().head.expect("a motion was given").end_to_end;
        let wait_ms = budget.waiting_ms + budget.sending_ms;
        // The host's message at either end and the link of 5 MB/s take less than a millisecond.
        assert!((least_ms..most_ms + 1.0).contains(&wait_ms), "{tracker}: {wait_ms}");
    }
}

/// The head stands still, 3 m to the right of the origin, and looks to the left. If the poses are in the coordinates of
/// the world, the head stays there. If they are in the coordinates of the scene, the head moves to the start of the
/// scene's own motion.
#[test]
fn poses_in_the_world_stay_in_place_and_poses_in_the_scene_move_to_the_start_of_the_scene() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let pose = Pose { position: DVec3::new(3.0, 1.0, -2.0), orientation: DQuat::from_xyzw(0.0, half, 0.0, half) };
    let truth = |place: HeadPlace| {
        let head = Head::new(Arc::new(Still(pose)), TrackerConfig::ideal(), PredictorKind::None, 1).expect("in range");
        let scene = pxpl5::scene::builtin("room").expect("built in");
        let start = scene.motion().pose(0);
        let jitp = Jitp::new(Viewpoint::Field, false);
        let experiment = Experiment::new(MachineConfig::small_hmd(), jitp, scene).head(head.with_place(place));
        let outcome = experiment.fields(20).pixels(Pixels::Off).run().unwrap_or_else(|error| panic!("{error}"));
        (outcome.head().expect("a head").truth(pxpl5::Time(1_000_000_000)), start)
    };
    let (in_world, start) = truth(HeadPlace::World);
    assert!((in_world.position - pose.position).length() < 1e-12);
    assert!(in_world.orientation.angle_between(pose.orientation) < 1e-7);
    let (in_scene, _) = truth(HeadPlace::Scene);
    assert!((in_scene.position - start.position).length() < 1e-12);
    assert!(in_scene.orientation.angle_between(start.orientation.normalize()) < 1e-7);
}

#[test]
fn the_place_of_a_head_changes_the_hash_only_if_the_place_is_not_the_default() {
    let usual = [("pipeline", "slats"), ("scene", "room"), ("head.motion", "pan:40")];
    let hash = |more: &[(&str, &str)]| plan(&[&usual[..], more].concat()).fingerprint();
    assert_eq!(hash(&[("head.place", "scene")]), hash(&[]));
    assert_ne!(hash(&[("head.place", "world")]), hash(&[]));
    let error = file(&[&usual[..], &[("head.place", "earth")]].concat()).resolve().expect_err("no place").to_string();
    assert!(error.contains("head.place") && error.contains("world"), "{error}");
}
