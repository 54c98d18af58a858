//! Six faces of the cube around the eye, drawn by Pixel-Planes 5 for a display that turns with the head.

use super::face_cells::ByCells;
use super::face_objects::ByObjects;
use super::face_plan::{Cycles, Full, Updates};
use super::{SHADING, shading_or, shading_value, swapped_in};
use crate::cut::CutScene;
use crate::keys::{Key, KeyValue, KeyValues, PipelineSettings};
use crate::latched_head::{LatchedHead, ORIENTATION_WORDS};
use crate::pipeline::{PictureTimes, Pipeline, Setup};
use crate::registry::{Goal, LimitCriterion, PipelineEntry, TestScene};
use crate::views::{Poses, ReportTimes};
use address_recalculation::{AddressRecalculationPipeline, ArpConfig, Latch, Orientation, orientation_message};
use cube_control::{CubeControlConfig, Planned, WarpedLists, host, master, slave};
use glam::{Mat4, Vec4};
use pphigs::{DisplayList, Picture, RecentViews, RegionBinning, Shading};
use priority_rendering::{Falloff, PriorityError, PriorityTiming};
use pxpl5_geometry::Viewport;
use pxpl5_gp::Priority;
use pxpl5_machine::{ConfigError, HostLine, Machine, MachineConfig, NamedTable, Record};
use pxpl5_renderer::Layout;
use pxpl5_scene::{HmdConfig, Scene};
use pxpl5_sim::Time;
use pxpl5_wire::{CopyContent, Lines, NodeId, PictureNumber, REGION_SIZE, RegionGrid, Word};
use std::any::Any;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// What is drawn when.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FacePolicy {
    /// One memory, all of it redrawn as often as the machine can.
    Full,
    /// A structure is in the slowest memory in which its image stays right (CPR05).
    Objects,
    /// A structure is in the memory of its cell, which lies around the user's (CPR05).
    Cells,
    /// The same, with vertices moved so that memories meet at their borders.
    CellsWarped,
}

/// Faces drawn by Pixel-Planes 5 for an address recalculation pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FacePipeline {
    /// What is drawn when.
    pub policy: FacePolicy,
    /// Before what the display latches the orientation.
    pub latch: Latch,
    /// Where colours are computed.
    pub shading: Shading,
    /// Whether structures are cut at the borders of cells, where there are cells; else all of a structure is in the fastest memory of any
    /// of its cells.
    pub segmented: bool,
    /// How warping falls off from the border to a slower memory, where cells are warped.
    pub falloff: Falloff,
}

impl FacePipeline {
    /// With a policy and the latch of the papers: before each field.
    #[must_use]
    pub const fn new(policy: FacePolicy) -> Self {
        Self { policy, latch: Latch::Field, shading: Shading::Phong, segmented: true, falloff: Falloff::Linear }
    }

    fn config(self, machine: &Machine, pixels: bool) -> Result<CubeControlConfig, ConfigError> {
        let ports = machine.ports();
        let [master, slaves @ ..] = &ports.gps[..] else { return Err(too_few_gps(0)) };
        if slaves.is_empty() {
            return Err(too_few_gps(1));
        }
        let display = display_of(machine.record())?.config();
        let texels = display.timing.face_texels as u32;
        let grid = RegionGrid { width: texels, height: texels, region_width: REGION_SIZE, region_height: REGION_SIZE };
        let viewport = Viewport::new(grid, Lines::Frame)
            .map_err(|error| ConfigError::Board(format!("arp.face_texels: {error}")))?;
        let picture =
            Picture { viewport, shading: self.shading, binning: RegionBinning::Touched, layout: self.layout(), pixels };
        Ok(CubeControlConfig {
            host: ports.host,
            master: *master,
            slaves: slaves.to_vec(),
            renderers: ports.renderers.clone(),
            memories: ports.display()[..display.timing.display_memories as usize].to_vec(),
            picture,
            content: if display.format().words() == 1 { CopyContent::Packed } else { CopyContent::ColourAndDepth },
            warped: WarpedLists::default(),
        })
    }

    /// What the host does when it is ready for an update.
    fn plan(self, machine: &Machine, setup: &Setup) -> Result<Plan, ConfigError> {
        let display = display_of(machine.record())?.config();
        let projection = projection(display);
        let updates = Updates::new(setup, projection, display.timing.display_memories as usize);
        if self.policy == FacePolicy::Full {
            let mut full = Full::new(updates);
            return Ok(Box::new(move |number, now| full.next(number, now)));
        }
        let timing =
            PriorityTiming { memories: display.timing.display_memories, ..priority_timing(machine.record().config())? };
        let scan = display.scan().map_err(|error| ConfigError::Board(error.to_string()))?;
        if self.policy == FacePolicy::Objects {
            let policy = ByObjects::new(&setup.list, scan, &timing);
            let mut cycles = Cycles::new(updates, scan, policy);
            return Ok(Box::new(move |number, now| cycles.next(number, now)));
        }
        let falloff = if self.policy == FacePolicy::CellsWarped { self.falloff } else { Falloff::None };
        let policy = ByCells::new(&updates, &timing, falloff);
        let mut cycles = Cycles::new(updates, scan, policy);
        Ok(Box::new(move |number, now| cycles.next(number, now)))
    }

    const fn has_cells(self) -> bool {
        matches!(self.policy, FacePolicy::Cells | FacePolicy::CellsWarped)
    }
}

/// The numbers of the policies, checked.
fn priority_timing(config: &MachineConfig) -> Result<PriorityTiming, ConfigError> {
    let timing = config.firmware_table().copied().unwrap_or(PriorityTiming::PAPERS);
    timing.check().map_err(refused)?;
    Ok(timing)
}

fn refused(error: PriorityError) -> ConfigError {
    ConfigError::Board(error.to_string())
}

type Plan = Box<dyn FnMut(PictureNumber, Time) -> Planned>;

fn too_few_gps(found: u64) -> ConfigError {
    ConfigError::Value { what: "n_gps of faces (a master and slaves)".to_owned(), expected: (2, 1_000), found }
}

fn display_of(record: &Record) -> Result<&AddressRecalculationPipeline, ConfigError> {
    (record.display() as &dyn Any)
        .downcast_ref()
        .ok_or_else(|| ConfigError::Board(format!("faces need the display arp, found {}", record.display().name())))
}

/// The projection of a face with its guard texels, between the near and the far plane of the head-mounted display.
fn projection(display: &ArpConfig) -> Mat4 {
    let geometry = display.geometry();
    let HmdConfig { near_m: near, far_m: far, .. } = HmdConfig::unc();
    let scale = f64::from(geometry.texels - 2 * geometry.guard) / f64::from(geometry.texels);
    let deep = far / (near - far);
    let columns =
        [[scale, 0.0, 0.0, 0.0], [0.0, scale, 0.0, 0.0], [0.0, 0.0, deep, -1.0], [0.0, 0.0, near * deep, 0.0]];
    let [x, y, z, w] = columns.map(|column| Vec4::from_array(column.map(|v| v as f32)));
    Mat4::from_cols(x, y, z, w)
}

/// The host's own line to the display: the orientation that the head begins with, then one for each report, or predicted ones.
struct OrientationLine {
    reports: ReportTimes,
    poses: Poses,
    latched: LatchedHead,
}

impl fmt::Debug for OrientationLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OrientationLine").field("latched", &self.latched).finish_non_exhaustive()
    }
}

impl HostLine for OrientationLine {
    fn next(&self, after: Time) -> Option<Time> {
        self.latched.next(after, |instant| (self.reports)(instant))
    }

    fn words(&mut self, now: Time) -> Arc<[Word]> {
        let (known, aimed) = self.latched.predicted(now);
        let turned = (self.poses)(known, aimed).orientation;
        let rows = Orientation::from_quaternion(turned.to_array()).map_or([[f64::NAN; 3]; 3], |turned| turned.rows());
        orientation_message(rows)
    }
}

impl Pipeline for FacePipeline {
    fn name(&self) -> &'static str {
        let [field, line, pixel] = NAMES[self.policy as usize];
        match self.latch {
            Latch::Field => field,
            Latch::Line => line,
            Latch::Pixel => pixel,
        }
    }

    fn settings(&self) -> Vec<(&'static str, KeyValue)> {
        let mut settings = vec![("shading", shading_value(self.shading))];
        if self.has_cells() {
            settings.push((SEGMENT.name, KeyValue::Flag(self.segmented)));
        }
        if self.policy == FacePolicy::CellsWarped {
            let (name, _) = Falloff::ALL[self.falloff as usize];
            settings.push((WARP.name, KeyValue::Name(name)));
        }
        settings
    }

    fn eyes(&self) -> usize {
        1
    }

    fn layout(&self) -> Layout {
        Layout::rendering_control_phong()
    }

    fn shading(&self) -> Shading {
        self.shading
    }

    fn draws_faces(&self) -> Option<Latch> {
        Some(self.latch)
    }

    /// With a display that takes faces, which latches as this variant says; with one memory where all is drawn at once.
    fn adapt(&self, config: MachineConfig) -> MachineConfig {
        let mut config = config;
        if config.displays.first().is_none_or(|display| !display.takes_faces()) {
            config.displays = vec![Box::new(ArpConfig::MACHINE)];
        }
        if let Some(display) =
            config.displays.first_mut().and_then(|d| (d.as_mut() as &mut dyn Any).downcast_mut::<ArpConfig>())
        {
            display.latch = self.latch;
            if self.policy == FacePolicy::Full {
                display.timing.display_memories = 1;
            }
        }
        config
    }

    fn cut(&self, scene: &Arc<Scene>, config: &MachineConfig) -> Result<Option<CutScene>, ConfigError> {
        if !self.has_cells() {
            return Ok(None);
        }
        let side_m = priority_timing(config)?.cell_m;
        let cut = if self.segmented { CutScene::segmented(scene, side_m) } else { CutScene::whole(scene, side_m) };
        cut.map(Some).map_err(refused)
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), ConfigError> {
        let config = self.config(machine, setup.pixels)?;
        let mut list = DisplayList::clone(&setup.list);
        list.recent = RecentViews::keeping(VIEWS_AT_A_TIME);
        let list = Arc::new(list);
        let foreground = Priority::Foreground;
        let plan = self.plan(machine, setup)?;
        let gp = machine.processor(config.host, foreground);
        machine.load(config.host, foreground, Box::pin(host(gp, config.clone(), setup.host, plan)));
        let gp = machine.processor(config.master, foreground);
        machine.load(config.master, foreground, Box::pin(master(gp, config.clone())));
        for (index, node) in config.slaves.iter().enumerate() {
            let gp = machine.processor(*node, foreground);
            for (level, program) in slave(&gp, &config, config.share(&list, index), index) {
                machine.load(*node, level, Box::pin(program));
            }
        }
        let link = setup.host.link_span(ORIENTATION_WORDS);
        if let Some(latched) = LatchedHead::before(machine.record().display(), link, setup.aim) {
            let reports = Arc::clone(&setup.reports);
            let poses = Arc::clone(&setup.poses);
            machine.plug_host_line(Box::new(OrientationLine { reports, poses, latched }));
        }
        Ok(())
    }

    /// The updates of memory 0, which holds what must be drawn most often.
    fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes> {
        let Some(port) = record.ports().display().first() else { return Vec::new() };
        let stages = record.stages();
        let swaps = record.observation().swaps.iter().filter(|swap| swap.port == *port);
        let shown = updates_of(record, *port).into_iter().zip(swaps.map(|swap| record.tick(swap.tick)));
        shown.filter(|(_, at)| *at < end).filter_map(|(picture, at)| swapped_in(&stages, picture, at)).collect()
    }

    /// From the first swap of any memory on, one in each field, with the orientation that was latched.
    fn turned_periods(&self, record: &Record, end: Time) -> u64 {
        let first = record.observation().swaps.iter().map(|swap| swap.tick).min();
        let after = record.display().period_at(end);
        first.map_or(0, |first| after.since(first.min(after)))
    }

    fn latency_definition(&self) -> &'static str {
        "of translation: from the start of TRANSFORM of an update of memory 0 on the first slave to the retrace at which it is swapped in"
    }

    fn due_definition(&self) -> &'static str {
        "an update is never due: until it is shown the old faces are looked up in the right direction, from the old place"
    }

    fn has_one_pose(&self) -> bool {
        false
    }
}

/// Views that slaves ask for at a time: six faces of two updates.
const VIEWS_AT_A_TIME: usize = 12;

/// The updates that a port got, in order: every update has a region at least.
fn updates_of(record: &Record, port: NodeId) -> Vec<PictureNumber> {
    let arrivals = record.observation().arrivals.iter().filter(|arrival| arrival.target.frame_buffer == port);
    let first: BTreeMap<PictureNumber, ()> = arrivals.map(|arrival| (arrival.target.picture, ())).collect();
    first.into_keys().collect()
}

/// Names by policy and latch.
const NAMES: [[&str; 3]; 4] = [
    ["arp-full", "arp-full-line", "arp-full-pixel"],
    ["arp-priority", "arp-priority-line", "arp-priority-pixel"],
    ["arp-cells", "arp-cells-line", "arp-cells-pixel"],
    ["arp-cells-warp", "arp-cells-warp-line", "arp-cells-warp-pixel"],
];

/// Ways in which warping can fall off, as [`Falloff`] has them behind none.
const FALLOFFS: [&str; 3] = [Falloff::ALL[1].0, Falloff::ALL[2].0, Falloff::ALL[3].0];

const SEGMENT: Key = Key {
    name: "segment",
    about: "cut structures at the borders of cells (without, all of one is drawn as often as its nearest part): true or false",
    values: KeyValues::Flag,
    sets: &[],
};

const WARP: Key = Key {
    name: "warp",
    about: "how the displacement of vertices falls off from a border to a slower memory: linear, smoothstep or step",
    values: KeyValues::Names(&FALLOFFS),
    sets: &[],
};

/// Keys by policy.
const KEYS: [&[Key]; 4] = [&[SHADING], &[SHADING], &[SHADING, SEGMENT], &[SHADING, SEGMENT, WARP]];

const TABLES: &[NamedTable] = &[("priority", || Box::new(PriorityTiming::PAPERS))];

const fn entry(
    (policy, latch): (FacePolicy, Latch),
    about: &'static str,
    build: fn(&PipelineSettings) -> Arc<dyn Pipeline>,
) -> PipelineEntry {
    PipelineEntry {
        name: NAMES[policy as usize][latch as usize],
        family: "arp",
        about,
        preset: "small-hmd",
        keys: KEYS[policy as usize],
        build,
        limit: |_| LimitCriterion { goal: Goal::RateHz(20.0), scene: TestScene::Typical, fields: 60 },
        tables: TABLES,
        closed_form: None,
        compared: true,
    }
}

fn build(policy: FacePolicy, latch: Latch, settings: &PipelineSettings) -> Arc<dyn Pipeline> {
    let new = FacePipeline::new(policy);
    let falloff = Falloff::ALL.into_iter().find(|(name, _)| settings.name(WARP.name) == Some(name));
    Arc::new(FacePipeline {
        latch,
        shading: shading_or(settings, new.shading),
        segmented: settings.flag(SEGMENT.name).unwrap_or(new.segmented),
        falloff: falloff.map_or(new.falloff, |(_, falloff)| falloff),
        ..new
    })
}

/// An entry for a policy and a latch.
macro_rules! entry {
    ($policy:ident, $latch:ident, $about:literal) => {
        entry((FacePolicy::$policy, Latch::$latch), $about, |settings| {
            build(FacePolicy::$policy, Latch::$latch, settings)
        })
    };
}

/// Address recalculation pipelines fed by Pixel-Planes 5 in the registry.
pub(super) const ENTRIES: [PipelineEntry; 12] = [
    entry!(Full, Field, "six faces in one memory, looked up by the orientation of each field (VRAIS 93)"),
    entry!(Full, Line, "the same, with an orientation for each line"),
    entry!(Full, Pixel, "the same, with orientations as often as the host's line carries them, latched by pixel"),
    entry!(Objects, Field, "six faces in several memories, objects in the slowest that keeps them right (SIGGRAPH 94)"),
    entry!(Objects, Line, "the same, with an orientation for each line"),
    entry!(Objects, Pixel, "the same, with orientations as often as the host's line carries them, latched by pixel"),
    entry!(
        Cells,
        Field,
        "objects cut at the borders of square cells, near cells drawn often, far ones seldom (ACSC 2005)"
    ),
    entry!(Cells, Line, "the same, with an orientation for each line"),
    entry!(Cells, Pixel, "the same, with orientations as often as the host's line carries them, latched by pixel"),
    entry!(CellsWarped, Field, "cells whose vertices are moved so that memories meet at their borders (ACSC 2005)"),
    entry!(CellsWarped, Line, "the same, with an orientation for each line"),
    entry!(
        CellsWarped,
        Pixel,
        "the same, with orientations as often as the host's line carries them, latched by pixel"
    ),
];
