//! Ranking of the interpretations of the papers: all figures of Rendering Control under every combination of answers.
//!
//! ```text
//!   Interpretation::all() --FigureSettings, analytic level--> Fit of each --the likeliest, transaction level--> Interpretations
//!                                                   |
//!                                                   +--without one figure in turn--> LeaveOneOut: its prediction
//! ```
//!
//! Among hundreds of combinations, some may fit a dozen figures by chance. Every figure is therefore also predicted by
//! the interpretation under which all other figures are likeliest, and the result lists the interpretations that the
//! figures cannot tell apart. The ranking decides nothing by itself: where the text of the papers gives an answer, this
//! project takes it, and rows that depend on other answers are marked.
//!
//! Source of the questions: TR94, which does not answer these questions.

mod fit;
mod rank;

pub use fit::{FigureFit, Fit};
pub use rank::{ALIKE, InterpretationQuery, Interpretations, LeaveOneOut};

use crate::figures::{Basis, Measurement, all};

/// Returns the figures that decide the ranking: all that depend on the interpretation, except those that follow from
/// other rows and would count twice.
pub fn figures() -> impl Iterator<Item = &'static Measurement> {
    all().filter(|figure| figure.is_interpreted && !matches!(figure.basis, Basis::Derived(_)))
}
