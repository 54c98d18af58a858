//! The settings of motions, trackers and predictors as keys and values. The names of experiments derive from these
//! texts, so a text stays the same when a type or field is renamed.
//!
//! [`Display`] formats every number. The text of an `f64` is the shortest text that parses to the same number. Each
//! function names all fields of its struct. If a struct gets a new field, the code does not compile until the function
//! handles this field.

use core::fmt::Display;

use glam::DVec3;

use crate::pose::Pose;

/// A callback that receives settings one after the other, each as a key and a value.
pub type SettingSink<'a> = dyn FnMut(&str, &dyn Display) + 'a;

pub(crate) fn write_vector(settings: &mut SettingSink, key: &str, vector: DVec3) {
    let [x, y, z] = vector.to_array();
    settings(key, &format_args!("{x} {y} {z}"));
}

/// Writes a pose as one setting: position, then quaternion with the real part last.
pub(crate) fn write_pose(settings: &mut SettingSink, key: &str, pose: &Pose) {
    let Pose { position, orientation } = pose;
    let [x, y, z] = position.to_array();
    let [i, j, k, w] = orientation.to_array();
    settings(key, &format_args!("{x} {y} {z} {i} {j} {k} {w}"));
}
