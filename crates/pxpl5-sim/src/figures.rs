//! Published figures next to the values of a model: rows with provenance, definitions, and their tables.
//!
//! Every comparison of a paper with a model uses the same [`FigureRow`]. Each document chooses the columns of its table
//! from [`mod@column`] or writes its own.

pub mod column;
mod row;
mod table;

pub use row::{Basis, Definition, Detail, FigureRow, around};
pub use table::{TableColumn, significant, table};
