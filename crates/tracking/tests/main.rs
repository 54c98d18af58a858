//! Tests of motion, trackers, and predictors.

mod gain;
mod pendulum_rig;
mod prediction;
mod synthetic_motion;
mod trackers;
mod tuning;
mod view;
