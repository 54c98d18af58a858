use glam::{DQuat, DVec3};
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use serde::{Deserialize, Serialize};

use super::Predictor;
use super::checked::Checked;
use super::extrapolation::{Extrapolation, Order};
use super::orientation_kalman::OrientationKalman;
use super::position_kalman::{NoiseModel, PositionKalman};
use super::predicting::GatedFilterPair;
use super::propagation::Decay;
use crate::config as table;
use crate::error::check;
use crate::tracker::TrackerConfig;

/// Least position noise that a Kalman filter may assume, m. With a noise of 0 the covariance matrix would be singular.
const MIN_NOISE_M: f64 = 1e-6;
/// Least orientation noise that a Kalman filter may assume, degrees.
const MIN_NOISE_DEG: f64 = 1e-4;

/// A prediction method, which computes the head's pose at a requested instant from earlier reports of the tracker.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PredictorKind {
    /// No prediction: the method returns the pose of the last report.
    None,
    /// Constant velocity: the last reported pose plus velocity x time.
    ConstantVelocity,
    /// Constant acceleration: the last reported pose plus velocity x time plus half the acceleration x time squared.
    ConstantAcceleration,
    /// Two Kalman filters. The filter for position is linear and estimates position, velocity and acceleration. The
    /// filter for orientation is an extended Kalman filter and estimates a quaternion, the angular velocity and the
    /// angular acceleration. Velocities and accelerations decay by [`Decay`].
    Kalman,
}

impl PredictorKind {
    /// All prediction methods in order of complexity, the simplest first.
    pub const ALL: [Self; 4] = [Self::None, Self::ConstantVelocity, Self::ConstantAcceleration, Self::Kalman];

    /// Returns the name of the method in experiment files and tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::ConstantVelocity => "velocity",
            Self::ConstantAcceleration => "acceleration",
            Self::Kalman => "kalman",
        }
    }
}

pxpl5_sim::parameters::named!(PredictorKind, "predictor", PredictorKind::ALL.map(|kind| (kind.name(), kind)));

/// Settings of a predictor: the method, and its assumptions about the noise of reports and the motion of the head.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PredictorConfig {
    /// Prediction method of the predictor.
    pub kind: PredictorKind,
    /// Number of reports, 1 to 16, from the older to the newer of the two positions whose difference gives a velocity.
    /// Kalman filters ignore this number.
    pub position_baseline: u32,
    /// Number of reports, 1 to 16, from the older to the newer of the two orientations whose difference gives an
    /// angular velocity. Kalman filters ignore this number.
    pub orientation_baseline: u32,
    /// Random position error that the filter assumes for each report, rms along each axis, m.
    pub position_noise_m: f64,
    /// Random orientation error that the filter assumes for each report, rms about each axis, degrees.
    pub orientation_noise_deg: f64,
    /// Strength of random changes of the head's acceleration (jerk), as a Kalman filter assumes it, m/s^3/sqrt(Hz). The
    /// jerk is white noise, and the value is the root of its spectral density.
    pub position_jerk: f64,
    /// Strength of random changes of the head's angular acceleration (angular jerk), as a Kalman filter assumes it,
    /// rad/s^3/sqrt(Hz). The angular jerk is white noise, and the value is the root of its spectral density.
    pub orientation_jerk: f64,
    /// Decay of the head's velocity and acceleration, as a Kalman filter assumes it.
    #[serde(default)]
    pub position_decay: Decay,
    /// Decay of the head's angular velocity and angular acceleration, as a Kalman filter assumes it.
    #[serde(default)]
    pub orientation_decay: Decay,
    /// Prediction intervals of position and orientation, ps. At these intervals, the predictions of a Kalman filter, of
    /// the last report and of a constant velocity are compared, and weighted by their recent errors. 0 uses the filter
    /// alone.
    #[serde(default)]
    pub check_ps: [u64; 2],
    /// Longest time, ps, for which the predictor extrapolates, forwards or backwards from the newest measurement. For
    /// other instants the predictor returns its estimate for the instant of the newest measurement.
    pub horizon_ps: u64,
    /// Assumptions of Kalman filters about the head's motion before the first report.
    #[serde(default)]
    pub start: Start,
    /// Limits by which the predictor accepts or rejects reports.
    #[serde(default = "default_gate")]
    pub gate: table::Gate,
}

/// Standard deviations that a Kalman filter assumes for the head's motion before the first report. The assumed mean is
/// a still head.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// Standard deviation of the head's speed before the first report, m/s.
    pub speed: f64,
    /// Standard deviation of the head's acceleration before the first report, m/s^2.
    pub acceleration: f64,
    /// Standard deviation of the head's angular velocity before the first report, rad/s.
    pub turn: f64,
    /// Standard deviation of the head's angular acceleration before the first report, rad/s^2.
    pub turn_acceleration: f64,
}

impl Start {
    const fn of(filter: &table::Filter) -> Self {
        Self {
            speed: filter.start_speed,
            acceleration: filter.start_acceleration,
            turn: filter.start_turn,
            turn_acceleration: filter.start_turn_acceleration,
        }
    }
}

impl Default for Start {
    fn default() -> Self {
        Self::of(&table::Filter::PAPERS)
    }
}

const fn default_gate() -> table::Gate {
    table::Gate::PAPERS
}

impl PredictorConfig {
    /// Returns settings of a predictor for the tracker `tracker`. The predictor assumes the same noise that the tracker
    /// model adds.
    pub fn for_tracker(kind: PredictorKind, tracker: &TrackerConfig) -> Self {
        Self::for_tracker_by(&table::Tables::PAPERS, kind, tracker)
    }

    /// Returns the settings of [`Self::for_tracker`] with the numbers of `tables` instead of the papers' numbers.
    pub fn for_tracker_by(tables: &table::Tables, kind: PredictorKind, tracker: &TrackerConfig) -> Self {
        let filter = &tables.filter;
        Self {
            kind,
            position_baseline: filter.baseline as u32,
            orientation_baseline: filter.baseline as u32,
            // A tracker without noise would make the covariance singular.
            position_noise_m: tracker.position_noise_m.max(MIN_NOISE_M),
            orientation_noise_deg: tracker.orientation_noise_deg.max(MIN_NOISE_DEG),
            position_jerk: filter.position_jerk,
            orientation_jerk: filter.orientation_jerk,
            position_decay: Decay { velocity: filter.velocity_decay, acceleration: filter.acceleration_decay },
            orientation_decay: Decay { velocity: filter.turn_decay, acceleration: filter.turn_acceleration_decay },
            check_ps: [0; 2],
            horizon_ps: table::ms_to_ps(filter.horizon),
            start: Start::of(filter),
            gate: tables.gate,
        }
    }

    /// Checks the settings and builds the predictor.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] if a setting is out of range.
    pub fn build(&self) -> Result<Box<dyn Predictor>, SettingError> {
        self.check()?;
        Ok(match self.kind {
            PredictorKind::None => self.extrapolation(Order::Zeroth),
            PredictorKind::ConstantVelocity => self.extrapolation(Order::First),
            PredictorKind::ConstantAcceleration => self.extrapolation(Order::Second),
            PredictorKind::Kalman => self.kalman(),
        })
    }

    fn check(&self) -> Result<(), SettingError> {
        check("position noise, m", self.position_noise_m, MIN_NOISE_M, 10.0)?;
        check("orientation noise, deg", self.orientation_noise_deg, MIN_NOISE_DEG, 90.0)?;
        [self.position_baseline, self.orientation_baseline].into_iter().try_for_each(|b| self.filter(b).check())?;
        self.gate.check()?;
        Ok(())
    }

    /// Returns these settings as a parameter table. Position and orientation have one baseline each, but the table has
    /// only one, `baseline`: the reports between the two poses whose difference gives a speed.
    pub(crate) fn filter(&self, baseline: u32) -> table::Filter {
        table::Filter {
            position_jerk: self.position_jerk,
            orientation_jerk: self.orientation_jerk,
            velocity_decay: self.position_decay.velocity,
            acceleration_decay: self.position_decay.acceleration,
            turn_decay: self.orientation_decay.velocity,
            turn_acceleration_decay: self.orientation_decay.acceleration,
            baseline: baseline.into(),
            horizon: crate::time::seconds(self.horizon_ps) * 1e3,
            start_speed: self.start.speed,
            start_acceleration: self.start.acceleration,
            start_turn: self.start.turn,
            start_turn_acceleration: self.start.turn_acceleration,
        }
    }

    fn extrapolation(&self, order: Order) -> Box<dyn Predictor> {
        Box::new(GatedFilterPair::new(
            Extrapolation::new(order, self.position_baseline as usize, DVec3::ZERO),
            Extrapolation::new(order, self.orientation_baseline as usize, DQuat::IDENTITY),
            crate::time::seconds(self.horizon_ps),
            self.gate,
        ))
    }

    fn kalman(&self) -> Box<dyn Predictor> {
        // Settings have standard deviations, filters need variances.
        let position = NoiseModel {
            measurement: square(self.position_noise_m),
            jerk: square(self.position_jerk),
            decay: self.position_decay,
            start: (square(self.start.speed), square(self.start.acceleration)),
        };
        let orientation = NoiseModel {
            measurement: square(self.orientation_noise_deg.to_radians()),
            jerk: square(self.orientation_jerk),
            decay: self.orientation_decay,
            start: (square(self.start.turn), square(self.start.turn_acceleration)),
        };
        let (position, orientation) = (PositionKalman::new(position), OrientationKalman::new(orientation));
        let horizon_s = crate::time::seconds(self.horizon_ps);
        let [of_position, of_orientation] = self.check_ps;
        if self.check_ps == [0; 2] {
            return Box::new(GatedFilterPair::new(position, orientation, horizon_s, self.gate));
        }
        Box::new(GatedFilterPair::new(
            Checked::new(position, self.position_baseline as usize, of_position, DVec3::ZERO),
            Checked::new(orientation, self.orientation_baseline as usize, of_orientation, DQuat::IDENTITY),
            horizon_s,
            self.gate,
        ))
    }
}

/// Returns `x * x`. All computers round a product equally, but may round a power function differently.
fn square(x: f64) -> f64 {
    x * x
}
