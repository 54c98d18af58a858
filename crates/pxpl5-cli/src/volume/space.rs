//! The file of a sweep of volumes: settings that all points share, and the axes of the settings that change.

use crate::error::CliError;
use crate::leaves::{leaves, plain};
use pxpl5::sweep::{Axis, MAX_POINTS, Values};
use pxpl5::volume::VolumeSettings;
use pxpl5_sim::parameters::text_of;
use std::collections::BTreeMap;
use std::path::Path;
use toml::{Table, Value};

/// Keys of the file that are not settings of a volume.
const OWN: [&str; 5] = ["title", "scene", "triangles", "measure", "sweep"];

/// Quantities of a volume that are measured by default.
const MEASURED: [&str; 6] = [
    "fragments_accepted",
    "tile_occupancy_percent",
    "lit_voxels",
    "connected_percent",
    "volumes_hz_serial",
    "volumes_hz_overlapped",
];

/// A sweep of volumes: shared settings, axes and measured quantities, as its file describes them.
#[derive(Clone, Debug)]
pub(super) struct VolumeSpace {
    pub(super) title: Option<String>,
    /// Paths of the measured quantities in the JSON report.
    pub(super) measure: Vec<String>,
    /// Settings that all points share, including `scene` and `triangles`.
    pub(super) settings: BTreeMap<String, Value>,
    /// Axes of the sweep. The last axis changes fastest.
    pub(super) axes: Vec<Axis>,
    pub(super) points: u64,
}

impl VolumeSpace {
    /// Reads a file. `sets` are settings of the command line, which override settings of the file.
    pub(super) fn load(path: &Path, sets: &[String]) -> Result<Self, CliError> {
        let place = path.display().to_string();
        let bytes =
            std::fs::read(path).map_err(|error| CliError::failure(format!("{place}: cannot be read: {error}")))?;
        let text = text_of(&bytes).map_err(|error| CliError::usage(format!("{place}: {error}")))?;
        let file: Table = toml::from_str(text).map_err(|error| CliError::usage(format!("{place}: {error}")))?;
        Self::read(file, sets, &place)
    }

    fn read(mut file: Table, sets: &[String], place: &str) -> Result<Self, CliError> {
        let title = file.remove("title").map(|title| plain(&title));
        let measure = measure(file.remove("measure"), place)?;
        let sweep = match file.remove("sweep") {
            Some(Value::Table(sweep)) => sweep,
            _ => return Err(wrong(place, "sweep", "a table [sweep.grid] with lists or ranges of settings", "none")),
        };
        let mut settings: BTreeMap<String, Value> = leaves(file).into_iter().collect();
        // Settings of the command line override the file.
        for assignment in sets {
            let (path, value) =
                assignment.split_once('=').ok_or_else(|| wrong("--set", "PATH=VALUE", "an equals sign", assignment))?;
            settings.insert(path.trim().to_owned(), Value::from(value.trim()));
        }
        let axes = axes(sweep, place)?;
        // Every path must exist before any volume is drawn.
        for path in settings.keys().chain(axes.iter().flat_map(|axis| &axis.paths)) {
            check_path(path, place)?;
        }
        // Multiply with care: the product of long axes can overflow.
        let points = axes.iter().try_fold(1u64, |all, axis| all.checked_mul(axis.len()));
        let points = points.filter(|points| *points <= MAX_POINTS);
        let points = points.ok_or_else(|| wrong(place, "sweep", &format!("at most {MAX_POINTS} points"), "more"))?;
        Ok(Self { title, measure, settings, axes, points })
    }

    /// Returns the settings that vary in the sweep, with their values at point `point` of the parameter space.
    pub(super) fn of_point(&self, point: u64) -> BTreeMap<String, Value> {
        let mut rest = point;
        let mut settings = BTreeMap::new();
        // The number of the point has one mixed-radix digit for each axis, the last axis lowest.
        for axis in self.axes.iter().rev() {
            let step = axis.step(rest % axis.len());
            rest /= axis.len();
            settings.extend(axis.paths.iter().cloned().zip(step));
        }
        settings
    }
}

fn wrong(place: &str, key: &str, expected: &str, found: &str) -> CliError {
    CliError::usage(format!("{place}: {key}: expected {expected}, found {found}"))
}

fn measure(value: Option<Value>, place: &str) -> Result<Vec<String>, CliError> {
    let Some(value) = value else { return Ok(MEASURED.map(str::to_owned).to_vec()) };
    let names = value.as_array().and_then(|list| list.iter().map(|name| name.as_str().map(str::to_owned)).collect());
    names
        .filter(|names: &Vec<String>| !names.is_empty())
        .ok_or_else(|| wrong(place, "measure", "a list of names of the report's numbers", &value.to_string()))
}

fn check_path(path: &str, place: &str) -> Result<(), CliError> {
    let keys = VolumeSettings::paper().keys();
    if keys.iter().any(|key| key == path) || ["scene", "triangles"].contains(&path) {
        return Ok(());
    }
    let is_near = |key: &&String| key.split('.').next() == path.split('.').next();
    let near: Vec<&str> = keys.iter().filter(is_near).map(String::as_str).chain(OWN).collect();
    Err(CliError::usage(format!("{place}: there is no key `{path}`; expected one of {}", near.join(", "))))
}

fn axes(mut sweep: Table, place: &str) -> Result<Vec<Axis>, CliError> {
    let mut axes = Vec::new();
    // Each setting of the grid is an axis; all lists of `together` form one axis and must have equal lengths.
    for (path, value) in leaves(table(&mut sweep, "grid", place)?) {
        axes.push(Axis { values: vec![values(&path, &value, place)?], paths: vec![path] });
    }
    let mut together = Axis { paths: Vec::new(), values: Vec::new() };
    for (path, value) in leaves(table(&mut sweep, "together", place)?) {
        let values = values(&path, &value, place)?;
        let expected = together.values.first().map_or(values.len(), Values::len);
        if values.len() != expected {
            let expected = format!("{expected} values, as many as the other lists of sweep.together");
            return Err(wrong(place, &path, &expected, &values.len().to_string()));
        }
        together.paths.push(path);
        together.values.push(values);
    }
    axes.extend(Some(together).filter(|axis| !axis.paths.is_empty()));
    if let Some(seeds) = sweep.remove("seeds") {
        let count = seeds.as_integer().and_then(|count| u64::try_from(count).ok()).filter(|count| *count > 0);
        let count =
            count.ok_or_else(|| wrong(place, "sweep.seeds", "a number of seeds from 1 on", &seeds.to_string()))?;
        axes.push(Axis { paths: vec!["seed".to_owned()], values: vec![Values::Range { from: 1, step: 1, count }] });
    }
    if let Some(key) = sweep.keys().next() {
        return Err(wrong(
            place,
            &format!("sweep.{key}"),
            "one of sweep.grid, sweep.together, sweep.seeds",
            "another key",
        ));
    }
    check_axes(&axes, place)?;
    Ok(axes)
}

fn check_axes(axes: &[Axis], place: &str) -> Result<(), CliError> {
    if axes.is_empty() {
        return Err(wrong(place, "sweep", "at least one setting under [sweep.grid]", "none"));
    }
    let mut paths: Vec<&String> = axes.iter().flat_map(|axis| &axis.paths).collect();
    paths.sort();
    match paths.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(wrong(place, pair[0], "to be in one axis of the sweep", "two")),
        None => Ok(()),
    }
}

fn table(sweep: &mut Table, key: &str, place: &str) -> Result<Table, CliError> {
    match sweep.remove(key) {
        None => Ok(Table::new()),
        Some(Value::Table(table)) => Ok(table),
        Some(other) => Err(wrong(place, &format!("sweep.{key}"), "a table of settings", &other.to_string())),
    }
}

/// Parses the values of an axis: a list, or a range of whole numbers.
fn values(path: &str, value: &Value, place: &str) -> Result<Values, CliError> {
    match value {
        Value::Array(list) if !list.is_empty() => Ok(Values::Listed(list.clone())),
        Value::Table(range) => {
            let whole = |key: &str| range.get(key).and_then(Value::as_integer);
            let step = range.get("step").map_or(Some(1), Value::as_integer).filter(|step| *step > 0);
            let known = range.keys().all(|key| ["from", "to", "step"].contains(&key.as_str()));
            // A range that ends before its beginning is refused.
            let length = whole("to").zip(whole("from")).and_then(|(to, from)| to.checked_sub(from));
            match (whole("from"), step, length.filter(|length| known && *length >= 0)) {
                (Some(from), Some(step), Some(length)) => {
                    Ok(Values::Range { from, step, count: (length / step) as u64 + 1 })
                }
                _ => Err(wrong(
                    place,
                    path,
                    "whole numbers { from, to, step } with from <= to and step > 0",
                    &value.to_string(),
                )),
            }
        }
        other => Err(wrong(place, path, "a list with values, or { from, to, step }", &other.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_range_is_reported_with_the_file_first_and_then_the_key() {
        let range: Value = toml::from_str("from = 4\nto = 1\n").map(Value::Table).expect("TOML");
        let error = values("display.slices", &range, "volumes.toml").expect_err("from is above to");
        assert!(error.message().starts_with("volumes.toml: display.slices: expected whole numbers"), "{error:?}");
    }
}
