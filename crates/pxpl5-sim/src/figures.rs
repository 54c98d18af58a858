//! Published figures (numbers in papers) next to the values that a model gives, with their provenance, as rows of
//! tables.
//!
//! Every comparison of a paper with a model uses the same [`FigureRow`], and each document chooses the columns of its
//! table from [`mod@column`] or defines its own.

pub mod column;
mod row;
mod table;

pub use row::{Basis, Definition, Detail, FigureRow, around};
pub use table::{TableColumn, filled, four, lines, range, significant, table};
