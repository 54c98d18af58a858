//! Results as tables: a row for each picture that was shown, as CSV and, with the feature `parquet`, as Parquet.
//!
//! What the file can be made again from ([`origin`]) stands in `report.json` and `experiment.toml` beside CSV, and in Parquet's own
//! key-value metadata (keys `pxpl5.machine` and so on). All times are whole picoseconds of
//! simulated time, so nothing is rounded. [`columns`] is the schema; its name and version stand in [`SCHEMA`].
//!
//! [`csv_table`] is the writer of every CSV file; [`quantities_csv`] is the table of what an experiment measured.

mod csv_file;
mod origin;
#[cfg(feature = "parquet")]
mod parquet;
mod pictures;
mod tables;

pub use csv_file::csv_table;
pub(crate) use origin::count_of;
pub use origin::{origin, origin_lines};
#[cfg(feature = "parquet")]
pub use parquet::parquet;
pub use pictures::{Column, SCHEMA, columns, rows};
pub use tables::{csv, quantities_csv};
