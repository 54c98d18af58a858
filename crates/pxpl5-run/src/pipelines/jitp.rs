use super::{late_regions, ntsc, sampled_at, samples};
use crate::keys::PipelineSettings;
use crate::pipeline::{PictureRules, PictureTimes, Pipeline, PipelineProperties, Setup, Source};
use crate::registry::{Goal, LimitCriterion, PipelineEntry, TestScene};
use crate::result::picture_ends::PictureResult;
use jitp::{Beam, DrawingSchedule, JitpConfig, JitpTiming, Transforms, Wanted, host, master, slave};
use pphigs::{Share, TransformCost};
use pxpl5_framebuffer::Video;
use pxpl5_gp::Priority;
use pxpl5_machine::{Arrival, LateRegion, Machine, NamedTable, Record};
use pxpl5_renderer::Layout;
use pxpl5_sim::Time;
use pxpl5_sim::parameters::{Key, KeyValue, KeyValues, SettingError};
use pxpl5_wire::display::Aim;
use pxpl5_wire::{CopyTarget, FieldParity, PictureNumber, RegionGrid, RegionId, ViewNumber};
use std::collections::BTreeMap;
use std::sync::Arc;

pub use jitp::{Interpolation, Viewpoint};

/// The pipeline of just-in-time pixels (JITP).
///
/// The pipeline divides a picture into strips of lines and draws each strip for the instant at which the strip is
/// displayed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Jitp {
    /// Choice of the instants for which the lines of a picture are drawn.
    pub viewpoint: Viewpoint,
    /// True if strips arrive at the frame buffer just before the beam. False if strips arrive one field earlier.
    pub racing: bool,
    /// Number of lines in a strip, 1 to 128.
    pub strip_rows: u32,
}

impl Jitp {
    /// Creates a pipeline with strips of one line. If a whole field shows one instant ([`Viewpoint::Field`]), strips
    /// have eight lines, because strips of fewer lines would not reduce the error.
    pub const fn new(viewpoint: Viewpoint, racing: bool) -> Self {
        let strip_rows = if matches!(viewpoint, Viewpoint::Field) { 8 } else { 1 };
        Self { viewpoint, racing, strip_rows }
    }

    /// Returns the pipelines of all viewpoints, each without and with racing.
    pub fn all() -> Vec<Self> {
        VARIANTS.iter().map(|(_, viewpoint, racing, _)| Self::new(*viewpoint, *racing)).collect()
    }

    fn config(self, record: &Record, pixels: bool) -> Result<JitpConfig, SettingError> {
        let schedule =
            DrawingSchedule::Beam { viewpoint: self.viewpoint, racing: self.racing, strip_rows: self.strip_rows };
        config(self.name(), record, schedule, Layout::slats(), pixels)
    }

    fn is_middle(self, arrival: &Arrival) -> bool {
        let grid = arrival.target.grid;
        u32::from(arrival.target.region.0) / grid.columns() == grid.rows() / 2
    }
}

/// Returns the settings of the firmware for a machine. `pipeline` is the name of the pipeline, for errors.
pub(super) fn config(
    pipeline: &str,
    record: &Record,
    schedule: DrawingSchedule,
    layout: Layout,
    pixels: bool,
) -> Result<JitpConfig, SettingError> {
    // The firmware needs the beam times of an interlaced display.
    let ports = record.ports();
    let display = ntsc(record, pipeline)?;
    let config = JitpConfig {
        host: ports.host,
        master: ports.gps[0],
        slaves: ports.gps[1..].to_vec(),
        renderers: ports.renderers.clone(),
        frame_buffer: ports.display()[0],
        schedule,
        beam: beam(*display.video()),
        aim: Aim::default(),
        layout,
        pixels,
        timing: record.config().firmware_table().copied().unwrap_or(JitpTiming::PAPERS),
    };
    config.check()?;
    Ok(config)
}

fn beam(video: Video) -> Beam {
    let at = move |field, row, x| {
        let line = 2 * row + FieldParity::of_field(field).first_line();
        video.when(x, line, field).unwrap_or_else(|| video.retrace(field))
    };
    Beam::new(at, move |field| video.retrace(field))
}

pub(super) fn whole_pass(setup: &Setup) -> TransformCost {
    TransformCost::pass_over(&setup.list, Share::new(Arc::clone(&setup.list), 0, 1).counts())
}

pub(super) fn load(machine: &mut Machine, setup: &Setup, config: &JitpConfig) {
    let gp = machine.processor(config.host, Priority::Foreground);
    let views = Arc::clone(&setup.views);
    // The host passes on the tracker's reports.
    let program = host(gp, config.clone(), setup.host, move |after| views.report_after(after));
    machine.load(config.host, Priority::Foreground, Box::pin(program));
    let gp = machine.processor(config.master, Priority::Foreground);
    let views = Arc::clone(&setup.views);
    let pass = whole_pass(setup);
    // The master requests views for the instants at which its strips are visible.
    let view_of = move |wanted: Wanted| views.view_at(wanted.number, wanted.reports_until, wanted.shown_at);
    for (level, program) in master(&gp, config, pass, view_of) {
        machine.load(config.master, level, program);
    }
    // Slaves have the same list and views, so the simulator transforms each field once for all slaves.
    let transforms = Transforms::default();
    for (index, node) in config.slaves.iter().enumerate() {
        let gp = machine.processor(*node, Priority::Foreground);
        for (level, program) in slave(&gp, config, &setup.list, &transforms, index) {
            machine.load(*node, level, program);
        }
    }
}

fn due(video: &Video, target: &CopyTarget) -> Time {
    let field = target.picture.period_drawn_for();
    video.reaches(target, field).unwrap_or_else(|| video.retrace(field))
}

/// Counts of a field's regions that arrived before the end of the field and before the beam, and the arrival time of
/// the middle strip.
#[derive(Clone, Copy, Debug, Default)]
struct Arrived {
    in_period: u32,
    in_time: u32,
    middle_at: Option<Time>,
}

impl Pipeline for Jitp {
    fn name(&self) -> &'static str {
        let is_own = |(_, viewpoint, racing, _): &&Variant| (*viewpoint, *racing) == (self.viewpoint, self.racing);
        VARIANTS.iter().find(is_own).map_or("", |(name, ..)| name)
    }

    fn settings(&self) -> Vec<(&'static str, KeyValue)> {
        vec![("strip_rows", KeyValue::Whole(self.strip_rows.into()))]
    }

    fn properties(&self) -> PipelineProperties {
        PipelineProperties {
            knows_when_seen: true,
            without_code: None,
            has_one_pose: self.viewpoint == Viewpoint::Field,
            can_discard_records: true,
            ..PipelineProperties::new(
                Layout::slats(),
                "from the order of the middle strip (or of the field, where one view serves all of it), for which the newest pose is taken, to the scan of that strip",
                "a picture is due every field, and in time if every strip arrives before the beam",
            )
        }
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), SettingError> {
        let config = JitpConfig { aim: setup.aim, ..self.config(machine.record(), setup.pixels)? };
        load(machine, setup, &config);
        Ok(())
    }
}

impl PictureRules for Jitp {
    fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes> {
        let Ok(display) = ntsc(record, self.name()) else { return Vec::new() };
        let observation = record.observation();
        let video = display.video();
        // Count the regions of each picture that arrived in the period and in time.
        let mut arrived: BTreeMap<PictureNumber, Arrived> = BTreeMap::new();
        for arrival in &observation.arrivals {
            let Arrived { in_period, in_time, middle_at } = arrived.entry(arrival.target.picture).or_default();
            let next_field = arrival.target.picture.period_drawn_for().next();
            *in_period += u32::from(arrival.last_part_at <= video.retrace(next_field));
            *in_time += u32::from(arrival.last_part_at <= due(video, &arrival.target));
            if self.is_middle(arrival) {
                *middle_at = (*middle_at).max(Some(arrival.last_part_at));
            }
        }
        // The middle line defines the picture's times: the picture is shown when the middle line is scanned.
        let grid = RegionGrid { region_height: self.strip_rows, ..RegionGrid::FIELD };
        let middle_line = |field| 2 * (grid.rows() / 2 * self.strip_rows) + FieldParity::of_field(field).first_line();
        let times = samples(record).map(|mark| {
            let Arrived { in_period, in_time, middle_at } = arrived.get(&mark.picture).copied().unwrap_or_default();
            let field = mark.picture.period_drawn_for();
            let shown_at = video.when(0, middle_line(field), field).unwrap_or_else(|| video.retrace(field));
            let end = PictureResult::of(in_period == grid.regions(), in_time == grid.regions());
            sampled_at(mark, middle_at, shown_at, end)
        });
        times.filter(|times| video.retrace(times.picture.period_drawn_for().next()) <= end).collect()
    }

    fn late_regions(&self, record: &Record, end: Time) -> Vec<LateRegion> {
        let Ok(display) = ntsc(record, self.name()) else { return Vec::new() };
        late_regions(display, record, end, |video, arrival| due(video, &arrival.target))
    }

    fn periods_a_picture(&self, _: &Record) -> Option<u64> {
        Some(1)
    }

    fn source(
        &self,
        record: &Record,
        target: &CopyTarget,
        _: &BTreeMap<PictureNumber, ViewNumber>,
        aim: Aim,
    ) -> Option<Source> {
        let field = target.picture.period_drawn_for();
        let strip = u32::from(target.region.0) / target.grid.columns();
        let view = |i: u32| JitpConfig::view_number(field, u64::from(i));
        Some(match self.viewpoint {
            Viewpoint::Field => Source::View(view(0)),
            Viewpoint::Strip => Source::View(view(strip)),
            // Two views of a field are interpolated by the position of the strip.
            Viewpoint::Dual(reading) => Source::Between {
                from: view(0),
                to: view(1),
                part: JitpConfig { aim, ..self.config(record, false).ok()? }.part(field, strip),
                on_screen: reading == Interpolation::Screen,
            },
        })
    }
}

/// Returns the region of `grid` that contains the pixel in column `x` and line `row`.
pub fn region_at(grid: &RegionGrid, x: u32, row: u32) -> RegionId {
    RegionId((row / grid.region_height * grid.columns() + x / grid.region_width) as u16)
}

pub(super) const TABLES: &[NamedTable] = &[("jitp", || Box::new(JitpTiming::PAPERS))];

const KEYS: &[Key] = &[Key::new("strip_rows", "height of a strip", KeyValues::Whole(1, 128))
    .with_unit("lines")
    .with_default("8 for a field, 1 for lines")];

/// Name of a variant, the choice of the instants for which lines are drawn, true if strips arrive just before the beam,
/// and a description.
type Variant = (&'static str, Viewpoint, bool, &'static str);

const SCREEN: Viewpoint = Viewpoint::Dual(Interpolation::Screen);
const VIEW: Viewpoint = Viewpoint::Dual(Interpolation::View);
const RACING: &str = "the same, just before the beam (JITP)";

const VARIANTS: [Variant; 8] = [
    (
        "jitp-field",
        Viewpoint::Field,
        false,
        "a field drawn for the instant of its middle, one field ahead of the beam (JITP)",
    ),
    (
        "jitp-field-racing",
        Viewpoint::Field,
        true,
        "a field drawn for the instant of its middle, just before the beam (JITP)",
    ),
    (
        "jitp-scanline",
        Viewpoint::Strip,
        false,
        "every line drawn for its own instant, one field ahead of the beam (JITP)",
    ),
    (
        "jitp-scanline-racing",
        Viewpoint::Strip,
        true,
        "every line drawn for its own instant, just before the beam (JITP)",
    ),
    ("jitp-dual-screen", SCREEN, false, "lines between two views of a field, interpolated on the screen (JITP)"),
    ("jitp-dual-screen-racing", SCREEN, true, RACING),
    ("jitp-dual-view", VIEW, false, "lines between two views of a field, interpolated before the projection (JITP)"),
    ("jitp-dual-view-racing", VIEW, true, RACING),
];

pub(super) const ENTRIES: [PipelineEntry; 8] =
    [entry::<0>(), entry::<1>(), entry::<2>(), entry::<3>(), entry::<4>(), entry::<5>(), entry::<6>(), entry::<7>()];

const fn entry<const VARIANT: usize>() -> PipelineEntry {
    let (name, .., about) = VARIANTS[VARIANT];
    PipelineEntry {
        name,
        family: "jitp",
        about,
        preset: "small-hmd",
        keys: KEYS,
        build: build::<VARIANT>,
        limit: |_| LimitCriterion { goal: Goal::NoMissedRetrace, scene: TestScene::FullScreen, fields: 24 },
        tables: TABLES,
        closed_form: None,
        compared: true,
    }
}

fn build<const VARIANT: usize>(settings: &PipelineSettings) -> Arc<dyn Pipeline> {
    let (_, viewpoint, racing, _) = VARIANTS[VARIANT];
    let jitp = Jitp::new(viewpoint, racing);
    let strip_rows = settings.whole("strip_rows").map_or(jitp.strip_rows, |rows| rows as u32);
    Arc::new(Jitp { strip_rows, ..jitp })
}
