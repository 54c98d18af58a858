//! Results as one page of HTML that needs no network, fits a phone and can be printed.
//!
//! A page is made of what a results folder holds ([`PageRun`]), so a run of any version whose report has the same schema
//! can stand on it; where something is missing, it is left out.

mod configuration;
mod html;
mod latency;
mod pictures_csv;
mod section;
mod summary;
mod values;

pub use html::html;
pub use pictures_csv::latencies_ms;

use serde_json::Value;

/// One experiment of a page.
#[derive(Clone, Debug, Default)]
pub struct PageRun {
    /// What stands over it.
    pub name: String,
    /// Its report, as in `report.json` (schema `pxpl5-report/1`).
    pub report: Value,
    /// The published value beside the simulated one: `quantity`, `published`, `error_percent`, `source`; null if there is
    /// none.
    pub published: Value,
    /// What the viewer sees at the end, surface by surface.
    pub pictures: Vec<PagePicture>,
    /// Its timeline, as SVG.
    pub timeline: Option<Vec<u8>>,
    /// The latency of each picture after the warm-up, milliseconds; [`latencies_ms`] finds them in `pictures.csv`.
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
