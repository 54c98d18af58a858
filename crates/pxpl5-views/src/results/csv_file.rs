use csv::WriterBuilder;
use serde::Serialize;
use serde_json::Value;

/// Returns a table as CSV: a line of names and a line for each row. Lines end with a line feed. A value with a comma, a
/// quote or a line break is quoted. The text has no comments, so pandas, R and spreadsheets can read it. The origin of
/// the data is in a separate file.
///
/// ```
/// let rows = [["updates_hz", "59.94"], ["a, b", ""]];
/// let text = pxpl5_views::results::csv_table(["quantity", "value"], rows);
/// assert_eq!(text, "quantity,value\nupdates_hz,59.94\n\"a, b\",\n");
/// ```
pub fn csv_table<Row>(columns: impl IntoIterator<Item: AsRef<[u8]>>, rows: impl IntoIterator<Item = Row>) -> String
where
    Row: IntoIterator<Item: AsRef<[u8]>>,
{
    let mut writer = WriterBuilder::new().flexible(true).from_writer(Vec::new());
    // Writing to memory cannot fail, and the writer accepts rows of any length.
    let _ = writer.write_record(columns);
    for row in rows {
        let _ = writer.write_record(row);
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// Returns rows as CSV. The columns are all plain values of the rows by their path in JSON ([`flat`]), and a missing value
/// is an empty cell. Times of the host are left out, so that equal results give equal files.
pub fn csv_of<R: Serialize>(rows: &[R]) -> String {
    let rows: Vec<_> = rows.iter().map(|row| flat(serde_json::to_value(row).unwrap_or_default())).collect();
    let mut columns: Vec<&str> = Vec::new();
    for (name, _) in rows.iter().flatten() {
        if !columns.contains(&name.as_str()) {
            columns.push(name);
        }
    }
    // A missing object is an empty cell in each of its columns, and no column of its own.
    let has_parts =
        |name: &str| columns.iter().any(|other| other.strip_prefix(name).is_some_and(|rest| rest.starts_with('.')));
    let columns: Vec<&str> =
        columns.iter().copied().filter(|name| *name != "host_seconds" && !has_parts(name)).collect();
    let cell = |value: &Value| match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        value => value.to_string(),
    };
    let line = |row: &Vec<(String, Value)>| {
        let of = |column: &&str| {
            row.iter().find(|(name, _)| name == column).map_or_else(String::new, |(_, value)| cell(value))
        };
        columns.iter().map(of).collect::<Vec<_>>()
    };
    csv_table(&columns, rows.iter().map(line))
}

/// Lists with an entry for each field or pixel.
const GROWING: [&str; 2] = ["by_field", "picture"];

/// Returns all plain values within a JSON value by their path. In a path, an object in a list appears by the value of its
/// member `cause` or `kind`, and other entries by their number. Lists that grow with the run are left out.
pub fn flat(value: Value) -> Vec<(String, Value)> {
    let mut row = Vec::new();
    flatten("", value, &mut row);
    row
}

fn flatten(path: &str, value: Value, row: &mut Vec<(String, Value)>) {
    match value {
        Value::Object(inner) => {
            for (key, value) in inner.into_iter().filter(|(key, _)| !GROWING.contains(&key.as_str())) {
                let path = if path.is_empty() { key } else { format!("{path}.{key}") };
                flatten(&path, value, row);
            }
        }
        Value::Array(list) => {
            for (number, mut value) in list.into_iter().enumerate() {
                let name = name_of(&value).unwrap_or_else(|| number.to_string());
                if let Some(object) = value.as_object_mut() {
                    object.retain(|key, _| key != "cause" && key != "kind");
                }
                flatten(&format!("{path}.{name}"), value, row);
            }
        }
        value => row.push((path.to_owned(), value)),
    }
}

/// Returns the name of an object in a list: the value of its member `cause` or `kind`. If `cause` is null, the object
/// holds the interaction of all causes, and the name is `interaction`.
fn name_of(value: &Value) -> Option<String> {
    let object = value.as_object()?;
    match object.get("cause").or_else(|| object.get("kind"))? {
        Value::String(name) => Some(name.clone()),
        Value::Null => Some("interaction".to_owned()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn quotes_are_doubled_within_quotes() {
        let text = csv_table(["a"], [["say \"no\""], ["two\nlines"]]);
        assert_eq!(text, "a\n\"say \"\"no\"\"\"\n\"two\nlines\"\n");
    }

    #[test]
    fn columns_are_the_paths_of_plain_values_and_missing_values_are_empty() {
        let causes = json!([{"cause": "latency", "px": 2.5}, {"cause": null, "px": 0.5}]);
        let rows = [
            json!({"name": "a, b", "error": {"mean": null}, "rates_hz": [60, 15.5], "by_field": [1], "host_seconds": 0.5}),
            json!({"name": "c", "error": null, "causes": causes}),
        ];
        let expected = "name,error.mean,rates_hz.0,rates_hz.1,causes.latency.px,causes.interaction.px\n\"a, b\",,60,15.5,,\nc,,,,2.5,0.5\n";
        assert_eq!(csv_of(&rows), expected);
    }

    #[test]
    fn a_table_without_rows_has_its_column_names() {
        assert_eq!(csv_table(["a", "b"], [] as [[&str; 2]; 0]), "a,b\n");
    }
}
