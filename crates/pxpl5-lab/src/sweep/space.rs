//! The space of settings: axes of values, and its points by number.

use crate::experiment_file::{ExperimentFile, FileError, Setting};
use std::collections::BTreeMap;
use toml::{Table, Value};

/// Most points of a sweep: assumed, what a folder of rows can hold (some gigabytes).
pub const MAX_POINTS: u64 = 10_000_000;

/// Settings that change together, and their values in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Keys of the experiment file.
    pub paths: Vec<String>,
    /// For each step one value per path.
    pub steps: Vec<Vec<Value>>,
}

/// All combinations of the steps of all axes; the last axis changes fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Space {
    axes: Vec<Axis>,
    points: u64,
}

const KEYS: [&str; 3] = ["grid", "together", "seeds"];

impl Space {
    pub(super) fn read(file: &ExperimentFile) -> Result<Self, FileError> {
        let how = "a table [sweep.grid] with lists or ranges of settings";
        let setting = file.sweep.as_ref().ok_or(FileError::Missing { key: "sweep", how })?;
        let fault = Fault(setting);
        let table = setting.value.as_table().ok_or_else(|| fault.value("sweep", "a table", &setting.value))?;
        if let Some(key) = table.keys().find(|key| !KEYS.contains(&key.as_str())) {
            let nearest = parameters::nearest(key, KEYS.into_iter()).unwrap_or_default();
            return Err(fault.unknown(&format!("sweep.{key}"), &format!("sweep.{nearest}")));
        }
        let mut axes = Vec::new();
        for (path, values) in leaves(fault.table(table, "grid")?) {
            let steps = fault.values(&path, &values)?;
            axes.push(Axis { paths: vec![path], steps: steps.into_iter().map(|value| vec![value]).collect() });
        }
        axes.extend(fault.together(fault.table(table, "together")?)?);
        axes.extend(fault.seeds(table.get("seeds"))?);
        fault.check(file, &axes)?;
        let points = axes.iter().try_fold(1u64, |all, axis| all.checked_mul(axis.steps.len() as u64));
        let points = points.filter(|points| *points <= MAX_POINTS);
        let points = points.ok_or_else(|| fault.text("sweep", &format!("at most {MAX_POINTS} points"), "more"))?;
        Ok(Self { axes, points })
    }

    /// The axes, of which the last one changes fastest.
    #[must_use]
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The number of points.
    #[must_use]
    pub const fn points(&self) -> u64 {
        self.points
    }

    /// The settings of a point.
    #[must_use]
    pub fn settings(&self, point: u64) -> BTreeMap<String, Value> {
        let mut rest = point;
        let mut settings = BTreeMap::new();
        for axis in self.axes.iter().rev() {
            let steps = axis.steps.len() as u64;
            let step = &axis.steps[(rest % steps) as usize];
            rest /= steps;
            settings.extend(axis.paths.iter().cloned().zip(step.iter().cloned()));
        }
        settings
    }
}

/// Makes errors that point to the sweep's place in the file.
struct Fault<'a>(&'a Setting);

impl Fault<'_> {
    fn text(&self, key: &str, expected: &str, found: &str) -> FileError {
        let place = self.0.place.clone();
        FileError::Value { place, key: key.to_owned(), expected: expected.to_owned(), found: found.to_owned() }
    }

    fn value(&self, key: &str, expected: &str, found: &Value) -> FileError {
        self.text(key, expected, &found.to_string().chars().take(60).collect::<String>())
    }

    fn unknown(&self, found: &str, nearest: &str) -> FileError {
        FileError::UnknownKey { place: self.0.place.clone(), found: found.to_owned(), nearest: nearest.to_owned() }
    }

    fn table(&self, table: &Table, key: &str) -> Result<Table, FileError> {
        match table.get(key) {
            None => Ok(Table::new()),
            Some(Value::Table(table)) => Ok(table.clone()),
            Some(other) => Err(self.value(&format!("sweep.{key}"), "a table of settings", other)),
        }
    }

    fn values(&self, path: &str, value: &Value) -> Result<Vec<Value>, FileError> {
        match value {
            Value::Array(list) if !list.is_empty() => Ok(list.clone()),
            Value::Table(range) => self.range(path, range),
            other => Err(self.value(path, "a list with values, or { from, to, step }", other)),
        }
    }

    fn range(&self, path: &str, range: &Table) -> Result<Vec<Value>, FileError> {
        let expected = "whole numbers { from, to, step } with from <= to and step > 0";
        let Some([from, step, count]) = from_step_count(range) else {
            return Err(self.value(path, expected, &Value::Table(range.clone())));
        };
        if count as u64 >= MAX_POINTS {
            return Err(self.text(path, &format!("at most {MAX_POINTS} points"), "more"));
        }
        Ok((0..=count).map(|n| Value::Integer(from + n * step)).collect())
    }

    /// Lists of the same length, taken in step.
    fn together(&self, table: Table) -> Result<Option<Axis>, FileError> {
        let lists: Vec<(String, Vec<Value>)> = leaves(table)
            .into_iter()
            .map(|(path, v)| Ok((path.clone(), self.values(&path, &v)?)))
            .collect::<Result<_, FileError>>()?;
        let Some((_, first)) = lists.first() else { return Ok(None) };
        let length = first.len();
        if let Some((path, list)) = lists.iter().find(|(_, list)| list.len() != length) {
            let expected = format!("{length} values, as many as the other lists of sweep.together");
            return Err(self.text(path, &expected, &list.len().to_string()));
        }
        let steps = (0..length).map(|n| lists.iter().map(|(_, list)| list[n].clone()).collect()).collect();
        Ok(Some(Axis { paths: lists.into_iter().map(|(path, _)| path).collect(), steps }))
    }

    fn seeds(&self, seeds: Option<&Value>) -> Result<Option<Axis>, FileError> {
        let Some(value) = seeds else { return Ok(None) };
        let Some(count) = value.as_integer().filter(|count| (1..=MAX_POINTS as i64).contains(count)) else {
            return Err(self.value("sweep.seeds", &format!("a number of seeds from 1 to {MAX_POINTS}"), value));
        };
        let steps = (1..=count).map(|seed| vec![Value::Integer(seed)]).collect();
        Ok(Some(Axis { paths: vec!["seed".to_owned()], steps }))
    }

    /// Every path is a key, and no two axes set the same.
    fn check(&self, file: &ExperimentFile, axes: &[Axis]) -> Result<(), FileError> {
        let mut seen = BTreeMap::new();
        if axes.is_empty() {
            return Err(self.text("sweep", "at least one setting under [sweep.grid]", "none"));
        }
        for path in axes.iter().flat_map(|axis| &axis.paths) {
            let key = file.canonical_key(path, &self.0.place)?;
            if seen.insert(key, path).is_some() {
                return Err(self.text(path, "to be in one axis of the sweep", "two"));
            }
        }
        Ok(())
    }
}

/// The first value of a range, the distance between two of them, and how many come behind the first.
fn from_step_count(range: &Table) -> Option<[i64; 3]> {
    let from = range.get("from")?.as_integer()?;
    let to = range.get("to")?.as_integer()?;
    let step = range.get("step").map_or(Some(1), Value::as_integer)?;
    let known = range.keys().all(|key| ["from", "to", "step"].contains(&key.as_str()));
    let length = to.checked_sub(from).filter(|_| known && from <= to && step > 0)?;
    Some([from, step, length / step])
}

/// Paths and values; a table with `from` is a range, any other one part of the path.
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
