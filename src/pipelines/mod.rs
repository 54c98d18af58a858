//! Pipelines as experiments see them. A new pipeline is one more file here (or in a user's crate) that implements
//! [`Pipeline`].

mod rendering_control;
mod slats;

pub use rendering_control::RenderingControl;
pub use slats::{Code, Slats};

use crate::config::{ConfigError, MachineConfig};
use crate::machine::Machine;
use crate::observation::LateRegion;
use image::RgbImage;
use pphigs::{DisplayList, FrameView};
use pxpl5_gp::HostTiming;
use pxpl5_renderer::Layout;
use pxpl5_sim::Time;
use pxpl5_wire::Eye;
use std::fmt::Debug;
use std::sync::Arc;

/// The view of a frame or update (by number) whose pose is sampled at a time.
pub type Views = Arc<dyn Fn(u64, Time) -> FrameView + Send + Sync>;

/// What a pipeline is given to draw.
#[derive(Clone)]
pub struct Setup {
    /// Primitives.
    pub list: Arc<DisplayList>,
    /// Transforms and edits.
    pub views: Views,
    /// The host's times.
    pub host: HostTiming,
    /// Whether somebody may want pixels.
    pub pixels: bool,
}

/// One picture (a frame, or a field) and when it went through the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureTimes {
    /// Its number.
    pub picture: u64,
    /// When its pose was sampled.
    pub sampled_at: Option<Time>,
    /// Start of TRANSFORM.
    pub transform_at: Time,
    /// End of COPY.
    pub copied_at: Option<Time>,
    /// The retrace from which on it is shown.
    pub shown_at: Time,
    /// Whether all of it was there in time.
    pub complete: bool,
}

/// A program of a whole machine.
pub trait Pipeline: Debug + Send + Sync {
    /// Name on the command line.
    fn name(&self) -> &'static str;

    /// Frame buffers that it draws into: 1 or 2.
    fn eyes(&self) -> usize;

    /// How it divides pixel memory.
    fn layout(&self) -> Layout;

    /// The machine with what the pipeline's variant changes in it, such as the time of its code.
    fn adapt(&self, config: MachineConfig) -> MachineConfig {
        config
    }

    /// Loads its programs onto the boards.
    ///
    /// # Errors
    ///
    /// [`ConfigError`] when the machine is not one on which it can run.
    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), ConfigError>;

    /// The pictures shown before `end`, in order.
    fn pictures(&self, machine: &Machine, end: Time) -> Vec<PictureTimes>;

    /// Regions that missed their deadline before `end`.
    fn late_regions(&self, machine: &Machine, end: Time) -> Vec<LateRegion>;

    /// Retraces at which no complete new picture could be shown though there should have been one.
    fn missed_retraces(&self, pictures: &[PictureTimes]) -> u64;

    /// What latency means here, in a sentence.
    fn latency_definition(&self) -> &'static str;

    /// What a missed retrace means here, in a sentence.
    fn missed_definition(&self) -> &'static str;

    /// What the eye sees at the end of the run.
    fn picture(&self, machine: &Machine, eye: Eye) -> Option<RgbImage>;
}
