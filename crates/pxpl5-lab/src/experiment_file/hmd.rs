//! The head-mounted display of an experiment: its optics and the viewer's eyes.

use super::ExperimentFile;
use super::read::{not_applicable, wrong};
use pxpl5_run::{Coverage, Pipeline};
use pxpl5_scene::{Hmd, HmdConfig};
use pxpl5_sim::parameters::SettingError;
use toml::Value;

/// A parameter of the head-mounted display: its key, its explanation, and the functions that set and return its value.
type Number = (&'static str, &'static str, fn(&mut HmdConfig, f64), fn(&HmdConfig) -> f64);

/// Key of the distance at which the optical axes meet. Infinity stands for parallel axes.
const CONVERGENCE: &str = "hmd.convergence";

/// Keys of the head-mounted display's parameters, with their explanations.
pub(super) const NUMBERS: [Number; 6] = [
    (
        "hmd.field_of_view",
        "degrees between the left and the right edge of an eye's picture, 1 to 170; default 60 (published in JITP's example, assumed here, sources: 30 to 100)",
        |config, value| config.horizontal_fov_deg = value,
        |config| config.horizontal_fov_deg,
    ),
    (
        "hmd.eye_distance",
        "millimetres between the viewer's eyes, 0 to 1000; default 64 (assumed, mean of adults, sources: 54 to 74)",
        |config, value| config.eye_separation_m = value / 1e3,
        |config| config.eye_separation_m * 1e3,
    ),
    (
        "hmd.near",
        "metres from the eye to the plane in front of which nothing is drawn, 1e-6 to 1e6; default 0.05 (assumed: nearer than a hand)",
        |config, value| config.near_m = value,
        |config| config.near_m,
    ),
    (
        "hmd.far",
        "metres from the eye to the plane behind which nothing is drawn, above hmd.near, at most 1e9; default 50 (assumed: 24 bits of depth then give steps of 1.2 um at 1 m)",
        |config, value| config.far_m = value,
        |config| config.far_m,
    ),
    (
        CONVERGENCE,
        "metres from the head to the point where the optical axes of both eyes meet, 0.1 to 1e6, or inf for parallel axes; default inf (assumed: the papers print no angle)",
        |config, value| config.convergence_m = Some(value).filter(|metres| *metres != f64::INFINITY),
        |config| config.convergence_m.unwrap_or(f64::INFINITY),
    ),
    (
        "hmd.lens",
        "radial distortion of the lens before an eye's picture; only 0 is possible, because the model shows flat pictures without a lens; default 0 (assumed: the papers' pictures are not distorted)",
        |config, value| config.lens_distortion = value,
        |config| config.lens_distortion,
    ),
];

/// Reads the parameters of the head-mounted display.
///
/// # Errors
///
/// Fails if a value is out of range. Also fails for a pipeline that draws cube faces around the head, because the
/// optics of such a display are among that display's own parameters.
pub(super) fn read(file: &ExperimentFile, pipeline: &dyn Pipeline) -> Result<Hmd, SettingError> {
    let mut config = HmdConfig::unc();
    for (key, _, set, _) in NUMBERS {
        let Some(setting) = file.get(key) else { continue };
        let is_parallel = key == CONVERGENCE && setting.value.as_float() == Some(f64::INFINITY);
        let Some(value) = (if is_parallel { Some(f64::INFINITY) } else { file.number(key)? }) else { continue };
        if pipeline.coverage() == Coverage::Surroundings {
            let applies_to = "pipelines that draw a picture for each eye";
            return Err(not_applicable(key, pipeline.name(), applies_to).at(&setting.place));
        }
        set(&mut config, value);
        // Each number is checked alone, so that the error names the key; near and far are checked together below.
        Hmd::new(HmdConfig { far_m: config.far_m.max(config.near_m * 2.0), ..config })
            .map_err(|error| wrong(key, setting, expected(&error)))?;
    }
    Hmd::new(config).map_err(|error| match file.get("hmd.far").or_else(|| file.get("hmd.near")) {
        Some(setting) => wrong("hmd.far", setting, expected(&error)),
        None => SettingError::missing("hmd", "numbers within their ranges"),
    })
}

/// Returns the valid range of a parameter in words, for an error message. Names and units are those of the experiment
/// file.
fn expected(error: &SettingError) -> &str {
    match &*error.name {
        "eye_separation_m" => "0 to 1000, in millimetres",
        "far_m" => "a number above hmd.near, at most 1e9",
        _ => &error.expected,
    }
}

/// Returns the keys and values of the parameters that differ from the head-mounted display of the papers.
pub(super) fn settings(hmd: &Hmd) -> impl Iterator<Item = (&'static str, Value)> {
    let config = *hmd.config();
    let usual = HmdConfig::unc();
    let changed = NUMBERS.into_iter().filter(move |(.., get)| get(&config) != get(&usual));
    changed.map(move |(key, _, _, get)| (key, Value::from(get(&config))))
}
