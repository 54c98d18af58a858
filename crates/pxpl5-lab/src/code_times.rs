//! Times of primitives that follow from i860 code, for the timing table: what a pass over the application scenes takes on a board.
//!
//! ```text
//!   clocks of a pass = triangle * (inside the guard band) + guard * (left to the clipper) + entry * (entries of bins)
//! ```
//!
//! `guard` comes from triangles that cover the screen and reach beyond the guard band, the others from the three application scenes: a share
//! of each, seen along its own head motion; the first pass only fills the caches. `entry` is the slope over all passes by least squares,
//! `triangle` the mean of the scenes' means.

use pphigs::{DisplayList, Pass, Picture, RegionBinning, Shading, Share};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{CodeVersion, Processor, ProcessorFault};
use pxpl5_machine::MachineConfig;
use pxpl5_renderer::Layout;
use pxpl5_run::{ExperimentError, display_list, views};
use pxpl5_scene::{Hmd, HmdConfig, builtin};
use pxpl5_sim::Time;
use pxpl5_wire::{FieldParity, NodeId, ViewNumber};
use std::sync::Arc;

/// The application scenes of TR94.
const SCENES: [&str; 3] = ["mig", "molecules", "head"];

/// Of so many boards, the share of the first (the slaves of the small machine).
const BOARDS: usize = 12;

/// Views of each scene, and time between them.
const VIEWS: u64 = 4;
const VIEW_PERIOD_PS: u64 = 500_000_000_000;

/// Triangles that Slats transforms at a time (published TR94), and how many such clumps of a scene are measured.
const CLUMP: usize = 30;
const CLUMPS: usize = 20;

/// A board's memory (published TR94).
const MEMORY: u64 = 8 << 20;

/// What code does: PPHIGS draws frames in Phong shading, with bins; Slats fields in Gouraud shading, in clumps for all regions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeUse {
    /// Frames, Phong shading, bins.
    Pphigs,
    /// Fields, Gouraud shading, clumps of thirty.
    Slats,
}

/// Times of primitives in nanoseconds, as the code gives them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CodeTimes {
    /// A triangle wholly inside the guard band: mean of the scenes' means.
    pub triangle_ns: f64,
    /// The least and the greatest scene's mean.
    pub triangle_range_ns: [f64; 2],
    /// An entry in a bin.
    pub entry_ns: f64,
    /// A triangle that is left to the clipper.
    pub guard_ns: f64,
}

/// One pass: triangles inside the guard band, triangles left to the clipper, entries, nanoseconds.
type Sample = [f64; 4];

impl CodeUse {
    fn picture(self) -> Picture {
        let (viewport, shading, binning) = match self {
            Self::Pphigs => (Viewport::FRAME, Shading::Phong, RegionBinning::Touched),
            Self::Slats => (Viewport::field(FieldParity::Even), Shading::Gouraud, RegionBinning::All),
        };
        Picture { viewport, shading, binning, layout: Layout::rendering_control_phong(), pixels: false }
    }

    fn parts(self, share: &Share) -> Vec<Share> {
        match self {
            Self::Pphigs => vec![share.clone()],
            Self::Slats => share.clumps(CLUMP).take(CLUMPS).collect(),
        }
    }
}

/// Measures the times of code in one use.
///
/// # Errors
///
/// [`ExperimentError::Scene`] when a scene is not found or the code does not come to its end.
pub fn code_times(version: CodeVersion, of: CodeUse) -> Result<CodeTimes, ExperimentError> {
    let outside = samples(version, of, "full-screen:30", 1)?;
    let guard_ns = guard(&outside);
    let scenes: Vec<Vec<Sample>> =
        SCENES.iter().map(|scene| samples(version, of, scene, BOARDS)).collect::<Result<_, _>>()?;
    let without_guard = |[inside, outside, entries, ns]: Sample| [inside, entries, ns - guard_ns * outside];
    let all: Vec<[f64; 3]> = scenes.iter().flatten().copied().map(without_guard).collect();
    let entry_ns = if of == CodeUse::Pphigs { slope_of_entries(&all) } else { 0.0 };
    let means = scenes.iter().map(|samples| {
        let rows = samples.iter().copied().map(without_guard);
        let [triangles, ns] =
            rows.fold([0.0; 2], |sum, [inside, entries, ns]| [sum[0] + inside, sum[1] + ns - entry_ns * entries]);
        ns / triangles
    });
    let means: Vec<f64> = means.collect();
    let range = [means.iter().copied().fold(f64::INFINITY, f64::min), means.iter().copied().fold(0.0, f64::max)];
    Ok(CodeTimes {
        triangle_ns: means.iter().sum::<f64>() / means.len() as f64,
        triangle_range_ns: range,
        entry_ns,
        guard_ns,
    })
}

/// Least squares of ns = a inside + b outside over the screen-filling triangles; b.
fn guard(samples: &[Sample]) -> f64 {
    solve(samples.iter().map(|[inside, outside, _, ns]| ([*outside, *inside], *ns)))
}

/// Least squares of ns = a inside + b entries; b.
fn slope_of_entries(rows: &[[f64; 3]]) -> f64 {
    solve(rows.iter().map(|[inside, entries, ns]| ([*entries, *inside], *ns)))
}

/// The factor of the first of two unknowns by least squares; where the second never occurs, of the first alone.
fn solve(rows: impl Iterator<Item = ([f64; 2], f64)>) -> f64 {
    let mut sums = [0.0; 5];
    for ([a, b], y) in rows {
        for (sum, value) in sums.iter_mut().zip([a * a, a * b, b * b, a * y, b * y]) {
            *sum += value;
        }
    }
    let [aa, ab, bb, ay, by] = sums;
    if bb == 0.0 { ay / aa } else { (ay * bb - by * ab) / (aa * bb - ab * ab) }
}

fn samples(version: CodeVersion, of: CodeUse, scene: &str, boards: usize) -> Result<Vec<Sample>, ExperimentError> {
    let scene = Arc::new(builtin(scene).map_err(|error| ExperimentError::Scene(error.to_string()))?);
    let list: Arc<DisplayList> = Arc::new(display_list(&scene).map_err(ExperimentError::Scene)?);
    let hmd = Hmd::new(HmdConfig::unc()).map_err(|error| ExperimentError::Scene(error.to_string()))?;
    let (views, _) = views(&scene, 1, hmd, 2);
    let share = Share::new(list, 0, boards);
    let fault = |error: ProcessorFault| ExperimentError::Scene(error.to_string());
    let mut processor = Processor::new(NodeId(1), MEMORY, version, MachineConfig::small_hmd().i860);
    share.install(&mut processor).map_err(fault)?;
    let mut samples = Vec::new();
    let parts = of.parts(&share);
    for number in 0..VIEWS {
        let view = views(ViewNumber(number), Time(number * VIEW_PERIOD_PS));
        for (part, eye) in parts.iter().flat_map(|part| [(part, 0), (part, 1)]) {
            let pass = part.transform(&view, eye, of.picture());
            samples.extend(sample(&pass, &mut processor, eye as u8).map_err(fault)?);
        }
    }
    samples.remove(0);
    Ok(samples)
}

fn sample(pass: &Pass, processor: &mut Processor, context: u8) -> Result<Option<Sample>, ProcessorFault> {
    let Some(made) = pass.run_code(processor, context)? else { return Ok(None) };
    let outside = pass.unguarded();
    let inside = u64::from(pass.transformed().triangles) - outside;
    Ok(Some([inside as f64, outside as f64, made.entries() as f64, made.span.0 as f64 / 1e3]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_unknowns_are_found_from_exact_rows() {
        let rows = [[1.0, 2.0], [3.0, 1.0], [2.0, 5.0]];
        let found = solve(rows.into_iter().map(|[a, b]| ([a, b], 7.0 * a + 11.0 * b)));
        assert!((found - 7.0).abs() < 1e-9, "{found}");
        assert_eq!(solve(rows.into_iter().map(|[a, _]| ([a, 0.0], 7.0 * a))), 7.0);
    }
}
