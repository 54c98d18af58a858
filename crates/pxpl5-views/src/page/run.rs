//! What a page is made of.

use serde_json::Value;

/// One experiment of a page.
#[derive(Clone, Debug, Default)]
pub struct PageRun {
    /// What stands over it.
    pub name: String,
    /// Its report, as in `report.json` (schema `pxpl5-report/2`).
    pub report: Value,
    /// The published value beside the simulated one: `quantity`, `published`, `error_percent`, `source`; null if there is
    /// none.
    pub published: Value,
    /// What the viewer sees at the end, surface by surface.
    pub pictures: Vec<PagePicture>,
    /// Its timeline, as SVG.
    pub timeline: Option<Vec<u8>>,
    /// The latency of each picture after the warm-up, milliseconds; [`latencies_ms`](super::latencies_ms) finds them in `pictures.csv`.
    pub latencies_ms: Vec<f64>,
}

/// A picture of a page.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PagePicture {
    /// Whose picture it is, such as `left eye`.
    pub label: String,
    /// The picture, as PNG.
    pub png: Vec<u8>,
}
