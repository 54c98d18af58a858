//! The pipelines of the papers. A new one is one more file here, or in a user's crate, and one more line below.

mod frameless;
mod jitp;
mod rendering_control;
mod slats;

pub use frameless::Frameless;
pub use jitp::{Interpolation, Jitp, Viewpoint, region_at};
pub use rendering_control::RenderingControl;
pub use slats::{Code, Slats};

use crate::registry::PipelineEntry;
use pxpl5_framebuffer::NtscDisplay;
use pxpl5_machine::{ConfigError, Record};
use std::any::Any;

pub(crate) fn entries() -> Vec<PipelineEntry> {
    let mut all = vec![rendering_control::ENTRY, slats::ENTRY, frameless::ENTRY];
    all.extend(jitp::ENTRIES);
    all
}

/// The display of a pipeline that is written for interlaced fields.
fn ntsc<'a>(record: &'a Record, pipeline: &str) -> Result<&'a NtscDisplay, ConfigError> {
    (record.display() as &dyn Any).downcast_ref().ok_or_else(|| {
        let found = record.display().name();
        ConfigError::Board(format!("{pipeline} draws single fields: expected the display ntsc, found {found}"))
    })
}
