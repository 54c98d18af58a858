//! The analytic level: the stage rules of both pipelines as recurrences over clumps, regions and pictures.
//!
//! ```text
//!   MachineConfig + Load --> SlatsModel::field  --> times of one field   (clumps x regions)
//!                        --> StereoModel::steady --> times of a frame     (pictures x regions)
//! ```
//!
//! There are no events, no programs and no pixels: a configuration is a few hundred additions and maxima, so that
//! sweeps over many thousand configurations take seconds. What it takes from the rules of the boards:
//!
//! - the DMA chain of a clump goes out in order; a message is held up by the input FIFO of its renderer;
//! - a renderer executes in order and is held by the copy of a region;
//! - a frame-buffer port takes one region at a time, in order of arrival.
//!
//! Slats on several GPs goes through its messages one by one, in the order in which the ring grants them (`senders`). Other
//! pipelines, displays that are not NTSC, and heads with a tracker are refused.
//!
//! **Not modelled:** channels that pixels take, interrupts of a GP by messages of others, the words of the last clump's messages beside its
//! primitives, the host's own messages (a rate instead), views after the first one (Slats), memory.
//!
//! Times are nanoseconds in f64; an error of 1 ns is far below everything that is compared.

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
use pxpl5_machine::{ConfigError, MachineConfig};
use pxpl5_run::{Experiment, ExperimentError, Pipeline, Registry, Summary};
use pxpl5_scene::Scene;
use std::any::Any;
use std::sync::Arc;

/// Adds the closed forms to the pipelines that have one.
pub fn add_closed_forms(registry: &mut Registry) {
    registry.closed_form("rendering-control", rendering_control::CLOSED_FORM);
    registry.closed_form("slats", slats::CLOSED_FORM);
}

/// Checks an experiment and gives its pipeline, of which there is a closed form.
fn pipeline_of<P: Pipeline + Copy>(experiment: &Experiment) -> Result<P, ExperimentError> {
    experiment.config().check()?;
    if experiment.tracked_head().is_some() {
        return Err(no_form("a head with a tracker").into());
    }
    let pipeline: &dyn Any = experiment.pipeline().as_ref();
    let found = pipeline.downcast_ref().copied();
    found.ok_or_else(|| no_form(experiment.pipeline().name()).into())
}

/// Fields that an estimate looks at: enough for a steady state, and for some of the views of a head that moves.
const ESTIMATED_FIELDS: (u64, u64) = (24, 60);

/// About the most primitives to which an experiment's scene can be decimated so that all is in time; with them it is.
/// A head with a tracker is left out: the scene's own motion stands for it.
///
/// While it searches, what is already too much is thinned further, not the whole scene each time: what comes out differs a little
/// from the scene that the whole one is decimated to, of which at last it is asked whether it is in time.
fn triangles_in_time(
    experiment: &Experiment,
    summary: fn(&Experiment) -> Result<Summary, ExperimentError>,
) -> Option<u64> {
    let (least, most) = ESTIMATED_FIELDS;
    let plain = experiment.clone().without_head().fields(experiment.length().clamp(least, most));
    let is_in_time = |scene: &Arc<Scene>| is_in_time(&summary(&plain.clone().with_scene(Arc::clone(scene))).ok()?);
    let whole = Arc::clone(plain.scene());
    let mut denser = Arc::clone(&whole);
    let mut in_time = 0;
    let mut too_many = primitives(&whole) + 1;
    while too_many - in_time > 1 {
        let middle = in_time + (too_many - in_time) / 2;
        let thinned = Arc::new(denser.decimated(middle).ok()?);
        if is_in_time(&thinned)? {
            in_time = middle;
            continue;
        }
        too_many = middle;
        // It can have fewer, where no edge is left that can go: then others are thinned from what came before it.
        if primitives(&thinned) == middle {
            denser = thinned;
        }
    }
    while in_time > 0 && !is_in_time(&Arc::new(whole.decimated(in_time).ok()?))? {
        in_time -= in_time.div_ceil(100);
    }
    Some(in_time as u64)
}

fn primitives(scene: &Scene) -> usize {
    scene.triangles().len() + scene.spheres().len()
}

fn is_in_time(summary: &Summary) -> Option<bool> {
    summary.due.map(|due| due.not_shown() == 0)
}

fn no_form(what: &str) -> ConfigError {
    ConfigError::Board(format!("the analytic level has no closed form of {what}"))
}

/// Retraces and beam of a machine's first display, which the closed forms know only as NTSC.
fn video_of(config: &MachineConfig) -> Result<Video, ConfigError> {
    let display: Option<&FrameBufferConfig> =
        config.displays.first().and_then(|display| (display.as_ref() as &dyn Any).downcast_ref());
    let display = display.ok_or_else(|| no_form("a display other than ntsc"))?;
    Video::new(display.video).map_err(|error| ConfigError::Board(error.to_string()))
}
