//! What the papers print beside what comes out here.

mod compared;
mod document;
mod experiments;
mod fit;
mod lens;
mod row;
mod rows;

pub use document::{markdown, missed, table};
pub use experiments::{
    EXPERIMENT_FRAMES, Experiments, Fit, SizeRow, Slowed, Walked, point_objects_reduction, size_rows,
};
pub(crate) use experiments::{gallery, looking_at};
pub use fit::{RATE_FITTED, RATES_HZ, fitted_cell_m, policy_rates_hz};
pub use lens::straight_edge;
pub use row::{Row, Standing};
pub use rows::rows;

use crate::error::ExperimentError;

/// Everything that is compared.
///
/// # Errors
///
/// As [`Experiments::run`].
pub fn all() -> Result<(Experiments, Vec<Row>), ExperimentError> {
    let experiments = Experiments::run()?;
    let rows = rows(&experiments);
    Ok((experiments, rows))
}
