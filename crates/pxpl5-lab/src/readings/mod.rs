//! Which reading of the papers explains their figures: all figures of Rendering Control under every combination.
//!
//! ```text
//!   Reading::all() --Bench with a Reading, analytic--> Fit of each --best of them, transaction--> Readings: ranked
//!                                                  |
//!                                                  +--without one figure in turn--> LeftOut: predicted by the others\' choice
//! ```
//!
//! Hundreds of combinations against a dozen figures can fit by luck. So every figure is also predicted from the reading that all
//! others choose, and it is said how many readings are as good as the best within the digits that the papers print; among those,
//! what the text says decides.
//!
//! Source of the questions: TR94, which leaves them open.

mod fit;
mod rank;

pub use fit::{Fit, FitOfFigure};
pub use rank::{LeftOut, Readings, run};

/// The figures of Rendering Control that a reading changes, or could.
pub const FIGURES: [&str; 12] = ["3", "4", "4b", "5", "6", "7", "7b", "7c", "16", "16b", "16c", "17"];
