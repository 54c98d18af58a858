//! Head motion, tracker models and pose prediction for head-mounted displays.
//!
//! The crate also computes pixel errors of a wrong pose, and measures latency from outside the machine.
//!
//! ```text
//!  motion ──pose(t)──▶ tracker ──▶ cable ──▶ host port ──Report──▶ predict ──pose(t')──▶ view
//!    │                  rate, latency,  47 bytes   polled every        none, v, a,        pixel error,
//!    │                  noise, filter,  a record   30 ms, or           Kalman             raster offset,
//!    │                  metal, faults              per character                          dual list, frameless
//!    └──▶ rig: pendulum, photodiodes, D/A line, oscilloscope
//! ```
//!
//! # Modules, in the order of the signal
//!
//! 1. [`motion`]: the pose of the head as a pure function of simulated time. A head can stand still, pan, swing as a
//!    pendulum or walk. A head can also move at random with the statistics of recorded headset use, or replay a
//!    recorded file.
//! 2. [`tracker`]: the tracker measures poses at its own rate. The model adds noise, metal distortion and filter delay.
//!    The serial cable carries one record at a time, so the tracker drops measurements if a transfer takes longer than
//!    its period. The host's Unix kernel polls the serial port. Experiments can inject faults.
//! 3. [`predict`]: a check rejects and counts impossible reports. A filter then predicts the pose at an exact instant.
//! 4. [`view`]: converts a pose error into pixels. This module also has the formulas of the dual display list, of the
//!    raster offset and of frameless rendering.
//! 5. [`rig`]: a pendulum that measures tracking latency and rendering latency from outside the machine.
//!
//! # Units and conventions
//!
//! Instants and spans are picoseconds of simulated time in `u64` (suffix `_ps`). Only differences of instants are
//! converted to floating point. Lengths are metres. Angles are degrees in settings and radians in vectors. Axes are
//! right-handed with y up, and a head looks along its own -z axis. A quaternion rotates head axes into world axes.
//!
//! The same seed gives the same numbers on every computer. All transcendental functions come from `libm`, and each
//! random number is a function of (seed, index). The tables of [`config`] hold every number that describes hardware or
//! people, with unit, source, provenance and range.
//!
//! ```
//! use tracking::motion::Synthetic;
//! use tracking::predict::{PredictorConfig, PredictorKind};
//! use tracking::tracker::{TrackerConfig, TrackerModel};
//!
//! let head = Synthetic::recorded_use(1);
//! let tracker = TrackerModel::new(TrackerConfig::fastrak())?;
//! let mut predictor = PredictorConfig::for_tracker(PredictorKind::Kalman, tracker.config()).build()?;
//! for report in tracker.reports(&head, 2).take(120) {
//!     predictor.observe(&report);
//! }
//! let shown_ps = 1_050_000_000_000;
//! assert!(predictor.predict(shown_ps).is_finite());
//! # Ok::<(), pxpl5_sim::parameters::SettingError>(())
//! ```
//!
//! # Not modelled
//!
//! - The field of a magnetic tracker. The distortion is a smooth bowl.
//! - The sight lines of the optical tracker.
//! - Coloured noise. All noise is white, so the tracker's filter performs better than a real filter, and slow drift is
//!   missing.
//! - The contents of other receivers' records. These records only take time on the cable, and the head's record goes
//!   first.
//! - Clock drift between tracker and host. Only the phase of the host's polling is random.
//! - Inertial sensors.
//! - The statistical correlation between translation and rotation in the random motion.
//! - The neck. A pan rotates the eye about its own position.
//! - Damping of the pendulum, and the response times of photodiodes.
//!
//! # Sources
//!
//! [`config`] lists the sources of all numbers. Prediction is by Azuma and Bishop 1995, just-in-time pixels by Mine and
//! Bishop, UNC TR93-005. The raster offset is by Breglia 1981, and frameless rendering by Bishop, Fuchs, McMillan and
//! Scher Zagier 1994. The pendulum rig is described by Olano, Cohen, Mine and Bishop, I3D 1995. Elliptic functions follow Abramowitz and
//! Stegun, chapters 16 and 17.

#![warn(missing_docs)]

pub mod config;
mod error;
mod identify;
mod identity;
pub mod motion;
mod pose;
pub mod predict;
pub mod random;
pub mod rig;
pub mod rotation;
pub mod time;
pub mod tracker;
pub mod view;

pub use identity::SettingSink;
pub use pose::Pose;

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
