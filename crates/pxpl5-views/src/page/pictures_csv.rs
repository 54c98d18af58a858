//! Reads the values that a page needs from the file `pictures.csv`.

use csv::{ReaderBuilder, StringRecord};

/// Returns the values of the column `latency_ps` in milliseconds, from the rows that are `steady` (after the warm-up).
///
/// Returns an empty list for a file without these columns.
pub fn latencies_ms(pictures_csv: &str) -> Vec<f64> {
    let mut reader = ReaderBuilder::new().flexible(true).from_reader(pictures_csv.as_bytes());
    let Ok(names) = reader.headers().cloned() else { return Vec::new() };
    let Some(latency) = place_of(&names, "latency_ps") else { return Vec::new() };
    let Some(steady) = place_of(&names, "steady") else { return Vec::new() };
    let rows = reader.records().filter_map(Result::ok);
    let steady_rows = rows.filter(|row| row.get(steady) == Some("1"));
    steady_rows.filter_map(|row| milliseconds(row.get(latency)?)).collect()
}

fn place_of(names: &StringRecord, wanted: &str) -> Option<usize> {
    names.iter().position(|name| name == wanted)
}

fn milliseconds(text: &str) -> Option<f64> {
    let ps: u64 = text.parse().ok()?;
    Some(ps as f64 * 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_pictures_after_the_warm_up_are_read() {
        let csv = "picture,steady,latency_ps\n0,0,1\n1,1,2000000000\n2,1,\n3,1,3000000000\n";
        assert_eq!(latencies_ms(csv), [2.0, 3.0]);
        assert!(latencies_ms("nothing").is_empty() && latencies_ms("").is_empty());
    }
}
