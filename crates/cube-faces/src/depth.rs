//! Depths of 24 bits between the same near and far on all faces.

use address_recalculation::DEPTH_FARTHEST;
use thiserror::Error;

/// Distances along the axis of a face between which things are drawn, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    near_m: f64,
    far_m: f64,
}

/// A range of depths that there cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("depth range: expected 0 < near < far, both finite, found near {near_m} m and far {far_m} m")]
pub struct DepthError {
    /// The nearest distance, m.
    pub near_m: f64,
    /// The farthest distance, m.
    pub far_m: f64,
}

impl DepthRange {
    /// From near to far, m.
    ///
    /// # Errors
    ///
    /// [`DepthError`] unless 0 < near < far and far is finite.
    pub fn new(near_m: f64, far_m: f64) -> Result<Self, DepthError> {
        let is_range = near_m > 0.0 && far_m > near_m && far_m.is_finite();
        if is_range { Ok(Self { near_m, far_m }) } else { Err(DepthError { near_m, far_m }) }
    }

    /// The nearest distance, m.
    #[must_use]
    pub const fn near_m(&self) -> f64 {
        self.near_m
    }

    /// The farthest distance, m.
    #[must_use]
    pub const fn far_m(&self) -> f64 {
        self.far_m
    }

    /// Depth from 0 at the near plane to 1 at the far plane of what lies at 1/w along the axis: a + b/w, as (a, b).
    #[must_use]
    pub(crate) fn linear(&self) -> [f64; 2] {
        let scale = self.far_m / (self.far_m - self.near_m);
        [scale, -scale * self.near_m]
    }

    /// The depth in 24 bits of a distance along the axis; `None` of what is not drawn.
    #[must_use]
    pub fn word(&self, distance_m: f64) -> Option<u32> {
        let [a, b] = self.linear();
        let depth = a + b / distance_m;
        (distance_m > 0.0 && (0.0..1.0).contains(&depth)).then_some((depth * f64::from(DEPTH_FARTHEST)) as u32)
    }

    /// The distance along the axis, m, of the middle of what has this depth in 24 bits.
    #[must_use]
    pub fn distance_m(&self, word: u32) -> f64 {
        let [a, b] = self.linear();
        b / ((f64::from(word) + 0.5) / f64::from(DEPTH_FARTHEST) - a)
    }
}
