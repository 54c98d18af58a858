//! What an experiment behind a figure gives.

use pxpl5_run::ExperimentError;
use pxpl5_scene::{Scene, builtin};
use serde::Serialize;
use std::sync::Arc;

pub(super) type Result<T> = std::result::Result<T, ExperimentError>;

/// A further number of an experiment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Detail {
    /// What the number is, in a few words: `standard deviation`.
    pub name: String,
    /// The number, in the unit that stands beside it.
    pub value: f64,
    /// Unit of the value: `ms`, `fields`, `Hz`, `triangles`.
    pub unit: &'static str,
}

/// What an experiment gave.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureValue {
    /// The figure's own number.
    pub value: f64,
    /// Further numbers of the same experiment, each with a unit of its own.
    pub details: Vec<Detail>,
    /// Least and greatest value over a condition of the experiment that the paper does not print; `None` where it prints all.
    pub unprinted: Option<[f64; 2]>,
}

impl FigureValue {
    /// The figure's own number with further numbers of the same experiment.
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
