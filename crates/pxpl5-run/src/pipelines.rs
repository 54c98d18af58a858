//! The pipelines of the papers. A new pipeline needs a new file in this module or in a separate crate, and a line in
//! the function `entries`.

pub(crate) mod faces;
mod frameless;
mod jitp;
mod region_policy;
mod rendering_control;
mod slats;

pub use frameless::Frameless;
pub use jitp::{Interpolation, Jitp, Viewpoint, region_at};
pub use region_policy::{PolicyFrame, PolicyPipeline, RegionAssignment, RegionPolicy};
pub use rendering_control::{FinishedRegions, RenderingControl};
pub use slats::{Code, Slats, SlatsLighting};

use crate::keys::PipelineSettings;
use crate::pipeline::PictureTimes;
use crate::registry::PipelineEntry;
use crate::result::picture_ends::PictureResult;
use pphigs::{Picture, RegionBinning, Shading};
use pxpl5_framebuffer::{NtscDisplay, Video};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{Mark, Stage};
use pxpl5_machine::{Arrival, LateRegion, Record, StageSpan};
use pxpl5_renderer::Layout;
use pxpl5_sim::Time;
use pxpl5_sim::parameters::{Key, KeyValue, KeyValues, SettingError, names};
use pxpl5_wire::{Lines, PictureNumber, RegionGrid, ViewNumber};
use std::any::Any;

pub(crate) fn entries() -> Vec<PipelineEntry> {
    let mut all = vec![rendering_control::ENTRY, slats::ENTRY, frameless::ENTRY];
    all.extend(jitp::ENTRIES);
    all.extend(faces::ENTRIES.into_iter().flatten());
    all
}

/// Checks that a backing store of `renderer.backing_bits` bits holds one finished region, because a region without room
/// can never be copied. The region takes `blocks` times `renderer.kept_bits` bits.
fn region_has_room(record: &Record, blocks: u64) -> Result<(), SettingError> {
    let renderer = &record.config().renderer;
    if renderer.backing_regions() >= blocks {
        return Ok(());
    }
    let (needed, found) = (blocks.saturating_mul(renderer.kept_bits), renderer.backing_bits);
    let what = format!("{blocks} blocks of {} bits (renderer.kept_bits) for a finished region", renderer.kept_bits);
    let expected = format!("{needed} at least, room for {what}");
    Err(SettingError::value("renderer.backing_bits", expected, found))
}

fn whole_picture(record: &Record) -> Result<Viewport, SettingError> {
    let grid = record.display().surfaces().first().map_or(Viewport::FRAME.grid(), |surface| surface.grid());
    Viewport::new(grid, Lines::Frame)
}

/// Returns the first display of the machine. Returns an error unless the display is interlaced and has at least 640 x
/// 480 pixels.
fn ntsc<'a>(record: &'a Record, pipeline: &str) -> Result<&'a NtscDisplay, SettingError> {
    let display: &NtscDisplay = (record.display() as &dyn Any).downcast_ref().ok_or_else(|| {
        let found = record.display().name();
        SettingError::combination(format_args!(
            "{pipeline} draws single fields of 240 lines between two retraces, so it needs interlace: expected the display ntsc, found {found}"
        ))
    })?;
    // A larger display is accepted.
    let RegionGrid { width, height, .. } = RegionGrid::FRAME;
    let [found_width, found_height] = [display.video().width(), display.video().height()];
    if found_width < width || found_height < height {
        let lines = height / 2;
        return Err(SettingError::combination(format_args!(
            "{pipeline} draws {width} x {height} pixels: expected video.visible_pixels from {width} and video.visible_lines from {lines}, \
             found {found_width} and {}",
            found_height / 2
        )));
    }
    Ok(display)
}

const SHADINGS: [(&str, Shading); 2] = [("phong", Shading::Phong), ("gouraud", Shading::Gouraud)];

const SHADING: Key =
    Key::new("shading", "method of shading", KeyValues::Names(&const { names(&SHADINGS) })).with_default("phong");

fn shading_value(shading: Shading) -> KeyValue {
    KeyValue::Name(SHADINGS[usize::from(shading == SHADINGS[1].1)].0)
}

fn shading_or(settings: &PipelineSettings, default: Shading) -> Shading {
    let given = SHADINGS.iter().find(|(name, _)| settings.name(SHADING.name) == Some(name));
    given.map_or(default, |(_, shading)| *shading)
}

/// Returns the times of a picture that a swap shows at `shown_at`. Returns `None` before the picture's TRANSFORM.
/// `stages` must be sorted by picture.
fn swapped_in(stages: &[StageSpan], picture: PictureNumber, shown_at: Time) -> Option<PictureTimes> {
    let first = stages.partition_point(|span| span.picture < picture);
    let own = stages[first..].iter().take_while(|span| span.picture == picture);
    let of = |stage: Stage| own.clone().filter(move |span| span.stage == stage);
    Some(PictureTimes {
        picture,
        view: ViewNumber::taken_for(picture),
        sampled_at: of(Stage::Sample).map(|s| s.begin).min(),
        transform_at: of(Stage::Transform).map(|s| s.begin).min()?,
        copied_at: of(Stage::Copy).filter_map(|s| s.end).max(),
        shown_at,
        end: PictureResult::Shown,
        layer: 0,
    })
}

/// Returns a picture of the usual regions, whole in one viewport, in the layout of Rendering Control.
const fn picture(viewport: Viewport, shading: Shading, pixels: bool) -> Picture {
    let layout = Layout::rendering_control_phong();
    Picture { viewport, shading, binning: RegionBinning::Touched, layout, pixels }
}

/// Returns the times of a picture that begins with TRANSFORM at the sample `mark`, and that the display shows at
/// `shown_at`.
fn sampled_at(mark: &Mark, copied_at: Option<Time>, shown_at: Time, end: PictureResult) -> PictureTimes {
    PictureTimes {
        picture: mark.picture,
        view: mark.view.unwrap_or(ViewNumber::taken_for(mark.picture)),
        sampled_at: Some(mark.time),
        transform_at: mark.time,
        copied_at,
        shown_at,
        end,
        layer: 0,
    }
}

fn samples(record: &Record) -> impl Iterator<Item = &Mark> {
    record.observation().marks.iter().filter(|mark| mark.stage == Stage::Sample)
}

fn late_regions(
    display: &NtscDisplay,
    record: &Record,
    end: Time,
    due: impl Fn(&Video, &Arrival) -> Time,
) -> Vec<LateRegion> {
    // Only regions that arrived before `end` are evaluated.
    let arrived = record.observation().arrivals.iter().filter(|arrival| arrival.last_part_at < end);
    // Keep the arrivals after their deadline, with the delay.
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
