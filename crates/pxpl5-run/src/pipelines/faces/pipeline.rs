//! Pipelines that draw the six faces of a cube around the eye. The display then selects the visible pixels by the
//! orientation of the head.

use super::cells::ByCells;
use super::ideal::{All, IdealFaces};
use super::keys::{FacePolicy, LENS, NAMES, POLICY, SEGMENT, WARP};
use super::objects::ByObjects;
use super::plan::{Cycles, DuePolicy, Plan, Updates, full};
use crate::pipeline::{PictureRules, PictureTimes, Pipeline, PipelineProperties, Setup};
use crate::pipelines::faces::latched_head::{ORIENTATION_WORDS, OrientationTiming};
use crate::pipelines::faces::requests::RequestedUpdates;
use crate::pipelines::faces::segments::SegmentedScene;
use crate::pipelines::rendering_control::{load_programs, with_boards};
use crate::pipelines::{picture, region_has_room, shading_value, swapped_in};
use crate::result::picture_ends::PictureResult;
use crate::views::ViewSource;
use address_recalculation::priority::{Falloff, PriorityTiming};
use address_recalculation::{AddressRecalculationPipeline, ArpConfig, Latch, Lens, Orientation, orientation_message};
use glam::{Mat4, Vec4};
use pphigs::{DisplayList, RecentViews, Shading};
use pxpl5_geometry::Viewport;
use pxpl5_machine::{Attachment, HostLine, Machine, MachineConfig, Record, Shown};
use pxpl5_renderer::Layout;
use pxpl5_scene::{HmdConfig, Scene};
use pxpl5_sim::Time;
use pxpl5_sim::parameters::{KeyValue, SettingError};
use pxpl5_wire::display::Coverage;
use pxpl5_wire::{Body, CopyContent, Lines, NodeId, PictureNumber, REGION_SIZE, RegionGrid, ViewNumber};
use rendering_control::cube::{Faces, WarpedLists};
use std::any::Any;
use std::sync::Arc;

/// The renderer that draws the cube faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceSource {
    /// The firmware of Rendering Control on the machine.
    PixelPlanes,
    /// An ideal renderer without delay. This renderer draws from the eye position that is available at each retrace.
    ///
    /// Errors that remain with this renderer are not caused by drawing time.
    Ideal,
}

/// A pipeline that draws six cube faces for an address recalculation display.
#[derive(Clone, Debug, PartialEq)]
pub struct FacePipeline {
    /// The renderer that draws the cube faces.
    pub source: FaceSource,
    /// Policy that assigns structures to display memories.
    pub policy: FacePolicy,
    /// Interval at which the display latches (samples and holds) the head's orientation: by field, by line or by pixel.
    pub latch: Latch,
    /// Method of shading.
    pub shading: Shading,
    /// For policies with cells (squares of the floor): true if structures are cut at the borders of cells.
    ///
    /// Otherwise each whole structure is in the fastest (most often updated) display memory among the memories of the
    /// cells that the structure touches.
    pub segmented: bool,
    /// Decrease of the displacement of vertices, for warped cells, with the distance from the border to a display
    /// memory with a lower update rate.
    pub falloff: Falloff,
    /// Lens between display and eye. By default, the lens in the display's configuration.
    pub lens: Option<Lens>,
}

impl FacePipeline {
    /// Creates a pipeline that runs on the machine. The display latches one orientation per field, as in the papers.
    pub const fn new(policy: FacePolicy) -> Self {
        let source = FaceSource::PixelPlanes;
        Self {
            source,
            policy,
            latch: Latch::Field,
            shading: Shading::Phong,
            segmented: true,
            falloff: Falloff::Linear,
            lens: None,
        }
    }

    fn faces(&self, machine: &Machine, pixels: bool) -> Result<Faces, SettingError> {
        let display = display_of(machine.record())?.config();
        let texels = display.timing.face_texels as u32;
        // A face is a square picture, divided into the usual regions.
        let grid = RegionGrid { width: texels, height: texels, region_width: REGION_SIZE, region_height: REGION_SIZE };
        let viewport = Viewport::new(grid, Lines::Frame).map_err(|error| error.at("arp.face_texels"))?;
        let picture = picture(viewport, self.shading, pixels);
        // A display with packed texels takes one word a pixel, otherwise colour and depth are sent.
        let content = if display.format().words() == 1 { CopyContent::Packed } else { CopyContent::ColourAndDepth };
        if self.source == FaceSource::PixelPlanes {
            region_has_room(machine.record(), content.words().into())?;
        }
        let memories = machine.ports().display()[..display.timing.display_memories as usize].to_vec();
        Ok(Faces { memories, picture, content, warped: WarpedLists::default() })
    }

    fn plan(&self, machine: &mut Machine, setup: &Setup) -> Result<Plan, SettingError> {
        let notes = Arc::new(RequestedUpdates::default());
        machine.attach(Arc::clone(&notes) as Arc<dyn Attachment>);
        let display = display_of(machine.record())?.config();
        let projection = projection(display);
        let scan = display.scan()?;
        // An ideal renderer has no delay, so its views are predicted for the next field.
        let seen_next = (self.source == FaceSource::Ideal).then_some(scan);
        let updates = Updates::new(setup, seen_next, &notes, projection, display.timing.display_memories as usize);
        let structures = vec![true; setup.list.structures.len()].into();
        if self.policy == FacePolicy::Full && self.source == FaceSource::PixelPlanes {
            return Ok(full(updates, structures));
        }
        // Other policies distribute structures over several memories and work in cycles.
        let memories = display.timing.display_memories;
        let timing = || priority_timing(machine.record().config()).map(|timing| PriorityTiming { memories, ..timing });
        let policy: Box<dyn DuePolicy> = match self.policy {
            FacePolicy::Full => Box::new(All { structures }),
            FacePolicy::Objects => Box::new(ByObjects::new(&setup.list, scan, &timing()?)),
            FacePolicy::Cells | FacePolicy::CellsWarped => {
                // Without warping, cells use a falloff of `None`.
                let falloff = if self.policy == FacePolicy::CellsWarped { self.falloff } else { Falloff::None };
                let cut: Option<&SegmentedScene> = machine.record().attached();
                let cells = cut.map_or_else(Arc::default, |cut| Arc::clone(&cut.cells));
                Box::new(ByCells::new(&updates, cells, &timing()?, falloff))
            }
        };
        Ok(Cycles::plan(updates, scan, policy))
    }

    const fn has_cells(&self) -> bool {
        matches!(self.policy, FacePolicy::Cells | FacePolicy::CellsWarped)
    }
}

fn lens_text(lens: &Lens) -> String {
    match lens {
        Lens::Radial { k1, k2: 0.0 } => format!("radial:{k1}"),
        lens => lens.to_string(),
    }
}

fn priority_timing(config: &MachineConfig) -> Result<PriorityTiming, SettingError> {
    let timing = config.firmware_table().copied().unwrap_or(PriorityTiming::PAPERS);
    timing.check()?;
    Ok(timing)
}

fn display_of(record: &Record) -> Result<&AddressRecalculationPipeline, SettingError> {
    (record.display() as &dyn Any).downcast_ref().ok_or_else(|| {
        SettingError::combination(format_args!("faces need the display arp, found {}", record.display().name()))
    })
}

/// Returns the projection of a cube face with its guard texels. The near and far planes come from the head-mounted
/// display.
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

const ORIENTATION_PORT: usize = 0;

/// Connection from the host to the display that carries the head's orientations.
///
/// The first orientation is the head's initial orientation. Later orientations follow tracker reports or are predicted.
#[derive(Debug)]
struct OrientationLine {
    views: Arc<dyn ViewSource>,
    latched: OrientationTiming,
}

impl HostLine for OrientationLine {
    fn next(&self, after: Time) -> Option<Time> {
        self.latched.next(after, |instant| self.views.report_after(instant))
    }

    fn messages(&mut self, now: Time) -> Vec<(usize, Body)> {
        let (reports_until, aimed) = self.latched.predicted(now);
        let turned = self.views.pose_at(reports_until, aimed).orientation;
        let rows = Orientation::from_quaternion(turned.to_array()).map_or([[f64::NAN; 3]; 3], |turned| turned.rows());
        vec![(ORIENTATION_PORT, Body::Words(orientation_message(rows)))]
    }
}

impl Pipeline for FacePipeline {
    fn name(&self) -> &'static str {
        let row = if self.source == FaceSource::Ideal { FacePolicy::ALL.len() } else { self.policy as usize };
        NAMES[row][self.latch as usize]
    }

    fn settings(&self) -> Vec<(&'static str, KeyValue)> {
        let mut settings = vec![("shading", shading_value(self.shading))];
        if self.source == FaceSource::Ideal {
            settings.push((POLICY.name, KeyValue::Name(FacePolicy::ALL[self.policy as usize].0)));
        }
        // Without a lens, the key for the lens is absent, so that names of older experiments stay valid.
        settings.extend(self.lens.as_ref().map(|lens| (LENS.name, KeyValue::Text(lens_text(lens).into()))));
        if self.has_cells() {
            settings.push((SEGMENT.name, KeyValue::Flag(self.segmented)));
        }
        if self.policy == FacePolicy::CellsWarped {
            let (name, _) = Falloff::ALL[self.falloff as usize];
            settings.push((WARP.name, KeyValue::Name(name)));
        }
        settings
    }

    fn properties(&self) -> PipelineProperties {
        let is_ideal = self.source == FaceSource::Ideal;
        // An ideal renderer uses no graphics processors. Moving vertices of warped cells takes no time at any level.
        let is_warped = !is_ideal && self.policy == FacePolicy::CellsWarped;
        PipelineProperties {
            shading: self.shading,
            coverage: Coverage::Surroundings,
            without_code: is_warped.then_some("moving the vertices of warped cells (0 in the table)"),
            knows_when_seen: is_ideal,
            has_one_pose: false,
            can_discard_records: true,
            ..PipelineProperties::new(
                Layout::rendering_control_phong(),
                if is_ideal {
                    "of translation: from the instant at which an update of any display memory is drawn, in no time, to the retrace at which it is swapped in"
                } else {
                    "of translation: from the start of TRANSFORM of an update of any display memory on the first slave to the retrace at which it is swapped in"
                },
                "an update is never due: until it is shown, the display shows the old faces in the right direction, from the old eye position",
            )
        }
    }

    /// Adapts the display to this variant. The adapted display accepts cube faces, and uses the variant's latch mode
    /// and lens. The policy `Full` uses one display memory.
    fn adapt(&self, config: MachineConfig) -> MachineConfig {
        let mut config = config;
        // Replace a display that takes no faces.
        if config.displays.first().is_none_or(|display| display.coverage() != Coverage::Surroundings) {
            let display = match self.source {
                FaceSource::PixelPlanes => ArpConfig::MACHINE,
                FaceSource::Ideal => ArpConfig::IDEAL,
            };
            config.displays = vec![Box::new(display)];
        }
        // Set the latch mode and the lens, which belong to the variant.
        if let Some(display) =
            config.displays.first_mut().and_then(|d| (d.as_mut() as &mut dyn Any).downcast_mut::<ArpConfig>())
        {
            display.latch = self.latch;
            if let Some(lens) = &self.lens {
                display.lens = lens.clone();
            }
            if self.policy == FacePolicy::Full {
                display.timing.display_memories = 1;
            }
        }
        config
    }

    fn prepare(&self, scene: &Arc<Scene>, machine: &mut Machine) -> Result<Arc<Scene>, SettingError> {
        if !self.has_cells() {
            return Ok(Arc::clone(scene));
        }
        let side_m = priority_timing(machine.record().config())?.cell_m;
        let cut = if self.segmented {
            SegmentedScene::segmented(scene, side_m)?
        } else {
            SegmentedScene::whole(scene, side_m)?
        };
        let scene = Arc::clone(&cut.scene);
        machine.attach(Arc::new(cut));
        Ok(scene)
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), SettingError> {
        self.plug_orientations(machine, setup);
        if self.source == FaceSource::Ideal {
            return self.plug_ideal_source(machine, setup);
        }
        let config = with_boards(machine, "faces", || self.faces(machine, setup.pixels))?;
        // All slaves share recent views, because each slave transforms for the same faces.
        let mut list = matte(&setup.list);
        list.recent = RecentViews::keeping(VIEWS_AT_A_TIME);
        let plan = self.plan(machine, setup)?;
        load_programs(machine, &config, setup.host, &Arc::new(list), plan);
        Ok(())
    }
}

impl PictureRules for FacePipeline {
    fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes> {
        let Ok(display) = display_of(record) else { return Vec::new() };
        let ports = record.ports().display().iter().take(display.config().timing.display_memories as usize);
        let stages = record.stages();
        // Each display memory is a layer.
        let of_layer = |(layer, port): (usize, &NodeId)| {
            let shown = record.shown_by(*port).into_iter().filter(|shown| shown.at < end);
            let times = shown.filter_map(|shown| match self.source {
                FaceSource::PixelPlanes => swapped_in(&stages, shown.picture, shown.at),
                FaceSource::Ideal => Some(drawn_at_once(shown)),
            });
            times.map(|times| PictureTimes { layer, ..times }).collect::<Vec<_>>()
        };
        let mut pictures: Vec<PictureTimes> = ports.enumerate().flat_map(of_layer).collect();
        pictures.sort_by_key(|times| (times.shown_at, times.picture));
        pictures
    }
}

impl FacePipeline {
    /// Adds the connection that carries orientations from the host to the display. Every renderer of faces needs this
    /// connection.
    fn plug_orientations(&self, machine: &mut Machine, setup: &Setup) {
        let link = setup.host.link_span(ORIENTATION_WORDS);
        if let Some(latched) = OrientationTiming::before(machine.record().display(), link, setup.aim) {
            machine.plug_host_line(Box::new(OrientationLine { views: Arc::clone(&setup.views), latched }));
        }
    }

    fn plug_ideal_source(&self, machine: &mut Machine, setup: &Setup) -> Result<(), SettingError> {
        let display = display_of(machine.record())?;
        let scan = display.config().scan()?;
        let ideal = IdealFaces {
            plan: self.plan(machine, setup)?,
            faces: Arc::new(self.faces(machine, setup.pixels)?),
            list: Arc::new(matte(&setup.list)),
            scan,
            next: PictureNumber::FIRST,
        };
        machine.plug_host_line(Box::new(ideal));
        Ok(())
    }
}

/// Returns the display list without highlights.
///
/// The renderers shade a region with a single direction to the eye. On a cube face, this direction is the face's axis,
/// so a highlight would jump at the border between two faces.
fn matte(list: &DisplayList) -> DisplayList {
    DisplayList { is_matte: true, recent: RecentViews::default(), ..list.clone() }
}

const fn drawn_at_once(shown: Shown) -> PictureTimes {
    let drawn = shown.first_region_at;
    PictureTimes {
        picture: shown.picture,
        view: ViewNumber::taken_for(shown.picture),
        sampled_at: Some(drawn),
        transform_at: drawn,
        copied_at: Some(drawn),
        shown_at: shown.at,
        end: PictureResult::Shown,
        layer: 0,
    }
}

/// Number of views that slave processors use at the same time: six faces of two updates.
const VIEWS_AT_A_TIME: usize = 12;
