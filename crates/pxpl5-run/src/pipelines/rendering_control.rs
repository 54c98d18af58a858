use super::{SHADING, picture, region_has_room, shading_or, shading_value, swapped_in, whole_picture};
use crate::keys::PipelineSettings;
use crate::pipeline::{PictureRules, PictureTimes, Pipeline, PipelineProperties, Setup};
use crate::registry::{Goal, LimitCriterion, PipelineEntry, TestScene};
use image::RgbImage;
use pphigs::{DisplayList, Shading};
use pxpl5_gp::{HostTiming, Priority};
use pxpl5_machine::{Arrival, Machine, Ports, Record};
use pxpl5_renderer::Layout;
use pxpl5_sim::parameters::{Key, KeyValue, KeyValues, SettingError};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::display::Surface;
use pxpl5_wire::{MAX_MESSAGE_WORDS, PictureNumber, RegionId, SurfaceId, ViewNumber};
use rendering_control::{Drawn, Frames, HostAction, RenderingControlConfig, frames, host, master, slave};
use std::sync::Arc;

/// The pipeline Rendering Control of the library PPHIGS (TR94).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderingControl {
    /// True for one picture instead of a stereo pair.
    pub mono: bool,
    /// Method of shading.
    pub shading: Shading,
    /// Action of a renderer that has finished a region while the frame buffer is not available.
    pub finished: FinishedRegions,
}

/// Action of a renderer that has finished a region while the frame buffer is not available.
///
/// TR94 says that the last slave returns the token, and that the master then gives the renderer its next region, without
/// a condition. Two further statements of TR94 support [`FinishedRegions::Store`] (docs/decisions.md).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FinishedRegions {
    /// The renderer keeps the region in pixel memory and waits for the copy.
    Wait,
    /// The renderer moves the region to its backing store, if there is room, and draws the next region.
    #[default]
    Store,
}

impl FinishedRegions {
    /// All choices of [`FinishedRegions`], with their names in experiment files.
    pub const ALL: [Self; 2] = [Self::Wait, Self::Store];

    /// Returns the name of the choice in experiment files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Wait => "wait",
            Self::Store => "store",
        }
    }

    /// Returns how many finished regions a renderer can store at a time. `room` is the capacity of the backing store in
    /// regions.
    pub const fn stored(self, room: u64) -> u64 {
        match self {
            Self::Wait => 0,
            Self::Store => room,
        }
    }
}

pxpl5_sim::parameters::named!(FinishedRegions, "action", FinishedRegions::ALL.map(|action| (action.name(), action)));

impl RenderingControl {
    /// Creates a stereo pipeline with Phong shading, as measured in TR94.
    pub const fn stereo() -> Self {
        Self { mono: false, shading: Shading::Phong, finished: FinishedRegions::Store }
    }

    /// Creates a pipeline for one eye, with Phong shading.
    pub const fn mono() -> Self {
        Self { mono: true, ..Self::stereo() }
    }

    fn frames(self, machine: &Machine, pixels: bool) -> Result<Frames, SettingError> {
        let ports = machine.ports();
        // A finished region takes one block of the backing store.
        region_has_room(machine.record(), 1)?;
        Ok(Frames {
            frame_buffers: ports.display().iter().copied().take(self.properties().eyes).collect(),
            frame_buffer_ports: ports.display().to_vec(),
            picture: picture(whole_picture(machine.record())?, self.shading, pixels),
            regions_stored: self.finished.stored(machine.record().config().renderer.backing_regions()) as usize,
        })
    }
}

/// Returns the boards that draw under Rendering Control: the first graphics processor is the master, and all others are
/// slaves. `pipeline` is the name of the pipeline, for errors.
pub(super) fn with_boards<D>(
    machine: &Machine,
    pipeline: &str,
    drawn: impl FnOnce() -> Result<D, SettingError>,
) -> Result<RenderingControlConfig<D>, SettingError> {
    let Ports { host, gps, renderers, .. } = machine.ports();
    let [master, slaves @ ..] = &gps[..] else { return Err(too_few_gps(pipeline, 0)) };
    if slaves.is_empty() {
        return Err(too_few_gps(pipeline, 1));
    }
    let (slaves, renderers) = (slaves.to_vec(), renderers.clone());
    Ok(RenderingControlConfig { host: *host, master: *master, slaves, renderers, drawn: drawn()? })
}

fn too_few_gps(pipeline: &str, found: u64) -> SettingError {
    SettingError::limits(&format!("n_gps of {pipeline} (a master and slaves)"), (2, 1_000), found)
}

/// Loads the programs of Rendering Control. `plan` decides when the host sends a picture.
pub(super) fn load_programs<D: Drawn>(
    machine: &mut Machine,
    config: &RenderingControlConfig<D>,
    timing: HostTiming,
    list: &Arc<DisplayList>,
    plan: impl FnMut(PictureNumber, Time) -> HostAction<D::Sent> + 'static,
) {
    let foreground = Priority::Foreground;
    let gp = machine.processor(config.host, foreground);
    machine.load(config.host, foreground, Box::pin(host(gp, config.clone(), timing, plan)));
    let gp = machine.processor(config.master, foreground);
    machine.load(config.master, foreground, Box::pin(master(gp, config.clone())));
    // A slave runs two programs at different priorities, over its share of the triangles.
    for (index, node) in config.slaves.iter().enumerate() {
        let gp = machine.processor(*node, foreground);
        for (level, program) in slave(&gp, config, config.share(list, index), index) {
            machine.load(*node, level, Box::pin(program));
        }
    }
}

impl Pipeline for RenderingControl {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn settings(&self) -> Vec<(&'static str, KeyValue)> {
        let finished = KeyValue::Name(self.finished.name());
        vec![("mono", KeyValue::Flag(self.mono)), ("shading", shading_value(self.shading)), ("finished", finished)]
    }

    fn properties(&self) -> PipelineProperties {
        PipelineProperties {
            eyes: if self.mono { 1 } else { 2 },
            shading: self.shading,
            // i860 code exists for all work of this pipeline.
            without_code: None,
            can_discard_records: true,
            ..PipelineProperties::new(
                Layout::rendering_control_phong(),
                "from the start of TRANSFORM of the frame's first eye on the first slave to the retrace at which the frame is swapped in",
                "the time of COPY determines how often a frame is due: once in the number of periods that the pixels of all eyes need at a frame buffer's port, one eye at a time (two NTSC fields for a stereo pair); a frame is shown when it is swapped in",
            )
        }
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), SettingError> {
        let config = with_boards(machine, "Rendering Control", || self.frames(machine, setup.pixels))?;
        let (starts, views) = (setup.clone(), Arc::clone(&setup.views));
        // The host decides when a frame begins, and samples the view for it.
        let view = move |frame, time| views.newest(ViewNumber::taken_for(frame), time);
        let plan = frames(move |ready| starts.frame_start(ready), view);
        load_programs(machine, &config, setup.host, &setup.list, plan);
        Ok(())
    }
}

impl PictureRules for RenderingControl {
    fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes> {
        let stages = record.stages();
        let frames = record.observation().frames(self.properties().eyes).into_iter();
        let shown = frames.map(|(number, tick)| (PictureNumber::FIRST.after(number), record.tick(tick)));
        let shown = shown.filter(|(_, shown_at)| *shown_at < end);
        shown.filter_map(|(frame, at)| swapped_in(&stages, frame, at)).collect()
    }

    /// Returns the time of COPY for all eyes, one after the other, in whole display periods. For a stereo pair, COPY
    /// takes 31.2 ms, so the result is two fields (TR94).
    fn periods_a_picture(&self, record: &Record) -> Option<u64> {
        let surfaces = record.display().surfaces();
        let ports = (record.ports().display().len() / surfaces.len().max(1)).max(1);
        let copies: Span = surfaces.iter().map(|surface| copy_span(record, surface, ports as u16)).sum();
        Some(record.display().period_at(Time(copies.0.saturating_sub(1))).next().0)
    }

    fn copy_part(&self, arrival: &Arrival) -> u8 {
        arrival.surface.0 as u8
    }

    /// Returns the shown buffer, which has a complete frame even while the beam scans it.
    fn picture(&self, record: &Record, surface: SurfaceId) -> Option<RgbImage> {
        record.display().shown(surface.index())
    }
}

/// Returns the time to transfer all pixels of a surface. The regions are assigned to the ports in turn, so the port
/// with the most pixels determines the time.
fn copy_span(record: &Record, surface: &Surface, ports: u16) -> Span {
    (0..ports).map(|port| port_span(record, surface, port, ports)).max().unwrap_or(Span::ZERO)
}

fn port_span(record: &Record, surface: &Surface, first: u16, ports: u16) -> Span {
    let timing = record.ring().timing();
    let grid = surface.grid();
    let regions = (first..grid.regions() as u16).step_by(usize::from(ports)).map(RegionId);
    regions
        .map(|region| {
            let [_, _, width, height] = grid.rectangle(region);
            let words = width * height;
            let last = words % MAX_MESSAGE_WORDS;
            let of_last = if last == 0 { Span::ZERO } else { timing.occupancy(last) };
            timing.occupancy(MAX_MESSAGE_WORDS) * u64::from(words / MAX_MESSAGE_WORDS) + of_last
        })
        .sum()
}

pub(super) const ENTRY: PipelineEntry = PipelineEntry {
    name: "rendering-control",
    family: "rendering-control",
    about: "frames drawn region by region in three overlapping stages under PPHIGS (TR94)",
    preset: "small-hmd",
    keys: &[
        Key::new("mono", "one picture instead of a stereo pair", KeyValues::Flag).with_default("false"),
        SHADING,
        Key::new(
            "finished",
            "rule for a finished region whose frame buffer is not available: wait in pixel memory, or store (the \
             renderer continues with the next)",
            KeyValues::Names(&[FinishedRegions::Wait.name(), FinishedRegions::Store.name()]),
        )
        .with_default("store"),
    ],
    build,
    limit: |_| LimitCriterion { goal: Goal::NoMissedRetrace, scene: TestScene::Typical, fields: 90 },
    tables: &[],
    closed_form: None,
    compared: true,
};

fn build(settings: &PipelineSettings) -> Arc<dyn Pipeline> {
    let stereo = RenderingControl::stereo();
    Arc::new(RenderingControl {
        mono: settings.flag("mono").unwrap_or(stereo.mono),
        shading: shading_or(settings, stereo.shading),
        finished: settings.chosen("finished").unwrap_or(stereo.finished),
    })
}
