//! The pipelines of the papers. A new one is one more file here, or in a user's crate, and one more line below.

mod face_plan;
mod faces;
mod frameless;
mod jitp;
mod rendering_control;
mod slats;

pub use faces::{FacePipeline, FacePolicy};
pub use frameless::Frameless;
pub use jitp::{Interpolation, Jitp, Viewpoint, region_at};
pub use rendering_control::{FinishedRegions, RenderingControl};
pub use slats::{Code, Slats};

use crate::registry::PipelineEntry;
use pxpl5_framebuffer::{NtscDisplay, Video};
use pxpl5_gp::{Mark, Stage};
use pxpl5_machine::{Arrival, ConfigError, LateRegion, Record};
use pxpl5_sim::Time;
use std::any::Any;

pub(crate) fn entries() -> Vec<PipelineEntry> {
    let mut all = vec![rendering_control::ENTRY, slats::ENTRY, frameless::ENTRY];
    all.extend(jitp::ENTRIES);
    all.extend(faces::ENTRIES);
    all
}

/// The display of a pipeline that is written for interlaced fields.
fn ntsc<'a>(record: &'a Record, pipeline: &str) -> Result<&'a NtscDisplay, ConfigError> {
    (record.display() as &dyn Any).downcast_ref().ok_or_else(|| {
        let found = record.display().name();
        ConfigError::Board(format!("{pipeline} draws single fields: expected the display ntsc, found {found}"))
    })
}

/// When boards took a view to draw for.
fn samples(record: &Record) -> impl Iterator<Item = &Mark> {
    record.observation().marks.iter().filter(|mark| mark.stage == Stage::Sample)
}

/// Regions that were there after they were due, in the order of arrival.
fn late_regions(
    display: &NtscDisplay,
    record: &Record,
    end: Time,
    due: impl Fn(&Video, &Arrival) -> Time,
) -> Vec<LateRegion> {
    let arrived = record.observation().arrivals.iter().filter(|arrival| arrival.last_part_at < end);
    let late = arrived.filter_map(|arrival| {
        let due = due(display.video(), arrival);
        (arrival.last_part_at > due).then(|| LateRegion {
            field: arrival.target.picture.period_drawn_for(),
            surface: arrival.surface,
            region: arrival.target.region.0,
            lateness: arrival.last_part_at.since(due),
        })
    });
    late.collect()
}
