//! The first line of a sweep's rows: everything that is needed to make them again.

use super::{Axis, Sweep, Values};
use crate::experiment_file::{FileError, Plan};
use pxpl5_run::Fingerprint;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// What all rows of a sweep have in common.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Name and version of the layout of header and rows.
    pub schema: String,
    /// Version of the program.
    pub version: String,
    /// Preset of the machine at the first point that is an experiment.
    pub machine: String,
    /// Name of the settings, the space and the quantities.
    pub config_hash: String,
    /// Level of modelling at that point.
    pub level: String,
    /// Seed at that point.
    pub seed: u64,
    /// A line for people.
    pub title: Option<String>,
    /// Number of points of the whole sweep, all shards together.
    pub points: u64,
    /// The quantities measured, and their definitions.
    pub measure: BTreeMap<String, String>,
    /// The settings that all points share.
    pub settings: BTreeMap<String, Value>,
    /// The axes: settings that change together, and the values that they take.
    pub axes: Vec<AxisRecord>,
}

/// An axis as it is written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisRecord {
    /// Keys of the experiment file.
    pub paths: Vec<String>,
    /// What they take.
    #[serde(flatten)]
    pub steps: Steps,
}

/// The steps of an axis as they are written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Steps {
    /// For each step one value per path.
    Steps(Vec<Vec<Value>>),
    /// Of a long axis that consists of ranges: for each path the first value, the distance between two, and their number.
    Ranges(Vec<[i64; 3]>),
}

/// Steps up to which all are written out.
const LISTED_STEPS: u64 = 1_000;

impl Header {
    /// Name and version of the layout.
    pub const SCHEMA: &'static str = "pxpl5-sweep/1";
}

/// Points among which the first experiment is looked for: assumed, some seconds' worth.
const MOST_LOOKED_AT: u64 = 100_000;

impl Sweep {
    /// The header of the sweep's rows.
    ///
    /// # Errors
    ///
    /// [`FileError`] of the first point when no point is an experiment.
    pub fn header(&self) -> Result<Header, FileError> {
        let looked_at = self.space.points().min(MOST_LOOKED_AT);
        let mut points = (0..looked_at).map(|point| self.plan(point));
        let first = points.find_map(Result::ok).map_or_else(|| self.plan(0), Ok)?;
        let axes: Vec<AxisRecord> = self.space.axes().iter().map(record).collect();
        let settings: BTreeMap<String, Value> =
            self.base.settings.iter().map(|(path, setting)| (path.clone(), json(&setting.value))).collect();
        let measure: BTreeMap<String, String> =
            first.measure.iter().map(|m| (m.name().to_owned(), m.definition().to_owned())).collect();
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Ok(Header {
            schema: Header::SCHEMA.to_owned(),
            machine: first.machine.preset.clone(),
            config_hash: hash(&version, &first, &settings, &axes, &self.inputs()).to_string(),
            version,
            level: first.level_name(),
            seed: first.seed,
            title: first.title,
            points: self.space.points(),
            measure,
            settings,
            axes,
        })
    }
}

/// The effective settings of the first point are part of it: a preset may change from version to version. So are the contents of
/// all files that points name.
fn hash(
    version: &str,
    first: &Plan,
    settings: &BTreeMap<String, Value>,
    axes: &[AxisRecord],
    inputs: &BTreeMap<String, Fingerprint>,
) -> Fingerprint {
    let mut hash = Fingerprint::default();
    hash.setting("version", version);
    hash.setting("first", first.fingerprint());
    // Maps are sorted by their keys: equal settings are equal texts.
    settings.iter().for_each(|(path, value)| hash.setting(path, value));
    first.measure.iter().for_each(|measure| hash.setting("measure", measure.name()));
    for axis in axes {
        hash.setting("axis", axis.paths.join(","));
        match &axis.steps {
            Steps::Steps(steps) => steps.iter().for_each(|step| hash.setting("step", Value::from(step.clone()))),
            Steps::Ranges(ranges) => ranges.iter().for_each(|range| hash.setting("range", Value::from(range.to_vec()))),
        }
    }
    inputs.iter().for_each(|(name, contents)| hash.setting("input", format_args!("{name}={contents}")));
    hash
}

fn record(axis: &Axis) -> AxisRecord {
    let paths = axis.paths.clone();
    let ranges: Option<Vec<[i64; 3]>> = axis.values.iter().map(range).collect();
    let steps = match ranges.filter(|_| axis.len() > LISTED_STEPS) {
        Some(ranges) => Steps::Ranges(ranges),
        None => Steps::Steps((0..axis.len()).map(|n| axis.step(n).iter().map(json).collect()).collect()),
    };
    AxisRecord { paths, steps }
}

fn range(values: &Values) -> Option<[i64; 3]> {
    match values {
        Values::Range { from, step, count } => Some([*from, *step, i64::try_from(*count).ok()?]),
        Values::Listed(_) => None,
    }
}

pub(super) fn json(value: &toml::Value) -> Value {
    serde_json::to_value(value).unwrap_or_default()
}
