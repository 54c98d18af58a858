//! Times of primitives that follow from i860 code, for the timing table: what a pass over the application scenes takes on a board.
//!
//! ```text
//!   clocks of triangles in a pass = triangle * (triangles) + guard * (of these, cut by the clipper) + entry * (their entries of bins)
//!   clocks of spheres             = sphere * (spheres) + entry * (their entries of bins)
//! ```
//!
//! `guard` comes from triangles that cover the screen and reach beyond the guard band (`CLIPPED_M`), the others from the three application
//! scenes: a share of each, seen along its own head motion; the first pass only fills the caches. `entry` is the slope over all passes by least squares,
//! `triangle` the mean of the scenes' means. Each is found from what the others leave of the time, in turn until they stay. `sphere` is
//! what entries leave of the spheres' time, the mean of the means of those of the three scenes that have spheres. Triangles are measured
//! without the spheres of their scene, whose code takes the instruction cache.
//!
//! ```text
//!   beginning of a pass = pass + structure * (structures * eyes) + sphere view * (of these, with spheres)
//! ```
//!
//! `structure` is what one more costs, in a list with some more that hold nothing, `sphere view` what a scene takes more than the same without
//! spheres, and `pass` what is left: bins reset, and code that is not in the caches. Each is the mean of the scenes' means.
//!
//! A message's time is the mean over all that a board receives and sends around these passes: under PPHIGS a slave's, with what
//! each token costs whose bin it hands over, under Slats those of fields; of the three scenes the mean again. `token entry` is the slope of
//! the time in which a bin is handed over, over the entries in it, by least squares over all bins.

mod messages;
mod strips;

pub use strips::{StripTimes, strip_times};

use glam::Mat4;
use pphigs::{
    DisplayList, DisplayStructure, Editing, FrameView, KernelOutput, ModelEdit, Pass, Picture, RegionBinning, Shading,
    Share, TransformCost,
};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{CodeUse, CodeVersion, GpTiming, Processor, ProcessorFault, Work};
use pxpl5_machine::MachineConfig;
use pxpl5_renderer::Layout;
use pxpl5_run::{ExperimentError, Views, display_list, views};
use pxpl5_scene::{Hmd, HmdConfig, builtin};
use pxpl5_sim::Time;
use pxpl5_wire::{FieldParity, NodeId, RegionId, ViewNumber};
use std::sync::Arc;

/// The application scenes of TR94.
const SCENES: [&str; 3] = ["mig", "molecules", "head"];

/// Of so many boards, the share of the first (the slaves of the small machine).
const BOARDS: usize = 12;

/// Views of each scene, and time between them.
const VIEWS: u64 = 4;
const VIEW_PERIOD_PS: u64 = 500_000_000_000;

/// Half of the side of the square that a triangle at a distance of 1 m covers where the clipper is measured, metres: its corners lie up to
/// 4,477 pixels from the picture's. Assumed, anything beyond the guard band.
const CLIPPED_M: f32 = 2.0;

/// Triangles that Slats transforms at a time (published TR94), and how many such clumps of a scene are measured.
const CLUMP: usize = 30;
const CLUMPS: usize = 20;

/// Edits of a message by which their time is measured: several, of matrices that lie one behind the other.
const EDITS: u32 = 16;

/// Structures more by which the time of one is measured.
const MORE_STRUCTURES: usize = 8;

/// A board's memory (published TR94).
const MEMORY: u64 = 8 << 20;

/// Times of primitives in nanoseconds, as the code gives them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CodeTimes {
    /// A triangle that is not cut: mean of the scenes' means.
    pub triangle_ns: f64,
    /// The least and the greatest scene's mean.
    pub triangle_range_ns: [f64; 2],
    /// A sphere: mean of the scenes' means.
    pub sphere_ns: f64,
    /// An entry in a bin.
    pub entry_ns: f64,
    /// A triangle that the clipper cuts, besides: its cuts, and all pieces but one.
    pub guard_ns: f64,
    /// The beginning of a pass, but for its structures: mean of the scenes' means.
    pub pass_ns: f64,
    /// A structure put in its place for an eye, among others: mean of the scenes' means.
    pub structure_ns: f64,
    /// What the spheres of a structure need of a view, besides: mean of those scenes' means.
    pub sphere_view_ns: f64,
    /// An edit among others.
    pub edit_ns: f64,
    /// An entry of a bin that is handed over with its token.
    pub token_entry_ns: f64,
    /// A message, or a chain: mean of the scenes' means.
    pub message_ns: f64,
    /// The least and the greatest scene's mean.
    pub message_range_ns: [f64; 2],
}

/// Rounds after which the times stay as they are: each takes over a small part of the last one's error.
const ROUNDS: usize = 30;

/// One pass: triangles that are not cut, triangles that are, their entries, nanoseconds.
type Sample = [f64; 4];

/// The same of spheres: spheres, their entries, nanoseconds.
type SphereSample = [f64; 3];

fn picture(of: CodeUse) -> Picture {
    let (viewport, shading, binning) = match of {
        CodeUse::Pphigs => (Viewport::FRAME, Shading::Phong, RegionBinning::Touched),
        CodeUse::Slats => (Viewport::field(FieldParity::Even), Shading::Precomputed, RegionBinning::All),
        CodeUse::SlatsLit => (Viewport::field(FieldParity::Even), Shading::Gouraud, RegionBinning::All),
    };
    Picture { viewport, shading, binning, layout: Layout::rendering_control_phong(), pixels: false }
}

/// Returns the eyes of each pass over the display list, one pass after the other.
const fn eyes_of_a_pass(of: CodeUse) -> &'static [&'static [usize]] {
    match of {
        CodeUse::Pphigs => &[&[0], &[1]],
        CodeUse::Slats | CodeUse::SlatsLit => &[&[0, 1]],
    }
}

fn parts(of: CodeUse, share: &Share) -> Vec<Share> {
    match of {
        CodeUse::Pphigs => vec![share.clone()],
        CodeUse::Slats | CodeUse::SlatsLit => share.clumps(CLUMP).take(CLUMPS).collect(),
    }
}

/// Measures the times of code in one use.
///
/// # Errors
///
/// [`ExperimentError::Scene`] when a scene is not found or the code does not come to its end.
pub fn code_times(version: CodeVersion, of: CodeUse) -> Result<CodeTimes, ExperimentError> {
    // An eye after the other: both in one pass always have the same parts of triangles that are cut, from which nothing follows.
    let cut = measured(of, Rig::of_list(version, "full-screen:30", 1, beyond_the_guard_band)?, false, sample)?;
    let scenes: Vec<Vec<Sample>> =
        SCENES.iter().map(|scene| samples(version, of, scene, BOARDS)).collect::<Result<_, _>>()?;
    let of_spheres: Vec<Vec<SphereSample>> =
        SCENES.iter().map(|scene| sphere_samples(version, of, scene)).collect::<Result<_, _>>()?;
    let begun: Vec<Begun> = SCENES.iter().map(|scene| begun(version, of, scene)).collect::<Result<_, _>>()?;
    let edit_ns = edit_ns(version)?;
    let traffic: Vec<_> = SCENES.iter().map(|scene| messages::traffic(version, of, scene)).collect::<Result<_, _>>()?;
    let token_entry_ns = messages::token_entry_ns(&traffic);
    let messages: Vec<f64> = traffic.iter().map(|traffic| traffic.message_ns(token_entry_ns)).collect();
    let range = [0.0; 2];
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
    for _ in 0..ROUNDS {
        times.improve(of, &cut, &scenes);
    }
    times.sphere_ns = times.sphere(&of_spheres);
    Ok(times)
}

impl CodeTimes {
    /// Finds each from what the others leave of the time.
    fn improve(&mut self, of: CodeUse, cut: &[Sample], scenes: &[Vec<Sample>]) {
        let of_clipper = self.triangle_ns + self.guard_ns;
        let uncut = |sample: &Sample| [sample[0], sample[2], sample[3] - of_clipper * sample[1]];
        if of == CodeUse::Pphigs {
            self.entry_ns = solve(scenes.iter().flatten().map(uncut).map(|[uncut, n, ns]| ([n, uncut], ns)));
        }
        let entry_ns = self.entry_ns;
        let of_scene = |samples: &Vec<Sample>| {
            let rows = samples.iter().map(uncut);
            let [n, ns] = rows.fold([0.0; 2], |sum, [uncut, n, ns]| [sum[0] + uncut, sum[1] + ns - entry_ns * n]);
            ns / n
        };
        let means: Vec<f64> = scenes.iter().map(of_scene).collect();
        self.triangle_ns = mean(means.iter().copied());
        self.triangle_range_ns = extremes(&means);
        let without_entries = |[uncut, cut, n, ns]: &Sample| ([*cut, *uncut], ns - entry_ns * n);
        self.guard_ns = solve(cut.iter().map(without_entries)) - self.triangle_ns;
    }

    /// What entries leave of the time of a sphere; scenes without spheres say nothing.
    fn sphere(&self, scenes: &[Vec<SphereSample>]) -> f64 {
        let sums = scenes.iter().map(|samples| {
            samples.iter().fold([0.0; 2], |[n, ns], [spheres, entries, of_spheres]| {
                [n + spheres, ns + of_spheres - self.entry_ns * entries]
            })
        });
        mean(sums.filter(|[n, _]| *n > 0.0).map(|[n, ns]| ns / n))
    }
}

/// 0 of nothing.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let [n, sum] = values.fold([0.0; 2], |[n, sum], value| [n + 1.0, sum + value]);
    sum / f64::max(n, 1.0)
}

/// The least and the greatest.
fn extremes(values: &[f64]) -> [f64; 2] {
    [values.iter().copied().fold(f64::INFINITY, f64::min), values.iter().copied().fold(0.0, f64::max)]
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

/// A scene on a board, and its views.
struct Rig {
    share: Share,
    views: Views,
    processor: Processor,
}

fn fault(error: ProcessorFault) -> ExperimentError {
    ExperimentError::Scene(error.to_string())
}

impl Rig {
    fn new(version: CodeVersion, scene: &str, boards: usize) -> Result<Self, ExperimentError> {
        Self::of_list(version, scene, boards, |list| list)
    }

    /// The same without spheres.
    fn of_triangles(version: CodeVersion, scene: &str, boards: usize) -> Result<Self, ExperimentError> {
        Self::of_list(version, scene, boards, without_spheres)
    }

    fn of_list(
        version: CodeVersion,
        scene: &str,
        boards: usize,
        part: impl Fn(DisplayList) -> DisplayList,
    ) -> Result<Self, ExperimentError> {
        let scene = Arc::new(builtin(scene).map_err(|error| ExperimentError::Scene(error.to_string()))?);
        let list = Arc::new(part(display_list(&scene).map_err(ExperimentError::Scene)?));
        let hmd = Hmd::new(HmdConfig::unc()).map_err(|error| ExperimentError::Scene(error.to_string()))?;
        let (views, _) = views(&scene, 1, hmd, 2);
        let share = Share::new(list, 0, boards);
        let mut processor = Processor::new(NodeId(1), MEMORY, version, MachineConfig::small_hmd().i860);
        share.install(&mut processor).map_err(fault)?;
        Ok(Self { share, views, processor })
    }

    fn view(&self, number: u64) -> FrameView {
        (self.views)(ViewNumber(number), Time(number * VIEW_PERIOD_PS))
    }
}

fn samples(version: CodeVersion, of: CodeUse, scene: &str, boards: usize) -> Result<Vec<Sample>, ExperimentError> {
    measured(of, Rig::of_triangles(version, scene, boards)?, true, sample)
}

/// None of scenes without spheres.
fn sphere_samples(version: CodeVersion, of: CodeUse, scene: &str) -> Result<Vec<SphereSample>, ExperimentError> {
    let rig = Rig::new(version, scene, BOARDS)?;
    if rig.share.counts().spheres == 0 { Ok(Vec::new()) } else { measured(of, rig, true, sphere_sample) }
}

/// All passes but the first. What goes through both eyes in one pass, where that is `together`, is one sample.
fn measured<const N: usize>(
    of: CodeUse,
    mut rig: Rig,
    together: bool,
    sample: impl Fn(&Pass, &KernelOutput) -> [f64; N],
) -> Result<Vec<[f64; N]>, ExperimentError> {
    let mut samples = Vec::new();
    let parts = parts(of, &rig.share);
    for number in 0..VIEWS {
        let view = rig.view(number);
        for part in &parts {
            let passes = [0, 1].map(|eye| part.transform(&view, eye, picture(of)));
            let [left, right] = &passes;
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
    samples.remove(0);
    Ok(samples)
}

/// Triangles that cover the screen, each enlarged to a right angle at the lower left whose legs are four times so many metres long, and 0.5 m
/// more for the eyes.
fn beyond_the_guard_band(mut list: DisplayList) -> DisplayList {
    for triangle in list.positions.chunks_exact_mut(3) {
        for (corner, [x, y]) in triangle.iter_mut().zip([[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]]) {
            let half = CLIPPED_M * -corner.z + 0.5;
            (corner.x, corner.y) = (x * half, y * half);
        }
    }
    list
}

fn without_spheres(mut list: DisplayList) -> DisplayList {
    list.spheres.clear();
    list.structures.iter_mut().for_each(|structure| structure.spheres = 0..0);
    list
}

/// The same with some structures more, which hold nothing.
fn with_more_structures(list: DisplayList) -> DisplayList {
    let mut list = without_spheres(list);
    let end = list.triangles.len();
    let more = list.structures.last().cloned();
    let more = more.map(|last| DisplayStructure { triangles: end..end, spheres: 0..0, ..last });
    list.structures.extend(std::iter::repeat_n(more, MORE_STRUCTURES).flatten());
    list
}

/// Parts of the beginning of a pass over a scene.
struct Begun {
    pass_ns: f64,
    structure_ns: f64,
    /// None of scenes without spheres.
    sphere_view_ns: Option<f64>,
}

fn begun(version: CodeVersion, of: CodeUse, scene: &str) -> Result<Begun, ExperimentError> {
    let rig = |part: fn(DisplayList) -> DisplayList| Rig::of_list(version, scene, BOARDS, part);
    let whole = rig(|list| list)?;
    let TransformCost { structures, sphere_views, .. } = TransformCost::beginning(&whole.share.list().structures);
    let whole_ns = beginning_ns(of, whole)?;
    let plain_ns = beginning_ns(of, rig(without_spheres)?)?;
    let more_ns = beginning_ns(of, rig(with_more_structures)?)?;
    let eyes = eyes_of_a_pass(of)[0].len() as f64;
    let structure_ns = (more_ns - plain_ns) / (MORE_STRUCTURES as f64 * eyes);
    Ok(Begun {
        pass_ns: plain_ns - structure_ns * structures as f64 * eyes,
        structure_ns,
        sphere_view_ns: (sphere_views > 0).then(|| (whole_ns - plain_ns) / (sphere_views as f64 * eyes)),
    })
}

/// Mean time in which a pass begins: of each eye, or of both where one follows the other.
fn beginning_ns(of: CodeUse, mut rig: Rig) -> Result<f64, ExperimentError> {
    let eyes = eyes_of_a_pass(of);
    let mut all_ns = 0.0;
    for number in 0..VIEWS {
        let view = rig.view(number);
        for eyes in eyes {
            let beginning = rig.share.beginning(&view, eyes, picture(of));
            // The triangles of the pass before have taken the caches.
            eyes.iter().try_for_each(|eye| {
                let pass = rig.share.transform(&view, *eye, picture(of));
                pass.run_code(&mut rig.processor, *eye as u8).map(|_| ()).map_err(fault)
            })?;
            let span = beginning.by_code(&GpTiming::PAPERS, &mut rig.processor).map_err(fault)?;
            all_ns += span.0 as f64 / 1e3;
        }
    }
    Ok(all_ns / (VIEWS * eyes.len() as u64) as f64)
}

/// Time of an edit: of one more in a message.
fn edit_ns(version: CodeVersion) -> Result<f64, ExperimentError> {
    let mut processor = Processor::new(NodeId(1), MEMORY, version, MachineConfig::small_hmd().i860);
    let mut ns = |count: u32| {
        let edits = (0..count).map(|structure| ModelEdit { structure, model: Mat4::IDENTITY }).collect();
        let view = FrameView { number: ViewNumber::FIRST, eyes: Vec::new(), edits };
        Editing(&view).by_code(&GpTiming::PAPERS, &mut processor).map(|span| span.0 as f64 / 1e3).map_err(fault)
    };
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
    fn a_sphere_takes_what_its_entries_leave() {
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
    fn two_unknowns_are_found_from_exact_rows() {
        let rows = [[1.0, 2.0], [3.0, 1.0], [2.0, 5.0]];
        let found = solve(rows.into_iter().map(|[a, b]| ([a, b], 7.0 * a + 11.0 * b)));
        assert!((found - 7.0).abs() < 1e-9, "{found}");
        assert_eq!(solve(rows.into_iter().map(|[a, _]| ([a, 0.0], 7.0 * a))), 7.0);
    }
}
