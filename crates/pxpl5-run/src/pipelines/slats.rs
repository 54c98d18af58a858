use super::{late_regions, ntsc, sampled_at, samples};
use crate::keys::PipelineSettings;
use crate::pipeline::{PictureRules, PictureTimes, Pipeline, PipelineProperties, Setup, light_span};
use crate::registry::{Goal, LimitCriterion, PipelineEntry, TestScene};
use crate::result::picture_ends::PictureResult;
use pphigs::{RegionBinning, Shading, Share};
use pxpl5_framebuffer::Video;
use pxpl5_gp::{CodeUse, CodeVersion, GpTiming, Priority};
use pxpl5_machine::{Arrival, LateRegion, Machine, MachineConfig, Record};
use pxpl5_renderer::Layout;
use pxpl5_sim::Time;
use pxpl5_sim::parameters::{Key, KeyValue, KeyValues, SettingError, names};
use pxpl5_wire::display::LightTimes;
use pxpl5_wire::{CopyTarget, PeriodNumber, PictureNumber, RegionGrid, SurfaceId};
use slats::{CopySchedule, SlatsConfig, host, processor};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Version of the graphics processor's program.
///
/// Versions differ only in simulated time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// Code of the 1994 prototype (TR94).
    Of1994,
    /// Code of 1995 (I3D95).
    Of1995,
    /// Code that fits in the instruction cache and takes a third of the time of the 1994 code (I3D95).
    Optimised,
}

pxpl5_sim::parameters::named!(Code, "version of the code", Code::ALL);

impl Code {
    /// All versions of the graphics processor's code, with their names in experiment files.
    pub const ALL: [(&str, Self); 3] = [("1994", Self::Of1994), ("1995", Self::Of1995), ("optimised", Self::Optimised)];

    const fn timing(self) -> GpTiming {
        match self {
            Self::Of1994 => GpTiming::SLATS_1994,
            Self::Of1995 => GpTiming::SLATS_1995,
            Self::Optimised => GpTiming::SLATS_OPTIMISED,
        }
    }

    const fn version(self) -> CodeVersion {
        match self {
            Self::Of1994 | Self::Of1995 => CodeVersion::Compiled,
            Self::Optimised => CodeVersion::Scheduled,
        }
    }
}

/// Source of the colours of vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlatsLighting {
    /// Colours were computed before the run (TR94: by radiosity). The graphics processor computes no lighting.
    Precomputed,
    /// The graphics processor computes the lighting of each vertex for each eye.
    OnGp,
}

pxpl5_sim::parameters::named!(SlatsLighting, "lighting", SlatsLighting::ALL);

impl SlatsLighting {
    /// Both sources of colours, with their names in experiment files.
    pub const ALL: [(&str, Self); 2] = [("precomputed", Self::Precomputed), ("gp", Self::OnGp)];

    const fn shading(self) -> Shading {
        match self {
            Self::Precomputed => Shading::Precomputed,
            Self::OnGp => Shading::Gouraud,
        }
    }
}

/// The pipeline Slats, which draws one new image in every field (TR94, I3D95).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slats {
    /// Order in which the regions of a picture are copied.
    pub copy: CopySchedule,
    /// Choice of the regions that receive a clump (a group of at most 30 triangles).
    pub binning: RegionBinning,
    /// Source of the colours of vertices.
    pub lighting: SlatsLighting,
    /// Version of the graphics processor's code. `None` selects the code of the machine's preset.
    pub code: Option<Code>,
}

impl Slats {
    /// Creates the prototype with the split copy of TR94. The lower half of a picture is copied while the display
    /// already scans the upper half.
    pub const fn split() -> Self {
        Self {
            copy: CopySchedule::Split,
            binning: RegionBinning::All,
            lighting: SlatsLighting::Precomputed,
            code: None,
        }
    }

    /// Creates the prototype without the split copy: both halves are copied before the retrace (TR94).
    pub const fn whole() -> Self {
        Self { copy: CopySchedule::Whole, ..Self::split() }
    }

    /// Creates a variant of [`Slats::split`] that copies into the hidden buffer. If a field is late, the display
    /// repeats the last complete field.
    pub const fn backup() -> Self {
        Self { copy: CopySchedule::Backup, ..Self::split() }
    }

    fn config(&self, machine: &Machine, pixels: bool) -> SlatsConfig {
        let ports = machine.ports();
        SlatsConfig {
            host: ports.host,
            processors: ports.gps.clone(),
            renderers: ports.renderers.clone(),
            frame_buffers: [ports.display()[0], ports.display()[1]],
            copy: self.copy,
            binning: self.binning,
            shading: self.lighting.shading(),
            layout: Layout::slats(),
            pixels,
        }
    }

    fn is_due_before_retrace(&self, arrival: &Arrival) -> bool {
        let top = u32::from(arrival.target.region.0) < RegionGrid::FIELD.columns();
        !self.copy.is_split() || top
    }
}

impl Pipeline for Slats {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn settings(&self) -> Vec<(&'static str, KeyValue)> {
        let mut all = vec![
            ("copy", name(&CopySchedule::ALL, self.copy)),
            ("binning", name(&RegionBinning::ALL, self.binning)),
            ("lighting", name(&SlatsLighting::ALL, self.lighting)),
        ];
        all.extend(self.code.map(|code| ("code", name(&Code::ALL, code))));
        all
    }

    fn properties(&self) -> PipelineProperties {
        PipelineProperties {
            eyes: 2,
            shading: self.lighting.shading(),
            code_use: match (self.lighting, self.binning) {
                (SlatsLighting::Precomputed, RegionBinning::All) => CodeUse::Slats,
                (SlatsLighting::Precomputed, _) => CodeUse::SlatsTouched,
                (SlatsLighting::OnGp, _) => CodeUse::SlatsLit,
            },
            without_code: (self.binning == RegionBinning::Boxes).then_some("no code bins by bounding boxes"),
            can_discard_records: true,
            // The latency is always one field, but not the time from the start of a field to the first copy.
            compared_ms: |summary| summary.copy_begins_ms,
            ..PipelineProperties::new(
                Layout::slats(),
                "from the retrace at which the newest view is taken and TRANSFORM starts to the retrace from which on the field is scanned out",
                "a picture is due every field, and in time if every region arrives before its deadline; the deadline is the retrace, or for the bottom regions of a split copy the scan of their first line; with a backup, a late picture counts for the later retrace of its lines at which it is shown",
            )
        }
    }

    fn adapt(&self, config: MachineConfig) -> MachineConfig {
        // A machine with times of code has those of the program that draws this variant.
        let has_times_of_code = config.gp == GpTiming::SLATS_1994;
        let config = if has_times_of_code { config.with_times_of_code(self.properties().code_use) } else { config };
        let Some(code) = self.code else { return config };
        // The fitted program of 1995 has no times of its own per pass and structure.
        if has_times_of_code && matches!(code, Code::Of1995) {
            return MachineConfig { gp: code.timing(), code: Some(code.version()), ..config };
        }
        let GpTiming { triangle_ns, sphere_ns, bin_entry_ns, .. } = code.timing();
        let gp = GpTiming { triangle_ns, sphere_ns, bin_entry_ns, ..config.gp };
        MachineConfig { gp, code: Some(code.version()), ..config }
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), SettingError> {
        ntsc(machine.record(), self.name())?;
        let config = self.config(machine, setup.pixels);
        // The configuration also fixes which renderer serves which regions.
        let binding = config.check()?;
        let foreground = Priority::Foreground;
        let views = Arc::clone(&setup.views);
        let reports = Arc::clone(&setup.views);
        let gp = machine.processor(config.host, foreground);
        let view_of = move |view, time| views.newest(view, time);
        let program = host(gp, config.clone(), setup.host, move |after| reports.report_after(after), view_of);
        machine.load(config.host, foreground, Box::pin(program));
        // Every GP transforms its own share of the triangles.
        for (index, node) in config.processors.iter().enumerate() {
            let gp = machine.processor(*node, foreground);
            let share = Share::new(Arc::clone(&setup.list), index, config.processors.len());
            for (level, program) in processor(&gp, &config, &binding, share, index) {
                machine.load(*node, level, Box::pin(program));
            }
        }
        Ok(())
    }
}

impl PictureRules for Slats {
    fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes> {
        // Collect the arrivals of each picture and the fields with late regions.
        let observation = record.observation();
        let late: BTreeSet<PeriodNumber> = self.late_regions(record, end).iter().map(|region| region.field).collect();
        let mut arrivals: BTreeMap<PictureNumber, Copied> = BTreeMap::new();
        for arrival in &observation.arrivals {
            arrivals.entry(arrival.target.picture).or_default().note(arrival);
        }
        let backup = (self.copy == CopySchedule::Backup).then(|| Backup::new(record));
        // The first GP samples a pose at the start of each picture.
        let leader = record.ports().gps[0];
        let begun = samples(record).filter(|mark| mark.node == leader);
        let times = begun.map(|mark| {
            let copied = arrivals.get(&mark.picture).copied().unwrap_or_default();
            let whole = copied.regions == 2 * RegionGrid::FIELD.regions() as usize;
            let field = mark.picture.period_drawn_for();
            let in_its_period = whole && copied.at <= record.tick(field.next());
            // Under a backup, the swaps determine in which period the picture was shown.
            let shown = backup.as_ref().filter(|_| whole).and_then(|backup| backup.shown(record, field, &copied));
            let picture_end = match (&backup, shown) {
                (None, _) => PictureResult::of(in_its_period, !late.contains(&field)),
                (Some(_), Some(_)) => PictureResult::Shown,
                (Some(_), None) => PictureResult::of(in_its_period, false),
            };
            sampled_at(mark, whole.then_some(copied.at), record.tick(shown.unwrap_or(field)), picture_end)
        });
        // A picture is evaluated only after its last possible period. The bottom half of a split copy is scanned in
        // that period. Under a backup, a later retrace of the same lines may show the picture.
        let evaluated = |times: &PictureTimes| {
            let field = times.picture.period_drawn_for();
            let shown = record.display().period_at(times.shown_at);
            let last =
                if backup.is_some() && times.end != PictureResult::Shown { field.0 + LATER_RETRACES } else { shown.0 };
            record.tick(PeriodNumber(last).next()) <= end
        };
        times.filter(evaluated).collect()
    }

    fn late_regions(&self, record: &Record, end: Time) -> Vec<LateRegion> {
        let Ok(display) = ntsc(record, self.name()) else { return Vec::new() };
        let due =
            |video: &Video, arrival: &Arrival| deadline(video, &arrival.target, self.is_due_before_retrace(arrival));
        late_regions(display, record, end, due)
    }

    fn periods_a_picture(&self, _: &Record) -> Option<u64> {
        Some(1)
    }

    /// Returns the time from the first to the last light of a field. The display scans the lines of the field only
    /// once, because the next field has the lines between them.
    fn shown(&self, record: &Record, times: &PictureTimes, _: Option<&PictureTimes>) -> LightTimes {
        light_span(record, record.display().period_at(times.shown_at), 1)
    }

    /// Returns 0 for the upper and 1 for the lower half of a split copy. The halves are timed separately.
    fn copy_part(&self, arrival: &Arrival) -> u8 {
        let bottom = u32::from(arrival.target.region.0) >= RegionGrid::FIELD.columns();
        u8::from(bottom && self.copy.is_split())
    }
}

/// Number of retraces after the due retrace at which [`Slats::backup`] can still show a late field. Even and odd fields
/// alternate, so only two of these four retraces begin a scan of the late field's lines.
const LATER_RETRACES: u64 = 4;

#[derive(Clone, Copy, Debug, Default)]
struct Copied {
    regions: usize,
    at: Time,
    top_at: Time,
    buffer: u8,
}

impl Copied {
    fn note(&mut self, arrival: &Arrival) {
        self.regions += 1;
        self.at = self.at.max(arrival.last_part_at);
        if u32::from(arrival.target.region.0) < RegionGrid::FIELD.columns() {
            self.top_at = self.top_at.max(arrival.last_part_at);
        }
        self.buffer = arrival.target.buffer;
    }
}

struct Backup {
    /// First period and buffer of each swap, in order, for each eye.
    swaps: [Vec<(PeriodNumber, u8)>; 2],
}

impl Backup {
    fn new(record: &Record) -> Self {
        let of =
            |surface| record.observation().swaps_of(SurfaceId(surface)).map(|swap| (swap.tick, swap.buffer)).collect();
        Self { swaps: [of(0), of(1)] }
    }

    /// Returns the first period in which both eyes see the field, beginning with the period `field`.
    ///
    /// Only every second period scans the field's lines.
    fn shown(&self, record: &Record, field: PeriodNumber, copied: &Copied) -> Option<PeriodNumber> {
        let periods = (field.0..=field.0 + LATER_RETRACES).step_by(2).map(PeriodNumber);
        let displays = |swaps: &Vec<(PeriodNumber, u8)>, period: PeriodNumber| {
            let swap = swaps[..swaps.partition_point(|swap| swap.0 <= period)].last();
            swap.map_or(0, |swap| swap.1) == copied.buffer
        };
        periods
            .filter(|period| copied.top_at < record.tick(*period))
            .find(|period| self.swaps.iter().all(|swaps| displays(swaps, *period)))
    }
}

fn deadline(video: &Video, target: &CopyTarget, before_retrace: bool) -> Time {
    let field = target.picture.period_drawn_for();
    let retrace = video.retrace(field);
    if before_retrace { retrace } else { video.reaches(target, field).unwrap_or(retrace) }
}

fn name<T: PartialEq>(choices: &[(&'static str, T)], value: T) -> KeyValue {
    KeyValue::Name(choices.iter().find(|(_, choice)| *choice == value).map_or("", |(name, _)| name))
}

pub(super) const ENTRY: PipelineEntry = PipelineEntry {
    name: "slats",
    family: "slats",
    about: "a new picture in every field, drawn completely between two retraces (TR94, I3D95)",
    preset: "slats",
    keys: &[
        Key::new(
            "copy",
            "time of the copies of regions: whole (all before the retrace), split (the bottom regions after it) or \
                    backup (split, and the last complete field replaces a late field; beyond the prototype)",
            KeyValues::Names(&const { names(&CopySchedule::ALL) }),
        )
        .with_default("split"),
        Key::new(
            "binning",
            "receivers of a clump: all regions, the touched regions, or the regions under bounding boxes",
            KeyValues::Names(&const { names(&RegionBinning::ALL) }),
        )
        .with_default("all"),
        Key::new(
            "lighting",
            "source of vertex colours: precomputed (no light on the GP), or gp (computed on the GP for each eye)",
            KeyValues::Names(&const { names(&SlatsLighting::ALL) }),
        )
        .with_default("precomputed"),
        Key {
            sets: &["gp.triangle_ns", "gp.sphere_ns", "gp.bin_entry_ns"],
            ..Key::new(
                "code",
                "times per primitive of the code of 1994, 1995 or optimised, instead of the times of the machine",
                KeyValues::Names(&const { names(&Code::ALL) }),
            )
        },
    ],
    build,
    limit,
    tables: &[],
    closed_form: None,
    compared: true,
};

fn build(settings: &PipelineSettings) -> Arc<dyn Pipeline> {
    let split = Slats::split();
    Arc::new(Slats {
        copy: settings.chosen("copy").unwrap_or(split.copy),
        binning: settings.chosen("binning").unwrap_or(split.binning),
        lighting: settings.chosen("lighting").unwrap_or(split.lighting),
        code: settings.chosen("code"),
    })
}

/// Returns the criterion by which a search finds the largest scene.
///
/// If every clump (group of triangles) goes to all regions, the test scene has full-screen triangles. Otherwise the
/// test scene has small triangles.
fn limit(settings: &PipelineSettings) -> LimitCriterion {
    let touched = settings.chosen("binning") == Some(RegionBinning::Touched);
    let scene = if touched { TestScene::Typical } else { TestScene::FullScreen };
    LimitCriterion { goal: Goal::NoMissedRetrace, scene, fields: 16 }
}
