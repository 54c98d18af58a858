//! Head motion, tracker models, prediction, pixel errors, and latency measured from outside, for head-mounted displays.
//!
//! ```text
//!  motion ──pose(t)──▶ tracker ──▶ cable ──▶ host port ──Report──▶ predict ──pose(t')──▶ view
//!    │                  rate, latency,  47 bytes   polled every        none, v, a,        pixel error,
//!    │                  noise, filter,  a record   30 ms, or           Kalman             dual list, VDRT,
//!    │                  metal, faults              per character                          frameless
//!    └──▶ rig: pendulum, photodiodes, D/A line, oscilloscope
//! ```
//!
//! # Behaviour, in the order of the signal
//!
//! 1. [`motion`]: where the head is, a pure function of simulated time. Still, pan, pendulum (exact, by elliptic
//!    functions), a seeded generator fitted to recorded headset use, and replay of CSV.
//! 2. [`tracker`]: solutions on the grid of the tracker's rate, each with the instant at which its pose was true;
//!    metal, noise and the tracker's own filter; one record at a time on the cable, so that solutions are dropped when
//!    a transfer outlasts the period; then the host's kernel, which polls. Faults can be injected.
//! 3. [`predict`]: a gate that rejects and counts what cannot be true, then a filter, asked for an exact instant.
//! 4. [`view`]: what an error of the pose is worth in pixels, and the mathematics of the dual display list, of the
//!    raster offset and of frameless rendering.
//! 5. [`rig`]: the pendulum that measures tracking and rendering latency from outside.
//!
//! # Units and conventions
//!
//! Instants and spans are picoseconds of simulated time in `u64` (`_ps`); only differences become floating point.
//! Metres, degrees in settings, radians in vectors. Axes are right-handed, y up; a head looks along its own -z. A
//! quaternion turns head axes into world axes. The same seed gives the same numbers on every host: all transcendental
//! functions come from `libm`, and random numbers are functions of (seed, index). Every number that describes hardware
//! or people is in the tables of [`config`], with unit, source, standing and range.
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
//! # Ok::<(), tracking::SettingError>(())
//! ```
//!
//! # Not modelled
//!
//! - The field of a magnetic tracker: distortion is a smooth bowl. Nor sight lines of the optical one.
//! - Coloured noise: all noise is white, so the tracker's filter looks better and slow wander is missing.
//! - Records of other receivers: they only take time on the cable. The head's record goes first.
//! - Clock drift between tracker and host; the phase of the host's polling is the only thing left to chance.
//! - Inertial sensors, and statistical correlation of translation with rotation in the synthetic motion.
//! - The neck: a pan turns the eye about itself.
//! - Damping of the pendulum, and the response times of photodiodes.
//!
//! # Sources
//!
//! See [`config`]. Prediction: Azuma and Bishop 1995. Just-in-time pixels: Mine and Bishop, UNC TR93-005. Raster
//! offset: Breglia 1981. Frameless rendering: Bishop, Fuchs, McMillan and Scher Zagier 1994. The rig: Cohen and Olano,
//! UNC TR94-028. Elliptic functions: Abramowitz and Stegun 16 and 17.

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

pub use error::SettingError;
pub use identity::SettingSink;
pub use pose::Pose;
