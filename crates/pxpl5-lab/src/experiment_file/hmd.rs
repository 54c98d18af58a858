use super::ExperimentFile;
use super::read::{not_applicable, wrong};
use pxpl5_run::{Coverage, Pipeline};
use pxpl5_scene::{Hmd, HmdConfig};
use pxpl5_sim::parameters::{Key, KeyValues, SettingError};
use toml::Value;

/// A parameter's key, and the functions that set and return its value.
type Number = (Key, fn(&mut HmdConfig, f64), fn(&HmdConfig) -> f64);

/// Keys of the head-mounted display. An infinite convergence means parallel axes.
pub(super) const KEYS: [Number; 6] = [
    (
        Key::new(
            "hmd.field_of_view",
            "angle between the left and the right edge of an eye's picture",
            KeyValues::Real(1.0, 170.0),
        )
        .with_unit("deg")
        .with_default("60 (published in JITP's example, assumed here, sources: 30 to 100)"),
        |config, value| config.horizontal_fov_deg = value,
        |config| config.horizontal_fov_deg,
    ),
    (
        Key::new("hmd.eye_distance", "distance between the viewer's eyes", KeyValues::Real(0.0, 1000.0))
            .with_unit("mm")
            .with_default("64 (assumed, mean of adults, sources: 54 to 74)"),
        |config, value| config.eye_separation_m = value / 1e3,
        |config| config.eye_separation_m * 1e3,
    ),
    (
        Key::new(
            NEAR,
            "distance from the eye to the plane in front of which nothing is drawn",
            KeyValues::Real(1e-6, 1e6),
        )
        .with_unit("m")
        .with_default("0.05 (assumed: nearer than a hand)"),
        |config, value| config.near_m = value,
        |config| config.near_m,
    ),
    (
        Key::new(
            FAR,
            "distance from the eye to the plane behind which nothing is drawn, above hmd.near",
            KeyValues::Real(1e-6, 1e9),
        )
        .with_unit("m")
        .with_default("50 (assumed: 24 bits of depth then give steps of 1.2 um at 1 m)"),
        |config, value| config.far_m = value,
        |config| config.far_m,
    ),
    (
        Key::new(
            CONVERGENCE,
            "distance from the head to the point where the optical axes of both eyes meet, or inf for parallel \
                axes",
            KeyValues::Real(0.1, f64::INFINITY),
        )
        .with_unit("m")
        .with_default("inf (assumed: the papers print no angle)"),
        |config, value| config.convergence_m = Some(value).filter(|metres| *metres != f64::INFINITY),
        |config| config.convergence_m.unwrap_or(f64::INFINITY),
    ),
    (
        Key::new(
            LENS,
            "radial distortion of the lens before an eye's picture; only 0 is possible, because the model shows flat \
                pictures without a lens",
            KeyValues::NUMBER,
        )
        .with_default("0 (assumed: the papers' pictures are not distorted)"),
        |config, value| config.lens_distortion = value,
        |config| config.lens_distortion,
    ),
];

const NEAR: &str = "hmd.near";
const FAR: &str = "hmd.far";
const CONVERGENCE: &str = "hmd.convergence";
const LENS: &str = "hmd.lens";

/// Reads the parameters of the head-mounted display. Fails for a pipeline that draws cube faces around the head,
/// because such a display has optics of its own.
pub(super) fn read(file: &ExperimentFile, pipeline: &dyn Pipeline) -> Result<Hmd, SettingError> {
    let mut config = HmdConfig::unc();
    for (key, set, _) in KEYS {
        let (Some(value), Some(setting)) = (file.number(key.name)?, file.get(key.name)) else { continue };
        if pipeline.properties().coverage == Coverage::Surroundings {
            let applies_to = "pipelines that draw a picture for each eye";
            return Err(not_applicable(key.name, pipeline.name(), applies_to).at(&setting.place));
        }
        set(&mut config, value);
    }
    // Only the lens, the convergence and the order of the planes can still be wrong.
    Hmd::new(config).map_err(|error| {
        let (key, expected) = match &*error.name {
            "lens_distortion" => (LENS, error.expected.to_string()),
            "convergence_m" => (CONVERGENCE, "0.1 to 1e6, or inf for parallel axes".to_owned()),
            _ if file.get(FAR).is_some() => (FAR, "a number above hmd.near, at most 1e9".to_owned()),
            _ => (NEAR, format!("a number below hmd.far, {}", config.far_m)),
        };
        file.get(key).map_or(error, |setting| wrong(key, setting, &expected))
    })
}

/// Returns the keys and values of the parameters that differ from the head-mounted display of the papers.
pub(super) fn settings(hmd: &Hmd) -> impl Iterator<Item = (&'static str, Value)> {
    let config = *hmd.config();
    let usual = HmdConfig::unc();
    let changed = KEYS.into_iter().filter(move |(.., get)| get(&config) != get(&usual));
    changed.map(move |(key, _, get)| (key.name, Value::from(get(&config))))
}
