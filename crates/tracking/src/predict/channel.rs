use glam::{DQuat, DVec3};

use crate::rotation;

/// A filter of one quantity: position or orientation. Updates come with rising times, which the gate ensures.
pub(super) trait Channel<T>: Send {
    /// Forgets all past values and starts from this value.
    fn restart(&mut self, t_ps: u64, value: T);
    /// Adds a measured value.
    fn update(&mut self, t_ps: u64, value: T);
    /// Returns the value `dt_s` after the last update, or before it for a negative `dt_s`.
    fn extrapolate(&self, dt_s: f64) -> T;
}

/// Values whose differences are vectors: positions (m) and orientations (rotation vectors, rad).
pub(super) trait VectorDifference: Copy + Send {
    /// Returns the vector from `origin` to `self`.
    fn since(self, origin: Self) -> DVec3;
    /// Returns `self` moved by a vector.
    fn moved(self, by: DVec3) -> Self;
}

impl VectorDifference for DVec3 {
    fn since(self, origin: Self) -> DVec3 {
        self - origin
    }
    fn moved(self, by: DVec3) -> Self {
        self + by
    }
}

impl VectorDifference for DQuat {
    fn since(self, origin: Self) -> DVec3 {
        rotation::difference(origin, self)
    }
    fn moved(self, by: DVec3) -> Self {
        (rotation::exp(by) * self).normalize()
    }
}
