//! The quadric error metric (Garland and Heckbert, SIGGRAPH 97). The metric is the weighted sum of squared distances
//! from a point to planes.

use std::ops::{Add, AddAssign};

use glam::DVec3;

/// A weighted sum of squared distances to planes, as a function of a point p: the sum of weight x (normal . p +
/// offset)^2.
#[derive(Clone, Copy, Default)]
pub(super) struct Quadric {
    /// Coefficients of second degree: the upper triangle of the sum of weight x normal normal^T, in the order xx, xy,
    /// xz, yy, yz, zz.
    squares: [f64; 6],
    /// Coefficients of first degree, halved: the sum of weight x offset x normal.
    linear: DVec3,
    /// Constant term: the sum of weight x offset^2.
    constant: f64,
}

impl Quadric {
    /// Returns the function of a point p that is `weight` times the squared distance of p from a plane. The plane
    /// contains `point` and has the unit normal `normal`.
    pub(super) fn of_plane(normal: DVec3, point: DVec3, weight: f64) -> Self {
        let offset = -normal.dot(point);
        let [x, y, z] = normal.to_array();
        let squares = [x * x, x * y, x * z, y * y, y * z, z * z].map(|product| product * weight);
        Self { squares, linear: normal * (weight * offset), constant: weight * offset * offset }
    }

    /// Returns the weighted sum of squared distances at the point `p`. A result that is negative by rounding becomes
    /// zero.
    pub(super) fn at(&self, p: DVec3) -> f64 {
        let [xx, xy, xz, yy, yz, zz] = self.squares;
        let turned =
            DVec3::new(xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z, xz * p.x + yz * p.y + zz * p.z);
        (p.dot(turned) + 2.0 * self.linear.dot(p) + self.constant).max(0.0)
    }
}

impl AddAssign for Quadric {
    fn add_assign(&mut self, other: Self) {
        for (own, other) in self.squares.iter_mut().zip(other.squares) {
            *own += other;
        }
        self.linear += other.linear;
        self.constant += other.constant;
    }
}

impl Add for Quadric {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadric_is_the_sum_of_squared_distances_to_its_planes() {
        let floor = Quadric::of_plane(DVec3::Y, DVec3::new(5.0, 1.0, 7.0), 2.0);
        let wall = Quadric::of_plane(DVec3::X, DVec3::new(-1.0, 0.0, 0.0), 3.0);
        // 2 x (4 - 1)^2 + 3 x (2 + 1)^2
        assert_eq!((floor + wall).at(DVec3::new(2.0, 4.0, -9.0)), 45.0);
        assert_eq!(floor.at(DVec3::new(100.0, 1.0, 100.0)), 0.0);
    }
}
