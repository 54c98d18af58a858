//! The error of a run, split into its causes.

use crate::errors::{PixelErrors, Showing};
use pxpl5_run::{Cause, Outcome};
use serde::Serialize;

/// Mean error of a run and the contribution of each cause, in pixels.
///
/// The contribution of a cause is the reduction of the error when only this cause is turned off. Some causes act only
/// together: a latency matters only if the prediction fails. The interaction is the remaining error, so contributions
/// and interaction add up to the whole error.
///
/// A contribution can be negative. For example, a filter lags even without the noise that it should smooth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ErrorCauses {
    /// Mean error over the grid of evaluated pixels and over all evaluated fields, in pixels.
    pub whole_px: f64,
    /// Contribution of each cause in pixels, in the order of [`Cause::ALL`].
    pub parts_px: Vec<ErrorPart>,
    /// Interaction of the causes: `whole_px` minus the sum of the contributions `parts_px`, in pixels.
    pub interaction_px: f64,
}

/// One cause of error, and its contribution to the mean error of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorPart {
    /// The cause that was turned off.
    pub cause: Cause,
    /// Mean error minus the mean error without the cause, in pixels.
    pub px: f64,
}

impl ErrorCauses {
    /// Computes the contributions for a run.
    ///
    /// `whole` holds the errors of the same run in the display mode `showing` ([`PixelErrors::shown`]). Returns `None`
    /// for a run without a head, or if no pixel could be evaluated.
    pub fn of(outcome: &Outcome, showing: Showing, whole: &PixelErrors) -> Option<Self> {
        outcome.head()?;
        if whole.evaluated == 0 {
            return None;
        }
        let whole_px = whole.pixels.mean;
        // Evaluate the run again without each single cause.
        let parts = Cause::ALL.map(|cause| {
            let without_px = PixelErrors::without(outcome, showing, cause).pixels.mean;
            ErrorPart { cause, px: whole_px - without_px }
        });
        let sum_px: f64 = parts.iter().map(|part| part.px).sum();
        Some(Self { whole_px, parts_px: parts.to_vec(), interaction_px: whole_px - sum_px })
    }
}
