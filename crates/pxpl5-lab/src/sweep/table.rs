use super::{Header, Status, SweepRow};

/// Table of comma-separated values. Its columns are the settings that differ between points, and the measured
/// quantities.
#[derive(Debug)]
pub(super) struct Table<'a> {
    parameters: Vec<&'a str>,
    measured: Vec<&'a str>,
}

impl<'a> Table<'a> {
    pub(super) fn of(header: &'a Header) -> Self {
        Self {
            parameters: header.axes.iter().flat_map(|axis| &axis.paths).map(String::as_str).collect(),
            measured: header.measure.keys().map(String::as_str).collect(),
        }
    }

    /// Returns the line of column names. Settings that all points share are not columns, because the header of
    /// `rows.jsonl` holds them.
    pub(super) fn head(&self) -> Vec<u8> {
        let settings = self.parameters.iter().chain(&self.measured).copied();
        let columns = ["point", "status"].into_iter().chain(settings).chain(["trace_hash", "error"]);
        line_of_cells(columns.map(str::to_owned))
    }

    pub(super) fn line(&self, row: &SweepRow) -> Vec<u8> {
        let status = if row.status == Status::Done { "done" } else { "failed" };
        let settings = self.parameters.iter().map(|path| row.parameters.get(*path).map_or_else(String::new, plain));
        let values = self.measured.iter().map(|name| row.value_text(name));
        let cells = [row.point.to_string(), status.to_owned()].into_iter().chain(settings);
        let last = [row.trace_hash.clone().unwrap_or_default(), row.error.clone().unwrap_or_default()];
        line_of_cells(cells.chain(values).chain(last))
    }
}

impl SweepRow {
    /// Returns the value of a quantity as text. The text is empty if the run does not define the quantity.
    fn value_text(&self, name: &str) -> String {
        self.measured.get(name).copied().flatten().map_or_else(String::new, |value| value.to_string())
    }
}

fn plain(value: &serde_json::Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

fn line_of_cells(cells: impl Iterator<Item = String>) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let _ = writer.write_record(cells);
    writer.into_inner().unwrap_or_default()
}
