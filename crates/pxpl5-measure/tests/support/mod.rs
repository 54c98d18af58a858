//! The beam of NTSC, rotations, and small experiments, for tests against formulas.

use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, PipelineSettings, Pixels, Registry};
use pxpl5_scene::builtin;
use std::sync::Arc;

/// Duration of an NTSC line.
///
/// A line has 780 pixel periods, of which the last 640 are visible. A field has 262.5 lines, of which the first 22 are
/// blanked, and half a line more in odd fields. All blanking precedes the visible part.
pub(crate) const LINE_S: f64 = 4004.0 / 63.0 * 1e-6;

/// Returns the time at which the beam begins a field.
pub(crate) fn retrace(field: u64) -> f64 {
    field as f64 * 262.5 * LINE_S
}

/// Returns the time at which the beam reaches a pixel of a field.
pub(crate) fn beam(field: u64, row: u64, x: u64) -> f64 {
    let half = (field % 2) as f64 / 2.0;
    retrace(field) + (half + 22.0 + row as f64 + (140.0 + x as f64) / 780.0) * LINE_S
}

/// Returns the focal length, in pixels, of `width` pixels over 60 degrees.
pub(crate) fn focal_px(width: f64) -> f64 {
    width / 2.0 / 30f64.to_radians().tan()
}

/// Returns the position of content after a rotation to the left, in pixels from the middle.
pub(crate) fn after(right: f64, up: f64, angle: f64, f: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    let depth = f * cos - right * sin;
    [(right * cos + f * sin) * f / depth, up * f / depth]
}

/// Returns an experiment with a pipeline and a scene, which are given by name, on a machine that suits the pipeline.
pub(crate) fn experiment(pipeline: &str, scene: &str) -> Experiment {
    let pipeline = (Registry::of_papers().pipeline(pipeline).expect("listed").build)(&PipelineSettings::default());
    let config = pipeline.adapt(MachineConfig::small_hmd());
    Experiment::with(config, pipeline, Arc::new(builtin(scene).expect("built in"))).pixels(Pixels::Off)
}
