//! The results of a viewer's walk, which a report contains as object `arp` with schema `pxpl5-arp/1`. Results that were
//! not evaluated are null.

use crate::cube_faces::DrawCounts;
use crate::settings::{PolicyKind, WalkSettings};
use crate::tears::TearWidths;
use crate::walk::{MemoryTally, WalkTally};
use crate::world::World;
use address_recalculation::{ArpConfig, Latch, LookupStats};
use pxpl5_sim::Span;
use pxpl5_wire::PeriodNumber;
use serde::Serialize;
use std::collections::BTreeMap;

/// Name and version of the layout of the report.
pub const SCHEMA: &str = "pxpl5-arp/1";

/// The results of a walk through a scene, as written to JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ArpReport {
    pub schema: &'static str,
    /// Number of texels along the edge of a cube face.
    pub face_texels: u64,
    /// Time at which the display reads the head's orientation: before each `field`, `line` or `pixel`.
    pub latch: &'static str,
    /// Time from reading the orientation to displaying the pixel, in ns.
    pub pipeline_ns: f64,
    /// Number of orientation matrices that arrived from the tracker. Null without a tracker.
    pub matrix_loads: Option<u64>,
    /// Number of matrices that were refused because they were not rotations. Null without a tracker.
    pub matrix_refused: Option<u64>,
    /// Number of pixels whose footprint (its four texels) extends beyond one face. Null if no view was drawn.
    pub footprints_split: Option<u64>,
    /// Number of pixels whose footprint (its four texels) has two texels in one memory bank. Null if no view was drawn.
    pub bank_conflicts: Option<u64>,
    pub memories: Vec<WalkMemoryReport>,
    /// Results of the policy that decides when each memory is drawn.
    pub priority: PriorityReport,
    /// Widths of the tears (gaps where different memories meet), in texels of a face. A texel is the angle of 90 degrees
    /// divided by [`Self::face_texels`].
    pub tears_texels: TearsReport,
    /// Time from reading the head's orientation to displaying the pixel, in ms, averaged over all pixels. The times of
    /// tracker and host are not included.
    pub rotation_latency_ms: WalkLatency,
    /// Latency with which display memory 0 shows a translation of the eye, in ms. Null without an update.
    ///
    /// The memory is drawn from the eye position at the start of a frame. The latency lasts from the start of this
    /// frame to the display of a pixel of the memory.
    pub translation_latency_ms: WalkLatency,
    /// Mean difference between the displayed view and a direct rendering of the same pose, in pixels. Always null,
    /// because no run evaluates this difference yet.
    pub sampling_error_px: Option<f64>,
}

/// The part of an [`ArpReport`] about one display memory.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WalkMemoryReport {
    /// Number of times per second that the memory shows a new update.
    pub updates_hz: f64,
    /// Mean number of frames between two updates of the memory. Null without updates.
    pub period_frames: Option<f64>,
    /// Number of segments (parts of objects) in the memory, averaged over frames.
    pub segments: f64,
    /// Mean number of triangles per update. Null without updates.
    pub triangles: Option<f64>,
    /// Number of regions that arrived over a ring. Null with an ideal renderer, which has no regions.
    pub regions_copied: Option<u64>,
    /// Number of retraces at which an update was incomplete.
    pub missed: u64,
    /// Mean distance between the eye and the position from which the memory was drawn, in mm.
    pub eye_age_mm: f64,
    /// Latency with which the memory shows a translation of the eye, in ms, averaged over frames.
    ///
    /// The memory is drawn from the eye position at the start of a frame. The latency lasts from the start of this
    /// frame to the display of a pixel of the memory.
    pub translation_latency_ms: WalkLatency,
    /// Size of both buffers of the memory, in bytes.
    pub bytes: u64,
}

/// Results of a policy, which decides when each memory is drawn.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PriorityReport {
    /// Name of the policy that decides which segments (parts of objects) are drawn in which frames: `full`, `objects`
    /// or `cells`.
    pub policy: &'static str,
    /// Largest accepted image error, in degrees. Null if the policy draws everything in every frame.
    pub theta_deg: Option<f64>,
    /// Side of a square cell of the floor, in metres. Null without cells.
    pub cell_m: Option<f64>,
    /// Number of segments (parts of objects in one cell) that are drawn per second.
    pub draws_per_s: f64,
    /// Percentage of draws that the policy saves, relative to drawing everything in every frame.
    pub saved_percent: f64,
    /// Number of times that an object moved from one memory to another. Null unless the policy is `objects`.
    pub moved_objects: Option<u64>,
    /// Number of times that cells (squares of the floor) were assigned to memories anew. Null without cells.
    pub redeals: Option<u64>,
    /// Number of faces that a triangle covers, averaged over the last update of each memory. Null if no view was drawn.
    pub faces_per_primitive: Option<f64>,
}

/// Widths of the tears, in texels. A tear is a gap in the view where different memories meet. Its width is the angle
/// between the two directions in which the memories draw a shared vertex.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TearsReport {
    /// Widths that the tears would have without warping. Null if no object is cut between two memories.
    pub before: Option<TearWidths>,
    /// Widths of the tears in the displayed picture. Null if no object is cut between two memories.
    pub after: Option<TearWidths>,
    /// Angle by which warping moves the most displaced vertex of a frame, in texels, as percentiles over the frames.
    /// Null without warping.
    pub stretch: Option<TearWidths>,
}

/// A latency and its parts, in ms.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WalkLatency {
    /// Sum of all parts in ms.
    pub total: Option<f64>,
    /// Parts of the latency in ms, each with its name. Null for parts that were not simulated.
    pub parts: BTreeMap<&'static str, Option<f64>>,
}

impl ArpReport {
    /// Creates the report of a viewer's walk, without the counts of a view ([`Self::with_view`]).
    pub fn of(world: &World, settings: &WalkSettings, tally: &WalkTally) -> Self {
        let timing = &settings.display.timing;
        let percentiles = |angles: &[f64]| TearWidths::of(angles, settings.texel_deg());
        Self {
            schema: SCHEMA,
            face_texels: timing.face_texels,
            latch: latch(&settings.display),
            pipeline_ns: timing.depth().0 as f64 / 1e3,
            // A walk has no tracker that sends matrices.
            matrix_loads: None,
            matrix_refused: None,
            footprints_split: None,
            bank_conflicts: None,
            memories: memories(settings, tally),
            priority: priority(world, settings, tally),
            tears_texels: TearsReport {
                before: percentiles(&tally.tears.before),
                after: percentiles(&tally.tears.after),
                stretch: percentiles(&tally.tears.stretch),
            },
            rotation_latency_ms: rotation(&settings.display),
            translation_latency_ms: translation(tally.memories.first(), settings),
            sampling_error_px: None,
        }
    }

    /// Adds the counts of extra memory accesses for the pixels of a view, and of the triangles drawn for the view.
    #[must_use]
    pub fn with_view(mut self, stats: &LookupStats, drawing: &DrawCounts) -> Self {
        self.footprints_split = Some(stats.split);
        self.bank_conflicts = Some(stats.conflicts);
        self.priority.faces_per_primitive = Some(drawing.on_faces as f64 / drawing.triangles.max(1) as f64);
        self
    }
}

fn latch(display: &ArpConfig) -> &'static str {
    Latch::ALL.iter().find(|(_, latch)| *latch == display.latch).map_or("field", |(name, _)| name)
}

/// Returns the latency of a head rotation: all pipeline stages, then the scan from reading the orientation to the
/// pixel.
fn rotation(display: &ArpConfig) -> WalkLatency {
    WalkLatency::of(vec![("pipeline", Some(ms(display.timing.depth()))), ("scan", scan_ms(display, display.latch))])
}

/// Returns the latency of an eye's translation in three parts. The parts are the drawing of an update, the time for
/// which the update has already been shown, and the scan until the pixel is displayed.
fn translation(memory: Option<&MemoryTally>, settings: &WalkSettings) -> WalkLatency {
    let memory = memory.filter(|memory| memory.shown_frames > 0);
    let mean_ms = |frames: fn(&MemoryTally) -> u64| {
        let mean = memory.map(|memory| frames(memory) as f64 / memory.shown_frames as f64);
        mean.map(|frames| frames * 1e3 / settings.numbers.frame_hz)
    };
    WalkLatency::of(vec![
        ("draw", mean_ms(|memory| memory.drawing_frames)),
        ("wait", mean_ms(|memory| memory.age_frames - memory.drawing_frames)),
        ("scan", scan_ms(&settings.display, Latch::Field)),
    ])
}

fn ms(span: Span) -> f64 {
    span.0 as f64 / 1e9
}

/// Returns the mean time from reading the orientation to displaying a pixel, without the stages of the pixel pipeline,
/// in ms. The mean is over the pixels of an even and an odd field. Returns `None` if the scan is invalid.
fn scan_ms(display: &ArpConfig, from: Latch) -> Option<f64> {
    let scan = display.scan().ok()?;
    let mut sum = 0.0;
    for y in 0..scan.height() {
        let field = PeriodNumber(u64::from(y % 2));
        // All pixels of a line have equal distances, so the first and the last pixel give the mean.
        for x in [0, scan.width() - 1] {
            let latched = scan.latches(from, x, y, field)?;
            sum += ms(scan.when(x, y, field)?.since(latched)) - ms(display.timing.depth());
        }
    }
    Some(sum / 2.0 / f64::from(scan.height()))
}

impl WalkLatency {
    /// Creates a latency as the sum of its parts. The sum is `None` if a part is `None`.
    fn of(parts: Vec<(&'static str, Option<f64>)>) -> Self {
        Self { total: parts.iter().map(|(_, part)| *part).sum(), parts: parts.into_iter().collect() }
    }
}

fn memories(settings: &WalkSettings, tally: &WalkTally) -> Vec<WalkMemoryReport> {
    let timing = &settings.display.timing;
    let bytes = 2 * 6 * timing.face_texels.pow(2) * (timing.colour_bits + timing.depth_bits) / 8;
    tally.memories.iter().map(|memory| WalkMemoryReport::of(memory, tally.frames as f64, settings, bytes)).collect()
}

impl WalkMemoryReport {
    fn of(memory: &MemoryTally, frames: f64, settings: &WalkSettings, bytes: u64) -> Self {
        let updates = memory.updates as f64;
        Self {
            updates_hz: updates * settings.numbers.frame_hz / frames,
            period_frames: (memory.updates > 0).then(|| frames / updates),
            segments: memory.segment_frames as f64 / frames,
            triangles: (memory.updates > 0).then(|| memory.triangles_drawn as f64 / updates),
            regions_copied: None,
            missed: memory.missed,
            eye_age_mm: memory.age_m * 1e3 / frames,
            translation_latency_ms: translation(Some(memory), settings),
            bytes,
        }
    }
}

fn priority(world: &World, settings: &WalkSettings, tally: &WalkTally) -> PriorityReport {
    let hz = settings.numbers.frame_hz;
    let is_cells = settings.policy == PolicyKind::Cells;
    let draws_per_s = tally.draws_per_s(hz);
    PriorityReport {
        policy: PolicyKind::ALL[settings.policy as usize].0,
        theta_deg: (settings.policy != PolicyKind::Full).then_some(settings.numbers.theta_deg),
        cell_m: is_cells.then_some(settings.numbers.cell_m),
        draws_per_s,
        saved_percent: address_recalculation::priority::saved_percent(draws_per_s, world.segments.len() as f64 * hz),
        moved_objects: tally.moved_objects,
        redeals: is_cells.then_some(tally.redeals),
        faces_per_primitive: None,
    }
}
