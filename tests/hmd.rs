//! The head-mounted display has numbers that an experiment can set.

use pxpl5::{ExperimentFile, Measured, Report};

fn report(settings: &[&str]) -> Report {
    let mut file = ExperimentFile::default();
    let usual =
        ["pipeline=jitp-field", "scene=full-screen:2", "fields=40", "head.motion=pan:40", "head.tracker=optical"];
    for setting in usual.iter().chain(&["head.predict=none", "head.evaluate_at=1000"]).chain(settings) {
        file.set_text(setting, "test").unwrap_or_else(|error| panic!("{error}"));
    }
    let plan = file.resolve().unwrap_or_else(|error| panic!("{error}"));
    let scene = plan.load_scene().expect("built in");
    plan.experiment(scene).run().unwrap_or_else(|error| panic!("{error}")).report()
}

/// A turn by an angle moves the middle of the picture by the focal length times the tangent of the angle. The focal
/// length is half the width divided by the tangent of half the field of view. The ratio is tan 45 / tan 30 = 1.732.
#[test]
fn the_error_in_the_middle_is_proportional_to_the_focal_length() {
    let centre = |settings: &[&str]| {
        let error = report(settings).head.expect("a tracked head").error;
        let fields: Vec<f64> = error.by_field.iter().map(|field| field.centre_px).filter(|px| px.is_finite()).collect();
        fields.iter().sum::<f64>() / fields.len() as f64
    };
    let [usual, wide] = [centre(&[]), centre(&["hmd.field_of_view=90"])];
    assert!((usual / wide - 3f64.sqrt()).abs() < 0.02, "{usual} px, {wide} px");
}

#[test]
fn every_report_states_the_display_and_default_display_settings_do_not_change_the_hashes() {
    let usual = report(&[]);
    assert_eq!(
        (usual.hmd.horizontal_fov_deg, usual.hmd.eye_separation_m, usual.hmd.near_m, usual.hmd.far_m),
        (60.0, 0.064, 0.05, 50.0)
    );
    let set = report(&["hmd.field_of_view=60", "hmd.eye_distance=64"]);
    assert_eq!((&set.config_hash, &set.trace_hash), (&usual.config_hash, &usual.trace_hash));
    let other = report(&["hmd.eye_distance=70"]);
    assert!((other.hmd.eye_separation_m - 0.07).abs() < 1e-12);
    assert_ne!(other.config_hash, usual.config_hash);
}

#[test]
fn impossible_displays_are_refused_by_name() {
    for (setting, expected) in [
        ("hmd.field_of_view=0", "hmd.field_of_view"),
        ("hmd.eye_distance=-1", "hmd.eye_distance"),
        ("hmd.far=0.01", "hmd.far"),
        ("hmd.near=0", "hmd.near"),
        ("hmd.convergence=0.01", "hmd.convergence"),
        ("hmd.convergence=-inf", "hmd.convergence"),
        ("hmd.lens=0.2", "hmd.lens: expected 0: the model shows flat pictures without a lens"),
    ] {
        let mut file = ExperimentFile::default();
        for text in ["pipeline=slats", "scene=full-screen:2", setting] {
            file.set_text(text, "test").expect("known keys");
        }
        let error = file.resolve().expect_err(setting).to_string();
        assert!(error.contains(expected), "{error}");
    }
    let mut file = ExperimentFile::default();
    for text in ["pipeline=arp-full", "display=arp", "scene=room", "hmd.near=1"] {
        file.set_text(text, "test").expect("known keys");
    }
    let error = file.resolve().expect_err("faces").to_string();
    assert!(error.contains("arp-full"), "{error}");
}

#[test]
fn the_report_states_the_convergence_of_the_eyes_and_parallel_axes_are_the_default() {
    let usual = report(&[]);
    let parallel = report(&["hmd.convergence=inf", "hmd.lens=0"]);
    assert_eq!((&parallel.config_hash, &parallel.trace_hash), (&usual.config_hash, &usual.trace_hash));
    let converging = report(&["hmd.convergence=0.8"]);
    assert_eq!(converging.hmd.convergence_m, Some(0.8));
    assert_ne!(converging.config_hash, usual.config_hash);
    assert_eq!(
        converging.hmd.to_string(),
        "Display: 60 degrees wide, eyes 64 mm apart with axes that meet at 0.8 m, near 0.05 m, far 50 m, no lens (hmd.*)"
    );
}
