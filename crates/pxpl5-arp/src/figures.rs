//! Comparison of the figures in the papers on priority rendering with simulated figures.

use pxpl5_sim::StopFlag;
use pxpl5_sim::parameters::SettingError;

mod compared;
mod definitions;
mod document;
mod experiments;
mod fit;
mod interpretations;
mod lens;
mod row;
mod rows;
mod rules;

pub use definitions::{SEGMENTS, definitions};
pub use document::{interpretations as interpretations_text, markdown, missed, table};
pub(crate) use experiments::looking_at;
pub use experiments::{
    CellFit, EXPERIMENT_FRAMES, Experiments, NamedWalk, SizeLimit, SlowRendererResult, point_objects_reduction,
    size_limits,
};
pub use fit::{RATE_FITTED, RATES_HZ, fitted_cell_m, policy_rates_hz};
pub(crate) use interpretations::gallery;
pub use interpretations::{
    Interpretations, LeftOutRate, PIXEL_DEG, RankedRules, Situation, ThresholdRow, Trial, Tried, threshold_rows,
};
pub use lens::straight_edge;
pub use row::{limit, row, shape, verdict};
pub use rows::rows;
pub use rules::Rules;

use pxpl5_sim::figures::FigureRow;

/// Runs all experiments and returns them with the rows of the comparison.
///
/// # Errors
///
/// Fails in the same cases as [`Experiments::run`].
pub fn all() -> Result<(Experiments, Vec<FigureRow>), SettingError> {
    let experiments = Experiments::run(&StopFlag::default())?;
    let rows = rows(&experiments);
    Ok((experiments, rows))
}
