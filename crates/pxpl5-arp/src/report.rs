//! The object `arp` of a report, schema `pxpl5-arp/1`. What was not judged is null.

use crate::settings::{PolicyKind, Settings};
use crate::tears::Percentiles;
use crate::walk::{MemoryTally, WalkTally};
use crate::world::World;
use address_recalculation::{ArpConfig, Latch, LookStats};
use cube_faces::Drawing;
use pxpl5_sim::Span;
use pxpl5_wire::PeriodNumber;
use serde::Serialize;
use std::collections::BTreeMap;

/// Name and version of the record's layout.
pub const SCHEMA: &str = "pxpl5-arp/1";

/// What came of a walk.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// Texels along the edge of a face.
    pub face_texels: u64,
    /// Before what the orientation is latched: field, line or pixel.
    pub latch: &'static str,
    /// From the latch to the light, ns.
    pub pipeline_ns: f64,
    /// Matrices that came; null without a tracker.
    pub matrix_loads: Option<u64>,
    /// Matrices that were no rotations; null without a tracker.
    pub matrix_refused: Option<u64>,
    /// Footprints with a texel on another face; null where nobody looked.
    pub footprints_split: Option<u64>,
    /// Footprints with two texels in a bank; null where nobody looked.
    pub bank_conflicts: Option<u64>,
    /// Each display memory.
    pub memories: Vec<MemoryReport>,
    /// The policy.
    pub priority: PriorityReport,
    /// Cuts between memories, in texels of 90 degrees over a face's edge; null where no memories meet.
    pub tears_px: TearsReport,
    /// From an orientation that is known at the latch to the light, ms, mean over all pixels. A tracker and a host are no part of a walk.
    pub rotation_latency_ms: Latency,
    /// From the beginning of the frame in which the eye was there to the light of what memory 0 shows, ms; null without a picture.
    pub translation_latency_ms: Latency,
    /// Mean difference of the eye's picture from a redraw for the same pose, pixels; null where nobody looked.
    pub sampling_error_px: Option<f64>,
}

/// A display memory.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MemoryReport {
    /// Pictures a second.
    pub updates_hz: f64,
    /// Frames from one picture to the next in the mean; null without any.
    pub period_frames: Option<f64>,
    /// Segments in it, mean over frames.
    pub segments: f64,
    /// Triangles of an update, mean; null without any.
    pub triangles: Option<f64>,
    /// Regions that came over a ring; null with an ideal source, which has none.
    pub regions_copied: Option<u64>,
    /// Retraces at which an update was not whole.
    pub missed: u64,
    /// How far the eye was from where it was drawn, mean, mm.
    pub eye_age_mm: f64,
    /// From the beginning of the frame in which the eye was where it was drawn from to the light, ms, mean over frames.
    pub translation_latency_ms: Latency,
    /// Bytes of both buffers.
    pub bytes: u64,
}

/// A policy.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PriorityReport {
    /// full, objects or cells.
    pub policy: &'static str,
    /// The angle by which an image may be wrong, degrees; null where everything is drawn in every frame.
    pub theta_deg: Option<f64>,
    /// Side of a cell, m; null without cells.
    pub cell_m: Option<f64>,
    /// Segments drawn a second.
    pub draws_per_s: f64,
    /// Of drawing all in every frame, percent.
    pub saved_percent: f64,
    /// Objects that changed memories; null without the policy that has them.
    pub moved_objects: Option<u64>,
    /// How often cells were dealt anew; null without cells.
    pub redeals: Option<u64>,
    /// Faces that a triangle reaches, mean of the last pictures; null where nobody looked.
    pub faces_per_primitive: Option<f64>,
}

/// Widths of tears.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TearsReport {
    /// As they would be without warping.
    pub before: Option<Percentiles>,
    /// As drawn.
    pub after: Option<Percentiles>,
    /// By how much warping turns the most turned vertex of a frame.
    pub stretch: Option<Percentiles>,
}

/// A latency and its parts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Latency {
    /// Sum of all parts, ms.
    pub total: Option<f64>,
    /// Parts by name, ms; null what was not simulated.
    pub parts: BTreeMap<&'static str, Option<f64>>,
}

/// What somebody saw who looked at the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Looked {
    /// Footprints of the picture.
    pub stats: LookStats,
    /// What was drawn for it.
    pub drawing: Drawing,
}

impl Report {
    /// Of a walk, and of what was seen at its end where somebody looked.
    #[must_use]
    pub fn of(world: &World, settings: &Settings, tally: &WalkTally, looked: Option<&Looked>) -> Self {
        let timing = &settings.display.timing;
        let percentiles = |angles: &[f64]| Percentiles::of(angles, settings.texel_deg());
        Self {
            schema: SCHEMA,
            face_texels: timing.face_texels,
            latch: latch(&settings.display),
            pipeline_ns: timing.depth().0 as f64 / 1e3,
            matrix_loads: None,
            matrix_refused: None,
            footprints_split: looked.map(|looked| looked.stats.split),
            bank_conflicts: looked.map(|looked| looked.stats.conflicts),
            memories: memories(settings, tally),
            priority: priority(world, settings, tally, looked),
            tears_px: TearsReport {
                before: percentiles(&tally.tears.before),
                after: percentiles(&tally.tears.after),
                stretch: percentiles(&tally.tears.stretch),
            },
            rotation_latency_ms: rotation(&settings.display),
            translation_latency_ms: translation(tally.memories.first(), settings),
            sampling_error_px: None,
        }
    }
}

fn latch(display: &ArpConfig) -> &'static str {
    Latch::ALL.iter().find(|(_, latch)| *latch == display.latch).map_or("field", |(name, _)| name)
}

/// From the latch to the light: all stages, then the scan from the first pixel of what was latched together.
fn rotation(display: &ArpConfig) -> Latency {
    Latency::of(vec![("pipeline", Some(ms(display.timing.depth()))), ("scan", scan_ms(display, display.latch))])
}

/// From a place of the eye to the light: until the picture was drawn and shown, then until it is looked at, then the scan.
fn translation(memory: Option<&MemoryTally>, settings: &Settings) -> Latency {
    let memory = memory.filter(|memory| memory.shown_frames > 0);
    let mean_ms = |frames: fn(&MemoryTally) -> u64| {
        let mean = memory.map(|memory| frames(memory) as f64 / memory.shown_frames as f64);
        mean.map(|frames| frames * 1e3 / settings.numbers.frame_hz)
    };
    Latency::of(vec![
        ("draw", mean_ms(|memory| memory.drawing_frames)),
        ("wait", mean_ms(|memory| memory.age_frames - memory.drawing_frames)),
        ("scan", scan_ms(&settings.display, Latch::Field)),
    ])
}

fn ms(span: Span) -> f64 {
    span.0 as f64 / 1e9
}

/// Mean time from the first pixel of a field, a line or itself to a pixel's light, ms, over both fields; `None` of a scan that there
/// cannot be.
fn scan_ms(display: &ArpConfig, from: Latch) -> Option<f64> {
    let scan = display.scan().ok()?;
    let mut sum = 0.0;
    for y in 0..scan.height() {
        let field = PeriodNumber(u64::from(y % 2));
        // All pixels of a line are equally far apart.
        for x in [0, scan.width() - 1] {
            let latched = scan.latches(from, x, y, field)?;
            sum += ms(scan.lights(x, y, field)?.since(latched)) - ms(display.timing.depth());
        }
    }
    Some(sum / 2.0 / f64::from(scan.height()))
}

impl Latency {
    /// The sum of parts; none as long as a part is.
    fn of(parts: Vec<(&'static str, Option<f64>)>) -> Self {
        Self { total: parts.iter().map(|(_, part)| *part).sum(), parts: parts.into_iter().collect() }
    }
}

fn memories(settings: &Settings, tally: &WalkTally) -> Vec<MemoryReport> {
    let timing = &settings.display.timing;
    let bytes = 2 * 6 * timing.face_texels.pow(2) * (timing.colour_bits + timing.depth_bits) / 8;
    tally.memories.iter().map(|memory| MemoryReport::of(memory, tally.frames as f64, settings, bytes)).collect()
}

impl MemoryReport {
    fn of(memory: &MemoryTally, frames: f64, settings: &Settings, bytes: u64) -> Self {
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

fn priority(world: &World, settings: &Settings, tally: &WalkTally, looked: Option<&Looked>) -> PriorityReport {
    let hz = settings.numbers.frame_hz;
    let is_cells = settings.policy == PolicyKind::Cells;
    let draws_per_s = tally.draws_per_s(hz);
    PriorityReport {
        policy: settings.policy.name(),
        theta_deg: (settings.policy != PolicyKind::Full).then_some(settings.numbers.theta_deg),
        cell_m: is_cells.then_some(settings.numbers.cell_m),
        draws_per_s,
        saved_percent: priority_rendering::saved_percent(draws_per_s, world.segments.len() as f64 * hz),
        moved_objects: tally.moved_objects,
        redeals: is_cells.then_some(tally.redeals),
        faces_per_primitive: looked
            .map(|looked| looked.drawing.on_faces as f64 / looked.drawing.triangles.max(1) as f64),
    }
}
