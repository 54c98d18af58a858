//! Results as tables, with one row for each picture that was begun. The formats are CSV and, with the feature
//! `parquet`, Parquet.
//!
//! The origin of a file ([`origin`]) states how to reproduce the file. For CSV, the origin is in `report.json` and
//! `experiment.toml` beside the file. For Parquet, the origin is in the key-value metadata (keys `pxpl5.machine` and so
//! on). All times are whole picoseconds of simulated time, so nothing is rounded. [`columns`] returns the table's
//! columns. [`SCHEMA`] has the name and version of this set of columns.
//!
//! [`csv_table`] writes every CSV file. [`quantities_csv`] returns the table of the measured quantities of an
//! experiment.

mod csv_file;
mod origin;
#[cfg(feature = "parquet")]
mod parquet;
mod pictures;

pub use csv_file::{csv_of, csv_table, flat};
pub(crate) use origin::count_of;
pub use origin::{origin, origin_lines};
#[cfg(feature = "parquet")]
pub use parquet::parquet;
pub use pictures::{Column, SCHEMA, columns, csv, quantities_csv, rows};
