use core::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;
use pxpl5_sim::parameters::{ParameterTable, SettingError};

use super::Motion;
use crate::config as table;
use crate::identity::SettingSink;
use crate::pose::Pose;
use crate::rotation;
use crate::time::{nearest_ps, seconds};

/// An undamped pendulum that swings in the x-y plane, with the exact formula of its motion. At time 0 the pendulum is
/// released at rest at the angle `+amplitude`.
///
/// With k = sin(amplitude / 2) and w = sqrt(g / arm): sin(angle / 2) = k cd(w t, k), where cd is Jacobi's elliptic
/// function. The exact period is 4 K(k) / w, where K is the complete elliptic integral. The small-angle period 2 pi / w
/// is shorter, by 0.77 % at 20 degrees. The bob, which is the weight of the pendulum, hangs `arm` below the origin and
/// turns with the arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pendulum {
    arm_m: f64,
    modulus: f64,
    /// Angular frequency sqrt(g / arm) of a small swing.
    natural_rad_per_s: f64,
    period_s: f64,
}

impl Pendulum {
    /// Creates a pendulum with an arm in metres (above 0) and an amplitude in degrees (above 0, below 180).
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] if the arm or the amplitude is outside the limits of [`table::RigNumbers`].
    pub fn new(arm_m: f64, amplitude_deg: f64) -> Result<Self, SettingError> {
        table::RigNumbers { pendulum_arm: arm_m, pendulum_amplitude: amplitude_deg, ..table::RigNumbers::PAPERS }
            .check()?;
        let modulus = libm::sin(amplitude_deg.to_radians() / 2.0);
        let natural_rad_per_s = (table::RigNumbers::PAPERS.gravity / arm_m).sqrt();
        let period_s = 4.0 * quarter_period(modulus) / natural_rad_per_s;
        Ok(Self { arm_m, modulus, natural_rad_per_s, period_s })
    }

    /// Returns the pendulum of the measuring rig: arm 0.5 m, amplitude 20 degrees. Both values are assumed.
    pub fn rig() -> Self {
        Self::new(table::RigNumbers::PAPERS.pendulum_arm, table::RigNumbers::PAPERS.pendulum_amplitude)
            .expect("the table's values are in range")
    }

    /// Returns the exact period of the swing in seconds.
    pub fn period_s(&self) -> f64 {
        self.period_s
    }

    /// Returns the period of an infinitely small swing, 2 pi sqrt(arm / g), in seconds.
    pub fn small_angle_period_s(&self) -> f64 {
        TAU / self.natural_rad_per_s
    }

    /// Returns the speed of the pendulum at its lowest point, m/s: 2 k sqrt(g arm) with k = sin(amplitude / 2). The
    /// formula follows from the conservation of energy.
    pub fn low_point_speed(&self) -> f64 {
        2.0 * self.modulus * self.natural_rad_per_s * self.arm_m
    }

    /// Returns the instant (ps) of pass `n` of the pendulum through its lowest point, counted from 0. This pass comes 2
    /// n + 1 quarters of a period after the start.
    pub fn low_point_ps(&self, n: u64) -> u64 {
        nearest_ps((2.0 * n as f64 + 1.0) * self.period_s / 4.0)
    }

    /// Returns the pendulum's angle from the vertical (rad, positive towards +x) and the rate of change of the angle
    /// (rad/s).
    pub fn angle(&self, t_ps: u64) -> (f64, f64) {
        let u = self.natural_rad_per_s * libm::fmod(seconds(t_ps), self.period_s);
        let (sn, cn, dn) = jacobi(u, self.modulus);
        let sine = (self.modulus * cn / dn).clamp(-1.0, 1.0);
        let complement = (1.0 - self.modulus * self.modulus).sqrt();
        let rate = -2.0 * self.modulus * complement * self.natural_rad_per_s * sn / dn;
        (2.0 * libm::asin(sine), rate)
    }
}

impl Motion for Pendulum {
    /// Writes the arm's length and the sine of half the amplitude, which determine frequency and period.
    fn identify(&self, settings: &mut SettingSink) {
        settings("motion", &"pendulum");
        settings("motion.arm_m", &self.arm_m);
        settings("motion.modulus", &self.modulus);
    }
    fn pose(&self, t_ps: u64) -> Pose {
        let (angle, _) = self.angle(t_ps);
        let (sin, cos) = libm::sincos(angle);
        Pose { position: DVec3::new(sin, -cos, 0.0) * self.arm_m, orientation: rotation::about_z(angle) }
    }
    fn velocity(&self, t_ps: u64) -> DVec3 {
        let (angle, rate) = self.angle(t_ps);
        let (sin, cos) = libm::sincos(angle);
        DVec3::new(cos, sin, 0.0) * (self.arm_m * rate)
    }
    fn angular_velocity(&self, t_ps: u64) -> DVec3 {
        DVec3::Z * self.angle(t_ps).1
    }
}

/// Number of steps of the arithmetic-geometric mean. Each step about doubles the number of correct digits, so 8 steps
/// suffice for every modulus below 0.99999.
const LEVELS: usize = 8;

/// Returns the complete elliptic integral K(k) = pi / (2 agm(1, k')), where agm is the arithmetic-geometric mean and k'
/// = sqrt(1 - k^2).
fn quarter_period(modulus: f64) -> f64 {
    FRAC_PI_2 / mean_ladder(modulus).0
}

/// Returns the arithmetic-geometric mean of 1 and k', and the ratio c_n / a_n of each step n of the mean (Abramowitz
/// and Stegun 17.6).
fn mean_ladder(modulus: f64) -> (f64, [f64; LEVELS]) {
    let mut a = 1.0;
    let mut b = (1.0 - modulus * modulus).sqrt();
    let ratios = core::array::from_fn(|_| {
        let c = (a - b) / 2.0;
        let arithmetic = (a + b) / 2.0;
        b = (a * b).sqrt();
        a = arithmetic;
        c / a
    });
    (a, ratios)
}

/// Returns Jacobi's sn, cn and dn, computed by the descending sequence of Abramowitz and Stegun 16.4.
fn jacobi(u: f64, modulus: f64) -> (f64, f64, f64) {
    let (mean, ratios) = mean_ladder(modulus);
    let top = (1u32 << LEVELS) as f64 * mean * u;
    let amplitude = ratios.iter().rev().fold(top, |phi, ratio| (phi + libm::asin(ratio * libm::sin(phi))) / 2.0);
    let (sn, cn) = libm::sincos(amplitude);
    (sn, cn, (1.0 - modulus * modulus * sn * sn).sqrt())
}

#[cfg(test)]
mod tests {
    use super::super::assert_rates_agree_with_poses;
    use super::*;
    use crate::time::PS_PER_S;
    use glam::DVec2;

    /// Returns the angle of a pendulum after `until_s` seconds, from a Runge-Kutta integration of angle'' = -(g / arm)
    /// sin(angle). The tested model uses elliptic functions instead.
    fn integrate(arm: f64, amplitude_deg: f64, until_s: f64) -> f64 {
        let steps = 20_000;
        let h = until_s / steps as f64;
        let mut state = DVec2::new(amplitude_deg.to_radians(), 0.0);
        for _ in 0..steps {
            let k1 = slope(arm, state);
            let k2 = slope(arm, state + k1 * (h / 2.0));
            let k3 = slope(arm, state + k2 * (h / 2.0));
            let k4 = slope(arm, state + k3 * h);
            state += (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0 * h;
        }
        state.x
    }

    fn slope(arm: f64, state: DVec2) -> DVec2 {
        DVec2::new(state.y, -table::RigNumbers::PAPERS.gravity / arm * state.x.sin())
    }

    #[test]
    fn the_closed_form_of_the_pendulum_agrees_with_a_numerical_integration() {
        for (arm, amplitude, t) in [(0.5, 20.0, 3.3), (0.5, 90.0, 2.1), (1.0, 170.0, 4.7)] {
            let closed = Pendulum::new(arm, amplitude).unwrap().angle(nearest_ps(t)).0;
            assert!((closed - integrate(arm, amplitude, t)).abs() < 1e-8, "{arm} {amplitude}");
        }
    }

    #[test]
    fn the_small_angle_period_of_half_a_metre_is_1_419_s() {
        let pendulum = Pendulum::rig();
        assert!((pendulum.small_angle_period_s() - TAU * (0.5f64 / 9.80665).sqrt()).abs() < 1e-15);
        assert!((pendulum.small_angle_period_s() - 1.419).abs() < 5e-4);
    }

    #[test]
    fn the_exact_period_follows_the_series_in_the_amplitude() {
        // T = T0 (1 + a^2/16 + 11 a^4/3072 + 173 a^6/737280 + ...), a in radians.
        let a = 20f64.to_radians();
        let series = 1.0 + a.powi(2) / 16.0 + 11.0 * a.powi(4) / 3072.0 + 173.0 * a.powi(6) / 737_280.0;
        let pendulum = Pendulum::rig();
        assert!((pendulum.period_s() / pendulum.small_angle_period_s() - series).abs() < 1e-8);
    }

    #[test]
    fn the_bob_passes_the_low_point_at_its_greatest_speed() {
        let pendulum = Pendulum::rig();
        for n in [0, 1, 2, 7, 5000] {
            let (angle, rate) = pendulum.angle(pendulum.low_point_ps(n));
            assert!(angle.abs() < 1e-10, "{n} {angle}");
            assert!((rate.abs() * 0.5 - pendulum.low_point_speed()).abs() < 1e-9);
        }
    }

    #[test]
    fn energy_is_conserved_for_an_hour() {
        let pendulum = Pendulum::rig();
        let (angle, rate) = pendulum.angle(3600 * PS_PER_S);
        let energy = 0.5 * (0.5 * rate).powi(2) - 9.80665 * 0.5 * angle.cos();
        assert!((energy + 9.80665 * 0.5 * 20f64.to_radians().cos()).abs() < 1e-12);
    }

    #[test]
    fn the_rates_are_the_derivatives_of_the_poses() {
        (1..20).for_each(|i| assert_rates_agree_with_poses(&Pendulum::rig(), i * 77_777_777_777, 1e-6));
    }

    #[test]
    fn a_low_point_beyond_the_end_of_time_is_the_end_of_time() {
        assert_eq!(Pendulum::rig().low_point_ps(u64::MAX), u64::MAX);
    }

    #[test]
    fn a_pendulum_without_an_arm_is_an_error() {
        assert!(Pendulum::new(0.0, 20.0).is_err());
        assert!(Pendulum::new(0.5, 180.0).is_err());
        assert!(Pendulum::new(f64::NAN, 20.0).is_err());
    }
}
