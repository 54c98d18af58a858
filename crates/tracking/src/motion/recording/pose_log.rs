//! Columns that are found by their names, in any order, and pose logs as OpenXR programs write them: as CSV or as one
//! JSON object per line.

use pxpl5_sim::parameters::FileError;
use serde_json::Value;

use super::axes::Axes;
use super::columns::{Column, of_line};

/// Names of the time with the decimal places of their unit where the name does not state it. The time of OpenXR counts
/// nanoseconds.
const TIMES: [(&str, i32); 4] = [("predicted_display_time", 9), ("time", 0), ("timestamp", 0), ("t", 0)];

/// Beginnings of the names of x, y and z, and the axes of files with these names.
const POSITIONS: [(&str, Axes); 6] = [
    ("position_", Axes::OpenGl),
    ("pos_", Axes::OpenGl),
    ("p_rs_r_", Axes::Euroc),
    ("t", Axes::Optical),
    ("p", Axes::OpenGl),
    ("", Axes::OpenGl),
];

/// Beginnings of the names of w, x, y and z of the quaternion.
const ORIENTATIONS: [&str; 8] = ["orientation_", "rotation_", "rot_", "quaternion_", "quat_", "q_rs_", "q_", "q"];

/// Units in names with the decimal places that they mean, as in `time_ms` and `x [mm]`.
const UNITS: [(&str, i32); 7] = [("ns", 9), ("us", 6), ("ms", 3), ("s", 0), ("mm", 3), ("cm", 2), ("m", 0)];

/// Parts of the names of a complete header, for errors.
const NAMES: [&str; 8] = [
    "predicted_display_time",
    "position_x",
    "position_y",
    "position_z",
    "orientation_w",
    "orientation_x",
    "orientation_y",
    "orientation_z",
];

/// Returns a column name in lower case with `_` between words: `pose.position.x` and `headPositionX` become
/// `position_x`.
fn normal(name: &str) -> String {
    let mut words = String::new();
    let mut before = '_';
    for letter in name.chars() {
        if letter.is_ascii_uppercase() && before.is_ascii_lowercase() {
            words.push('_');
        }
        words.push(if letter.is_ascii_alphanumeric() { letter.to_ascii_lowercase() } else { '_' });
        before = letter;
    }
    let mut bare = words.trim_matches('_');
    while let Some(rest) = ["pose_", "head_", "hmd_"].iter().find_map(|begin| bare.strip_prefix(begin)) {
        bare = rest;
    }
    bare.to_owned()
}

/// Returns a column name without its unit, and the decimal places of this unit.
fn without_unit(name: &str) -> (String, Option<i32>) {
    let places = |unit: &str| UNITS.iter().find(|(known, _)| *known == unit).map(|(_, places)| *places);
    if let Some((bare, unit)) = name.split_once(['[', '(']) {
        return (normal(bare), places(unit.trim_end_matches([']', ')']).trim()));
    }
    let name = normal(name);
    match name.rsplit_once('_').map(|(bare, unit)| (bare, places(unit))) {
        Some((bare, Some(places))) => (bare.to_owned(), Some(places)),
        _ => (name, None),
    }
}

/// The eight columns of a file whose header names them, and the axes that their names imply.
pub(super) struct Named {
    pub(super) columns: [Column; 8],
    pub(super) axes: Axes,
    /// True if the time counts from the beginning of the run and not from the first line (`time_s`).
    pub(super) counts_from_run: bool,
}

/// Finds the columns of a header by their names. The columns may have any order, among other columns. Returns `None`
/// if the names are unknown.
///
/// # Errors
///
/// Fails if the header belongs to a pose log and lacks a column.
pub(super) fn named(line: u64, header: &[&str]) -> Result<Option<Named>, FileError> {
    let names: Vec<(String, Option<i32>)> = header.iter().map(|name| without_unit(name)).collect();
    let column = |wanted: &str, places: i32| {
        let index = names.iter().position(|(name, _)| name == wanted)?;
        Some(Column {
            index,
            name: header[index].to_owned(),
            places: names[index].1.unwrap_or(places),
            is_negated: false,
        })
    };
    let group = |begin: &str, ends: &[&str]| ends.iter().map(|end| column(&format!("{begin}{end}"), 0)).collect();
    let time = TIMES.iter().find_map(|(name, places)| column(name, *places));
    let position: Option<(Vec<Column>, Axes)> =
        POSITIONS.iter().find_map(|(begin, axes)| Some((group(begin, &["x", "y", "z"])?, *axes)));
    let orientation: Option<Vec<Column>> = ORIENTATIONS.iter().find_map(|begin| group(begin, &["w", "x", "y", "z"]));
    if let (Some(time), Some((position, axes)), Some(orientation)) = (&time, &position, &orientation) {
        let all: Vec<Column> = [time].into_iter().chain(position).chain(orientation).cloned().collect();
        let counts_from_run = *axes == Axes::OpenGl && normal(&time.name) == "time_s";
        let columns = all.try_into().expect("one, three and four columns");
        return Ok(Some(Named { columns, axes: *axes, counts_from_run }));
    }
    // A pose log has the predicted display time, or a part of the position and of the orientation.
    let has = |begin: &str| names.iter().any(|(name, _)| name.starts_with(begin));
    if !(has("predicted_display_time") || has("position_") && has("orientation_")) {
        return Ok(None);
    }
    let is_missing = |name: &&str| match *name {
        "predicted_display_time" => time.is_none(),
        name => column(name, 0).is_none(),
    };
    let missing: Vec<&str> = NAMES.into_iter().filter(|name| is_missing(name)).collect();
    let found = format!("{} without {}", header.join(", "), missing.join(", "));
    Err(of_line(line, "all columns of a pose log", found))
}

/// Returns true if a file has one JSON object per line. Only the first line of the file is checked.
pub(super) fn is_json(first_line: &str) -> bool {
    first_line.starts_with('{')
}

/// Parses a line of JSON. Returns the texts of the eight quantities in the order of [`NAMES`], and the name and unit of
/// the time.
pub(super) fn json_fields(line: u64, text: &str) -> Result<([String; 8], Column), FileError> {
    let unreadable = |found: String| of_line(line, "an object of JSON", found);
    let value: Value = serde_json::from_str(text).map_err(|error| unreadable(error.to_string()))?;
    let mut all = Vec::new();
    flatten("", &value, &mut all);
    let names: Vec<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
    let named = named(line, &names)?;
    let columns = named.ok_or_else(|| of_line(line, "all columns of a pose log", names.join(", ")))?.columns;
    let fields = columns.each_ref().map(|column| all[column.index].1.clone());
    let [time, ..] = columns;
    Ok((fields, time))
}

/// Adds all numbers and texts within a JSON value to `all`, each with its path. The elements of a list are named x, y,
/// z and w, in the order of OpenXR.
fn flatten(path: &str, value: &Value, all: &mut Vec<(String, String)>) {
    let below = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    match value {
        Value::Object(fields) => fields.iter().for_each(|(name, value)| flatten(&below(name), value, all)),
        Value::Array(values) => {
            ["x", "y", "z", "w"].iter().zip(values).for_each(|(name, value)| flatten(&below(name), value, all));
        }
        Value::String(text) => all.push((path.to_owned(), text.clone())),
        other => all.push((path.to_owned(), other.to_string())),
    }
}

pub(super) fn json_columns(time: &Column) -> [Column; 8] {
    std::array::from_fn(|index| Column {
        index,
        name: if index == 0 { time.name.clone() } else { NAMES[index].to_owned() },
        places: if index == 0 { time.places } else { 0 },
        is_negated: false,
    })
}

#[cfg(test)]
mod tests {
    use crate::motion::{Motion, Recording};
    use glam::{DQuat, DVec3};
    use pxpl5_sim::parameters::FileError;

    fn read(text: &str) -> Result<Recording, FileError> {
        Recording::read(text.as_bytes())
    }

    /// A recording in which the head turns left by 90 degrees and moves 2 m to the right, within one second.
    const CSV: &str = "frame,predictedDisplayTime,position.x,position.y,position.z,orientation.x,orientation.y,orientation.z,orientation.w\n\
        7,5000000000,0,1.5,0,0,0,0,1\n8,6000000000,2,1.5,0,0,0.70710678,0,0.70710678\n";

    const JSON: &str = r#"{"predictedDisplayTime": 5000000000, "pose": {"orientation": {"x": 0, "y": 0, "z": 0, "w": 1}, "position": {"x": 0, "y": 1.5, "z": 0}}}

{"predictedDisplayTime": 6000000000, "pose": {"orientation": [0, 0.70710678, 0, 0.70710678], "position": [2, 1.5, 0]}, "valid": true}
"#;

    #[test]
    fn csv_and_json_logs_give_the_same_motion_with_time_from_the_first_line() {
        for text in [CSV, JSON] {
            let recording = read(text).expect("a pose log");
            assert_eq!(recording.span_ps(), (0, 1_000_000_000_000));
            let half = recording.pose(500_000_000_000);
            assert!((half.position - DVec3::new(1.0, 1.5, 0.0)).length() < 1e-12);
            let eighth = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_4);
            assert!(half.orientation.angle_between(eighth) < 1e-6, "{:?}", half.orientation);
        }
    }

    #[test]
    fn the_time_of_a_pose_log_may_have_a_unit_and_the_columns_may_have_any_order() {
        let text = "orientation_w;orientation_x;orientation_y;orientation_z;position_x;position_y;position_z;predicted_display_time_ms\n\
            1;0;0;0;0;0;0;20\n1;0;0;0;1;0;0;30.5\n";
        assert_eq!(read(text).expect("a pose log").span_ps(), (0, 10_500_000_000));
    }

    #[test]
    fn a_log_without_a_column_is_refused_with_the_missing_and_existing_columns() {
        let error = read("predictedDisplayTime,position_x,position_y,roll\n0,0,0,0\n").expect_err("no pose");
        assert_eq!(
            error.to_string(),
            "line 1: expected all columns of a pose log, found predictedDisplayTime, position_x, position_y, roll without \
             position_z, orientation_w, orientation_x, orientation_y, orientation_z"
        );
        let error = read("{\"predictedDisplayTime\": 1, \"yaw\": 2}\n").expect_err("no pose").to_string();
        assert!(error.contains("found predictedDisplayTime, yaw without position_x, position_y"), "{error}");
    }

    #[test]
    fn lines_without_numbers_or_json_are_refused_by_line() {
        let error = read(&JSON.replace("1.5, 0]", "\"up\", 0]")).expect_err("a word").to_string();
        assert!(error.starts_with("line 3, position_y: expected a finite number"), "{error}");
        let error = read(&JSON.replace("[2, 1.5, 0]", "[2, 1.5")).expect_err("an open list").to_string();
        assert!(error.starts_with("line 3: expected an object of JSON"), "{error}");
    }
}
