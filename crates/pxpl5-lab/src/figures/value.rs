//! The value of a figure in the model, with further numbers of the same experiment.

use crate::error::StudyError;
use pxpl5_run::Summary;
use pxpl5_scene::{Scene, builtin};
use pxpl5_sim::figures::Detail;
use std::sync::Arc;

pub(super) type Result<T> = std::result::Result<T, StudyError>;

/// Result of the experiment that simulates a published figure.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureValue {
    /// Value of the figure, in the figure's unit.
    pub value: f64,
    /// Additional numbers of the same experiment, each with its own unit.
    pub details: Vec<Detail>,
    /// Minimum and maximum of the figure over a condition that the paper does not print. `None` if the paper prints all
    /// conditions.
    pub unprinted: Option<[f64; 2]>,
}

impl FigureValue {
    pub(super) const fn with(value: f64, details: Vec<Detail>) -> Self {
        Self { value, details, unprinted: None }
    }

    /// Adds how near the pictures of the experiment come to another retrace, in fields: by how much later, and by how
    /// much earlier, their copies would have to end.
    pub(super) fn beside(mut self, edges: Option<[f64; 2]>) -> Self {
        if let Some([later, earlier]) = edges {
            self.details.extend([detail(LATER, later, "fields"), detail(EARLIER, earlier, "fields")]);
        }
        self
    }

    /// Returns the additional number called `name`.
    pub fn detail(&self, name: &str) -> Option<f64> {
        self.details.iter().find(|detail| detail.name == name).map(|detail| detail.value)
    }
}

/// Name of the detail with the mean in whole retraces.
pub(super) const WHOLE: &str = "whole retraces";
/// Name of the detail with the mean in exact fields.
pub(super) const EXACT: &str = "exact fields";
/// Name of the detail with the standard deviation of the samples.
pub(crate) const DEVIATION: &str = "standard deviation";
/// Name of the detail with the least delay of a copy that would show a picture a field later.
pub(super) const LATER: &str = "to a later retrace";
/// Name of the detail with the least saving that would show a picture a field earlier.
pub(super) const EARLIER: &str = "to an earlier retrace";

impl From<f64> for FigureValue {
    fn from(value: f64) -> Self {
        Self::with(value, Vec::new())
    }
}

pub(super) fn detail(name: &str, value: f64, unit: &'static str) -> Detail {
    Detail { name: name.to_owned(), value, unit }
}

pub(super) fn scene_named(name: &str) -> Result<Arc<Scene>> {
    Ok(Arc::new(builtin(name)?))
}

/// Returns the number of complete pictures per second: 0 if pictures were due and none was shown, and NaN if a single one
/// gives no rate.
pub(super) fn rate_hz(summary: &Summary) -> f64 {
    let none_shown = summary.due.is_some_and(|due| due.due > 0 && due.shown == 0);
    summary.updates_hz.unwrap_or(if none_shown { 0.0 } else { f64::NAN })
}
