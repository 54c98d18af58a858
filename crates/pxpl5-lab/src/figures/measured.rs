use pxpl5_run::ExperimentError;
use pxpl5_scene::{Scene, builtin};
use pxpl5_sim::figures::Detail;
use std::sync::Arc;

pub(super) type Result<T> = std::result::Result<T, ExperimentError>;

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
}

impl From<f64> for FigureValue {
    fn from(value: f64) -> Self {
        Self::with(value, Vec::new())
    }
}

pub(super) fn detail(name: &str, value: f64, unit: &'static str) -> Detail {
    Detail { name: name.to_owned(), value, unit }
}

pub(super) fn scene_named(name: &str) -> Result<Arc<Scene>> {
    builtin(name).map(Arc::new).map_err(|error| ExperimentError::Scene(error.to_string()))
}
