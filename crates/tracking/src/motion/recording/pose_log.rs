//! Reader of pose logs as OpenXR programs write them: predicted display time, position and orientation, as CSV or as
//! one JSON object per line.

use pxpl5_sim::parameters::FileError;
use serde_json::Value;

use super::columns::{Column, of_line};

/// Column names without units, in the order of a sample: time, x, y, z, qw, qx, qy, qz.
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

/// Suffixes of the names of time columns, with the decimal places of their units. For example, `_ns` has 9 places,
/// because a nanosecond is 10^-9 s. A time column without suffix is in nanoseconds, as an `XrTime` of OpenXR.
const UNITS: [(&str, i32); 4] = [("_ns", 9), ("_us", 6), ("_ms", 3), ("_s", 0)];

const NANOSECONDS: i32 = 9;

/// Returns a column name in lower case with `_` between words: `pose.position.x` and `posePositionX` become
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
    let bare = words.trim_matches('_');
    bare.strip_prefix("pose_").unwrap_or(bare).to_owned()
}

/// Returns the index of a column name in [`NAMES`] and the number of decimal places of the column's unit. Returns
/// `None` for an unknown name.
fn slot(name: &str) -> Option<(usize, i32)> {
    let normal = normal(name);
    if let Some(slot) = NAMES.iter().position(|candidate| *candidate == normal) {
        return Some((slot, if slot == 0 { NANOSECONDS } else { 0 }));
    }
    let unit = UNITS.iter().find(|(unit, _)| normal.strip_suffix(unit) == Some(NAMES[0]));
    unit.map(|(_, places)| (0, *places))
}

/// Returns true if a header belongs to a pose log: it has a predicted display time, or a position and an orientation.
pub(super) fn is_header(header: &[&str]) -> bool {
    let has =
        |begin: &str| header.iter().any(|name| slot(name).is_some_and(|(slot, _)| NAMES[slot].starts_with(begin)));
    has("predicted") || (has("position") && has("orientation"))
}

/// Returns the eight columns of a pose log in the order of [`NAMES`]. The header can contain these columns in any
/// order, among other columns.
pub(super) fn columns(line: u64, header: &[&str]) -> Result<[Column; 8], FileError> {
    let mut found: [Option<Column>; 8] = Default::default();
    for (index, name) in header.iter().enumerate() {
        if let Some((slot, places)) = slot(name)
            && found[slot].is_none()
        {
            found[slot] = Some(Column { index, name: (*name).to_owned(), places });
        }
    }
    let missing: Vec<&str> =
        NAMES.iter().zip(&found).filter(|(_, column)| column.is_none()).map(|(name, _)| *name).collect();
    if !missing.is_empty() {
        let found = format!("{} without {}", header.join(", "), missing.join(", "));
        return Err(of_line(line, "all columns of a pose log", found));
    }
    Ok(found.map(|column| column.expect("none is missing")))
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
    let columns = columns(line, &names)?;
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
