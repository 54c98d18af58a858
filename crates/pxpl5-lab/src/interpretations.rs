//! Ranking of the interpretations of the papers: all figures of Rendering Control under every combination of answers.
//!
//! ```text
//!   Interpretation::all() --Bench, analytic level--> Fit of each --the best, transaction level--> Interpretations
//!                                                   |
//!                                                   +--without one figure in turn--> LeaveOneOut: its prediction
//! ```
//!
//! Among hundreds of combinations, some may fit a dozen figures by chance. Every figure is therefore also predicted by
//! the interpretation that fits all other figures best. The result also counts the interpretations that are as good as
//! the best within the printed digits. The text of the papers decides between these interpretations.
//!
//! Source of the questions: TR94, which does not answer these questions.

mod fit;
mod rank;

pub use fit::{FigureFit, Fit};
pub use rank::{Interpretations, LeaveOneOut, run};

/// Numbers, in ACCURACY.md, of the Rendering Control figures that depend on the interpretation of the papers.
pub const FIGURES: [&str; 12] = ["3", "4", "4b", "5", "6", "7", "7b", "7c", "16", "16b", "16c", "17"];
