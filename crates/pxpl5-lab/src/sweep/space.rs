//! The parameter space of a sweep: axes of values, and points by index.

use crate::experiment_file::{ExperimentFile, FileError, Setting};
use std::collections::BTreeMap;
use toml::{Table, Value};

/// Maximum number of points of a sweep. Assumed, because the rows of this number of points fill some gigabytes.
pub const MAX_POINTS: u64 = 10_000_000;

/// An axis of a parameter space: settings that change together, with their values in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Keys of the experiment file that change together.
    pub paths: Vec<String>,
    /// Values of each key along the axis. All lists have the same length.
    pub values: Vec<Values>,
}

impl Axis {
    fn of_one(path: String, values: Values) -> Self {
        Self { paths: vec![path], values: vec![values] }
    }

    /// Returns the number of steps of the axis.
    #[must_use]
    pub fn len(&self) -> u64 {
        self.values.first().map_or(0, Values::len)
    }

    /// Returns true if the axis has no steps. No axis of a [`SweepSpace`] is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the values at a step, counted from 0, with one value for each path.
    #[must_use]
    pub fn step(&self, n: u64) -> Vec<Value> {
        self.values.iter().map(|values| values.at(n)).collect()
    }
}

/// Values of one setting in order. A range stores only three numbers.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Values as listed in the sweep's file.
    Listed(Vec<Value>),
    /// A range of whole numbers.
    Range {
        /// First value of the range.
        from: i64,
        /// Difference between neighbouring values, above 0.
        step: i64,
        /// Number of values in the range.
        count: u64,
    },
}

impl Values {
    /// Returns the number of values.
    #[must_use]
    pub fn len(&self) -> u64 {
        match self {
            Self::Listed(list) => list.len() as u64,
            Self::Range { count, .. } => *count,
        }
    }

    /// Returns true if there are no values.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the value at a step, counted from 0. Steps beyond the end return the last value.
    #[must_use]
    pub fn at(&self, n: u64) -> Value {
        let n = n.min(self.len().saturating_sub(1));
        match self {
            Self::Listed(list) => list[n as usize].clone(),
            Self::Range { from, step, .. } => Value::Integer(from + n as i64 * step),
        }
    }
}

/// All combinations of the steps of all axes. The last axis changes fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepSpace {
    axes: Vec<Axis>,
    points: u64,
}

const KEYS: [&str; 3] = ["grid", "together", "seeds"];

impl SweepSpace {
    pub(super) fn read(file: &ExperimentFile) -> Result<Self, FileError> {
        let how = "a table [sweep.grid] with lists or ranges of settings";
        let setting = file.sweep.as_ref().ok_or(FileError::Missing { key: "sweep", how })?;
        let fault = Fault { sweep: setting, places: &file.sweep_places };
        let table = setting.value.as_table().ok_or_else(|| fault.value("sweep", "a table", &setting.value))?;
        if let Some(key) = table.keys().find(|key| !KEYS.contains(&key.as_str())) {
            let nearest = pxpl5_sim::parameters::nearest(key, KEYS.into_iter()).unwrap_or_default();
            return Err(fault.unknown(&format!("sweep.{key}"), &format!("sweep.{nearest}")));
        }
        // Each setting of the grid is an axis. The lists of `together` form one more axis, the seeds the last.
        let mut axes = Vec::new();
        for (path, values) in leaves(fault.table(table, "grid")?) {
            let values = fault.values(&path, &values)?;
            axes.push(Axis::of_one(path, values));
        }
        axes.extend(fault.together(fault.table(table, "together")?)?);
        axes.extend(fault.seeds(table.get("seeds"))?);
        fault.check(file, &axes)?;
        // Multiply with care: the product of long axes can overflow.
        let points = axes.iter().try_fold(1u64, |all, axis| all.checked_mul(axis.len()));
        let points = points.filter(|points| *points <= MAX_POINTS);
        let points = points.ok_or_else(|| fault.text("sweep", &format!("at most {MAX_POINTS} points"), "more"))?;
        Ok(Self { axes, points })
    }

    /// Returns the axes of the space. The last axis changes fastest from point to point.
    #[must_use]
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Returns the number of points: the product of the axes' numbers of steps.
    #[must_use]
    pub const fn points(&self) -> u64 {
        self.points
    }

    /// Returns the settings that vary in the sweep, with their values at a point.
    #[must_use]
    pub fn settings(&self, point: u64) -> BTreeMap<String, Value> {
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

/// Builder of error messages that state the place of a key in the sweep's file.
struct Fault<'a> {
    sweep: &'a Setting,
    places: &'a BTreeMap<String, String>,
}

impl Fault<'_> {
    /// Returns the place of a key for an error message: its path in the file, or the setting that an axis varies.
    fn place(&self, key: &str) -> String {
        let paths = [key.to_owned(), format!("sweep.grid.{key}"), format!("sweep.together.{key}")];
        paths.iter().find_map(|path| self.places.get(path)).unwrap_or(&self.sweep.place).clone()
    }

    fn text(&self, key: &str, expected: &str, found: &str) -> FileError {
        let place = self.place(key);
        FileError::Value { place, key: key.to_owned(), expected: expected.to_owned(), found: found.to_owned() }
    }

    fn value(&self, key: &str, expected: &str, found: &Value) -> FileError {
        self.text(key, expected, &found.to_string().chars().take(60).collect::<String>())
    }

    fn unknown(&self, found: &str, nearest: &str) -> FileError {
        FileError::UnknownKey { place: self.place(found), found: found.to_owned(), nearest: nearest.to_owned() }
    }

    fn table(&self, table: &Table, key: &str) -> Result<Table, FileError> {
        match table.get(key) {
            None => Ok(Table::new()),
            Some(Value::Table(table)) => Ok(table.clone()),
            Some(other) => Err(self.value(&format!("sweep.{key}"), "a table of settings", other)),
        }
    }

    fn values(&self, path: &str, value: &Value) -> Result<Values, FileError> {
        match value {
            Value::Array(list) if !list.is_empty() => Ok(Values::Listed(list.clone())),
            Value::Table(range) => self.range(path, range),
            other => Err(self.value(path, "a list with values, or { from, to, step }", other)),
        }
    }

    fn range(&self, path: &str, range: &Table) -> Result<Values, FileError> {
        let expected = "whole numbers { from, to, step } with from <= to and step > 0";
        let Some([from, step, last]) = from_step_last(range) else {
            return Err(self.value(path, expected, &Value::Table(range.clone())));
        };
        let count = last as u64 + 1;
        if count > MAX_POINTS {
            return Err(self.text(path, &format!("at most {MAX_POINTS} points"), "more"));
        }
        Ok(Values::Range { from, step, count })
    }

    /// Returns an axis whose lists of values change together. All lists must have the same length.
    fn together(&self, table: Table) -> Result<Option<Axis>, FileError> {
        let mut axis = Axis { paths: Vec::new(), values: Vec::new() };
        for (path, value) in leaves(table) {
            let values = self.values(&path, &value)?;
            let expected = axis.values.first().map_or(values.len(), Values::len);
            // All lists of one axis need the same length.
            if values.len() != expected {
                let expected = format!("{expected} values, as many as the other lists of sweep.together");
                return Err(self.text(&path, &expected, &values.len().to_string()));
            }
            axis.paths.push(path);
            axis.values.push(values);
        }
        Ok(Some(axis).filter(|axis| !axis.paths.is_empty()))
    }

    fn seeds(&self, seeds: Option<&Value>) -> Result<Option<Axis>, FileError> {
        let Some(value) = seeds else { return Ok(None) };
        let Some(count) = value.as_integer().filter(|count| (1..=MAX_POINTS as i64).contains(count)) else {
            return Err(self.value("sweep.seeds", &format!("a number of seeds from 1 to {MAX_POINTS}"), value));
        };
        Ok(Some(Axis::of_one("seed".to_owned(), Values::Range { from: 1, step: 1, count: count as u64 })))
    }

    /// Checks that every path of the axes is a key of the file, and that no two axes set the same key.
    fn check(&self, file: &ExperimentFile, axes: &[Axis]) -> Result<(), FileError> {
        let mut seen = BTreeMap::new();
        if axes.is_empty() {
            return Err(self.text("sweep", "at least one setting under [sweep.grid]", "none"));
        }
        for path in axes.iter().flat_map(|axis| &axis.paths) {
            let key = file.canonical_key(path, &self.place(path))?;
            if seen.insert(key, path).is_some() {
                return Err(self.text(path, "to be in one axis of the sweep", "two"));
            }
        }
        Ok(())
    }
}

/// Parses a range. Returns its first value, its step, and the number of values after the first.
fn from_step_last(range: &Table) -> Option<[i64; 3]> {
    let from = range.get("from")?.as_integer()?;
    let to = range.get("to")?.as_integer()?;
    let step = range.get("step").map_or(Some(1), Value::as_integer)?;
    let known = range.keys().all(|key| ["from", "to", "step"].contains(&key.as_str()));
    let length = to.checked_sub(from).filter(|_| known && from <= to && step > 0)?;
    Some([from, step, length / step])
}

/// Flattens a table into paths and values. A table with the key `from` is a range and stays one value. The key of any
/// other table becomes part of the path.
fn leaves(table: Table) -> Vec<(String, Value)> {
    let mut all = Vec::new();
    for (key, value) in table {
        match value {
            Value::Table(inner) if !inner.contains_key("from") => {
                all.extend(leaves(inner).into_iter().map(|(path, value)| (format!("{key}.{path}"), value)));
            }
            value => all.push((key, value)),
        }
    }
    all
}
