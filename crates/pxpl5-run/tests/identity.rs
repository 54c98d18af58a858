//! Tests of fingerprints. A fingerprint depends on the contents, bit by bit and setting by setting, and not on the
//! types that store them.

use glam::Vec3;
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, Fingerprint, Head, Jitp, Raster, Registry, RenderingControl, Viewpoint};
use pxpl5_scene::{Frame, HeadMotion, HeadPath, Hinge, Lighting, Scene, SceneParts, Sphere, Structure, Sway, Vertex};
use pxpl5_sim::parameters::{ParameterTable, Value};
use std::fmt;
use std::sync::Arc;
use tracking::Pose;
use tracking::motion::{Motion, Pan, Pendulum, Recording, Still, Synthetic};
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

/// FNV-1a of 128 bits by its definition (Fowler, Noll, Vo).
fn fnv_1a(bytes: &[u8]) -> String {
    let mut hash = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d_u128;
    for byte in bytes {
        hash ^= u128::from(*byte);
        hash = hash.wrapping_mul((1 << 88) + 0x13b);
    }
    format!("{hash:032x}")
}

const HINGE: Hinge =
    Hinge { point: Vec3::X, axis: Vec3::Y, amplitude_deg: 20.0, period_ps: 2_000_000_000_000, phase_turns: 0.25 };

/// Returns a scene with one triangle that swings and one sphere, in front of a still head.
fn parts() -> SceneParts {
    let vertex = |x: f32| Vertex { position: Vec3::new(x, 0.5, -3.0), normal: Vec3::Z, colour: [1, 2, 3] };
    let structure = Structure {
        name: "flap".to_owned(),
        vertices: 0..3,
        triangles: 0..1,
        spheres: 0..1,
        frame: Frame::Head,
        hinge: Some(HINGE),
        culls_back_faces: false,
    };
    SceneParts {
        name: "small".to_owned(),
        vertices: vec![vertex(0.0), vertex(1.0), Vertex { position: Vec3::new(0.0, 2.0, -3.0), ..vertex(0.0) }],
        triangles: vec![[0, 1, 2]],
        spheres: vec![Sphere { centre: Vec3::NEG_Z, radius: 0.125, colour: [7, 8, 9] }],
        structures: vec![structure],
        lighting: Lighting { towards_light: Vec3::Z, ambient: 0.25, diffuse: 0.75, background: [4, 5, 6] },
        motion: HeadMotion::new(HeadPath::Pan { eye: Vec3::ZERO, deg_per_s: 30.0 }, Sway::none()).expect("in range"),
        path: Vec::new(),
    }
}

fn name_of(parts: SceneParts) -> String {
    Fingerprint::of_scene(&Scene::new(parts).expect("it is valid")).to_string()
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn reals(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn wholes(numbers: &[u64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

#[test]
fn a_scene_is_identified_by_the_bits_of_its_numbers_in_order() {
    let bytes = [
        wholes(&[3]),
        [floats(&[0.0, 0.5, -3.0, 0.0, 0.0, 1.0]), vec![1, 2, 3]].concat(),
        [floats(&[1.0, 0.5, -3.0, 0.0, 0.0, 1.0]), vec![1, 2, 3]].concat(),
        [floats(&[0.0, 2.0, -3.0, 0.0, 0.0, 1.0]), vec![1, 2, 3]].concat(),
        wholes(&[1]),
        [0_u32, 1, 2].iter().flat_map(|corner| corner.to_le_bytes()).collect(),
        wholes(&[1]),
        [floats(&[0.0, 0.0, -1.0, 0.125]), vec![7, 8, 9]].concat(),
        // The words of one structure: three ranges, the mark of a structure that is fixed to the head (1), and the mark
        // of a hinge (1).
        wholes(&[1, 0, 3, 0, 1, 0, 1]),
        vec![1, 1],
        floats(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
        [reals(&[20.0]), wholes(&[2_000_000_000_000]), reals(&[0.25])].concat(),
        // The numbers of the light, the path (a pan is the second kind) and the sway.
        [floats(&[0.0, 0.0, 1.0, 0.25, 0.75]), vec![4, 5, 6]].concat(),
        [vec![1], floats(&[0.0, 0.0, 0.0]), reals(&[30.0]), reals(&[0.0])].concat(),
    ];
    assert_eq!(name_of(parts()), fnv_1a(&bytes.concat()));
}

#[test]
fn any_change_of_a_scene_except_its_names_changes_its_fingerprint() {
    let plain = name_of(parts());
    let hinged = |hinge: Option<Hinge>| {
        let mut parts = parts();
        parts.structures[0].hinge = hinge;
        parts
    };
    let lit = |lighting: Lighting| SceneParts { lighting, ..parts() };
    let moved = |path: HeadPath, sway: Sway| {
        let motion = HeadMotion::new(path, sway).expect("in range");
        SceneParts { motion, ..parts() }
    };
    let pan = |deg_per_s: f64| HeadPath::Pan { eye: Vec3::ZERO, deg_per_s };
    let light = parts().lighting;
    let changed = [
        hinged(None),
        hinged(Some(Hinge { phase_turns: 0.5, ..HINGE })),
        hinged(Some(Hinge { period_ps: HINGE.period_ps + 1, ..HINGE })),
        lit(Lighting { background: [4, 5, 7], ..light }),
        lit(Lighting { ambient: 0.251, ..light }),
        moved(pan(30.000_000_001), Sway::none()),
        moved(HeadPath::Still { eye: Vec3::ZERO, target: Vec3::NEG_Z }, Sway::none()),
        moved(pan(30.0), Sway { scale: 0.5, ..Sway::none() }),
    ];
    for (number, parts) in changed.into_iter().enumerate() {
        assert_ne!(name_of(parts), plain, "change {number}");
    }
    let mut renamed = parts();
    renamed.name = "other".to_owned();
    renamed.structures[0].name = "wing".to_owned();
    assert_eq!(name_of(renamed), plain);
}

fn head(motion: impl Motion + Send + Sync + 'static) -> Head {
    Head::new(Arc::new(motion), TrackerConfig::ideal(), PredictorKind::None, 7).expect("in range")
}

#[test]
fn a_head_is_identified_by_its_settings_one_per_line() {
    let found = head(Pan::at(200.0)).with_raster(Raster::Vdrt).fingerprint().to_string();
    let TrackerConfig { rate_hz, filter_gain, .. } = TrackerConfig::ideal();
    let predictor = tracking::predict::PredictorConfig::for_tracker(PredictorKind::None, &TrackerConfig::ideal());
    let lines = [
        "motion=pan\nmotion.start=0 0 0 0 0 0 1\nmotion.deg_per_s=200\n".to_owned(),
        format!("tracker=ideal\ntracker.rate_hz={rate_hz}\ntracker.receivers=1\ntracker.sync_to_output_ps=0\n"),
        "tracker.position_latency_ps=0\ntracker.orientation_latency_ps=0\n".to_owned(),
        "tracker.position_noise_m=0\ntracker.orientation_noise_deg=0\n".to_owned(),
        "tracker.position_bias_m=0\ntracker.orientation_bias_deg=0\n".to_owned(),
        format!("tracker.filter_gain={filter_gain}\n"),
        "tracker.host=interrupt-per-character\n".to_owned(),
        format!("predictor=none\npredictor.position_baseline={}\n", predictor.position_baseline),
        format!("predictor.orientation_baseline={}\n", predictor.orientation_baseline),
        format!("predictor.position_noise_m={}\n", predictor.position_noise_m),
        format!("predictor.orientation_noise_deg={}\n", predictor.orientation_noise_deg),
        format!("predictor.position_jerk={}\n", predictor.position_jerk),
        format!("predictor.orientation_jerk={}\n", predictor.orientation_jerk),
        format!("predictor.start_speed={}\n", predictor.start.speed),
        format!("predictor.start_acceleration={}\n", predictor.start.acceleration),
        format!("predictor.start_turn={}\n", predictor.start.turn),
        format!("predictor.start_turn_acceleration={}\n", predictor.start.turn_acceleration),
        format!("predictor.horizon_ps={}\nseed=7\nraster=vdrt\naim=middle\n", predictor.horizon_ps),
    ];
    assert_eq!(found, fnv_1a(lines.concat().as_bytes()));
}

/// A motion in a user's crate whose `Debug` output is empty.
struct Nod {
    hz: f64,
}

impl fmt::Debug for Nod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Nod")
    }
}

impl Motion for Nod {
    fn pose(&self, t_ps: u64) -> Pose {
        let pitch = 0.1 * (self.hz * t_ps as f64 * 1e-12).sin();
        Pose::facing(tracking::rotation::about_x(pitch))
    }
}

#[test]
fn different_motions_have_different_names_even_with_equal_debug_output() {
    let recording = |x: f64| {
        let text = format!("time_s,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,{x},0,0,1,0,0,0\n");
        Recording::read(text.as_bytes()).expect("valid")
    };
    let names = [
        head(Nod { hz: 1.0 }),
        head(Nod { hz: 1.001 }),
        head(Still(Pose::IDENTITY)),
        head(Pan::at(0.0)),
        head(Pan::at(1.0)),
        head(Pendulum::rig()),
        head(Pendulum::new(0.6, 20.0).expect("in range")),
        head(Pendulum::new(0.5, 21.0).expect("in range")),
        head(Synthetic::recorded_use(1)),
        head(Synthetic::recorded_use(2)),
        head(recording(1.0)),
        head(recording(1.5)),
    ]
    .map(|head| head.fingerprint());
    for (number, name) in names.iter().enumerate() {
        assert!(!names[..number].contains(name), "motion {number}");
    }
    assert_eq!(head(Nod { hz: 1.0 }).fingerprint(), names[0]);
}

#[test]
fn heads_with_different_trackers_predictors_seeds_or_rasters_have_different_names() {
    let of = |tracker: TrackerConfig, predictor: PredictorKind, seed: u64| {
        Head::new(Arc::new(Pan::at(1.0)), tracker, predictor, seed).expect("in range").fingerprint()
    };
    let noisy = TrackerConfig { position_noise_m: 0.001, ..TrackerConfig::ideal() };
    let names = [
        of(TrackerConfig::ideal(), PredictorKind::None, 1),
        of(TrackerConfig::ideal(), PredictorKind::None, 2),
        of(TrackerConfig::ideal(), PredictorKind::Kalman, 1),
        of(noisy, PredictorKind::None, 1),
        of(TrackerConfig::fastrak(), PredictorKind::None, 1),
        of(TrackerConfig::flock_of_birds(), PredictorKind::None, 1),
        of(TrackerConfig::flock_of_birds_on_patched_host(), PredictorKind::None, 1),
        of(TrackerConfig::optical_ceiling(), PredictorKind::None, 1),
        of(TrackerConfig::polhemus_3space(), PredictorKind::None, 1),
        head(Pan::at(1.0)).with_raster(Raster::Vdrt).fingerprint(),
    ];
    for (number, name) in names.iter().enumerate() {
        assert!(!names[..number].contains(name), "head {number}");
    }
}

fn experiment(config: MachineConfig) -> Experiment {
    let scene = pxpl5_scene::builtin("full-screen:12").expect("built in");
    Experiment::new(config, RenderingControl::stereo(), scene)
}

#[test]
fn every_parameter_of_the_machine_changes_the_name_of_an_experiment() {
    let config = Registry::of_papers().machine_of(MachineConfig::small_hmd());
    let plain = experiment(config.clone()).config_hash();
    for parameter in config.parameters().into_iter().filter(|parameter| !parameter.read_only) {
        let mut changed = config.clone();
        let more = match parameter.value {
            Value::Whole(number) => Value::Whole(number + 1),
            Value::Real(number) => Value::Real(number + 0.5),
        };
        changed.set(&parameter.path, more).expect("listed");
        assert_ne!(experiment(changed).config_hash(), plain, "{}", parameter.path);
    }
}

#[test]
fn writing_out_the_default_parameters_of_firmware_changes_nothing() {
    let of = |config: MachineConfig| {
        let scene = pxpl5_scene::builtin("full-screen:12").expect("built in");
        Experiment::new(config, Jitp::new(Viewpoint::Field, false), scene).config_hash()
    };
    let mut config = Registry::of_papers().machine_of(MachineConfig::small_hmd());
    assert_eq!(of(config.clone()), of(MachineConfig::small_hmd()));
    let papers = jitp::JitpTiming::PAPERS.get("interpolate_ns").expect("listed");
    let changed = papers.whole().expect("whole") + 1;
    config.set("jitp.interpolate_ns", changed).expect("listed");
    assert_eq!(config.overrides().get("jitp.interpolate_ns"), Some(&changed.into()));
    assert_ne!(of(config.clone()), of(MachineConfig::small_hmd()));
    config.set("jitp.interpolate_ns", papers).expect("listed");
    assert!(config.overrides().is_empty());
    assert_eq!(of(config), of(MachineConfig::small_hmd()));
}
