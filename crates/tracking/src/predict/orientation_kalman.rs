use glam::{DMat3, DQuat, DVec3};

use super::channel::Channel;
use super::position_kalman::{NoiseModel, symmetric};
use super::propagation::{Propagation, Propagations};
use crate::rotation;
use crate::time::span_s;

/// Longest turn between two reports for which the turn may be approximated to first order, rad. The fastest head turn
/// (LIST83) at 120 Hz is 0.05 rad.
const LARGEST_LINEAR_TURN: f64 = 1.0;

/// The 9 x 9 covariance of (rotation error, angular velocity, angular acceleration), stored as its six distinct 3 x 3
/// submatrices.
#[derive(Clone, Copy, Debug)]
struct Covariance {
    angle: DMat3,
    angle_rate: DMat3,
    angle_acceleration: DMat3,
    rate: DMat3,
    rate_acceleration: DMat3,
    acceleration: DMat3,
}

/// Extended Kalman filter for orientation. The state is a quaternion, the angular velocity omega (rad/s) and the
/// angular acceleration domega (rad/s^2) in the world frame. Both decay, and angular jerk is white noise.
///
/// The filter describes the error of the quaternion by a rotation vector. The covariance is therefore 9 x 9 and
/// regular, and the quaternion keeps its length.
#[derive(Clone, Debug)]
pub(super) struct OrientationKalman {
    belief: NoiseModel,
    propagations: Propagations,
    t_ps: u64,
    orientation: DQuat,
    rate: DVec3,
    acceleration: DVec3,
    covariance: Covariance,
}

impl OrientationKalman {
    pub(super) fn new(belief: NoiseModel) -> Self {
        Self {
            belief,
            propagations: Propagations::of(belief.decay),
            t_ps: 0,
            orientation: DQuat::IDENTITY,
            rate: DVec3::ZERO,
            acceleration: DVec3::ZERO,
            covariance: Covariance::start(&belief),
        }
    }

    /// Returns the turn (rotation vector) from the factors of [`Propagations::way`]: the first two terms of the Magnus
    /// series. The second term accounts for the changing axis of rotation.
    fn turn(&self, [by_rate, by_acceleration, sideways]: [f64; 3]) -> DVec3 {
        self.rate * by_rate + self.acceleration * by_acceleration - self.rate.cross(self.acceleration) * sideways
    }

    fn predict(&mut self, dt: f64) {
        let propagation = self.propagations.over(dt);
        let turn = self.turn(propagation.turned(1.0));
        self.orientation = (rotation::exp(turn) * self.orientation).normalize();
        let step = &propagation.step;
        self.rate = self.rate * step.y_axis.y + self.acceleration * step.z_axis.y;
        self.acceleration *= step.z_axis.z;
        self.covariance.predict(turn, &propagation, self.belief.jerk);
    }

    fn correct(&mut self, measured: DQuat) {
        let surprise = rotation::difference(self.orientation, measured);
        let weighted = self.covariance.weigh(surprise, self.belief.measurement);
        self.orientation = (rotation::exp(self.covariance.angle * weighted) * self.orientation).normalize();
        self.rate += self.covariance.angle_rate.transpose() * weighted;
        self.acceleration += self.covariance.angle_acceleration.transpose() * weighted;
        self.covariance.correct(self.belief.measurement);
    }
}

impl Covariance {
    fn start(belief: &NoiseModel) -> Self {
        let (rate, acceleration) = belief.start;
        Self {
            angle: DMat3::IDENTITY * belief.measurement,
            angle_rate: DMat3::ZERO,
            angle_acceleration: DMat3::ZERO,
            rate: DMat3::IDENTITY * rate,
            rate_acceleration: DMat3::ZERO,
            acceleration: DMat3::IDENTITY * acceleration,
        }
    }

    /// Replaces the covariance P by F P F^T + Q with F = [R, A, B; 0, d, e; 0, 0, c]. R rotates old errors with the
    /// head. A and B integrate the errors of angular velocity and acceleration to first order in `turn`. The numbers d,
    /// e and c are the decay of the two, and the velocity that the acceleration adds.
    fn predict(&mut self, turn: DVec3, Propagation { step, growth, .. }: &Propagation, jerk: f64) {
        let r = DMat3::from_quat(rotation::exp(turn));
        let small = turn.clamp_length_max(LARGEST_LINEAR_TURN);
        let a = (DMat3::IDENTITY + cross(small / 2.0)) * step.y_axis.x;
        let b = (DMat3::IDENTITY + cross(small / 3.0)) * step.z_axis.x;
        let (d, e, c) = (step.y_axis.y, step.z_axis.y, step.z_axis.z);
        // The first block row of F P. The other two rows contain only the terms of rate and acceleration.
        let to_angle = r * self.angle + a * self.angle_rate.transpose() + b * self.angle_acceleration.transpose();
        let to_rate = r * self.angle_rate + a * self.rate + b * self.rate_acceleration.transpose();
        let to_acceleration = r * self.angle_acceleration + a * self.rate_acceleration + b * self.acceleration;
        let q = *growth * jerk;
        self.angle = symmetric(to_angle * r.transpose() + to_rate * a.transpose() + to_acceleration * b.transpose())
            + isotropic(q.x_axis.x);
        self.angle_rate = to_rate * d + to_acceleration * e + isotropic(q.x_axis.y);
        self.angle_acceleration = to_acceleration * c + isotropic(q.x_axis.z);
        let cross_rate = self.rate_acceleration;
        self.rate_acceleration = (cross_rate * d + self.acceleration * e) * c + isotropic(q.y_axis.z);
        self.rate = self.rate * (d * d)
            + (cross_rate + cross_rate.transpose()) * (d * e)
            + self.acceleration * (e * e)
            + isotropic(q.y_axis.y);
        self.acceleration = self.acceleration * (c * c) + isotropic(q.z_axis.z);
    }

    /// Returns S^-1 times the difference between measured and predicted orientation. S is P + r I. P is the covariance
    /// of the rotation error, r is the variance of the measurement, and I is the unit matrix.
    fn weigh(&self, surprise: DVec3, measurement: f64) -> DVec3 {
        (self.angle + isotropic(measurement)).inverse() * surprise
    }

    /// Corrects the covariance to P - P H^T S^-1 H P. In the rows of the angle, 1 - P S^-1 is written as r S^-1, so
    /// that rounding cannot make the variance negative.
    fn correct(&mut self, measurement: f64) {
        let inverse = symmetric((self.angle + isotropic(measurement)).inverse());
        let rate_gain = self.angle_rate.transpose() * inverse;
        let acceleration_gain = self.angle_acceleration.transpose() * inverse;
        self.rate = symmetric(self.rate - rate_gain * self.angle_rate);
        self.rate_acceleration -= rate_gain * self.angle_acceleration;
        self.acceleration = symmetric(self.acceleration - acceleration_gain * self.angle_acceleration);
        let keep = inverse * measurement;
        self.angle = symmetric(keep * self.angle);
        self.angle_rate = keep * self.angle_rate;
        self.angle_acceleration = keep * self.angle_acceleration;
    }
}

impl Channel<DQuat> for OrientationKalman {
    fn restart(&mut self, t_ps: u64, orientation: DQuat) {
        self.t_ps = t_ps;
        self.orientation = orientation;
        self.rate = DVec3::ZERO;
        self.acceleration = DVec3::ZERO;
        self.covariance = Covariance::start(&self.belief);
    }

    fn update(&mut self, t_ps: u64, orientation: DQuat) {
        self.predict(span_s(self.t_ps, t_ps));
        self.t_ps = t_ps;
        self.correct(orientation);
    }

    fn extrapolate(&self, dt_s: f64) -> DQuat {
        (rotation::exp(self.turn(self.propagations.way(dt_s))) * self.orientation).normalize()
    }
}

fn isotropic(variance: f64) -> DMat3 {
    DMat3::from_diagonal(DVec3::splat(variance))
}

/// Returns the matrix M for which M w is the cross product of `v` and w.
fn cross(v: DVec3) -> DMat3 {
    DMat3::from_cols(DVec3::new(0.0, v.z, -v.y), DVec3::new(-v.z, 0.0, v.x), DVec3::new(v.y, -v.x, 0.0))
}

#[cfg(test)]
mod tests;
