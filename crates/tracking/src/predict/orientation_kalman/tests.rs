use super::*;
use crate::predict::Decay;
use crate::predict::tests::{Dense, identity, is_positive_definite, norm, product, sum, transposed};
use crate::time::{PS_PER_S, nearest_ps};
use proptest::prelude::*;

const BELIEF: NoiseModel = NoiseModel { measurement: 6.9e-6, jerk: 1e4, decay: Decay::NONE, start: (4.0, 400.0) };

const DECAY: Decay = Decay { velocity: 5.0, acceleration: 30.0 };

/// Returns the covariance of the filter as one matrix of 9 x 9 numbers.
fn dense(c: &Covariance) -> Dense<9> {
    let blocks = [
        [c.angle, c.angle_rate, c.angle_acceleration],
        [c.angle_rate.transpose(), c.rate, c.rate_acceleration],
        [c.angle_acceleration.transpose(), c.rate_acceleration.transpose(), c.acceleration],
    ];
    std::array::from_fn(|i| std::array::from_fn(|j| blocks[i / 3][j / 3].col(j % 3)[i % 3]))
}

fn turning() -> OrientationKalman {
    let mut filter = OrientationKalman::new(BELIEF);
    for i in 1..=60u64 {
        let t = i as f64 / 120.0;
        let orientation = rotation::from_yaw_pitch_roll(3.0 * t, 0.4 * (5.0 * t).sin(), t * t);
        filter.update(i * PS_PER_S / 120, orientation);
    }
    filter
}

/// Returns the orientation after `dt` seconds, from 20,000 small steps of the differential equation. The filter uses a
/// closed form instead.
fn integrate(filter: &OrientationKalman, dt: f64) -> DQuat {
    let n = 20_000;
    let h = dt / f64::from(n);
    (0..n).fold(filter.orientation, |q, i| {
        let step = filter.propagations.over((f64::from(i) + 0.5) * h).step;
        rotation::exp((filter.rate * step.y_axis.y + filter.acceleration * step.z_axis.y) * h) * q
    })
}

#[test]
fn extrapolation_solves_the_differential_equation_of_a_turning_axis() {
    for decay in [Decay::NONE, DECAY] {
        let filter = OrientationKalman {
            rate: DVec3::new(1.0, 3.0, -0.5),
            acceleration: DVec3::new(10.0, -4.0, 6.0),
            ..OrientationKalman::new(NoiseModel { decay, ..BELIEF })
        };
        // Magnus' third term is of order |rate|^2 |acceleration| dt^4 / 240: below 1e-4 rad at 100 ms.
        assert!(rotation::angle_deg(filter.extrapolate(0.1), integrate(&filter, 0.1)) < 0.006);
        let [by_rate, by_acceleration, _] = filter.propagations.way(0.1);
        let without = rotation::exp(filter.rate * by_rate + filter.acceleration * by_acceleration) * filter.orientation;
        let missing = rotation::angle_deg(without, integrate(&filter, 0.1));
        assert!(missing > 0.04, "the second term is needed: {missing}");
    }
}

/// Returns the derivative of the predicted state by the current state (the matrix F), from finite differences.
fn jacobian(filter: &OrientationKalman, dt: f64) -> Dense<9> {
    let step = 1e-6;
    let end = filter.extrapolate(dt);
    let mut f = identity();
    for column in 0..9 {
        let mut moved = filter.clone();
        let by = DVec3::AXES[column % 3] * step;
        match column / 3 {
            0 => moved.orientation = rotation::exp(by) * moved.orientation,
            1 => moved.rate += by,
            _ => moved.acceleration += by,
        }
        let change = rotation::difference(end, moved.extrapolate(dt)) / step;
        (0..3).for_each(|row| f[row][column] = change[row]);
        let step = filter.propagations.over(dt).step;
        match column / 3 {
            0 => {}
            1 => f[column][column] = step.y_axis.y,
            _ => {
                f[column - 3][column] = step.z_axis.y;
                f[column][column] = step.z_axis.z;
            }
        }
    }
    f
}

#[test]
fn the_covariance_grows_by_the_jacobian_of_the_propagation() {
    for (dt, decay) in
        [1e-4, 1.0 / 120.0, 0.05].into_iter().flat_map(|dt| [Decay::NONE, DECAY].map(|decay| (dt, decay)))
    {
        let filter = OrientationKalman { propagations: Propagations::of(decay), ..turning() };
        let f = jacobian(&filter, dt);
        let mut q = [[0.0; 9]; 9];
        for (i, entry) in Propagation::over(dt, decay).growth.to_cols_array().into_iter().enumerate() {
            (0..3).for_each(|axis| q[i % 3 * 3 + axis][i / 3 * 3 + axis] = entry);
        }
        let moved = product(&product(&f, &dense(&filter.covariance)), &transposed(&f));
        let expected = sum(&moved, BELIEF.jerk, &q);
        let mut predicted = filter.clone();
        predicted.predict(dt);
        let error = norm(&sum(&dense(&predicted.covariance), -1.0, &expected)) / norm(&expected);
        assert!(error < 2e-4, "{dt}: {error}");
    }
}

#[test]
fn a_correction_equals_the_textbook_form() {
    let mut filter = turning();
    let p = dense(&filter.covariance);
    // A report measures the angles alone: h is the first three rows of the identity, and k h = p (h' s^-1 h).
    let s = filter.covariance.angle + glam::DMat3::IDENTITY * BELIEF.measurement;
    let mut inverse = [[0.0; 9]; 9];
    for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))) {
        inverse[row][column] = s.inverse().col(column)[row];
    }
    let gain = product(&p, &inverse);
    let surprise = DVec3::new(0.01, -0.02, 0.005);
    let step = gain.map(|row| DVec3::new(row[0], row[1], row[2]).dot(surprise));
    let before = filter.clone();
    filter.correct(rotation::exp(surprise) * filter.orientation);
    let expected = product(&sum(&identity(), -1.0, &gain), &p);
    assert!(norm(&sum(&dense(&filter.covariance), -1.0, &expected)) < 1e-9 * norm(&expected));
    let moved = rotation::difference(before.orientation, filter.orientation);
    for axis in 0..3 {
        assert!((moved[axis] - step[axis]).abs() < 1e-9);
        assert!(((filter.rate - before.rate)[axis] - step[3 + axis]).abs() < 1e-9);
        assert!(((filter.acceleration - before.acceleration)[axis] - step[6 + axis]).abs() < 1e-8);
    }
}

proptest! {
    #[test]
    fn the_covariance_stays_positive_definite_for_any_times_turns_and_noise(
        steps in prop::collection::vec((-4.3..-0.7f64, -0.2..0.2f64, -0.2..0.2f64), 1..100),
        noise in -10.0..-2.0f64,
        jerk in 0.0..6.0f64,
        decays in (0.0..1e3, 0.0..1e3),
    ) {
        let decay = Decay { velocity: decays.0, acceleration: decays.1 };
        let belief = NoiseModel { measurement: 10f64.powf(noise), jerk: 10f64.powf(jerk), decay, ..BELIEF };
        let mut filter = OrientationKalman::new(belief);
        let mut t_ps = 0;
        let mut q = DQuat::IDENTITY;
        for (step, yaw, roll) in steps {
            t_ps += nearest_ps(10f64.powf(step));
            q = rotation::from_yaw_pitch_roll(yaw, 0.0, roll) * q;
            filter.update(t_ps, q);
            prop_assert!(is_positive_definite(&dense(&filter.covariance)), "{:?}", filter.covariance);
        }
    }
}

/// Returns the orientation at `t` seconds of a head that turns at 3.5 rad/s.
fn pan(t: f64) -> DQuat {
    rotation::about_y(3.5 * t)
}

#[test]
fn a_pan_is_followed_through_several_revolutions() {
    let mut filter = OrientationKalman::new(NoiseModel { measurement: 1e-10, ..BELIEF });
    for i in 1..=1200u64 {
        // The signs of the quaternions alternate, which must not matter.
        let q = pan(i as f64 / 120.0);
        filter.update(i * PS_PER_S / 120, if i % 2 == 0 { -q } else { q });
        if i > 120 {
            let ahead = pan(i as f64 / 120.0 + 0.1);
            assert!(rotation::angle_deg(filter.extrapolate(0.1), ahead) < 1e-2, "report {i}");
        }
    }
}

#[test]
fn a_report_half_a_turn_away_leaves_a_unit_quaternion() {
    let mut filter = turning();
    let opposite = rotation::about_y(std::f64::consts::PI) * filter.orientation;
    filter.update(filter.t_ps + PS_PER_S / 120, opposite);
    assert!((filter.orientation.length() - 1.0).abs() < 1e-12 && filter.rate.is_finite());
}
