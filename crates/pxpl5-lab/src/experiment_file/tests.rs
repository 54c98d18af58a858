use super::*;
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Fingerprint, Pixels};
use std::path::Path;

fn plan(text: &str) -> Plan {
    ExperimentFile::parse(text, "test").expect("TOML").resolve().expect("an experiment")
}

fn refusal(text: &str) -> String {
    let resolved = ExperimentFile::parse(text, "test").and_then(|file| file.resolve());
    resolved.expect_err("no experiment").to_string()
}

const RC: &str = "pipeline = \"rendering-control\"\nscene = \"mig\"\n";

#[test]
fn missing_keys_have_the_values_of_the_papers() {
    let rc = plan(RC);
    assert_eq!(rc.machine, MachineConfig::small_hmd());
    assert_eq!((rc.fields, rc.seed, rc.pixels), (120, 1, Pixels::Lazy));
    let slats = plan("pipeline = \"slats\"\nscene = \"mig\"\n");
    assert_eq!(slats.machine, MachineConfig::slats());
}

#[test]
fn every_machine_parameter_is_found_with_and_without_its_prefix() {
    for parameter in MachineConfig::small_hmd().parameters().into_iter().filter(|parameter| !parameter.read_only) {
        let mut file = ExperimentFile::parse(RC, "test").expect("TOML");
        // One more than the preset's value is always in range, except for sizes and rates that frame buffers check
        // together.
        let path = &parameter.path;
        file.set_text(&format!("{path}={}", one_more(parameter.value)), "--set").expect("known");
        file.set_text(&format!("machine.{path}={}", parameter.value), "--set").expect("the same key");
        assert_eq!(file.resolve().expect("valid").machine, MachineConfig::small_hmd(), "{path}");
    }
}

/// Each row has a text and its error. `SLATS` and `FRAMELESS` stand for two lines that choose the pipeline and a scene.
#[test]
fn errors_name_the_line_and_the_expected_value() {
    let rows = r#"
a.b.c = 1 | test, line 1: there is no key `a.b.c`
\n\n[machine]\nring.wrod_ns = 1 | test, line 4: there is no key `machine.ring.wrod_ns`; did you mean `machine.ring.word_ns`?
machine = 3 | there is no key `machine`
SLATS\nseed = -1 | test, line 3: seed: expected a whole number
SLATS\nseed = 1.5 | line 3: seed: expected a whole number
SLATS\nlevel = "cycles" | line 3: level: there is no level `cycles`; did you mean `cycle`? (expected one of analytic, transaction, cycle, auto)
SLATS\nmeasure = ["latency_ms.maen"] | line 3: measure: there is no quantity `latency_ms.maen`; did you mean `latency_ms.mean`?
SLATS\nhead.distance = 1 | this head.path does not take it
SLATS\npublished.value = 1 | published.quantity is missing
pipeline = "jitp-scanline"\nscene = "mig"\nblock = 8 | does not apply to the pipeline jitp-scanline
FRAMELESS\nblock = 3 | line 3: block: expected a whole number from 4 to 128
FRAMELESS\nlevel = "analytic" | line 3: level: expected transaction
SLATS\nhead.motion = "still"\nlevel = "analytic" | line 4: level: expected
SLATS\nhead.tracker = "flock" | head.motion is missing
SLATS\nhead.motion = "pan" | line 3: head.motion: expected a pan of
SLATS\nhead.motion = "a.csv" | line 3: head.motion: a.csv cannot be opened
SLATS\n[head]\nmotion = "still"\ntracker = "x" | line 5: head.tracker: there is no
FRAMELESS\n[head]\nmotion = "still"\nraster = "vdrt" | line 5: head.raster = vdrt does not apply to the pipeline frameless
SLATS\nhead.motion = "pan:1"\nhead.evaluate_at = 0 | line 4: head.evaluate_at: expected a number from 0.001 to 1000000 m, found 0
SLATS\nhead.motion = "pan:1"\nhead.end = "hold" | line 4: head.end: expected nothing: head.motion is no recording
SLATS\nhead.motion = "sine:20" | such as sine:20:0.5, found `20`
SLATS\nhead.evaluate_at = 2.0 | head.motion is missing
x = 1\nx = 2 | test, line 2: not TOML
SLATS\n[machine]\n\ngp.triangle_ns = 9_000_000_000_000 | test, line 5: gp.triangle_ns must be
SLATS\nmachine.n_renderers = 0 | test, line 3: n_renderers must be 1
SLATS\nfit = false | test, line 3: fit: expected nothing
SLATS\nvideo.field_ps = 5 | did you mean `video.
"#;
    for (text, says) in rows.trim().lines().map(|row| row.split_once(" | ").expect(row)) {
        let pipeline = |name: &str| format!("pipeline = \"{name}\"\nscene = \"mig\"");
        let text = text.replace("SLATS", &pipeline("slats")).replace("FRAMELESS", &pipeline("frameless"));
        let text = text.replace("\\n", "\n");
        let found = refusal(&text);
        assert!(found.contains(says), "{text:?}: {found}");
    }
}

#[test]
fn a_written_file_describes_the_same_experiment() {
    let texts = [
        RC.to_owned(),
        format!("{RC}mono = true\nshading = \"gouraud\"\ntriangles = 9\nseed = 5\n[head]\npath = \"orbit\"\ndistance = 2\nsway = 0.5\n[hmd]\nnear = 0.1\n"),
        "title = \"a \\\"b\\\"\"\npipeline = \"slats\"\nscene = \"mig\"\ncode = 1995\npublished = {figure = 3, source = \"x\", quantity = \"copies_ms\", value = 2}\n".to_owned(),
    ];
    let registry = crate::registry();
    let named = registry.pipelines().iter().map(|entry| format!("pipeline = \"{}\"\nscene = \"mig\"\n", entry.name));
    let with_head = "pipeline = \"slats\"\nscene = \"mig\"\n[head]\nmotion = \"pan:-40.5\"\nraster = \"vdrt\"\npredict = \"none\"\nadded_latency = 12.5\n";
    let sized = ["jitp-field\"\nstrip_rows = 16", "frameless\"\nblock = 32\nbatch = 5\norder_seed = 9"]
        .map(|text| format!("scene = \"mig\"\npipeline = \"{text}"));
    for text in texts.into_iter().chain(named).chain(sized).chain([with_head.to_owned()]) {
        let first = plan(&text);
        let second = plan(&first.settings().to_string());
        assert_eq!((&first, first.fingerprint()), (&second, second.fingerprint()));
    }
}

#[test]
fn the_fingerprint_covers_every_setting_that_changes_the_result() {
    let base = plan(RC).fingerprint();
    for same in ["title = \"x\"", "pixels = \"off\"", "output.csv = false", "measure = [\"events\"]"] {
        assert_eq!(plan(&format!("{RC}{same}")).fingerprint(), base, "{same}");
    }
    for other in [
        "head.motion = \"still\"",
        "head.motion = \"still\"\nhead.added_latency = 20",
        "seed = 2",
        "fields = 121",
        "mono = true",
        "triangles = 5",
        "head.sway = 2",
        "machine.ring.hop_ns = 51",
    ] {
        assert_ne!(plan(&format!("{RC}{other}")).fingerprint(), base, "{other}");
    }
}

#[test]
fn an_orbit_keeps_its_distance_from_the_centre_of_the_scene() {
    let scene = plan(&format!("{RC}head.path = \"orbit\"\nhead.distance = 3")).load_scene().expect("built in");
    let (centre, _) = scene.bounding_sphere();
    for time_ps in [0, 1_000_000_000_000, 2_500_000_000_000] {
        let eye = scene.motion().pose(time_ps).position;
        assert!(((eye - centre.as_dvec3()).length() - 3.0).abs() < 1e-3);
    }
    assert_ne!(scene.motion().pose(0).position, scene.motion().pose(1_000_000_000_000).position);
}

#[test]
fn a_walk_goes_along_the_path_of_the_scene_and_begins_where_the_scene_does() {
    let text = "pipeline = \"slats\"\nscene = \"gallery\"\nhead.motion = \"walk:1\"\n";
    let walking = plan(text);
    let head = walking.head.as_ref().expect("a head").head();
    let scene = walking.load_scene().expect("built in");
    let first = scene.path()[0].as_dvec3();
    assert_eq!(head.motion().pose(0).position, first);
    assert_eq!(scene.motion().pose(0).position, first);
    assert!(head.motion().pose(0).angle_deg(&scene.motion().pose(0)) < 1e-3);
    let second = scene.path()[1].as_dvec3();
    let after = head.motion().pose(5_000_000_000_000).position;
    assert!(((after - first).length() - 5.0).abs() < 1e-9 && (after - first).cross(second - first).length() < 1e-9);
}

#[test]
fn a_walk_without_a_path_or_with_an_invalid_speed_is_refused() {
    let refused = |scene: &str, motion: &str| {
        refusal(&format!("pipeline = \"slats\"\nscene = \"{scene}\"\nhead.motion = \"{motion}\"\n"))
    };
    assert!(refused("mig", "walk:1").contains("this scene has none; expected a scene with a path, such as gallery"));
    for motion in ["walk:", "walk:fast", "walk:101", "walk:1:x"] {
        let error = refused("gallery", motion);
        assert!(error.contains("-100 to 100 metres per second") && error.contains(motion), "{error}");
    }
}

#[test]
fn a_scene_file_is_relative_to_the_experiment_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("one.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("writable");
    std::fs::write(folder.join("e.toml"), "pipeline = \"slats\"\nscene = \"one.obj\"\n").expect("writable");
    let plan = ExperimentFile::load(folder.join("e.toml")).and_then(|file| file.resolve()).expect("valid");
    assert_eq!(plan.load_scene().expect("beside the file").triangles().len(), 1);
}

#[test]
fn every_pipeline_has_the_same_name_in_files_and_reports() {
    for entry in crate::registry().pipelines() {
        let pipeline = (entry.build)(&pxpl5_run::PipelineSettings::default());
        assert_eq!((entry.name, entry.name.starts_with(entry.family)), (pipeline.name(), true));
    }
}

fn one_more(value: pxpl5_sim::parameters::Value) -> u64 {
    value.whole().expect("the machine's numbers are whole") + 1
}

#[test]
fn two_recordings_with_the_same_name_and_different_poses_give_different_experiments() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let text = format!("{RC}head.motion = \"head.csv\"\n");
    std::fs::write(folder.join("e.toml"), text).expect("writable");
    let a = moved_to(0.1, folder);
    let b = moved_to(0.2, folder);
    assert_eq!(config_hash(&a), config_hash(&moved_to(0.1, folder)));
    assert_ne!(config_hash(&a), config_hash(&b));
    assert_ne!(a, b);
}

#[test]
fn a_recording_is_found_beside_the_file_and_read_with_the_stated_columns_and_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let poses = "stamp;qx;qy;qz;qw;px;py;pz\n10;0;0;0;1;0;0;0\n1010;0;0;0;1;2000;0;0\n";
    std::fs::write(folder.join("poses.csv"), poses).expect("written");
    let text = "pipeline = \"slats\"\nscene = \"room\"\n[head]\nmotion = \"poses.csv\"\nend = \"hold\"\nevaluate_at = 3.5\n\
                [head.columns]\nt_ms = \"stamp\"\nx_mm = 6\ny = 7\nz = 8\nqw = \"qw\"\nqx = \"qx\"\nqy = \"qy\"\nqz = \"qz\"\n";
    let path = folder.join("experiment.toml");
    std::fs::write(&path, text).expect("written");
    let plan = ExperimentFile::load(&path).expect("keys").resolve().expect("a plan");
    let head = plan.head.as_ref().expect("a head").head();
    assert!(
        (head.motion().pose(500_000_000_000).position.x - 1.0).abs() < 1e-12,
        "half of 2,000 mm after half a second"
    );
    assert_eq!((head.motion().ends_ps(), head.evaluate_at_m), (None, Some(3.5)));
    // The written settings mean the same in another folder.
    let other = folder.join("elsewhere");
    std::fs::create_dir_all(&other).expect("a folder");
    std::fs::write(other.join("again.toml"), plan.settings_for_any_folder().to_string()).expect("written");
    let again = ExperimentFile::load(other.join("again.toml")).expect("keys").resolve().expect("the same plan");
    assert_eq!(again.head.as_ref().expect("a head").head().fingerprint(), head.fingerprint());
}

/// Resolves the experiment file `e.toml`, whose motion is a recording. In this recording, the head moves `x` metres in
/// one second.
fn moved_to(x: f64, folder: &Path) -> Plan {
    let rows = format!("time_s,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,{x},0,0,1,0,0,0\n");
    std::fs::write(folder.join("head.csv"), rows).expect("writable");
    ExperimentFile::load(folder.join("e.toml")).and_then(|file| file.resolve()).expect("beside the file")
}

fn config_hash(plan: &Plan) -> Fingerprint {
    plan.experiment(plan.load_scene().expect("built in")).config_hash()
}

#[test]
fn the_keys_of_the_head_mounted_display_have_the_limits_and_defaults_of_its_table() {
    use pxpl5_sim::parameters::KeyValues;
    use tracking::config::HeadMountedView;
    for (name, parameter, per_unit) in [
        ("hmd.field_of_view", "horizontal_fov_deg", 1.0),
        ("hmd.eye_distance", "eye_separation_m", 1e3),
        ("hmd.near", "near_m", 1.0),
        ("hmd.far", "far_m", 1.0),
    ] {
        let key = super::keys::common(name).expect("a key");
        let info = HeadMountedView::INFOS.iter().find(|info| info.name == parameter).expect("a parameter");
        let KeyValues::Real(low, high) = key.values else { panic!("{name} is a number") };
        assert_eq!((low, high), (info.limits.0.real() * per_unit, info.limits.1.real() * per_unit), "{name}");
        let default = (info.papers.real() * per_unit).to_string();
        assert_eq!(key.default.split(' ').next(), Some(default.as_str()), "{name}");
    }
}

#[test]
fn every_key_has_one_description_with_its_values() {
    let keys = ExperimentFile::keys_of(&crate::registry());
    let about = |path: &str| &keys.iter().find(|key| key.path == path).expect(path).about;
    assert!(about("fields").ends_with("; 1 to 10000000; default 120"), "{}", about("fields"));
    assert!(about("hmd.near").contains("; 0.000001 to 1000000 m; default 0.05"), "{}", about("hmd.near"));
    assert!(about("display.hz").ends_with("; 1 to 1000 Hz"), "{}", about("display.hz"));
    assert!(
        about("strip_rows").ends_with("; 1 to 128 lines; default 8 for a field, 1 for lines"),
        "{}",
        about("strip_rows")
    );
    assert!(about("level").contains("bound); default transaction"), "{}", about("level"));
    let mut paths: Vec<&str> = keys.iter().map(|key| key.path.as_str()).collect();
    paths.sort_unstable();
    assert!(paths.windows(2).all(|pair| pair[0] != pair[1]), "a path appears twice: {paths:?}");
}

/// Tests the keys that place a scene, and the file that a run writes: it reads back with the same place.
#[test]
fn a_scene_is_placed_in_metres_and_its_place_is_kept() {
    let text = "pipeline = \"slats\"\nscene = \"aircraft\"\nmodel.z = -4\nmodel.size = 2.0\nmodel.room = true\n";
    let plan = plan(text);
    let scene = plan.load_scene().expect("built in");
    let [aircraft, room] = ["aircraft", "room"].map(|name| pxpl5_scene::builtin(name).expect("built in").primitives());
    assert_eq!(scene.primitives(), aircraft + room);
    let again = self::plan(&plan.settings().to_string());
    assert_eq!((again.scene.model, again.fingerprint()), (plan.scene.model, plan.fingerprint()));
    let wrong = refusal("pipeline = \"slats\"\nscene = \"mig\"\nmodel.size = 0");
    assert!(wrong.contains("model.size"), "{wrong}");
}

#[test]
fn the_recordings_of_the_library_are_motions_with_an_end() {
    for (name, seconds) in [("vive-tracked", 29.241_548), ("vive-dev", 9.334_480)] {
        let text =
            format!("pipeline = \"slats\"\nscene = \"room\"\nhead.motion = \"recorded:{name}\"\nhead.end = \"hold\"");
        let plan = plan(&text);
        let head = plan.head.expect("a head").head();
        assert_eq!(head.motion().moves_until_ps(), Some((seconds * 1e12f64).round() as u64), "{name}");
    }
    let text = "pipeline = \"slats\"\nscene = \"room\"\nhead.motion = \"recorded:vive\"";
    let error = refusal(text);
    assert!(error.contains("vive-dev"), "{error}");
}
