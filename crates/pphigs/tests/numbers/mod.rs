//! A generator of numbers for tests of kernels. It gives the same numbers on every host.

use glam::Vec3;
use pxpl5_sim::SplitMix64;

pub(crate) struct Numbers(pub(crate) SplitMix64);

impl Numbers {
    /// Returns a number from -1 to 1.
    pub(crate) fn next(&mut self) -> f32 {
        2.0 * self.0.unit() - 1.0
    }

    /// Returns a vector whose components are from -`size` to `size`.
    pub(crate) fn vector(&mut self, size: f32) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * size
    }
}
