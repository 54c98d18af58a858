//! Formatting of tables in Markdown and of the numbers in these tables.

/// A column of a table: its heading, and the function that returns the text of a row's cell.
pub type TableColumn<R> = (&'static str, fn(&R) -> String);

/// Formats `rows` as a Markdown table with the headings and cells of `columns`.
pub fn table<'a, R: 'a>(columns: &[TableColumn<R>], rows: impl IntoIterator<Item = &'a R>) -> String {
    let heading = columns.iter().map(|(name, _)| if name.is_empty() { " |".to_owned() } else { format!(" {name} |") });
    let mut text = format!("|{}\n|{}\n", heading.collect::<String>(), "---|".repeat(columns.len()));
    for row in rows {
        let cells = columns.iter().map(|(_, cell)| format!(" {} |", cell(row)));
        text.push_str(&format!("|{}\n", cells.collect::<String>()));
    }
    text
}

/// Formats a number with at least `digits` significant digits and without trailing zeros. A number that is not finite
/// gives "none". A magnitude below a millionth counts as a rounding error and gives 0.
pub fn significant(value: f64, digits: i32) -> String {
    if !value.is_finite() {
        return "none".to_owned();
    }
    if value.abs() < 1e-6 {
        return "0".to_owned();
    }
    // The number of decimals follows from the magnitude.
    let exponent = format!("{value:e}").split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0);
    let decimals = (digits - 1 - exponent).clamp(0, 10) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Replaces each mark `{{name}}` of a text by a value. Ends of lines at the end of a value are left out.
pub fn filled(text: &str, marks: &[(&str, String)]) -> String {
    let filled =
        |text: String, (name, value): &(&str, String)| text.replace(&format!("{{{{{name}}}}}"), value.trim_end());
    marks.iter().fold(text.to_owned(), filled)
}

/// Returns rows of cells as lines of a Markdown table.
pub fn lines<const N: usize>(rows: impl IntoIterator<Item = [String; N]>) -> String {
    rows.into_iter().map(|cells| format!("| {} |\n", cells.join(" | "))).collect()
}

pub fn four(value: f64) -> String {
    significant(value, 4)
}

pub fn range([low, high]: [f64; 2]) -> String {
    format!("{} to {}", four(low), four(high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_significant_digits() {
        let texts = [54.116, 780.0, 1.0, 0.0, 16_800.0, f64::NAN].map(|value| significant(value, 4));
        assert_eq!(texts, ["54.12", "780", "1", "0", "16800", "none"]);
    }

    #[test]
    fn a_table_has_a_heading_and_a_line_for_each_row() {
        let columns: [TableColumn<u32>; 2] = [("", |n| n.to_string()), ("square", |n| (n * n).to_string())];
        assert_eq!(table(&columns, &[3, 4]), "| | square |\n|---|---|\n| 3 | 9 |\n| 4 | 16 |\n");
    }
}
