//! Six faces of the cube around the eye, drawn by Pixel-Planes 5 for a display that turns with the head.

use super::face_plan::{ByObjects, Full, Updates};
use crate::due::PictureEnd;
use crate::keys::{Key, KeyValue, KeyValues, PipelineSettings};
use crate::latched_head::{LatchedHead, ORIENTATION_WORDS};
use crate::pipeline::{PictureTimes, Pipeline, Setup};
use crate::registry::{Goal, LimitCriterion, PipelineEntry, TestScene};
use crate::views::{Poses, ReportTimes};
use address_recalculation::{AddressRecalculationPipeline, ArpConfig, Latch, Orientation, orientation_message};
use cube_control::{CubeControlConfig, Planned, host, master, slave};
use glam::{Mat4, Vec4};
use pphigs::{DisplayList, Picture, RecentViews, RegionBinning, Shading};
use priority_rendering::PriorityTiming;
use pxpl5_geometry::Viewport;
use pxpl5_gp::{Priority, Stage};
use pxpl5_machine::{ConfigError, HostLine, Machine, MachineConfig, NamedTable, Record, StageSpan};
use pxpl5_renderer::Layout;
use pxpl5_scene::HmdConfig;
use pxpl5_sim::Time;
use pxpl5_wire::{CopyContent, Lines, NodeId, PictureNumber, REGION_SIZE, RegionGrid, ViewNumber, Word};
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
}

impl FacePipeline {
    /// With a policy and the latch of the papers: before each field.
    #[must_use]
    pub const fn new(policy: FacePolicy) -> Self {
        Self { policy, latch: Latch::Field, shading: Shading::Phong }
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
            regions_stored: 0,
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
        let table = machine.record().config().firmware_table::<PriorityTiming>();
        let timing = PriorityTiming {
            memories: display.timing.display_memories,
            ..table.copied().unwrap_or(PriorityTiming::PAPERS)
        };
        timing.check().map_err(|error| ConfigError::Board(error.to_string()))?;
        let scan = display.scan().map_err(|error| ConfigError::Board(error.to_string()))?;
        let mut by_objects = ByObjects::new(updates, scan, &timing);
        Ok(Box::new(move |number, now| by_objects.next(number, now)))
    }
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

/// The host's own line to the display: the orientation that the head begins with, then one for each report.
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
        let first = self.latched.loaded(Time::ZERO);
        if after < first {
            return Some(first);
        }
        (self.reports)(self.latched.report_of(after)).map(|report| self.latched.loaded(report))
    }

    fn words(&mut self, now: Time) -> Arc<[Word]> {
        let report = self.latched.report_of(now);
        let aimed = self.latched.aimed(report, (self.reports)(report));
        let turned = (self.poses)(report, aimed).orientation;
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
        let (shading, _) = SHADINGS[usize::from(self.shading == SHADINGS[1].1)];
        vec![("shading", KeyValue::Name(shading))]
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
        shown.filter(|(_, at)| *at < end).filter_map(|(picture, at)| times(&stages, picture, at)).collect()
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

/// Times of an update; `stages` are in order of picture.
fn times(stages: &[StageSpan], picture: PictureNumber, shown_at: Time) -> Option<PictureTimes> {
    let first = stages.partition_point(|span| span.picture < picture);
    let of_update = stages[first..].iter().take_while(|span| span.picture == picture);
    let of = |stage: Stage| of_update.clone().filter(move |span| span.stage == stage);
    Some(PictureTimes {
        picture,
        view: ViewNumber::taken_for(picture),
        sampled_at: of(Stage::Sample).map(|s| s.begin).min(),
        transform_at: of(Stage::Transform).map(|s| s.begin).min()?,
        copied_at: of(Stage::Copy).filter_map(|s| s.end).max(),
        shown_at,
        end: PictureEnd::Shown,
    })
}

const SHADINGS: [(&str, Shading); 2] = [("phong", Shading::Phong), ("gouraud", Shading::Gouraud)];

const KEYS: &[Key] = &[Key {
    name: "shading",
    about: "phong or gouraud",
    values: KeyValues::Names(&[SHADINGS[0].0, SHADINGS[1].0]),
    sets: &[],
}];

/// Names by policy and latch.
const NAMES: [[&str; 3]; 2] =
    [["arp-full", "arp-full-line", "arp-full-pixel"], ["arp-priority", "arp-priority-line", "arp-priority-pixel"]];

const TABLES: &[NamedTable] = &[("priority", || Box::new(PriorityTiming::PAPERS))];

const fn entry(
    name: &'static str,
    about: &'static str,
    build: fn(&PipelineSettings) -> Arc<dyn Pipeline>,
) -> PipelineEntry {
    PipelineEntry {
        name,
        family: "arp",
        about,
        preset: "small-hmd",
        keys: KEYS,
        build,
        limit: |_| LimitCriterion { goal: Goal::RateHz(20.0), scene: TestScene::Typical, fields: 60 },
        tables: TABLES,
        closed_form: None,
        compared: true,
    }
}

fn build(policy: FacePolicy, latch: Latch, settings: &PipelineSettings) -> Arc<dyn Pipeline> {
    let new = FacePipeline::new(policy);
    let shading = SHADINGS.iter().find(|(name, _)| settings.name("shading") == Some(name));
    Arc::new(FacePipeline { latch, shading: shading.map_or(new.shading, |(_, shading)| *shading), ..new })
}

const FULL: FacePolicy = FacePolicy::Full;
const OBJECTS: FacePolicy = FacePolicy::Objects;

/// Address recalculation pipelines fed by Pixel-Planes 5 in the registry.
pub(super) const ENTRIES: [PipelineEntry; 6] = [
    entry(NAMES[0][0], "six faces in one memory, looked up by the orientation of each field (VRAIS 93)", |settings| {
        build(FULL, Latch::Field, settings)
    }),
    entry(NAMES[0][1], "the same, with an orientation for each line", |settings| build(FULL, Latch::Line, settings)),
    entry(NAMES[0][2], "the same, with an orientation for each pixel", |settings| build(FULL, Latch::Pixel, settings)),
    entry(
        NAMES[1][0],
        "six faces in several memories, objects in the slowest that keeps them right (SIGGRAPH 94)",
        |settings| build(OBJECTS, Latch::Field, settings),
    ),
    entry(NAMES[1][1], "the same, with an orientation for each line", |settings| build(OBJECTS, Latch::Line, settings)),
    entry(NAMES[1][2], "the same, with an orientation for each pixel", |settings| {
        build(OBJECTS, Latch::Pixel, settings)
    }),
];
