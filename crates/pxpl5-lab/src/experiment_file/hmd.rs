//! The head-mounted display of an experiment: its optics and the viewer's eyes.

use super::read::wrong;
use super::{ExperimentFile, FileError};
use pxpl5_run::Pipeline;
use pxpl5_scene::{Hmd, HmdConfig};
use toml::Value;

/// A parameter of the head-mounted display: its key, its explanation, and the functions that set and return its value.
type Number = (&'static str, &'static str, fn(&mut HmdConfig, f64), fn(&HmdConfig) -> f64);

/// Keys of the head-mounted display's parameters, with their explanations.
pub(super) const NUMBERS: [Number; 4] = [
    (
        "hmd.field_of_view",
        "degrees between the left and the right edge of an eye's picture; default 60 (JITP's example, assumed here)",
        |config, value| config.horizontal_fov_deg = value,
        |config| config.horizontal_fov_deg,
    ),
    (
        "hmd.eye_distance",
        "millimetres between the viewer's eyes; default 64 (assumed, mean of adults); the optical axes are parallel",
        |config, value| config.eye_separation_m = value / 1e3,
        |config| config.eye_separation_m * 1e3,
    ),
    (
        "hmd.near",
        "metres from the eye to the plane in front of which nothing is drawn; default 0.05",
        |config, value| config.near_m = value,
        |config| config.near_m,
    ),
    (
        "hmd.far",
        "metres from the eye to the plane behind which nothing is drawn; default 50",
        |config, value| config.far_m = value,
        |config| config.far_m,
    ),
];

/// Reads the parameters of the head-mounted display.
///
/// # Errors
///
/// Fails if a value is out of range. Also fails for a pipeline that draws cube faces around the head, because the
/// optics of such a display are among that display's own parameters.
pub(super) fn read(file: &ExperimentFile, pipeline: &dyn Pipeline) -> Result<Hmd, FileError> {
    let mut config = HmdConfig::unc();
    for (key, _, set, _) in NUMBERS {
        let Some(value) = file.number(key)? else { continue };
        let Some(setting) = file.get(key) else { continue };
        if pipeline.draws_faces() {
            return Err(FileError::NotApplicable {
                place: setting.place.clone(),
                key: key.to_owned(),
                pipeline: pipeline.name(),
                applies_to: "pipelines that draw a picture for each eye".to_owned(),
            });
        }
        set(&mut config, value);
        // Each number is checked alone, so that the error names the key; near and far are checked together below.
        Hmd::new(HmdConfig { far_m: config.far_m.max(config.near_m * 2.0), ..config })
            .map_err(|error| wrong(key, setting, &error.to_string()))?;
    }
    Hmd::new(config).map_err(|error| match file.get("hmd.far").or_else(|| file.get("hmd.near")) {
        Some(setting) => wrong("hmd.far", setting, &error.to_string()),
        None => FileError::Missing { key: "hmd", how: "numbers within their ranges" },
    })
}

/// Returns the parameters that differ from those of the papers' display, with their keys.
pub(super) fn settings(hmd: &Hmd) -> impl Iterator<Item = (&'static str, Value)> {
    let config = *hmd.config();
    let usual = HmdConfig::unc();
    let changed = NUMBERS.into_iter().filter(move |(.., get)| get(&config) != get(&usual));
    changed.map(move |(key, _, _, get)| (key, Value::from(get(&config))))
}
