//! Which reading of the papers explains their figures: all figures of Rendering Control under every combination.
//!
//! ```text
//!   all() --Bench with a Reading, analytic--> Fit of each --best of them, transaction--> Readings: ranked
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

use crate::figures::{FieldCount, ROOM, Reading, Samples};
use pxpl5_run::FinishedRegions;

/// The figures of Rendering Control that a reading changes, or could.
pub const FIGURES: [&str; 10] = ["3", "4", "4b", "5", "6", "7", "7b", "7c", "16b", "16c"];

/// Machines that could have drawn the application scenes.
const MACHINES: [&str; 4] = ["small-hmd", "medium", "design-maximum", "large"];

/// Regions that a renderer may keep; the last is what its backing store has room for.
const KEPT: [u64; 4] = [1, 2, 3, ROOM];

/// Every combination.
#[must_use]
pub fn all() -> Vec<Reading> {
    let mut all = Vec::new();
    for machine in MACHINES {
        for culled in [false, true] {
            for finished in FinishedRegions::ALL {
                for kept in KEPT {
                    all.extend(of_samples(Reading { machine, culled, finished, kept, ..Reading::USUAL }));
                }
            }
        }
    }
    all
}

/// The ways to take samples of the same runs.
fn of_samples(reading: Reading) -> impl Iterator<Item = Reading> {
    let counts = [FieldCount::Exact, FieldCount::Whole];
    let samples = [Samples::FirstEye, Samples::EachEye];
    samples.into_iter().flat_map(move |samples| counts.map(|fields| Reading { samples, fields, ..reading }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_combination_occurs_once_and_the_usual_one_is_among_them() {
        let all = all();
        assert_eq!(all.len(), 4 * 2 * 2 * 4 * 4);
        assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
        assert!(all.contains(&Reading::USUAL));
    }
}
