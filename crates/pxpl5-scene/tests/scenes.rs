//! The built-in scenes agree with their descriptions.

use pxpl5_sim::parameters::SettingErrorKind;
use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use pxpl5_scene::{Frame, Hmd, Pose, Scene, builtin, names};

fn scene(name: &str) -> Scene {
    builtin(name).unwrap_or_else(|error| panic!("{error}"))
}

fn counts(name: &str) -> (usize, usize) {
    let scene = scene(name);
    (scene.triangles().len(), scene.spheres().len())
}

fn corners(scene: &Scene, triangle: &[u32; 3]) -> [DVec3; 3] {
    triangle.map(|corner| scene.vertices()[corner as usize].position.as_dvec3())
}

/// Returns six times the volume inside a closed surface whose triangles are anticlockwise seen from outside.
fn six_volumes(scene: &Scene) -> f64 {
    let triangles = scene.triangles().iter();
    triangles.map(|t| corners(scene, t)).map(|[a, b, c]| a.dot(b.cross(c))).sum()
}

#[test]
fn each_scene_has_the_stated_number_of_primitives() {
    assert_eq!(counts("mig"), (417, 0)); // published TR94
    assert_eq!(counts("molecules"), (2_620, 1_219));
    assert_eq!(counts("head"), (59_592, 0));
    assert_eq!(counts("full-screen:12"), (12, 0)); // published TR94
    assert_eq!(counts("full-screen:1"), (1, 0));
    assert_eq!(counts("aircraft"), (100, 0));
    assert_eq!(counts("typical:37"), (37, 0));
    // The room has six sides of two triangles, and ten boxes without a lower side. The full scene has 30 whole boxes
    // and ten more boxes without a lower side.
    assert_eq!(counts("gallery"), (6 * 2 + 10 * 10, 0));
    assert_eq!(counts("gallery:full"), (112 + 30 * 12 + 10 * 10, 0));
}

#[test]
fn every_listed_name_can_be_built_with_n_replaced_and_only_a_gallery_has_a_path() {
    for (name, sentence) in names() {
        let has_path = !scene(&name.replace('N', "12")).path().is_empty();
        assert!(sentence.ends_with('.'), "{sentence}");
        assert_eq!(has_path, name.starts_with("gallery"), "{name}");
    }
}

#[test]
fn the_same_name_gives_the_same_scene() {
    for name in ["aircraft", "mig", "molecules", "head", "full-screen:7", "typical:7", "sphere:22"] {
        assert_eq!(scene(name), scene(name));
    }
}

#[test]
fn a_misspelt_name_is_refused_with_the_nearest_name() {
    for (wrong, right) in [
        ("mgi", "mig"),
        ("Haed", "head"),
        ("molecule", "molecules"),
        ("fullscreen:4", "full-screen:N"),
        ("sphre:8", "sphere:N"),
    ] {
        let error = builtin(wrong).expect_err(wrong);
        assert_eq!((error.kind, &*error.found, &*error.nearest), (SettingErrorKind::UnknownName, wrong, right));
    }
}

#[test]
fn a_count_of_triangles_out_of_range_is_refused() {
    for count in ["", "0", "-1", "1000001", "many", "99999999999999999999"] {
        let answer = builtin(&format!("full-screen:{count}"));
        let error = answer.expect_err(count);
        assert!(error.kind == SettingErrorKind::Value && error.expected.starts_with("N "), "{count}: {error}");
    }
}

#[test]
fn the_head_is_closed_and_its_triangles_and_normals_face_outwards() {
    let head = scene("head");
    let edges = edges(&head);
    assert!(edges.values().all(|uses| *uses == [1, 1]));
    // Euler: a surface without holes has V - E + F = 2.
    assert_eq!(head.vertices().len() as i64 - edges.len() as i64 + 59_592, 2);
    assert!(six_volumes(&head) > 0.0);
    let against = head.triangles().iter().filter(|t| {
        let [a, b, c] = corners(&head, t);
        let face = (b - a).cross(c - a);
        t.iter().all(|&corner| head.vertices()[corner as usize].normal.as_dvec3().dot(face) < 0.0)
    });
    assert_eq!(against.count(), 0);
}

#[test]
fn the_head_is_symmetric_and_taller_than_wide() {
    let head = scene("head");
    let [width, height] = [Vec3::X, Vec3::Y].map(|axis| {
        let along = head.vertices().iter().map(|v| v.position.dot(axis));
        along.clone().fold(f32::MIN, f32::max) - along.fold(f32::MAX, f32::min)
    });
    assert!(height > 1.5 * width);
    let sum: f64 = head.vertices().iter().map(|v| f64::from(v.position.x)).sum();
    assert!((sum / head.vertices().len() as f64).abs() < 1e-4);
}

#[test]
fn all_normals_are_of_unit_length() {
    for name in ["aircraft", "mig", "molecules", "head", "full-screen:12", "sphere:30"] {
        for vertex in scene(name).vertices() {
            assert!((vertex.normal.length() - 1.0).abs() < 1e-5, "{name}");
        }
    }
}

#[test]
fn the_normals_of_mig_agree_with_its_triangles() {
    let mig = scene("mig");
    for triangle in mig.triangles() {
        let [a, b, c] = corners(&mig, triangle);
        let face = (b - a).cross(c - a);
        let normals = triangle.map(|corner| mig.vertices()[corner as usize].normal.as_dvec3());
        assert!(face.length() > 0.0 && normals.iter().sum::<DVec3>().dot(face) > 0.0);
    }
    assert!(six_volumes(&mig) > 0.0);
}

#[test]
fn mig_moves_only_its_five_control_surfaces() {
    let mig = scene("mig");
    let edits = mig.edits_at(700_000_000_000);
    let moved: Vec<&str> = edits.iter().map(|e| mig.structures()[e.structure].name.as_str()).collect();
    let surfaces = ["left aileron", "right aileron", "left tailplane", "right tailplane", "rudder"];
    assert_eq!(moved, surfaces);
    let posed = mig.posed(&edits);
    let airframe = mig.structures()[0].vertices.clone();
    assert_eq!(posed.vertices()[airframe.clone()], mig.vertices()[airframe.clone()]);
    let last = airframe.end..mig.vertices().len();
    let still = last.filter(|&i| posed.vertices()[i].position == mig.vertices()[i].position);
    assert!(still.count() < 12, "only points on a hinge's axis may stay");
}

/// Returns the sum of the heights of a structure's vertices at an instant, metres.
fn sum_of_heights(scene: &Scene, structure: usize, time_ps: u64) -> f32 {
    let posed = scene.posed(&scene.edits_at(time_ps));
    let range = scene.structures()[structure].vertices.clone();
    range.map(|i| posed.vertices()[i].position.y).sum()
}

#[test]
fn the_ailerons_of_mig_deflect_oppositely() {
    let mig = scene("mig");
    // After a quarter and three quarters of the period of 4 s, the deflection is greatest in one direction and in the
    // other.
    let early = 1_000_000_000_000;
    let late = 3_000_000_000_000;
    assert!(
        sum_of_heights(&mig, 1, early) > sum_of_heights(&mig, 1, 0)
            && sum_of_heights(&mig, 2, early) < sum_of_heights(&mig, 2, 0)
    );
    // The right structure is the mirror image of the left structure half a swing later.
    assert!((sum_of_heights(&mig, 1, early) - sum_of_heights(&mig, 2, late)).abs() < 1e-5);
    assert!((sum_of_heights(&mig, 1, late) - sum_of_heights(&mig, 2, early)).abs() < 1e-5);
}

#[test]
fn full_screen_triangles_cover_both_screens_for_any_head_rotation() {
    let scene = scene("full-screen:12");
    let hmd = Hmd::unc();
    let pose = Pose { position: DVec3::new(3.0, -2.0, 9.0), orientation: glam::DQuat::from_xyzw(0.5, 0.5, -0.5, 0.5) };
    assert!(scene.structures().iter().all(|s| s.frame == Frame::Head));
    for view in hmd.stereo(&pose) {
        let to_clip = view.projection * Frame::Head.to_eye(&view);
        for triangle in scene.triangles() {
            let p = triangle.map(|c| to_clip.project_point3(scene.vertices()[c as usize].position));
            assert!(p.iter().all(|p| (0.0..1.0).contains(&p.z)));
            for corner in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(glam::Vec2::from) {
                let sides =
                    [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (p[j] - p[i]).truncate().perp_dot(corner - p[i].truncate()));
                assert!(sides.iter().all(|&side| side > 0.0), "{:?}", view.eye);
            }
        }
    }
}

#[test]
fn full_screen_triangles_lie_at_different_depths() {
    let scene = scene("full-screen:12");
    let mut depths: Vec<f32> = scene.vertices().chunks(3).map(|t| t[0].position.z).collect();
    depths.dedup();
    assert_eq!(depths.len(), 12);
}

#[test]
fn the_first_atoms_of_molecules_are_those_of_myoglobin() {
    // The molecule's PDB entry has 783 carbons, 216 nitrogens, 215 oxygens and 2 sulphurs. The scene adds a water
    // molecule.
    let molecules = scene("molecules");
    let colours = [[144, 144, 144], [48, 80, 248], [255, 216, 48], [240, 24, 24], [255, 255, 255]];
    let counts = colours.map(|colour| molecules.spheres().iter().filter(|s| s.colour == colour).count());
    // The counts are of carbon, nitrogen, sulphur, oxygen and hydrogen.
    assert_eq!(counts, [783, 216, 2, 216, 2]);
}

#[test]
fn a_triangle_with_a_vertex_of_another_structure_is_refused() {
    let mut parts = scene("mig").into_parts();
    parts.triangles[0][0] = parts.vertices.len() as u32 - 1;
    let error = Scene::new(parts).expect_err("the vertex belongs to the rudder");
    let text = error.to_string();
    assert!(text.contains("scene mig: triangle 0: expected vertices from 0.."), "{text}");
}

#[test]
fn every_part_of_a_scene_made_by_hand_is_checked() {
    let broken: [fn(&mut pxpl5_scene::SceneParts); 6] = [
        |p| p.vertices[3].position.y = f32::NAN,
        |p| p.vertices[3].normal = Vec3::ZERO,
        |p| p.spheres[0].radius = 0.0,
        |p| p.spheres[0].centre.x = f32::INFINITY,
        |p| p.structures[0].spheres.end -= 1,
        |p| p.structures[0].triangles.start += 1,
    ];
    for damage in broken {
        let mut parts = scene("molecules").into_parts();
        damage(&mut parts);
        assert_eq!(Scene::new(parts).expect_err("damaged").kind, SettingErrorKind::Scene);
    }
}

/// Returns the edges between positions, each with the number of uses forwards and backwards.
fn edges(scene: &Scene) -> BTreeMap<[[u32; 3]; 2], [u32; 2]> {
    let mut edges: BTreeMap<[[u32; 3]; 2], [u32; 2]> = BTreeMap::new();
    let place = |corner: u32| scene.vertices()[corner as usize].position.to_array().map(f32::to_bits);
    for &[a, b, c] in scene.triangles() {
        for (from, onto) in [(a, b), (b, c), (c, a)] {
            let [from, onto] = [place(from), place(onto)];
            let (key, way) = if from < onto { ([from, onto], 0) } else { ([onto, from], 1) };
            edges.entry(key).or_default()[way] += 1;
        }
    }
    edges
}

#[test]
fn the_aircraft_is_closed_and_its_triangles_face_outwards() {
    let aircraft = scene("aircraft");
    assert!(edges(&aircraft).values().all(|uses| *uses == [1, 1]));
    assert!(six_volumes(&aircraft) > 0.0);
    for triangle in aircraft.triangles() {
        let [a, b, c] = corners(&aircraft, triangle);
        let face = (b - a).cross(c - a);
        assert!(face.length() > 1e-4, "no triangle without area");
        let against = triangle.iter().all(|&t| aircraft.vertices()[t as usize].normal.as_dvec3().dot(face) < 0.0);
        assert!(!against, "normals point the way that triangles face");
    }
}

#[test]
fn the_aircraft_is_nearly_as_wide_as_long_and_symmetric() {
    let aircraft = scene("aircraft");
    let mirrored =
        |p: Vec3| aircraft.vertices().iter().any(|v| (v.position * Vec3::new(-1.0, 1.0, 1.0) - p).length() < 1e-3);
    assert!(aircraft.vertices().iter().all(|v| mirrored(v.position)));
    let reach = |axis: Vec3| aircraft.vertices().iter().map(|v| v.position.dot(axis).abs()).fold(0.0, f32::max);
    assert!((0.7..1.0).contains(&(reach(Vec3::X) / reach(Vec3::Z))), "wings and nose are both there");
}

#[test]
fn every_sphere_is_closed_and_nearly_round_with_the_stated_number_of_triangles() {
    for count in (8..400).step_by(2).chain([1_000, 20_000]) {
        let sphere = scene(&format!("sphere:{count}"));
        assert_eq!(sphere.triangles().len(), count);
        assert!(edges(&sphere).values().all(|uses| *uses == [1, 1]), "{count}");
        // The first vertex and the last are the poles; a bounding sphere may be some per cent larger than the smallest.
        let [Some(top), Some(bottom)] = [sphere.vertices().first(), sphere.vertices().last()] else {
            panic!("no vertices")
        };
        let radius = f64::from((top.position - bottom.position).length()) / 2.0;
        let full = 8.0 * std::f64::consts::PI * radius.powi(3);
        // The mean distance between an equilateral triangle of side s and the unit sphere is s^2/8. N such triangles
        // have an area of 4 pi / N each, so s^2 = 16 pi / (sqrt(3) N). The missing part of the volume is 3 s^2 / 8 =
        // 10.9 / N, and uneven triangles may miss half as much again.
        let share = six_volumes(&sphere) / full;
        assert!(share < 1.0 && 1.0 - share < 1.5 * 10.9 / count as f64, "{count}: {share}");
    }
    for count in ["0", "7", "9", "6", "1000002", "x"] {
        let answer = builtin(&format!("sphere:{count}"));
        let error = answer.expect_err(count);
        assert!(error.kind == SettingErrorKind::Value && error.expected.starts_with("N "), "{count}: {error}");
    }
}

/// Tests a scene that is turned to the left by a quarter, scaled and moved. What lay before its middle (-z) then lies to
/// the left of it (-x).
#[test]
fn a_scene_is_placed_by_the_middle_and_the_longest_side_of_its_box() {
    let scene = builtin("aircraft").expect("built in");
    let placed = scene.placed([Some(1.0), None, Some(-3.0)], Some(1.5), 90.0);
    let bounds = |scene: &Scene| {
        let positions = scene.vertices().iter().map(|vertex| vertex.position);
        positions.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
    };
    let [(low, high), (low_after, high_after)] = [bounds(&scene), bounds(&placed)];
    let [before, after] = [(low + high) / 2.0, (low_after + high_after) / 2.0];
    assert!(after.distance(Vec3::new(1.0, before.y, -3.0)) < 1e-5, "{after}");
    assert!(((high_after - low_after).max_element() - 1.5).abs() < 1e-5);
    let scale = 1.5 / (high - low).max_element();
    for (one, other) in scene.vertices().iter().zip(placed.vertices()) {
        let way = (one.position - before) * scale;
        assert!((other.position - after).distance(Vec3::new(way.z, way.y, -way.x)) < 1e-4);
    }
    assert_eq!(scene.placed([None; 3], None, 0.0).triangles(), scene.triangles());
}

#[test]
fn a_scene_together_with_a_room_has_the_primitives_of_both_and_its_own_name() {
    let [scene, room] = ["aircraft", "room"].map(|name| builtin(name).expect("built in"));
    let both = scene.clone().together_with(&room).expect("few vertices");
    assert_eq!((both.name(), both.primitives()), (scene.name(), scene.primitives() + room.primitives()));
    let corners =
        |scene: &Scene, triangle: usize| scene.triangles()[triangle].map(|v| scene.vertices()[v as usize].position);
    let last = room.triangles().len() - 1;
    assert_eq!(corners(&both, scene.triangles().len() + last), corners(&room, last));
}
