//! The data from which a page is made.

use serde_json::Value;

/// One experiment on a page.
#[derive(Clone, Debug, Default)]
pub struct PageRun {
    /// Heading of the experiment.
    pub name: String,
    /// Report of the experiment, as in `report.json` (schema `pxpl5-report/3`).
    pub report: Value,
    /// Comparison with a published value: `quantity`, `published`, `error_percent` and `source`. Null if the papers
    /// give no value.
    pub published: Value,
    /// Pictures that the viewer sees at the end of the run, one for each surface.
    pub pictures: Vec<PagePicture>,
    /// Timeline as SVG.
    pub timeline: Option<Vec<u8>>,
    /// Latency of each picture after the warm-up, in milliseconds. [`latencies_ms`](super::latencies_ms) reads these
    /// values from `pictures.csv`.
    pub latencies_ms: Vec<f64>,
}

/// A picture of a page with its label.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PagePicture {
    /// Label of the picture, such as `left eye`.
    pub label: String,
    /// Picture as PNG.
    pub png: Vec<u8>,
}
