use glam::{DQuat, DVec3};

use crate::rotation;

/// A prediction filter for one quantity, either position or orientation. The filter must receive measured values in
/// order of time.
pub(super) trait Channel<T>: Send {
    fn restart(&mut self, t_ps: u64, value: T);
    fn update(&mut self, t_ps: u64, value: T);
    /// Returns the predicted value at `dt_s` seconds after the last update. A negative `dt_s` gives an earlier value.
    fn extrapolate(&self, dt_s: f64) -> T;
}

/// A quantity whose differences are vectors: a position (difference in m), or an orientation (difference as a rotation
/// vector in rad).
pub(super) trait VectorDifference: Copy + Send {
    fn since(self, origin: Self) -> DVec3;
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
