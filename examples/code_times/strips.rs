//! Measures the processor times of just-in-time pixels and frameless rendering by executing their code.

use super::{CodeUse, ExperimentError, Rig, fault, mean};
use pphigs::{
    MemoryPart, Picture, PrimitiveCounts, RegionBinning, Shading, StripInterpolation, TriangleEndsRecorder,
    WindowSearchWork, assemble_order,
};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{CodeVersion, GpTiming, ProcessorFault};
use pxpl5_renderer::Layout;
use pxpl5_run::ViewSource;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{FieldParity, RegionGrid, RegionId, ViewNumber};

const SCENE: &str = "mig";
/// Number of boards that share the scene in the second measurement. In the first measurement, one board has the whole
/// scene. The difference of the two results, divided by the difference of the numbers of triangles, is the time of one
/// triangle.
const SMALLER: usize = 12;

const FIELD_PS: u64 = 16_683_333_333;

/// Memory address at which the display list begins. Smaller addresses belong to the program. An order message consists
/// of pieces of memory. A piece at this address or above holds the commands of a bin entry.
const COMMANDS: u32 = 1 << 20;

/// Sizes in words of four kinds of orders: a strip, a strip with a head pose, blocks of pixels with a head pose, and a
/// field with two head poses. The second number of each pair counts the words before the head poses.
const ORDERS: [(usize, usize); 4] = [(6, 6), (59, 6), (58, 5), (110, 4)];

/// Times in nanoseconds of the search for triangles in strips, and of the interpolation between two head poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StripTimes {
    /// Time to compare one triangle's bounding box with a strip that the box does not touch.
    pub(crate) box_ns: f64,
    /// Additional time of a bin entry for a triangle that touches one of the five windows (128 pixels wide) of a strip.
    /// The time includes the search and the transfer of the entry, and the comparison with nearby triangles that miss
    /// the strip.
    pub(crate) entry_ns: f64,
    /// Time to create and send the five windows (128 pixels wide) of a strip without triangles.
    pub(crate) windows_ns: f64,
    /// Time to compute a triangle's positions on the screen for two successive head poses.
    pub(crate) ends_ns: f64,
    /// Time to skip one triangle that is not near a strip, during interpolation between two head poses.
    pub(crate) passed_ns: f64,
    /// Additional time to interpolate one triangle that is near a strip: on the screen, and in eye space.
    pub(crate) interpolated_ns: [f64; 2],
    /// Times to assemble four kinds of orders: a strip, a strip with a head pose, blocks of pixels, and a field that is
    /// interpolated between two head poses.
    pub(crate) order_ns: [f64; 4],
}

/// Measures the times of one version of the i860 code.
///
/// # Errors
///
/// Returns [`ExperimentError::Scene`] when the code does not terminate.
pub(crate) fn strip_times(version: CodeVersion) -> Result<StripTimes, ExperimentError> {
    let [whole, smaller] = [measured(version, 1)?, measured(version, SMALLER)?];
    let more = whole.triangles - smaller.triangles;
    // The difference between the whole scene and a smaller share gives the time of one triangle.
    let each = |of: fn(&Measured) -> f64| (of(&whole) - of(&smaller)) / more;
    let box_ns = each(|measured| measured.search_ns);
    let passed_ns = each(|measured| measured.passed_ns);
    let interpolated_ns = whole.interpolated_ns.map(|ns| (ns - whole.passed_ns) / whole.triangles);
    Ok(StripTimes {
        box_ns,
        entry_ns: whole.entry_ns,
        windows_ns: smaller.search_ns - box_ns * smaller.triangles,
        ends_ns: each(|measured| measured.ends_ns),
        passed_ns,
        interpolated_ns,
        order_ns: order_ns(version)?,
    })
}

struct Measured {
    triangles: f64,
    /// Mean time to test all triangles against a strip that no triangle touches.
    search_ns: f64,
    /// Additional time of each bin entry, measured in strips that triangles touch.
    entry_ns: f64,
    ends_ns: f64,
    /// Time to compute the commands for an instant between two head poses if no triangle is near the strip.
    passed_ns: f64,
    /// Times to compute the commands for an instant between two head poses if all triangles are near the strip: on the
    /// screen, and in eye space.
    interpolated_ns: [f64; 2],
}

fn measured(version: CodeVersion, boards: usize) -> Result<Measured, ExperimentError> {
    let mut rig = Rig::of_triangles((version, CodeUse::Pphigs), SCENE, boards)?;
    let triangles = f64::from(rig.share.counts().triangles);
    // Strips without entries give the cost of a search. All other strips give the cost of entries.
    let rows = searches(&mut rig).map_err(fault)?;
    let search_ns = mean(rows.iter().filter(|[entries, _]| *entries == 0.0).map(|[_, ns]| *ns));
    let [entries, more_ns] = rows.iter().fold([0.0; 2], |sum, [n, ns]| [sum[0] + n, sum[1] + ns - search_ns]);
    let entry_ns = more_ns / entries;
    let ends_ns = ends_ns(&mut rig).map_err(fault)?;
    // The widest range of lines includes every triangle, the reversed range none.
    let all = [i32::MIN, i32::MAX];
    let passed_ns = between_ns(&mut rig, false, [i32::MAX, i32::MIN]).map_err(fault)?;
    let [on_screen, in_eye_space] =
        [false, true].map(|in_eye_space| between_ns(&mut rig, in_eye_space, all).map_err(fault));
    Ok(Measured { triangles, search_ns, entry_ns, ends_ns, passed_ns, interpolated_ns: [on_screen?, in_eye_space?] })
}

const VIEWPORT: Viewport = Viewport::field(FieldParity::Even);
const PICTURE: Picture = Picture {
    viewport: VIEWPORT,
    shading: Shading::Gouraud,
    binning: RegionBinning::All,
    layout: Layout::slats(),
    pixels: false,
};
const GRID: RegionGrid = RegionGrid { region_height: 1, ..RegionGrid::FIELD };

fn ns(span: Span) -> f64 {
    span.0 as f64 / 1e3
}

/// Returns the number of bin entries and the search time in nanoseconds for each strip. Here, every strip is one line.
fn searches(rig: &mut Rig) -> Result<Vec<[f64; 2]>, ProcessorFault> {
    let pass = rig.share.transform(&rig.view(0), 0, PICTURE);
    pass.keep(&GpTiming::PAPERS, &mut rig.processor, MemoryPart::WHOLE)?;
    // Each window has room for all triangles.
    let counts = [PrimitiveCounts { triangles: rig.share.counts().triangles, spheres: 0 }; 5];
    let columns = GRID.columns() as u16;
    let mut rows = Vec::new();
    // Each strip is one line, divided into five windows.
    for strip in 0..GRID.rows() as u16 {
        let windows: Vec<_> = (strip * columns..(strip + 1) * columns).map(RegionId).collect();
        let part = MemoryPart::WHOLE;
        let searching = WindowSearchWork { part, viewport: VIEWPORT, grid: GRID, windows: &windows, counts: &counts };
        let Some(output) = searching.run_code(&mut rig.processor)? else { continue };
        let listed = output.listed(&rig.processor)?;
        let entries = listed.iter().flatten().filter(|[address, _]| *address >= COMMANDS).count();
        rows.push([entries as f64, ns(output.span)]);
    }
    Ok(rows)
}

const PARTS: [MemoryPart; 2] = [MemoryPart::of(0, 2), MemoryPart::of(1, 2)];

fn ends_ns(rig: &mut Rig) -> Result<f64, ProcessorFault> {
    let [from, to] = views(rig);
    let keeping = TriangleEndsRecorder { share: &rig.share, views: [&from, &to], picture: PICTURE, part: PARTS[0] };
    Ok(keeping.run_code(&GpTiming::PAPERS, &mut rig.processor)?.map_or(0.0, ns))
}

/// Returns the nanoseconds to compute the commands of triangles half way between two head poses. Triangles on the lines
/// `near` are interpolated, and all others are skipped.
fn between_ns(rig: &mut Rig, in_eye_space: bool, near: [i32; 2]) -> Result<f64, ProcessorFault> {
    let [from, to] = views(rig);
    let interpolating = StripInterpolation {
        share: &rig.share,
        views: [&from, &to],
        between: &from,
        part_of_way: 0.5,
        in_eye_space,
        near,
        picture: PICTURE,
        ends: PARTS[0],
        commands: PARTS[1],
    };
    Ok(interpolating.run_code(&GpTiming::PAPERS, &mut rig.processor)?.map_or(0.0, ns))
}

fn views(rig: &Rig) -> [pphigs::FrameView; 2] {
    [0, 1].map(|number| rig.views.newest(ViewNumber(number), Time(number * FIELD_PS)))
}

/// Returns the nanoseconds to assemble each kind of order. A first execution loads the code into the caches.
fn order_ns(version: CodeVersion) -> Result<[f64; 4], ExperimentError> {
    let mut rig = Rig::of_triangles((version, CodeUse::Pphigs), SCENE, SMALLER)?;
    let mut times = [0.0; 4];
    for (time, (words, head)) in times.iter_mut().zip(ORDERS) {
        for _ in 0..2 {
            *time = ns(assemble_order(&mut rig.processor, &vec![0; words], head).map_err(fault)?);
        }
    }
    Ok(times)
}
