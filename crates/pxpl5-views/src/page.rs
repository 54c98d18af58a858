//! Results as a single HTML page. The page needs no network, fits on a phone and can be printed.
//!
//! A page is made from the content of results folders ([`PageRun`]). The page can show results of every program version
//! with the same report schema. Values that a report lacks are left out.

mod configuration;
mod html;
mod latency;
mod pictures_csv;
mod run;
mod section;
mod summary;
mod tables;
mod utilisation;
mod values;

pub use html::html;
pub use pictures_csv::latencies_ms;
pub use run::{PagePicture, PageRun};
pub use tables::{PageTable, html_of_tables};
