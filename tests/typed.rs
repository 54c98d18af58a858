//! Short programs with the prelude alone, like the first programs of a researcher.

use pxpl5::prelude::*;
use std::sync::Arc;

/// A cube of 12 triangles on a user's own machine, with a user's own motion of the head.
#[test]
fn a_cube_with_its_latency_by_stage_error_and_picture_takes_forty_lines() {
    let corners: Vec<Vec3> = (0..8).map(|n| Vec3::new((n & 1) as f32, (n >> 1 & 1) as f32, (n >> 2) as f32)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let cube = Scene::from_triangles(&corners, &triangles).expect("a cube");
    let machine = MachineConfig::small_hmd().with_gps(20).with_renderers(8);
    let turn = from_fn(|seconds| Pose { position: DVec3::ZERO, orientation: DQuat::from_rotation_y(0.5 * seconds) });
    let head = Head::new(Arc::new(turn), TrackerConfig::fastrak(), PredictorKind::None, 1).expect("a head");
    let experiment = Experiment::new(machine, RenderingControl::stereo(), cube).fields(60).head(head);
    let outcome = experiment.run().expect("it fits");
    let report = outcome.report();
    for part in &report.latency_parts_ms {
        assert!(part.statistics.statistics.mean >= 0.0, "{}", part.name);
    }
    // A turn of 0.5 rad/s in the latency to light moves the middle by f tan(0.5 t), and f is 320 px / tan 30.
    let to_light_s = report.head.as_ref().expect("a head").end_to_end.total_ms / 1e3;
    let expected = 320.0 / 30f64.to_radians().tan() * (0.5 * to_light_s).tan();
    let fields = &report.head.as_ref().expect("a head").error.by_field;
    let centre = fields.iter().map(|field| field.centre_px).filter(|px| px.is_finite());
    let (sum, n) = centre.fold((0.0, 0.0), |(sum, n), px| (sum + px, n + 1.0));
    assert!((sum / n / expected - 1.0).abs() < 0.2, "{} px, expected about {expected}", sum / n);
    assert!(outcome.picture(SurfaceId(0)).is_some());
}

/// The ring's channels by the number of renderers, as a table.
#[test]
fn a_table_over_renderers_takes_fifteen_lines() {
    let rows = in_parallel(&[5, 10, 20], |renderers| {
        let machine = MachineConfig::small_hmd().with_renderers(*renderers);
        let scene = scene::builtin("full-screen:12").expect("built in");
        let experiment = Experiment::new(machine, RenderingControl::stereo(), scene).fields(60).pixels(Pixels::Off);
        let outcome = experiment.run().expect("it fits");
        let channels = outcome.report().utilisation.expect("it ran").ring.channels;
        (*renderers, channels.mean, outcome.latency().expect("pictures were shown").mean)
    });
    // COPY sends the same pixels for any number of renderers, so the mean stays the same. Two copies of 15.6 ms in
    // 33.37 ms on one of 8 channels are 11.7 %. Commands and tokens are additional.
    assert!(rows.iter().all(|(_, mean, _)| (0.11..0.16).contains(mean)), "{rows:?}");
}

/// A panel of 1,080 x 1,200 pixels and 90 Hz for each eye.
#[test]
fn a_custom_display_takes_ten_lines() {
    let panel = PanelConfig { width: 1_080, height: 1_200, refresh_hz: 90, ports: 8, ..PanelConfig::PAPERS };
    let machine = MachineConfig::small_hmd().with_renderers(20).with_display(panel);
    let scene = scene::builtin("full-screen:12").expect("built in");
    let experiment = Experiment::new(machine, RenderingControl::stereo(), scene).fields(90);
    let outcome = experiment.run().expect("it fits");
    assert_eq!(outcome.picture(Eye::Right).map(|picture| picture.dimensions()), Some((1_080, 1_200)));
    assert!((outcome.field_ms() - 1e3 / 90.0).abs() < 1e-6);
}

#[test]
fn the_programs_have_at_most_the_stated_number_of_lines() {
    let source = include_str!("typed.rs");
    for (name, most) in [("takes_forty_lines", 40), ("takes_fifteen_lines", 15), ("takes_ten_lines", 10)] {
        let (_, program) = source.split_once(&format!("{name}() {{\n")).expect("a program");
        let (body, _) = program.split_once("\n}\n").expect("a program has an end");
        assert!(body.lines().count() <= most, "{name}: {} lines", body.lines().count());
    }
}

/// The events of a run are in the order of time, name their boards, and agree with the run's counters.
#[test]
fn events_have_their_boards_and_are_in_order_of_time() {
    let scene = scene::builtin("full-screen:12").expect("built in");
    let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(60);
    let outcome = experiment.pixels(Pixels::Off).record_traffic(true).run().expect("it fits");
    let events: Vec<_> = outcome.events().collect();
    assert!(events.is_sorted_by_key(|event| event.time));
    let count = |is_it: fn(&ObservedKind) -> bool| events.iter().filter(|event| is_it(&event.kind)).count();
    let observed = outcome.observation();
    assert_eq!(count(|kind| matches!(kind, ObservedKind::Stage { .. })), observed.marks.len());
    assert_eq!(count(|kind| matches!(kind, ObservedKind::Arrived { .. })), observed.arrivals.len());
    assert_eq!(count(|kind| matches!(kind, ObservedKind::Swapped { .. })), observed.swaps.len());
    let messages = observed.traffic.as_ref().expect("recorded").transfers.len();
    assert_eq!(count(|kind| matches!(kind, ObservedKind::Message { .. })), messages);
    // Each kind of event comes from a board that can cause it: 13 graphics processors, 5 renderers, a stereo display.
    for event in &events {
        let fits = match (event.kind, event.board) {
            (ObservedKind::Stage { .. }, Board::Host) => true,
            (ObservedKind::Stage { .. }, Board::Gp(number)) => number < 13,
            (ObservedKind::Copied { .. }, Board::Renderer(number)) => number < 5,
            (ObservedKind::Arrived { .. } | ObservedKind::Swapped { .. }, Board::Display(number)) => number == 0,
            (ObservedKind::Message { to, .. }, from) => to != from,
            _ => false,
        };
        assert!(fits, "{event}");
    }
}
