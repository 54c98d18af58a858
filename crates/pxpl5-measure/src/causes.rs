//! Why pixels are where they are: the error of a run split into its causes.

use crate::errors::{PixelErrors, Showing};
use pxpl5_run::{Cause, Outcome};
use serde::Serialize;

/// The mean error of a run and what each cause adds to it, pixels: how much smaller it is with that cause alone turned off. Causes
/// that need each other (a latency hurts only where a prediction fails) leave an interaction; all of it adds up to the whole.
///
/// A part can be negative: without noise a filter that smooths it still lags, without latency the noise remains.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ErrorCauses {
    /// Mean error over the grid and all judged fields, pixels.
    pub whole_px: f64,
    /// What each cause adds, pixels, in the order of [`Cause::ALL`].
    pub parts_px: Vec<ErrorPart>,
    /// What is left: `whole_px` less the sum of the parts, pixels.
    pub interaction_px: f64,
}

/// What one cause adds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorPart {
    /// What was turned off.
    pub cause: Cause,
    /// Mean error less the mean error without the cause, pixels.
    pub px: f64,
}

impl ErrorCauses {
    /// Of a run whose pictures are shown so; `None` of a run without a head, or of which no pixel could be judged.
    #[must_use]
    pub fn of(outcome: &Outcome, showing: Showing) -> Option<Self> {
        outcome.head()?;
        let whole = PixelErrors::shown(outcome, showing);
        if whole.judged == 0 {
            return None;
        }
        let whole_px = whole.pixels.mean;
        let parts = Cause::ALL.map(|cause| {
            let without_px = PixelErrors::without(outcome, showing, cause).pixels.mean;
            ErrorPart { cause, px: whole_px - without_px }
        });
        let sum_px: f64 = parts.iter().map(|part| part.px).sum();
        Some(Self { whole_px, parts_px: parts.to_vec(), interaction_px: whole_px - sum_px })
    }
}
