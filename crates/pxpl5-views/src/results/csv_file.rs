use csv::WriterBuilder;

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_are_doubled_within_quotes() {
        let text = csv_table(["a"], [["say \"no\""], ["two\nlines"]]);
        assert_eq!(text, "a\n\"say \"\"no\"\"\"\n\"two\nlines\"\n");
    }

    #[test]
    fn a_table_without_rows_has_its_column_names() {
        assert_eq!(csv_table(["a", "b"], [] as [[&str; 2]; 0]), "a,b\n");
    }
}
