//! Results as tables: a row for each picture that was shown, as CSV and, with the feature `parquet`, as Parquet.
//!
//! Both open with what the file can be made again from ([`origin`]): CSV with lines of comment that begin with `#`,
//! Parquet with the file's key-value metadata (keys `pxpl5.machine` and so on). All times are whole picoseconds of
//! simulated time, so nothing is rounded. [`columns`] is the schema; its name and version stand in [`SCHEMA`].

mod csv;
mod origin;
#[cfg(feature = "parquet")]
mod parquet;
mod table;

pub use csv::csv;
pub use origin::{origin, origin_lines};
#[cfg(feature = "parquet")]
pub use parquet::parquet;
pub use table::{Column, columns};

/// Name and version of the tables' schema; a column that is added at the end does not change it.
pub const SCHEMA: &str = "pxpl5-pictures/1";
