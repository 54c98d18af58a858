//! Measures the times of primitives by executing i860 code.
//!
//! These times fill the timing table that the analytic level and the transaction level use.
//!
//! The measurement transforms the application scenes of TR94 on one board (one transformation is a *pass*), and divides
//! the board's clocks among primitives:
//!
//! ```text
//!   clocks of triangles in a pass = triangle * (triangles) + guard * (clipped triangles) + entry * (bin entries)
//!   clocks of spheres             = sphere * (spheres) + entry * (bin entries)
//! ```
//!
//! - `guard` comes from triangles that cover the screen and reach beyond the guard band (`CLIPPED_M`).
//! - `triangle`, `entry` and `sphere` come from one board's share of each of the three application scenes, seen along
//!   the scene's own head motion. The first pass only fills the caches.
//! - `entry` is the slope of the clocks over the number of bin entries, fitted to all passes by least squares.
//! - `triangle` is first averaged over the passes of each scene, then over the scenes. The spheres of the scene are
//!   left out, because their code would displace the triangle code from the instruction cache.
//! - `sphere` is the time of spheres without their bin entries: the mean over the scenes with spheres.
//!
//! Each of `guard`, `entry` and `triangle` depends on the other two, so the measurement computes one time after the
//! other. Repetitions make the three times converge.
//!
//! ```text
//!   beginning of a pass = pass + structure * (structures * eyes) + sphere view * (structures with spheres * eyes)
//! ```
//!
//! - `structure` is the cost of one more empty structure in the display list.
//! - `sphere view` is the extra cost of a scene compared with the same scene without spheres.
//! - `pass` is the remainder: the time to reset the bins and to load code into the caches.
//!
//! Each of `structure`, `sphere view` and `pass` is averaged over each scene, then over the scenes.
//!
//! The time of a message is the mean over all messages that the board receives and sends around these passes. Under
//! PPHIGS (the graphics library that runs Rendering Control), the board is a slave. Each message then includes the cost
//! of the token whose bin the slave sends. Under Slats, the measurement covers the messages of one display field. The
//! time of a message is averaged over the three scenes. `token entry` is the additional time to send a bin for each
//! entry in the bin. This time is the slope of a least-squares fit over all bins.

mod messages;
mod strips;

pub(crate) use strips::strip_times;

use glam::Mat4;
use pphigs::{
    DisplayList, DisplayStructure, EditWork, FrameView, KernelOutput, ModelEdit, Pass, Picture, RegionBinning, Shading,
    Share, TransformCost,
};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{CodeUse, CodeVersion, GpTiming, Processor, ProcessorFault, Work};
use pxpl5_machine::MachineConfig;
use pxpl5_renderer::Layout;
use pxpl5_run::{ExperimentError, SceneViews, ViewSource, display_list};
use pxpl5_scene::{Hmd, builtin};
use pxpl5_sim::Time;
use pxpl5_wire::{FieldParity, NodeId, RegionId, ViewNumber};
use std::sync::Arc;

const SCENES: [&str; 3] = ["mig", "molecules", "head"];

/// Number of slaves among which a scene's triangles are divided, as in the preset `small-hmd`. Only the first slave's
/// share is measured.
const BOARDS: usize = 12;

const VIEWS: u64 = 4;
const VIEW_PERIOD_PS: u64 = 500_000_000_000;

/// Size in metres of the triangles that measure the clipper. At a distance of 1 m, each triangle covers a square with
/// sides of twice this length. The corners of the triangle lie up to 4,477 pixels outside the picture's corners.
/// Assumed: any size beyond the guard band has the same effect.
const CLIPPED_M: f32 = 2.0;

/// Number of triangles in a clump, which Slats transforms at a time (published in TR94).
const CLUMP: usize = 30;
const CLUMPS: usize = 20;

/// Number of additional edits (matrix replacements) in a message, from which the time of one edit follows. The replaced
/// matrices are adjacent in memory.
const EDITS: u32 = 16;

/// Number of additional empty structures in a display list, from which the time of one structure follows.
const MORE_STRUCTURES: usize = 8;

/// Memory of a graphics processor in bytes (published in TR94).
const MEMORY: u64 = 8 << 20;

/// Times of primitives in nanoseconds, measured by executing i860 code.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CodeTimes {
    /// Time to transform an unclipped triangle, averaged over each scene and then over the scenes.
    pub(crate) triangle_ns: f64,
    /// Smallest and largest mean time per triangle among the scenes.
    pub(crate) triangle_range_ns: [f64; 2],
    /// Time to transform a sphere, averaged over each scene and then over the scenes.
    pub(crate) sphere_ns: f64,
    /// Time to write one entry into a bin.
    pub(crate) entry_ns: f64,
    /// Additional time of a clipped triangle: the time to cut it and to process all resulting triangles except one.
    pub(crate) guard_ns: f64,
    /// Time to begin a pass over the display list, without its structures, averaged over each scene and then over the
    /// scenes.
    pub(crate) pass_ns: f64,
    /// Time to transform one more structure for one eye, averaged over each scene and then over the scenes.
    pub(crate) structure_ns: f64,
    /// Additional time per eye for a structure that contains spheres: the mean over the scenes with spheres.
    pub(crate) sphere_view_ns: f64,
    /// Time of one more edit (matrix replacement) in a message.
    pub(crate) edit_ns: f64,
    /// Time to send one bin entry, for a slave that has the token.
    pub(crate) token_entry_ns: f64,
    /// Time to process a message, or a chain of messages, averaged over each scene and then over the scenes.
    pub(crate) message_ns: f64,
    /// Smallest and largest mean time per message among the scenes.
    pub(crate) message_range_ns: [f64; 2],
}

/// Number of iterations of [`CodeTimes::improve`]. Each iteration leaves only a small fraction of the previous error.
const ROUNDS: usize = 30;

/// Numbers of unclipped triangles, clipped triangles and bin entries of one pass, and its time in nanoseconds.
type Sample = [f64; 4];

type SphereSample = [f64; 3];

fn picture(of: CodeUse) -> Picture {
    let (viewport, shading, binning) = match of {
        CodeUse::Pphigs => (Viewport::FRAME, Shading::Phong, RegionBinning::Touched),
        CodeUse::Slats => (Viewport::field(FieldParity::Even), Shading::Precomputed, RegionBinning::All),
        CodeUse::SlatsTouched => (Viewport::field(FieldParity::Even), Shading::Precomputed, RegionBinning::Touched),
        CodeUse::SlatsLit => (Viewport::field(FieldParity::Even), Shading::Gouraud, RegionBinning::All),
    };
    Picture { viewport, shading, binning, layout: Layout::rendering_control_phong(), pixels: false }
}

/// Returns a list of eyes (0 or 1) for each pass. A pass of PPHIGS transforms the display list for one eye, a pass of
/// Slats for both eyes.
const fn eyes_of_a_pass(of: CodeUse) -> &'static [&'static [usize]] {
    match of {
        CodeUse::Pphigs => &[&[0], &[1]],
        CodeUse::Slats | CodeUse::SlatsTouched | CodeUse::SlatsLit => &[&[0, 1]],
    }
}

fn parts(of: CodeUse, share: &Share) -> Vec<Share> {
    match of {
        CodeUse::Pphigs => vec![share.clone()],
        _ => share.clumps(CLUMP).take(CLUMPS).collect(),
    }
}

/// Measures the times of one version of the i860 code. `of` selects Slats or PPHIGS, the graphics library that runs
/// Rendering Control.
///
/// # Errors
///
/// Returns [`ExperimentError::Scene`] when a scene is not found or the code does not terminate.
pub(crate) fn code_times(version: CodeVersion, of: CodeUse) -> Result<CodeTimes, ExperimentError> {
    // The clipper is measured one eye after the other. A pass for both eyes always clips the same fractions, which
    // leaves the equations underdetermined, unless it clips all triangles.
    let cut = Rig::of_list((version, of), "full-screen:30", 1, beyond_the_guard_band)?;
    let together = cut.share.list().is_single;
    let cut = measured(of, cut, together, sample)?;
    // Triangles, spheres and the beginning of a pass are measured in separate runs.
    let scenes: Vec<Vec<Sample>> =
        SCENES.iter().map(|scene| samples(version, of, scene, BOARDS)).collect::<Result<_, _>>()?;
    let of_spheres: Vec<Vec<SphereSample>> =
        SCENES.iter().map(|scene| sphere_samples(version, of, scene)).collect::<Result<_, _>>()?;
    let begun: Vec<PassBeginning> = SCENES.iter().map(|scene| begun(version, of, scene)).collect::<Result<_, _>>()?;
    let edit_ns = edit_ns(version)?;
    let traffic: Vec<_> = SCENES.iter().map(|scene| messages::traffic(version, of, scene)).collect::<Result<_, _>>()?;
    let token_entry_ns = messages::token_entry_ns(&traffic);
    let messages: Vec<f64> = traffic.iter().map(|traffic| traffic.message_ns(token_entry_ns)).collect();
    let range = [0.0; 2];
    // Times that depend on other times start at zero.
    let mut times = CodeTimes {
        triangle_ns: 0.0,
        triangle_range_ns: range,
        sphere_ns: 0.0,
        entry_ns: 0.0,
        guard_ns: 0.0,
        pass_ns: mean(begun.iter().map(|begun| begun.pass_ns)),
        structure_ns: mean(begun.iter().map(|begun| begun.structure_ns)),
        sphere_view_ns: mean(begun.iter().filter_map(|begun| begun.sphere_view_ns)),
        edit_ns,
        token_entry_ns,
        message_ns: mean(messages.iter().copied()),
        message_range_ns: extremes(&messages),
    };
    // Triangle, entry and clipper times depend on each other, so they are computed in turn.
    for _ in 0..ROUNDS {
        times.improve(of, &cut, &scenes);
    }
    times.sphere_ns = times.sphere(&of_spheres);
    Ok(times)
}

impl CodeTimes {
    /// Improves the times of a bin entry, a triangle and the clipper by one iteration. Each time is fitted to measured
    /// passes after the estimated contributions of the other two times are subtracted.
    fn improve(&mut self, of: CodeUse, cut: &[Sample], scenes: &[Vec<Sample>]) {
        // Clipped triangles are counted separately, so their time is subtracted here.
        let of_clipper = self.triangle_ns + self.guard_ns;
        let uncut = |sample: &Sample| [sample[0], sample[2], sample[3] - of_clipper * sample[1]];
        // Only programs with bins by region have times of entries.
        if picture(of).binning == RegionBinning::Touched {
            self.entry_ns = solve(scenes.iter().flatten().map(uncut).map(|[uncut, n, ns]| ([n, uncut], ns)));
        }
        let entry_ns = self.entry_ns;
        // The mean of a scene weighs all of its triangles equally.
        let of_scene = |samples: &Vec<Sample>| {
            let rows = samples.iter().map(uncut);
            let [n, ns] = rows.fold([0.0; 2], |sum, [uncut, n, ns]| [sum[0] + uncut, sum[1] + ns - entry_ns * n]);
            ns / n
        };
        let means: Vec<f64> = scenes.iter().map(of_scene).collect();
        self.triangle_ns = mean(means.iter().copied());
        self.triangle_range_ns = extremes(&means);
        // The clipper's time is the rest of the run with clipped triangles.
        let without_entries = |[uncut, cut, n, ns]: &Sample| ([*cut, *uncut], ns - entry_ns * n);
        self.guard_ns = solve(cut.iter().map(without_entries)) - self.triangle_ns;
    }

    fn sphere(&self, scenes: &[Vec<SphereSample>]) -> f64 {
        let sums = scenes.iter().map(|samples| {
            samples.iter().fold([0.0; 2], |[n, ns], [spheres, entries, of_spheres]| {
                [n + spheres, ns + of_spheres - self.entry_ns * entries]
            })
        });
        mean(sums.filter(|[n, _]| *n > 0.0).map(|[n, ns]| ns / n))
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let [n, sum] = values.fold([0.0; 2], |[n, sum], value| [n + 1.0, sum + value]);
    sum / f64::max(n, 1.0)
}

fn extremes(values: &[f64]) -> [f64; 2] {
    [values.iter().copied().fold(f64::INFINITY, f64::min), values.iter().copied().fold(0.0, f64::max)]
}

/// Fits `y = a p + b q` to rows of `([a, b], y)` by least squares, and returns `p`. If all `b` are 0, only `p` is
/// fitted.
fn solve(rows: impl Iterator<Item = ([f64; 2], f64)>) -> f64 {
    let mut sums = [0.0; 5];
    for ([a, b], y) in rows {
        for (sum, value) in sums.iter_mut().zip([a * a, a * b, b * b, a * y, b * y]) {
            *sum += value;
        }
    }
    // Solve the normal equations of two unknowns.
    let [aa, ab, bb, ay, by] = sums;
    if bb == 0.0 { ay / aa } else { (ay * bb - by * ab) / (aa * bb - ab * ab) }
}

/// One board's share of a scene, with the head poses for which the board transforms the share.
struct Rig {
    share: Share,
    views: SceneViews,
    processor: Processor,
}

fn fault(error: ProcessorFault) -> ExperimentError {
    ExperimentError::Scene(error.to_string())
}

impl Rig {
    fn new(code: (CodeVersion, CodeUse), scene: &str, boards: usize) -> Result<Self, ExperimentError> {
        Self::of_list(code, scene, boards, |list| list)
    }

    fn of_triangles(code: (CodeVersion, CodeUse), scene: &str, boards: usize) -> Result<Self, ExperimentError> {
        Self::of_list(code, scene, boards, without_spheres)
    }

    fn of_list(
        (version, of): (CodeVersion, CodeUse),
        scene: &str,
        boards: usize,
        part: impl Fn(DisplayList) -> DisplayList,
    ) -> Result<Self, ExperimentError> {
        let scene = Arc::new(builtin(scene)?);
        let is_single = (version, of) == (CodeVersion::Compiled, CodeUse::Slats);
        let list = Arc::new(part(DisplayList { is_single, ..display_list(&scene)? }));
        let views = SceneViews::new(&scene, 1, Hmd::unc(), 2);
        let share = Share::new(list, 0, boards);
        // The board holds its share of the display list in memory, as in a run.
        let mut processor = Processor::new(NodeId(1), MEMORY, version, MachineConfig::small_hmd().i860);
        share.install(&mut processor).map_err(fault)?;
        Ok(Self { share, views, processor })
    }

    fn view(&self, number: u64) -> FrameView {
        self.views.newest(ViewNumber(number), Time(number * VIEW_PERIOD_PS))
    }
}

fn samples(version: CodeVersion, of: CodeUse, scene: &str, boards: usize) -> Result<Vec<Sample>, ExperimentError> {
    measured(of, Rig::of_triangles((version, of), scene, boards)?, true, sample)
}

/// Returns one sample for each pass over a scene's spheres. The result is empty if the scene has no spheres.
fn sphere_samples(version: CodeVersion, of: CodeUse, scene: &str) -> Result<Vec<SphereSample>, ExperimentError> {
    let rig = Rig::new((version, of), scene, BOARDS)?;
    if rig.share.counts().spheres == 0 { Ok(Vec::new()) } else { measured(of, rig, true, sphere_sample) }
}

/// Returns the samples of all passes except the first, which only fills the caches. If `together` is true, one sample
/// combines the passes of both eyes.
fn measured<const N: usize>(
    of: CodeUse,
    mut rig: Rig,
    together: bool,
    sample: impl Fn(&Pass, &KernelOutput) -> [f64; N],
) -> Result<Vec<[f64; N]>, ExperimentError> {
    let mut samples = Vec::new();
    let parts = parts(of, &rig.share);
    // Each view moves the head, so that other triangles are visible.
    for number in 0..VIEWS {
        let view = rig.view(number);
        for part in &parts {
            let passes = [0, 1].map(|eye| part.transform(&view, eye, picture(of)));
            let [left, right] = &passes;
            // Slats transforms both eyes in one pass, whose parts are one sample.
            if together && let Some(made) = left.run_code_for_both(right, &mut rig.processor, 0).map_err(fault)? {
                let [left, right] = [sample(left, &made[0]), sample(right, &made[1])];
                samples.push(std::array::from_fn(|n| left[n] + right[n]));
                continue;
            }
            for (pass, context) in passes.iter().zip([0, 1]) {
                let made = pass.run_code(&mut rig.processor, context).map_err(fault)?;
                samples.extend(made.map(|made| sample(pass, &made)));
            }
        }
    }
    // The first pass fills the caches.
    samples.remove(0);
    Ok(samples)
}

/// Replaces each triangle by a larger right-angled triangle that reaches beyond the guard band. At the distance d from
/// the viewer, both legs have a length of 4 ([`CLIPPED_M`] d + 0.5 m). The 0.5 m allow for the positions of the eyes.
///
/// The program of Slats clips a triangle only at the near plane, so the last corner then lies behind the viewer.
fn beyond_the_guard_band(mut list: DisplayList) -> DisplayList {
    let is_single = list.is_single;
    for triangle in list.positions.chunks_exact_mut(3) {
        for (corner, [x, y]) in triangle.iter_mut().zip([[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]]) {
            let half = CLIPPED_M * -corner.z + 0.5;
            (corner.x, corner.y) = (x * half, y * half);
        }
        triangle[2].z *= if is_single { -1.0 } else { 1.0 };
    }
    list
}

fn without_spheres(mut list: DisplayList) -> DisplayList {
    list.spheres.clear();
    list.structures.iter_mut().for_each(|structure| structure.spheres = 0..0);
    list
}

/// Returns the display list without its spheres, and with [`MORE_STRUCTURES`] empty structures at its end.
fn with_more_structures(list: DisplayList) -> DisplayList {
    let mut list = without_spheres(list);
    let end = list.triangles.len();
    let more = list.structures.last().cloned();
    let more = more.map(|last| DisplayStructure { triangles: end..end, spheres: 0..0, ..last });
    list.structures.extend(std::iter::repeat_n(more, MORE_STRUCTURES).flatten());
    list
}

struct PassBeginning {
    pass_ns: f64,
    structure_ns: f64,
    /// Additional time per eye for a structure that contains spheres. `None` for scenes without spheres.
    sphere_view_ns: Option<f64>,
}

fn begun(version: CodeVersion, of: CodeUse, scene: &str) -> Result<PassBeginning, ExperimentError> {
    // Measure the scene three times: whole, without spheres, and with more empty structures. The differences give the
    // cost of each part.
    let rig = |part: fn(DisplayList) -> DisplayList| Rig::of_list((version, of), scene, BOARDS, part);
    let whole = rig(|list| list)?;
    let TransformCost { structures, sphere_views, .. } = TransformCost::beginning(&whole.share.list().structures);
    let whole_ns = beginning_ns(of, whole)?;
    let plain_ns = beginning_ns(of, rig(without_spheres)?)?;
    let more_ns = beginning_ns(of, rig(with_more_structures)?)?;
    let eyes = eyes_of_a_pass(of)[0].len() as f64;
    let structure_ns = (more_ns - plain_ns) / (MORE_STRUCTURES as f64 * eyes);
    Ok(PassBeginning {
        pass_ns: plain_ns - structure_ns * structures as f64 * eyes,
        structure_ns,
        sphere_view_ns: (sphere_views > 0).then(|| (whole_ns - plain_ns) / (sphere_views as f64 * eyes)),
    })
}

/// Returns the mean time to begin a pass in nanoseconds. `of` determines if a pass transforms the scene for one eye or
/// for both eyes.
fn beginning_ns(of: CodeUse, mut rig: Rig) -> Result<f64, ExperimentError> {
    let eyes = eyes_of_a_pass(of);
    let mut all_ns = 0.0;
    for number in 0..VIEWS {
        let view = rig.view(number);
        for eyes in eyes {
            let beginning = rig.share.beginning(&view, eyes, picture(of));
            // The triangles of the previous pass fill the caches, as in a real frame.
            let passes: Vec<_> = eyes.iter().map(|eye| rig.share.transform(&view, *eye, picture(of))).collect();
            match &passes[..] {
                [left, right] if rig.share.list().is_single => {
                    left.run_code_for_both(right, &mut rig.processor, 0).map_err(fault)?;
                }
                _ => passes.iter().zip(*eyes).try_for_each(|(pass, eye)| {
                    pass.run_code(&mut rig.processor, *eye as u8).map(|_| ()).map_err(fault)
                })?,
            }
            let span = beginning.by_code(&GpTiming::PAPERS, &mut rig.processor).map_err(fault)?;
            all_ns += span.0 as f64 / 1e3;
        }
    }
    Ok(all_ns / (VIEWS * eyes.len() as u64) as f64)
}

fn edit_ns(version: CodeVersion) -> Result<f64, ExperimentError> {
    let mut processor = Processor::new(NodeId(1), MEMORY, version, MachineConfig::small_hmd().i860);
    let mut ns = |count: u32| {
        let edits = (0..count).map(|structure| ModelEdit { structure, model: Mat4::IDENTITY }).collect();
        let view = FrameView { number: ViewNumber::FIRST, eyes: Vec::new(), edits };
        EditWork(&view).by_code(&GpTiming::PAPERS, &mut processor).map(|span| span.0 as f64 / 1e3).map_err(fault)
    };
    // The difference removes the constant cost of a message.
    let [one, more] = [ns(1)?, ns(1 + EDITS)?];
    Ok((more - one) / f64::from(EDITS))
}

fn sample(pass: &Pass, made: &KernelOutput) -> Sample {
    let cut = pass.stats().clipped;
    let uncut = u64::from(pass.transformed().triangles) - cut;
    [uncut as f64, cut as f64, made.entries() as f64, made.span.0 as f64 / 1e3]
}

fn sphere_sample(pass: &Pass, made: &KernelOutput) -> SphereSample {
    let regions = pass.picture().viewport.grid().regions() as u16;
    let entries: u32 = (0..regions).map(|region| pass.counts(RegionId(region)).spheres).sum();
    [pass.transformed().spheres.into(), entries.into(), made.of_spheres.0 as f64 / 1e3]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_of_a_sphere_excludes_its_bin_entries() {
        let times = CodeTimes {
            triangle_ns: 0.0,
            triangle_range_ns: [0.0; 2],
            sphere_ns: 0.0,
            entry_ns: 3.0,
            guard_ns: 0.0,
            pass_ns: 0.0,
            structure_ns: 0.0,
            sphere_view_ns: 0.0,
            token_entry_ns: 0.0,
            edit_ns: 0.0,
            message_ns: 0.0,
            message_range_ns: [0.0; 2],
        };
        let scenes = [vec![[2.0, 4.0, 112.0], [3.0, 1.0, 153.0]], vec![[0.0; 3]], vec![[1.0, 0.0, 60.0]]];
        assert_eq!(times.sphere(&scenes), 55.0);
    }

    #[test]
    fn the_solver_finds_two_unknowns_from_exact_equations() {
        let rows = [[1.0, 2.0], [3.0, 1.0], [2.0, 5.0]];
        let found = solve(rows.into_iter().map(|[a, b]| ([a, b], 7.0 * a + 11.0 * b)));
        assert!((found - 7.0).abs() < 1e-9, "{found}");
        assert_eq!(solve(rows.into_iter().map(|[a, _]| ([a, 0.0], 7.0 * a))), 7.0);
    }
}
