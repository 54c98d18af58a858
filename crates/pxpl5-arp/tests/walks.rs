//! Tests of walks through a scene: general properties and special cases of the policies with a renderer.

use address_recalculation::priority::Falloff;
use address_recalculation::{CubeFace, FaceSet, Latch, Lens, TexelAddress};
use glam::{DQuat, DVec3};
use pxpl5_arp::pictures::{ArpPicture, of_walk};
use pxpl5_arp::{
    ArpReport, PolicyKind, Simulation, SourceKind, Tears, WalkFaces, WalkSettings, World, at_frames, walk,
};
use pxpl5_scene::{Scene, builtin};
use std::collections::BTreeMap;
use std::sync::LazyLock;
use tracking::motion::Walk;

/// Settings with the cell size of the scene, a threshold of 90/512 degrees, rings of cells that double, and a cascade only
/// with warping.
const CELLS: WalkSettings = without_cascade(five_metres(WalkSettings::CELLS));
const WARPED: WalkSettings = five_metres(WalkSettings::WARPED);
const OBJECTS: WalkSettings = five_metres(WalkSettings::OBJECTS);

const fn without_cascade(mut settings: WalkSettings) -> WalkSettings {
    settings.has_cascade = false;
    settings
}

const fn five_metres(settings: WalkSettings) -> WalkSettings {
    let mut settings = settings.with_cells(5.0);
    settings.numbers.theta_deg = 90.0 / 512.0;
    settings.numbers.inner_rings = 1;
    settings.numbers.ring_growth = 2;
    settings
}

static SCENE: LazyLock<Scene> = LazyLock::new(|| builtin("gallery").expect("built in"));
static WORLD: LazyLock<World> = LazyLock::new(|| World::new(&SCENE, 5.0).expect("it can be cut"));

static PATH: LazyLock<Walk> = LazyLock::new(|| {
    let corners: Vec<DVec3> = SCENE.path().iter().map(|corner| corner.as_dvec3()).collect();
    Walk::new(&corners, 1.0).expect("a path")
});

fn small(settings: WalkSettings) -> WalkSettings {
    let mut settings = settings;
    settings.display.timing.face_texels = 128;
    settings
}

fn simulated(settings: &WalkSettings) -> Simulation<'static> {
    Simulation::new(&WORLD, settings).expect("settings")
}

fn all_texels(faces: &FaceSet) -> impl Iterator<Item = Option<(u32, u32)>> + '_ {
    let size = faces.texels();
    let places = move |face| (0..size * size).map(move |k| TexelAddress { face, column: k % size, row: k / size });
    CubeFace::ALL.into_iter().flat_map(places).map(|texel| faces.texel(texel))
}

#[test]
fn the_gallery_has_150_to_250_segments_with_cells_of_5_m() {
    assert!((150..=250).contains(&WORLD.segments.len()), "{}", WORLD.segments.len());
    let full = World::new(&builtin("gallery:full").expect("built in"), 5.0).expect("it can be cut");
    assert!(full.segments.len() > WORLD.segments.len() + 40, "{}", full.segments.len());
}

#[test]
fn memories_drawn_from_one_position_equal_one_memory_bit_for_bit() {
    let eye = PATH.place(12.3);
    let mut cells = simulated(&small(CELLS));
    cells.frame(eye).expect("drawn");
    let faces = WalkFaces::of(&cells).expect("drawn");
    let view = cells.settings.view().expect("a range");
    let mut one = FaceSet::new(128, cells.settings.display.format());
    let in_order: Vec<usize> = cells.shown.iter().flatten().flat_map(|content| content.segments.clone()).collect();
    assert_eq!(in_order.len(), WORLD.segments.len());
    view.draw(eye, WORLD.triangles(&in_order, |vertex| vertex), &mut one);
    let mut composite = FaceSet::new(128, cells.settings.display.format());
    for face in CubeFace::ALL {
        for k in 0..128 * 128 {
            let texel = TexelAddress { face, column: k % 128, row: k / 128 };
            let nearest =
                faces.memories.iter().filter_map(|memory| memory.texel(texel)).min_by_key(|(_, depth)| *depth);
            if let Some((colour, depth)) = nearest {
                composite.set(texel, colour, depth);
            }
        }
    }
    assert!(composite == one);
    assert!(all_texels(&one).all(|texel| texel.is_some()), "a hall is seen everywhere");
}

#[test]
fn with_a_still_eye_only_memory_0_is_due() {
    // If the eye is inside a bounding sphere, an image is wrong immediately, even if nothing moves. Floor, ceiling and
    // walls of the gallery are such objects.
    let mut simulation = simulated(&OBJECTS);
    let eye = PATH.place(3.0);
    simulation.frame(eye).expect("drawn");
    for _ in 0..40 {
        assert_eq!(simulation.frame(eye).expect("drawn").due, [true, false, false, false]);
    }
}

#[test]
fn the_picture_after_a_rotation_equals_a_redraw_with_any_renderer() {
    // After a much too slow renderer has drawn all memories once, the eye stays in place and the head rotates.
    let eye = PATH.place(30.0);
    let ideal = small(CELLS);
    let slow = WalkSettings { source: SourceKind::Timed { triangles_per_s: 700.0 }, ..ideal.clone() };
    let mut simulations = [simulated(&ideal), simulated(&slow)];
    for simulation in &mut simulations {
        for _ in 0..200 {
            simulation.frame(eye).expect("drawn");
        }
    }
    let faces = simulations.each_ref().map(|simulation| WalkFaces::of(simulation).expect("drawn"));
    for degrees in [0.0_f64, 12.0, 90.0, 180.0] {
        let turned = DQuat::from_rotation_y(degrees.to_radians());
        let [redrawn, stalled] = faces.each_ref().map(|faces| faces.seen(turned).expect("a rotation").0);
        assert!(redrawn == stalled, "{degrees}");
    }
}

#[test]
fn no_vertex_ever_has_an_angular_error_above_theta() {
    // With the chord rule, a point at distance d is off by at most asin(2 sin(theta / 2)). This exceeds theta by a
    // factor of 1 + 1.2e-6.
    let theta = CELLS.numbers.theta_deg.to_radians();
    let bound = (2.0 * (theta / 2.0).sin()).asin() * (1.0 + 1e-9);
    let mut simulation = simulated(&CELLS);
    let eye = at_frames(&PATH, 1.0, 60.0);
    let mut worst: f64 = 0.0;
    for frame in 0..2_000 {
        let outcome = simulation.frame(eye(frame)).expect("drawn");
        for content in simulation.shown.iter().skip(1).flatten() {
            for segment in &content.segments {
                for vertex in WORLD.segments[*segment].triangles.iter().flatten() {
                    let place = WORLD.vertices[*vertex as usize];
                    worst = worst.max((place - outcome.eye).angle_between(place - content.eye));
                }
            }
        }
    }
    assert!(worst <= bound && worst > theta / 2.0, "{worst} {bound}");
}

#[test]
fn each_segment_is_in_exactly_one_memory_even_when_cells_are_reassigned() {
    for settings in [CELLS, WARPED, WalkSettings { is_segmented: false, ..CELLS }, OBJECTS] {
        let mut simulation = simulated(&settings);
        let eye = at_frames(&PATH, 3.0, 60.0);
        for frame in 0..700 {
            simulation.frame(eye(frame)).expect("drawn");
            let mut held: Vec<usize> =
                simulation.shown.iter().flatten().flat_map(|content| content.segments.clone()).collect();
            held.sort_unstable();
            assert!(held.iter().copied().eq(0..WORLD.segments.len()), "{:?} frame {frame}", settings.policy);
        }
    }
}

#[test]
fn warping_with_a_cascade_closes_all_cuts_and_without_it_some_stay_open() {
    let eye = at_frames(&PATH, 1.0, 60.0);
    for falloff in [Falloff::Linear, Falloff::Smoothstep, Falloff::Step] {
        let warped = WalkSettings { falloff, ..WARPED };
        let tally = walk(&WORLD, &warped, 1_800, &eye).expect("walked");
        let widest = tally.tears.after.iter().copied().fold(0.0, f64::max);
        assert!(widest < 1e-12, "{falloff:?}: {widest}");
    }
    let texel = WARPED.texel_deg().to_radians();
    let no_cascade = WalkSettings { has_cascade: false, ..WARPED };
    let [torn, stale] = [CELLS, no_cascade].map(|settings| {
        let tally = walk(&WORLD, &settings, 1_800, &eye).expect("walked");
        tally.tears.after.into_iter().fold(0.0, f64::max) / texel
    });
    // If updates are shown immediately, a tear is at most one texel wide (theta = 90/512 degrees).
    assert!(torn > 0.3 && torn <= 1.0 + 1e-6, "{torn}");
    assert!(stale > torn, "{stale}");
}

#[test]
fn without_cutting_there_is_no_tear_and_the_fastest_memory_draws_more() {
    let eye = at_frames(&PATH, 1.0, 60.0);
    let uncut = walk(&WORLD, &WalkSettings { is_segmented: false, ..CELLS }, 600, &eye).expect("walked");
    let cut = walk(&WORLD, &CELLS, 600, &eye).expect("walked");
    assert!(uncut.tears.after.is_empty());
    assert!(uncut.memories[0].segment_frames > 2 * cut.memories[0].segment_frames);
    assert!(uncut.draws_per_s(60.0) > cut.draws_per_s(60.0));
}

#[test]
fn a_jump_of_a_kilometre_assigns_objects_once_and_leaves_no_tear() {
    let mut simulation = simulated(&WARPED);
    simulation.frame(PATH.place(0.0)).expect("drawn");
    let far = DVec3::new(1_000.0, 1.7, 0.0);
    assert!(simulation.frame(far).expect("drawn").reassigns_cells);
    assert!(!simulation.frame(far).expect("drawn").reassigns_cells);
    assert!(Tears::of(&WORLD, &simulation.shown).after.iter().all(|gap| *gap < 1e-12));
}

#[test]
fn unusual_eye_positions_are_handled() {
    let mut simulation = simulated(&small(WARPED));
    let places = [
        DVec3::new(5.0, 1.7, 5.0),      // a corner of cells
        DVec3::new(-7.0, 1.5, -17.2),   // near or in a partition
        DVec3::new(20.0, 1.7, 0.0),     // in a wall
        DVec3::new(0.0, 0.0, 0.0),      // on the floor
        DVec3::new(-300.0, 90.0, 77.0), // outside of the world
        WORLD.vertices[40],             // on a vertex
    ];
    for place in places {
        simulation.frame(place).expect("drawn");
        let seen = WalkFaces::of(&simulation).and_then(|faces| faces.seen(DQuat::IDENTITY));
        assert!(seen.is_ok(), "{place}");
    }
}

#[test]
fn a_tiny_threshold_always_draws_everything_and_a_huge_one_draws_only_once() {
    let rates = |theta_deg: f64| {
        let mut settings = CELLS;
        settings.numbers.theta_deg = theta_deg;
        let tally = walk(&WORLD, &settings, 600, at_frames(&PATH, 1.0, 60.0)).expect("walked");
        tally.memories.iter().map(|memory| memory.updates).collect::<Vec<u64>>()
    };
    assert_eq!(rates(1e-6), [600; 4]);
    // Within a cell, the eye moves 3 m. Memory 1 begins at least 6 m away, so it would be due after 2 x 6 sin(45 deg) =
    // 8.5 m.
    let mut settings = CELLS;
    settings.numbers.theta_deg = 90.0;
    let inside = |frame: u64| DVec3::new(1.0 + 0.005 * frame as f64, 1.7, 2.5);
    let tally = walk(&WORLD, &settings, 600, inside).expect("walked");
    assert_eq!(tally.memories.iter().map(|memory| memory.updates).collect::<Vec<u64>>(), [600, 1, 1, 1]);
}

#[test]
fn one_memory_draws_all_segments_and_more_memories_need_fewer_draws() {
    let draws = |memories: u64| {
        // With doubling rings, the gallery is too small for eight memories.
        let mut settings = CELLS.with_memories(memories);
        settings.numbers.ring_growth = 1;
        walk(&WORLD, &settings, 900, at_frames(&PATH, 1.0, 60.0)).expect("walked").draws_per_s(60.0)
    };
    assert_eq!(draws(1), 60.0 * WORLD.segments.len() as f64);
    assert!(draws(8) < draws(4) && draws(4) < draws(2), "{} {} {}", draws(8), draws(4), draws(2));
}

#[test]
fn with_a_slow_renderer_slow_memories_miss_retraces_first_and_incomplete_memories_stay_hidden() {
    let missed = |triangles_per_s: f64| {
        let settings = WalkSettings { source: SourceKind::Timed { triangles_per_s }, ..CELLS };
        let tally = walk(&WORLD, &settings, 900, at_frames(&PATH, 1.0, 60.0)).expect("walked");
        tally.memories.iter().map(|memory| memory.missed).collect::<Vec<u64>>()
    };
    assert_eq!(missed(1e6), [0; 4]);
    let few = missed(20_000.0);
    assert!(few[3] > few[0] && few.windows(2).all(|pair| pair[0] <= pair[1]), "{few:?}");
    assert!(missed(3_000.0)[0] > few[0]);
    // A memory shows nothing before its first complete update.
    let slow = WalkSettings { source: SourceKind::Timed { triangles_per_s: 3_000.0 }, ..CELLS };
    let mut simulation = simulated(&slow);
    let outcome = simulation.frame(PATH.place(0.0)).expect("drawn");
    assert!(outcome.missed[3] && simulation.shown[3].is_none());
}

#[test]
fn scenes_and_settings_that_cube_faces_cannot_show_are_refused_by_name() {
    let refused = |name: &str| World::new(&builtin(name).expect("built in"), 5.0).expect_err("refused").to_string();
    assert!(refused("molecules").contains("triangles alone"));
    assert!(refused("mig").contains("structures that do not move"));
    assert!(refused("full-screen:3").contains("fixed to the head"));
    let rate = WalkSettings { source: SourceKind::Timed { triangles_per_s: f64::NAN }, ..CELLS };
    let error = Simulation::new(&WORLD, &rate).expect_err("no rate");
    assert_eq!(&*error.name, "source.triangles_per_s");
    let mut cells = CELLS;
    cells.numbers.falloff_m = 6.0;
    let error = Simulation::new(&WORLD, &cells).expect_err("refused").to_string();
    assert!(error.contains("priority.falloff_m") && error.contains("found 6"), "{error}");
}

#[test]
fn the_report_has_every_key_of_the_schema_and_null_for_missing_results() {
    let settings = WalkSettings { policy: PolicyKind::Cells, ..WARPED };
    let tally = walk(&WORLD, &settings, 300, at_frames(&PATH, 1.0, 60.0)).expect("walked");
    let report = serde_json::to_value(ArpReport::of(&WORLD, &settings, &tally)).expect("JSON");
    assert_eq!(report["schema"], "pxpl5-arp/1");
    for key in [
        "face_texels",
        "latch",
        "pipeline_ns",
        "matrix_loads",
        "matrix_refused",
        "footprints_split",
        "bank_conflicts",
        "memories",
        "priority",
        "tears_texels",
        "rotation_latency_ms",
        "translation_latency_ms",
        "sampling_error_px",
    ] {
        assert!(report.get(key).is_some(), "{key}");
    }
    for key in
        ["updates_hz", "period_frames", "segments", "triangles", "regions_copied", "missed", "eye_age_mm", "bytes"]
    {
        assert!(report["memories"][3].get(key).is_some(), "{key}");
    }
    for key in [
        "policy",
        "theta_deg",
        "cell_m",
        "draws_per_s",
        "saved_percent",
        "moved_objects",
        "redeals",
        "faces_per_primitive",
    ] {
        assert!(report["priority"].get(key).is_some(), "{key}");
    }
    // The display has 26 stages of 25 ns, and both buffers have 6 x 512 x 512 texels of 6 bytes.
    assert_eq!(
        (report["pipeline_ns"].as_f64(), report["memories"][0]["bytes"].as_u64()),
        (Some(650.0), Some(18_874_368))
    );
    assert!(report["memories"][0]["regions_copied"].is_null());
}

/// Checks the mean times until a pixel is displayed. After the first pixel of its field, it takes 239/2 lines of
/// 4004/63 us and 639/2 pixels of 11/135 us.
///
/// After the first pixel of its line, it takes 639/2 pixels. The pipeline takes 650 ns.
#[test]
fn a_walk_has_the_latencies_of_its_display() {
    let [lines_ms, pixels_ms] = [119.5 * 4.004 / 63.0, 319.5 * 0.011 / 135.0];
    let all = [("field", lines_ms + pixels_ms), ("line", pixels_ms), ("pixel", 0.0)];
    for ((name, latch), (expected_name, scan)) in Latch::ALL.into_iter().zip(all) {
        assert_eq!(name, expected_name);
        let mut settings = CELLS;
        settings.display.latch = latch;
        let tally = walk(&WORLD, &settings, 300, at_frames(&PATH, 1.0, 60.0)).expect("walked");
        let report = ArpReport::of(&WORLD, &settings, &tally);
        let turn = &report.rotation_latency_ms;
        assert!((turn.total.expect("simulated") - 0.00065 - scan).abs() < 1e-6, "{name}: {turn:?}");
        // Memory 0 is drawn in every frame in no time. Translation therefore waits only for the scan, regardless of the
        // latch.
        let step = &report.translation_latency_ms;
        assert!((step.total.expect("shown") - lines_ms - pixels_ms).abs() < 1e-6, "{name}: {step:?}");
        let sums = report.memories.iter().map(|memory| &memory.translation_latency_ms);
        assert!(sums.map(|latency| latency.total).is_sorted(), "far memories are older");
    }
}

/// Checks that a memory drawn every n frames is on average (n - 1) / 2 frames old. A renderer of limited speed adds one
/// frame.
#[test]
fn the_age_of_the_displayed_memory_is_part_of_the_latency_of_a_step() {
    let eye = at_frames(&PATH, 1.0, 60.0);
    let fast = WalkSettings { source: SourceKind::Timed { triangles_per_s: 1e9 }, ..CELLS };
    let reports = [CELLS, fast].map(|settings| {
        let tally = walk(&WORLD, &settings, 1_200, &eye).expect("walked");
        ArpReport::of(&WORLD, &settings, &tally)
    });
    for memory in 0..4 {
        let [ideal, timed] = [0, 1].map(|i| &reports[i].memories[memory].translation_latency_ms.parts);
        assert_eq!(ideal["draw"], Some(0.0));
        let frame_ms = 1e3 / 60.0;
        assert!((timed["draw"].expect("shown") - frame_ms).abs() < 1e-9, "{timed:?}");
        let least = (reports[0].memories[memory].period_frames.expect("drawn") - 1.0) / 2.0 * frame_ms;
        let wait = ideal["wait"].expect("shown");
        assert!(wait >= least - 0.2 && wait < 1.3 * least + 0.2, "{memory}: {wait}, {least}");
    }
}

/// Checks that the faces do not depend on the lens, and that views wider than 170 degrees have no flat picture.
#[test]
fn pictures_are_drawn_through_the_chosen_lens() {
    let names_of = |display: &dyn Fn(&mut WalkSettings)| {
        let mut settings = small(CELLS);
        settings.display.scan.visible_pixels = 64;
        settings.display.scan.visible_lines = 24;
        display(&mut settings);
        let pictures = of_walk(WORLD.clone(), &PATH, &settings, 1.0, 30).expect("drawn");
        let pixels = pictures.into_iter().map(|picture| match picture {
            ArpPicture::Pixels(name, pixels) => (name, Some(pixels)),
            ArpPicture::Drawing(name, _) => (name, None),
        });
        pixels.collect::<BTreeMap<_, _>>()
    };
    let flat = names_of(&|_| {});
    assert!(flat["eye"] == flat["eye-flat"] && flat.contains_key("cuts"), "flat is the default");
    let radial = names_of(&|settings| settings.display.lens = Lens::Radial { k1: 0.32, k2: 0.0 });
    assert!(radial["eye-flat"] == flat["eye-flat"] && radial["eye"] != flat["eye"]);
    let wide = names_of(&|settings| {
        settings.display.lens = Lens::Equidistant;
        settings.display.timing.horizontal_deg = 200.0;
    });
    assert!(wide.contains_key("eye") && wide.contains_key("error") && !wide.contains_key("eye-flat"));
}
