//! Closed form of the stage rules.
use crate::experiment::ExperimentError;
use crate::levels::{Case, Summary};
/// Evaluates a case.
pub fn run(_case: &Case) -> Result<Summary, ExperimentError> {
    Err(ExperimentError::Scene("todo".into()))
}
