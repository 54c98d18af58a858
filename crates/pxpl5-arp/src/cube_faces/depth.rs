//! Depths of 24 bits. All faces have the same near and far plane.

use address_recalculation::DEPTH_FARTHEST;
use pxpl5_sim::parameters::SettingError;

/// Range of the distances that are drawn, measured along the axis of a face, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    pub(crate) near_m: f64,
    far_m: f64,
}

impl DepthRange {
    /// Creates the range from the near plane at `near_m` to the far plane at `far_m`, metres.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] unless 0 < near < far and far is finite.
    pub fn new(near_m: f64, far_m: f64) -> Result<Self, SettingError> {
        let is_range = near_m > 0.0 && far_m > near_m && far_m.is_finite();
        let found = format_args!("near {near_m} m and far {far_m} m");
        SettingError::require(is_range, "depth range", "0 < near < far, both finite", found)?;
        Ok(Self { near_m, far_m })
    }

    /// Returns the coefficients (a, b) of the depth a + b/w, where w is the distance along the face's axis. The depth
    /// is 0 at the near plane and 1 at the far plane.
    pub(crate) fn linear(&self) -> [f64; 2] {
        let scale = self.far_m / (self.far_m - self.near_m);
        [scale, -scale * self.near_m]
    }

    /// Returns the 24-bit depth of a point from its distance along the axis. Returns `None` if the distance is outside
    /// the range.
    pub fn word(&self, distance_m: f64) -> Option<u32> {
        let [a, b] = self.linear();
        let depth = a + b / distance_m;
        (distance_m > 0.0 && (0.0..1.0).contains(&depth)).then_some((depth * f64::from(DEPTH_FARTHEST)) as u32)
    }

    /// Returns the distance along the axis, in metres, in the middle of the depth step with the 24-bit depth `word`.
    pub fn distance_m(&self, word: u32) -> f64 {
        let [a, b] = self.linear();
        b / ((f64::from(word) + 0.5) / f64::from(DEPTH_FARTHEST) - a)
    }
}
