//! Imported models are completely visible to both eyes. The test compares the bounding sphere with the sides of the
//! view.

use glam::{DVec3, Vec3};
use pxpl5_scene::{Format, Hmd, Placement, Scene, builtin, from_bytes, placed_from_bytes};

const SECOND: u64 = 1_000_000_000_000;

/// Returns the angle between the bounding sphere and the nearest side of a view, degrees. A negative angle means that
/// the sphere is cut off.
fn margin_deg(scene: &Scene, time_ps: u64) -> f64 {
    let hmd = Hmd::unc();
    let (centre, radius) = scene.bounding_sphere();
    let half_width = 30f64.to_radians().tan();
    let margins = hmd.stereo(&scene.motion().pose(time_ps)).map(|view| {
        let c = view.world_to_eye.transform_point3(centre).as_dvec3();
        let reach = (f64::from(radius) / c.length()).asin().to_degrees();
        // A side of the view is a plane through the eye with an outward normal. Its margin is the angle to the centre
        // minus the angle of the sphere.
        let sides = [
            DVec3::new(1.0, 0.0, half_width),
            DVec3::new(-1.0, 0.0, half_width),
            DVec3::new(0.0, 1.0, 0.75 * half_width),
            DVec3::new(0.0, -1.0, 0.75 * half_width),
        ];
        sides.map(|side| -(side.normalize().dot(c) / c.length()).asin().to_degrees() - reach)
    });
    margins.into_iter().flatten().fold(f64::MAX, f64::min)
}

/// Returns a bar, a flat plate and a lump, in any units.
fn models() -> Vec<Scene> {
    let texts = [
        "v 0 0 0\nv 1000 0 0\nv 0 2000 30\nv 5 5 5\nf 1 2 3\nf 1 2 4\n",
        "v 0 0 0\nv 0.001 0 0\nv 0 0.002 0\nf 1 2 3\n",
        "v -1 -1 -1\nv 1 1 -1\nv -1 1 1\nv 1 -1 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n",
    ];
    let read = |text: &str| from_bytes(text.as_bytes(), Format::Obj, "model").expect("well formed");
    texts.map(read).into_iter().chain([builtin("sphere:320").expect("built in")]).collect()
}

#[test]
fn both_eyes_see_the_whole_model_with_a_margin_at_all_times() {
    for scene in models() {
        let least = (0..6_000).map(|i| margin_deg(&scene, i * SECOND / 9)).fold(f64::MAX, f64::min);
        // The worst case of all sines at once leaves 1.2 degrees. The model must not be smaller than necessary either.
        assert!((1.0..8.0).contains(&least), "{}: {least} degrees", scene.name());
    }
}

#[test]
fn every_seed_of_the_motion_keeps_the_model_in_view() {
    let scene = builtin("sphere:80").expect("built in");
    for seed in 0..20 {
        let motion = scene.motion().with_seed(seed);
        let scene = Scene::new(pxpl5_scene::SceneParts { motion, ..scene.clone().into_parts() }).expect("as before");
        for i in 0..400 {
            assert!(margin_deg(&scene, i * SECOND * 7 / 3) > 1.0, "seed {seed}, {i}");
        }
    }
}

#[test]
fn without_fit_a_model_stays_where_its_file_places_it() {
    let text = b"v 1 2 -30\nv 2 2 -30\nv 1 4 -30\nf 1 2 3\n";
    let scene = placed_from_bytes(text, Format::Obj, "model", Placement::AsInFile).expect("well formed");
    assert_eq!(scene.vertices()[2].position, Vec3::new(1.0, 4.0, -30.0));
    let pose = scene.motion().pose(SECOND);
    assert_eq!((pose.position, pose.orientation * DVec3::NEG_Z), (DVec3::ZERO, DVec3::NEG_Z));
}
