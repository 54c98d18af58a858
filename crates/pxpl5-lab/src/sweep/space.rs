//! The parameter space of a sweep: axes of values, and the combinations of values (points) by index.

use pxpl5_sim::parameters::SettingError;
use std::collections::BTreeMap;
use toml::{Table, Value};

/// Maximum number of points of a sweep. Assumed: the rows of so many points fill some gigabytes.
pub const MAX_POINTS: u64 = 10_000_000;

/// An axis of a parameter space: settings that change together, with their values in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Keys of the experiment file that change together.
    pub paths: Vec<String>,
    /// Values of each key along the axis. All lists have the same length.
    pub values: Vec<AxisValues>,
}

impl Axis {
    fn of_one(path: String, values: AxisValues) -> Self {
        Self { paths: vec![path], values: vec![values] }
    }

    /// Returns the number of steps of the axis.
    pub fn len(&self) -> u64 {
        self.values.first().map_or(0, AxisValues::len)
    }

    /// Returns true if the axis has no steps. No axis of a [`SweepSpace`] is empty.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the values at a step, counted from 0, with one value for each path.
    pub fn step(&self, n: u64) -> Vec<Value> {
        self.values.iter().map(|values| values.at(n)).collect()
    }
}

/// Values of one setting along an axis, in order. A range stores only three numbers.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisValues {
    /// A list of values, as written in the sweep's file.
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

impl AxisValues {
    /// Returns the number of values along the axis.
    pub fn len(&self) -> u64 {
        match self {
            Self::Listed(list) => list.len() as u64,
            Self::Range { count, .. } => *count,
        }
    }

    /// Returns true if the axis has no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the value at a step, counted from 0. Steps beyond the end return the last value.
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
    /// Reads the table `sweep` of a file. `place` is the file and line of the table for error messages. `places` has
    /// the file and line of its keys, if known. `key_of` gets a key with its file and line, and returns the full key.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] if the table is missing or invalid, and the error of `key_of`.
    pub fn read(
        sweep: Option<&Value>,
        (place, places): (&str, &BTreeMap<String, String>),
        key_of: impl Fn(&str, &str) -> Result<String, SettingError>,
    ) -> Result<Self, SettingError> {
        let how = "a table [sweep.grid] with lists or ranges of settings";
        let sweep = sweep.ok_or_else(|| SettingError::missing("sweep", how))?;
        let fault = Fault { sweep: place, places };
        let table = sweep.as_table().ok_or_else(|| fault.value("sweep", "a table", sweep))?;
        if let Some(key) = table.keys().find(|key| !KEYS.contains(&key.as_str())) {
            let found = format!("sweep.{key}");
            let valid = KEYS.map(|key| format!("sweep.{key}"));
            return Err(SettingError::unknown_path("key", &found, valid).at(fault.place(&found)));
        }
        // Each setting of the grid is an axis. The lists of `together` form one more axis, the seeds the last.
        let mut axes = Vec::new();
        for (path, values) in leaves(fault.table(table, "grid")?) {
            let values = fault.values(&path, &values)?;
            axes.push(Axis::of_one(path, values));
        }
        axes.extend(fault.together(fault.table(table, "together")?)?);
        axes.extend(fault.seeds(table.get("seeds"))?);
        fault.check(&axes, key_of)?;
        // The multiplication checks for overflow, because the product of long axes can be too large.
        let points = axes.iter().try_fold(1u64, |all, axis| all.checked_mul(axis.len()));
        let points = points.filter(|points| *points <= MAX_POINTS);
        let points = points.ok_or_else(|| fault.text("sweep", &format!("at most {MAX_POINTS} points"), "more"))?;
        Ok(Self { axes, points })
    }

    /// Returns the values that the sweep's file lists for a key.
    pub fn listed(&self, key: &str) -> impl Iterator<Item = &Value> {
        let values = self.axes.iter().flat_map(|axis| axis.paths.iter().zip(&axis.values));
        let lists = values.filter(move |(path, _)| *path == key).map(|(_, values)| match values {
            AxisValues::Listed(list) => list.as_slice(),
            AxisValues::Range { .. } => &[],
        });
        lists.flatten()
    }

    /// Returns the axes of the space. The last axis changes fastest from point to point.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Returns the number of points: the product of the numbers of steps of all axes.
    pub const fn points(&self) -> u64 {
        self.points
    }

    /// Returns the varied settings with their values at a point.
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

struct Fault<'a> {
    sweep: &'a str,
    places: &'a BTreeMap<String, String>,
}

impl Fault<'_> {
    /// Returns the file and line of a key, or of the table `sweep` if the line of the key is unknown.
    fn place(&self, key: &str) -> String {
        let paths = [key.to_owned(), format!("sweep.grid.{key}"), format!("sweep.together.{key}")];
        paths.iter().find_map(|path| self.places.get(path)).map_or(self.sweep, String::as_str).to_owned()
    }

    fn text(&self, key: &str, expected: &str, found: &str) -> SettingError {
        SettingError::value(key, expected, found).at(self.place(key))
    }

    fn value(&self, key: &str, expected: &str, found: &Value) -> SettingError {
        self.text(key, expected, &found.to_string().chars().take(60).collect::<String>())
    }

    fn table(&self, table: &Table, key: &str) -> Result<Table, SettingError> {
        match table.get(key) {
            None => Ok(Table::new()),
            Some(Value::Table(table)) => Ok(table.clone()),
            Some(other) => Err(self.value(&format!("sweep.{key}"), "a table of settings", other)),
        }
    }

    fn values(&self, path: &str, value: &Value) -> Result<AxisValues, SettingError> {
        match value {
            Value::Array(list) if !list.is_empty() => Ok(AxisValues::Listed(list.clone())),
            Value::Table(range) => self.range(path, range),
            other => Err(self.value(path, "a list with values, or { from, to, step }", other)),
        }
    }

    fn range(&self, path: &str, range: &Table) -> Result<AxisValues, SettingError> {
        let expected = "whole numbers { from, to, step } with from <= to and step > 0";
        let Some([from, step, last]) = from_step_last(range) else {
            return Err(self.value(path, expected, &Value::Table(range.clone())));
        };
        let count = last as u64 + 1;
        if count > MAX_POINTS {
            return Err(self.text(path, &format!("at most {MAX_POINTS} points"), "more"));
        }
        Ok(AxisValues::Range { from, step, count })
    }

    /// Returns the axis of the table `together`, whose settings change together. All settings must have the same number
    /// of values.
    fn together(&self, table: Table) -> Result<Option<Axis>, SettingError> {
        let mut axis = Axis { paths: Vec::new(), values: Vec::new() };
        for (path, value) in leaves(table) {
            let values = self.values(&path, &value)?;
            let expected = axis.values.first().map_or(values.len(), AxisValues::len);
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

    fn seeds(&self, seeds: Option<&Value>) -> Result<Option<Axis>, SettingError> {
        let Some(value) = seeds else { return Ok(None) };
        let Some(count) = value.as_integer().filter(|count| (1..=MAX_POINTS as i64).contains(count)) else {
            return Err(self.value("sweep.seeds", &format!("a number of seeds from 1 to {MAX_POINTS}"), value));
        };
        Ok(Some(Axis::of_one("seed".to_owned(), AxisValues::Range { from: 1, step: 1, count: count as u64 })))
    }

    /// Checks the settings that the axes vary. Each setting must be a valid key, and no key may occur twice.
    fn check(
        &self,
        axes: &[Axis],
        key_of: impl Fn(&str, &str) -> Result<String, SettingError>,
    ) -> Result<(), SettingError> {
        let mut seen = BTreeMap::new();
        if axes.is_empty() {
            return Err(self.text("sweep", "at least one setting under [sweep.grid]", "none"));
        }
        for path in axes.iter().flat_map(|axis| &axis.paths) {
            let key = key_of(path, &self.place(path))?;
            if seen.insert(key, path).is_some() {
                return Err(self.text(path, "to be in one axis of the sweep", "two"));
            }
        }
        Ok(())
    }
}

/// Parses a range with the keys `from`, `to` and `step`. Returns the first value, the step, and the number of values
/// after the first.
fn from_step_last(range: &Table) -> Option<[i64; 3]> {
    let from = range.get("from")?.as_integer()?;
    let to = range.get("to")?.as_integer()?;
    let step = range.get("step").map_or(Some(1), Value::as_integer)?;
    let is_range = range.keys().all(|key| ["from", "to", "step"].contains(&key.as_str()));
    let length = to.checked_sub(from).filter(|_| is_range && from <= to && step > 0)?;
    Some([from, step, length / step])
}

/// Flattens a table into paths and values. A table with the key `from` is a range and stays one value. The key of any
/// other table becomes part of the path.
pub fn leaves(table: Table) -> Vec<(String, Value)> {
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
