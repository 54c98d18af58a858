//! Flattens settings of TOML files into pairs of path and value.

use toml::{Table, Value};

/// Formats a TOML value in the syntax of `--set`.
pub(crate) fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Flattens a table into paths and values. A table with the key `from` is a range and stays one value. The key of any
/// other table becomes part of the path.
pub(crate) fn leaves(table: Table) -> Vec<(String, Value)> {
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
