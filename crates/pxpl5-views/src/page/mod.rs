//! Results as one page of HTML that needs no network, fits a phone and can be printed.
//!
//! A page is made of what a results folder holds ([`PageRun`]), so a run of any version whose report has the same schema
//! can stand on it; where something is missing, it is left out.

mod configuration;
mod html;
mod latency;
mod pictures_csv;
mod run;
mod section;
mod summary;
mod tables;
mod values;

pub use html::html;
pub use pictures_csv::latencies_ms;
pub use run::{PagePicture, PageRun};
pub use tables::{PageTable, html_of_tables};
