//! Tables of parameters. Each parameter has a unit, a provenance, a range and a source.
//!
//! A [`parameter_table!`] declares them once, for four uses:
//!
//! ```text
//!                        +--> table.word_ns        code reads a plain public field
//!  parameter_table! { }--+--> table.get("word_ns") files, sweeps and reports use the name
//!                        +--> Table::INFOS         unit, provenance, range, limits, source
//!                        +--> table.check()        rejects values outside the limits
//! ```
//!
//! # A line of a table
//!
//! ```text
//! /// Time of one word on a channel.
//! word_ns: 50, "ns", Published, 50..=50 in 1..=1_000_000, "TR94";
//! ```
//!
//! These are the value, the unit, the provenance, the *range*, the *limits* and the source. The range is what the
//! sources allow, and the limits are what the model can compute; if there are no limits, the range serves as both.
//! Values are whole numbers (`u64`, exact) unless the line has the type `f64`:
//!
//! ```text
//! /// Error of each axis, rms.
//! position_noise: f64 = 2.5, "mm", Published, 0.0..=5.0, "data sheet";
//! ```
//!
//! # Range and limits
//!
//! An experiment may use a value outside its range, although no source allows it; [`ParameterTable::out_of_range`]
//! lists such parameters. Outside the limits, [`ParameterTable::check`] fails.
//!
//! # Errors
//!
//! All crates share two types of errors for inputs: [`SettingError`] for a setting, a name or an argument, and
//! [`FileError`] for a file or a text. Both state the place, what was expected and what was found, and programs can
//! read the reason from `kind`. A setting that names an unusable file is a [`SettingError`] of the kind
//! [`File`](SettingErrorKind::File).
//!
//! **Not here:** rules that relate several parameters, such as "at most the length of a line". They belong to the crate
//! that owns the table.

mod by_path;
mod error;
mod file_error;
mod info;
mod key;
mod macros;
mod name;
mod nearest;
mod number;
mod table;
mod value;

pub use crate::{named, parameter_table, tables_at};
pub use by_path::{Choice, Parameter, PathSettings, PathTable, PathTableMut, assignment_of, choose, table_at};
pub use error::{SettingError, SettingErrorKind};
pub use file_error::{FileError, FileErrorKind, text_of};
pub use info::{ParameterInfo, Provenance, unknown_parameter};
pub use key::{Key, KeyValue, KeyValues, names};
pub use name::{find_named, write_name};
pub use nearest::nearest;
pub use number::{Number, check, check_value};
pub use table::{Entry, ParameterTable};
pub use value::{MAX, Value};
