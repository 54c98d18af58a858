//! The header of a sweep's file of rows, with all data that are necessary to repeat the sweep.

use super::{Axis, AxisValues, Sweep, SweepSpace, measures};
use pxpl5_measure::Measure;
use pxpl5_run::Fingerprint;
use pxpl5_sim::parameters::{FileError, FileErrorKind, SettingError};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Data that all rows of a sweep share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Name and version of the JSON layout of header and rows.
    pub schema: String,
    /// Version of the program that wrote the rows.
    pub version: String,
    /// Preset of the machine at the first valid point.
    pub machine: String,
    /// Hash of the settings, the parameter space and the measured quantities.
    pub config_hash: String,
    /// Level of detail at the first valid point.
    pub level: String,
    /// Seed at the first valid point.
    pub seed: u64,
    /// Title of the sweep in one line.
    pub title: Option<String>,
    /// Number of points of the whole sweep, over all shards.
    pub points: u64,
    /// Names of the measured quantities with their definitions.
    pub measure: BTreeMap<String, String>,
    /// Settings that all points share.
    pub settings: BTreeMap<String, Value>,
    /// Axes of the parameter space. An axis is a group of settings that change together, with their values.
    pub axes: Vec<AxisRecord>,
}

/// An axis of the parameter space in the JSON layout.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisRecord {
    /// Keys of the experiment file that change together.
    pub paths: Vec<String>,
    /// Values of the keys at all steps of the axis.
    #[serde(flatten)]
    pub steps: Steps,
}

/// Steps of an axis of the parameter space in the JSON layout.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Steps {
    /// Lists of values: one list for each step, with one value for each path.
    Steps(Vec<Vec<Value>>),
    /// Ranges of a long axis, one for each path: first value, step, and number of values.
    Ranges(Vec<[i64; 3]>),
}

const LISTED_STEPS: u64 = 1_000;

impl Header {
    /// Name and version of the JSON layout.
    pub const SCHEMA: &'static str = "pxpl5-sweep/1";

    /// Returns the header with the hash that identifies the sweep. The hash covers `first`, the effective settings of
    /// the first point, because a preset may change between versions. The hash also covers the names of the measured
    /// quantities in their order, and the contents of all files that points name.
    #[must_use]
    pub fn with_hash<'a>(
        self,
        first: &str,
        measured: impl IntoIterator<Item = &'a str>,
        inputs: &BTreeMap<String, Fingerprint>,
    ) -> Self {
        let mut hash = Fingerprint::default();
        // The version is part of the hash, because results may change between versions.
        hash.setting("version", &self.version);
        hash.setting("first", first);
        // Maps are sorted by their keys, so equal settings give equal texts.
        self.settings.iter().for_each(|(path, value)| hash.setting(path, value));
        measured.into_iter().for_each(|name| hash.setting("measure", name));
        for axis in &self.axes {
            hash.setting("axis", axis.paths.join(","));
            match &axis.steps {
                Steps::Steps(steps) => steps.iter().for_each(|step| hash.setting("step", Value::from(step.clone()))),
                Steps::Ranges(ranges) => {
                    ranges.iter().for_each(|range| hash.setting("range", Value::from(range.to_vec())));
                }
            }
        }
        inputs.iter().for_each(|(name, contents)| hash.setting("input", format_args!("{name}={contents}")));
        Self { config_hash: hash.to_string(), ..self }
    }

    /// Returns an error that names the first difference if the file at `path` has the header of another sweep.
    pub(super) fn check(&self, path: &Path, found: &Self) -> Result<(), FileError> {
        if found == self {
            return Ok(());
        }
        let pairs = [
            ("schema", &self.schema, &found.schema),
            ("version", &self.version, &found.version),
            ("machine", &self.machine, &found.machine),
            ("config_hash", &self.config_hash, &found.config_hash),
        ];
        let differing = pairs.into_iter().find(|(_, expected, found)| expected != found);
        let (what, expected, found) = match differing {
            Some((what, expected, found)) => (what, expected.clone(), found.clone()),
            None => ("title", format!("{:?}", self.title), format!("{:?}", found.title)),
        };
        let reason = format_args!("these are results of another sweep: {what} was {found}, expected {expected}");
        Err(FileError::because(FileErrorKind::Occupied, reason).in_file(path.display()))
    }
}

/// Maximum number of points in the search for the first valid point. Assumed: some seconds of work.
const MAX_POINTS_SEARCHED: u64 = 100_000;

impl Sweep {
    /// Returns the header of the sweep's rows.
    ///
    /// # Errors
    ///
    /// Returns the [`SettingError`] of the first point if no point is valid.
    pub fn header(&self) -> Result<Header, SettingError> {
        // The header describes the first valid point.
        let searched = self.space.points().min(MAX_POINTS_SEARCHED);
        let mut points = (0..searched).map(|point| self.plan(point));
        let first = points.find_map(Result::ok).map_or_else(|| self.plan(0), Ok)?;
        let measured = measures(&first);
        let fingerprint = first.fingerprint().to_string();
        let header = Header {
            schema: Header::SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            config_hash: String::new(),
            level: first.level_name(),
            seed: first.seed,
            points: self.space.points(),
            measure: measured.iter().map(|m| (m.name().to_owned(), m.definition().to_owned())).collect(),
            settings: self.base.settings.iter().map(|(path, setting)| (path.clone(), json(&setting.value))).collect(),
            axes: self.space.records(),
            machine: first.machine.preset,
            title: first.title,
        };
        Ok(header.with_hash(&fingerprint, measured.iter().map(Measure::name), &self.inputs()))
    }
}

impl SweepSpace {
    /// Returns the axes in the JSON layout of a header.
    pub fn records(&self) -> Vec<AxisRecord> {
        self.axes().iter().map(record).collect()
    }
}

fn record(axis: &Axis) -> AxisRecord {
    let paths = axis.paths.clone();
    // Long ranges are written as three numbers, so that the header stays short.
    let ranges: Option<Vec<[i64; 3]>> = axis.values.iter().map(range).collect();
    let steps = match ranges.filter(|_| axis.len() > LISTED_STEPS) {
        Some(ranges) => Steps::Ranges(ranges),
        None => Steps::Steps((0..axis.len()).map(|n| axis.step(n).iter().map(json).collect()).collect()),
    };
    AxisRecord { paths, steps }
}

fn range(values: &AxisValues) -> Option<[i64; 3]> {
    match values {
        AxisValues::Range { from, step, count } => Some([*from, *step, i64::try_from(*count).ok()?]),
        AxisValues::Listed(_) => None,
    }
}

pub(super) fn json(value: &toml::Value) -> Value {
    serde_json::to_value(value).unwrap_or_default()
}
