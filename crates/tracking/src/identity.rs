//! What motions, trackers and predictors are, written out as keys and values: for names of experiments that must not
//! change with the name of a type or a field.
//!
//! Every number is written as [`Display`] writes it, which for an `f64` is the shortest text that reads back as the same
//! number. Fields are taken apart one by one, so that a new one which nobody writes does not compile.

use core::fmt::Display;

use glam::DVec3;

use crate::pose::Pose;

/// What takes the settings, one after the other: a key and its value.
pub type SettingSink<'a> = dyn FnMut(&str, &dyn Display) + 'a;

/// Writes the three numbers of a place or direction.
pub(crate) fn write_vector(settings: &mut SettingSink, key: &str, vector: DVec3) {
    let [x, y, z] = vector.to_array();
    settings(key, &format_args!("{x} {y} {z}"));
}

/// Writes a position and a quaternion, real part last.
pub(crate) fn write_pose(settings: &mut SettingSink, key: &str, pose: &Pose) {
    let Pose { position, orientation } = pose;
    let [x, y, z] = position.to_array();
    let [i, j, k, w] = orientation.to_array();
    settings(key, &format_args!("{x} {y} {z} {i} {j} {k} {w}"));
}
