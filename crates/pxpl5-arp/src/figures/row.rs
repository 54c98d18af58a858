//! Rows of the comparison: the published number, the simulated number, and the provenance of the simulated number.

use pxpl5_sim::figures::{Basis, FigureRow, around};

/// Creates a row whose numbers should agree to 1 percent.
pub fn row(id: &'static str, statement: &str, unit: &'static str, both: [f64; 2], basis: Basis) -> FigureRow {
    let accepted = around(both[0], 0.01 * both[0].abs());
    let cause = match id {
        "fig. 1" => {
            "From 100 to 1,000 triangles the mean latency falls by 6 us, because the wait for the retrace hides what they add."
        }
        "A8" => "No interpretation of size and distance gives such a large factor.",
        "A12" => {
            "The paper CPR05 does not print its scene, path, rings of cells and threshold. Of the update rates, only the rate of \
             memory 1 was fitted."
        }
        _ => "",
    };
    FigureRow { basis, cause, ..FigureRow::new(id, statement.to_owned(), unit, both, accepted) }
}

/// Creates a row for a number that cannot be reproduced. `holds` is true if the shape of the simulated curve or table
/// agrees with the published shape.
pub fn shape(id: &'static str, statement: &str, unit: &'static str, both: [f64; 2], holds: bool) -> FigureRow {
    FigureRow { is_met: holds, ..row(id, statement, unit, both, Basis::Shape) }
}

/// Creates a row that has its own criterion for agreement, such as "less than".
pub fn limit(id: &'static str, statement: &str, unit: &'static str, both: [f64; 2], is_met: bool) -> FigureRow {
    FigureRow { is_met, ..row(id, statement, unit, both, Basis::Free) }
}

/// Returns the outcome of a row's comparison: `met`, `within`, `shape` or `**missed**`.
///
/// `within` means that the published number lies in the interval of all interpretations. `shape` means that the number
/// cannot be reproduced, but the shape of the simulated curve or table agrees with the published shape.
pub const fn verdict(row: &FigureRow) -> &'static str {
    match (row.is_met, row.basis) {
        (false, _) => "**missed**",
        (true, Basis::Shape) => "shape",
        (true, Basis::Unprinted) => "within",
        (true, _) => "met",
    }
}
