//! The analytic level of the model.
//!
//! This crate computes the times of Slats and of Rendering Control by formulas, without simulation. Such a *closed
//! form* is a recurrence over clumps (groups of triangles), regions and pictures.
//!
//! ```text
//!   MachineConfig + Load --> SlatsModel::field  --> times of one field   (clumps x regions)
//!                        --> StereoModel::frames --> times of a frame     (pictures x regions)
//! ```
//!
//! The closed forms have no events, programs or pixels. The times of one configuration need a few hundred additions and
//! comparisons, so a sweep over many thousand configurations takes seconds. The formulas follow these rules of the
//! boards:
//!
//! - The messages of a clump leave in order. A renderer's full input FIFO delays a message.
//! - A renderer executes commands in order. While a renderer copies a region, the renderer executes no other command.
//! - A frame-buffer port receives one region at a time, in order of arrival.
//!
//! For Slats on several graphics processors, the model processes each message in the order in which the ring grants
//! channels (`senders`). The functions return an error for other pipelines, for displays other than NTSC, and for heads
//! with a tracker.
//!
//! Times are nanoseconds in f64. Rounding errors are far below 1 ns. Only differences of much more than 1 ns matter.
//!
//! # Not modelled
//!
//! - Ring channels that messages with pixels occupy.
//! - Interrupts of a graphics processor by messages of other boards.
//! - Words of a clump's last message, except the words of primitives.
//! - The host's own messages. A mean rate of messages replaces these messages.
//! - Views after the first view (Slats).
//! - Memory.

mod clumps;
mod copies;
mod load;
mod model;
mod renderer;
mod rendering_control;
mod senders;
mod slats;

pub use load::Load;
pub use model::{FieldTimes, PerTriangle, SlatsModel};
pub use rendering_control::{StereoModel, StereoTimes, stereo_loads};

use pxpl5_framebuffer::{FrameBufferConfig, Video};
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, ExperimentError, Pipeline, Registry, Summary};
use pxpl5_scene::Scene;
use pxpl5_sim::parameters::SettingError;
use std::any::Any;
use std::sync::Arc;

/// Registers the closed forms of Slats and of Rendering Control.
pub fn add_closed_forms(registry: &mut Registry) {
    registry.closed_form("rendering-control", rendering_control::CLOSED_FORM);
    registry.closed_form("slats", slats::CLOSED_FORM);
}

/// Returns the experiment's pipeline. Returns an error if the pipeline does not have the type `P`, or if a tracker
/// reports the head's pose.
fn pipeline_of<P: Pipeline + Copy>(experiment: &Experiment) -> Result<P, ExperimentError> {
    experiment.config().check()?;
    if experiment.head.is_some() {
        return Err(no_form("a head with a tracker").into());
    }
    let pipeline: &dyn Any = experiment.pipeline().as_ref();
    let found = pipeline.downcast_ref().copied();
    found.ok_or_else(|| no_form(experiment.pipeline().name()).into())
}

/// Smallest and largest number of fields that an estimate computes.
///
/// In these fields, a run reaches a steady state and shows several views of a moving head.
const ESTIMATED_FIELDS: (u64, u64) = (24, 60);

/// Estimates the largest number of primitives for which all pictures are in time.
///
/// The head follows the scene's own motion without a tracker. The search decimates the last scene that was too heavy,
/// so the result can differ slightly from a decimation of the whole scene. The last step therefore tests the final
/// number with a decimation of the whole scene.
fn primitives_in_time(
    experiment: &Experiment,
    summary: fn(&Experiment) -> Result<Summary, ExperimentError>,
) -> Option<u64> {
    let (least, most) = ESTIMATED_FIELDS;
    let mut plain = experiment.clone().fields(experiment.fields.clamp(least, most));
    plain.head = None;
    let is_in_time = |scene: &Arc<Scene>| is_in_time(&summary(&plain.clone().with_scene(Arc::clone(scene))).ok()?);
    let whole = Arc::clone(plain.scene());
    let mut denser = Arc::clone(&whole);
    let mut in_time = 0;
    // Bisection between a number of primitives that is in time and a number that is too large.
    let mut too_many = whole.primitives() + 1;
    while too_many - in_time > 1 {
        let middle = in_time + (too_many - in_time) / 2;
        let thinned = Arc::new(denser.decimated(middle).ok()?);
        if is_in_time(&thinned)? {
            in_time = middle;
            continue;
        }
        too_many = middle;
        // Decimation may return fewer primitives if no further edge can be removed. Then keep the denser scene.
        if thinned.primitives() == middle {
            denser = thinned;
        }
    }
    // Test the result with a direct decimation of the whole scene.
    while in_time > 0 && !is_in_time(&Arc::new(whole.decimated(in_time).ok()?))? {
        in_time -= in_time.div_ceil(100);
    }
    Some(in_time as u64)
}

fn is_in_time(summary: &Summary) -> Option<bool> {
    summary.due.map(|due| due.not_shown() == 0)
}

fn no_form(what: &str) -> SettingError {
    SettingError::combination(format_args!("the analytic level has no closed form of {what}"))
}

fn video_of(config: &MachineConfig) -> Result<Video, SettingError> {
    let display: Option<&FrameBufferConfig> =
        config.displays.first().and_then(|display| (display.as_ref() as &dyn Any).downcast_ref());
    let display = display.ok_or_else(|| no_form("a display other than ntsc"))?;
    display.video.video()
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
