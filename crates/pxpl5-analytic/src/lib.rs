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
//! **Not modelled:** the order of messages of different senders at one instant, the exact words of the last clump's
//! messages beside its primitives, the host's own messages (a rate instead), different weights of regions within a
//! clump (their mean instead), memory.
//!
//! Times are nanoseconds in f64; an error of 1 ns is far below everything that is compared.

mod copies;
mod load;
mod renderer;
mod rendering_control;
mod slats;

pub use load::Load;
pub use rendering_control::{StereoModel, StereoTimes, stereo_loads};
pub use slats::{FieldTimes, SlatsModel};

use crate::config::ConfigError;
use crate::experiment::ExperimentError;
use crate::levels::{Case, Program, Summary};

/// Evaluates a case.
///
/// # Errors
///
/// [`ExperimentError::Config`] and [`ExperimentError::Scene`] as the transaction level, and
/// [`ExperimentError::Config`] for a pipeline of which there is no closed form, or a head with a tracker.
pub fn run(case: &Case) -> Result<Summary, ExperimentError> {
    case.machine.check()?;
    let no_form = |what: &str| ConfigError::Board(format!("the analytic level has no closed form of {what}"));
    if case.head.is_some() {
        return Err(no_form("a head with a tracker").into());
    }
    match case.program {
        Program::Slats(program) => slats::run(case, program),
        Program::RenderingControl(program) => rendering_control::run(case, program),
        Program::Jitp(_) | Program::Frameless(_) => Err(no_form(case.program.family()).into()),
    }
}
