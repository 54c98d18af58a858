//! The experiments with an ideal renderer, numbered E2 to E9. Each experiment is run once for all rows of the
//! comparison.

use super::compared::{composite_differs, turned_differ};
use super::fit::fitted_cell_m;
use super::interpretations::{Interpretations, ThresholdRow, gallery, threshold_rows};
use super::lens::straight_edge;
use super::rules::Rules;
use crate::report::ArpReport;
use crate::settings::{SourceKind, WalkSettings};
use crate::walk::{WalkTally, at_frames, walk, walked};
use crate::world::World;
use address_recalculation::Lens;
use address_recalculation::priority::{Objects, PriorityTiming, SizeRule, Threshold};
use glam::{DMat3, DQuat, DVec3};
use pxpl5_sim::StopFlag;
use pxpl5_sim::parameters::SettingError;
use tracking::motion::Walk;

/// Number of frames of each walk: two minutes, or four fifths of a round on the gallery's path.
pub const EXPERIMENT_FRAMES: u64 = 7_200;

/// Settings and results of one simulated walk of the viewer.
#[derive(Clone, Debug)]
pub struct NamedWalk {
    pub name: &'static str,
    pub settings: WalkSettings,
    pub tally: WalkTally,
    pub report: ArpReport,
}

/// The side of a cell (square of the floor), fitted to one update rate in table 1 of the paper CPR05.
#[derive(Clone, Debug, PartialEq)]
pub struct CellFit {
    pub rules: Rules,
    /// Fitted side of a cell, in metres.
    pub cell_m: f64,
    /// Updates per second of each display memory.
    pub rates_hz: Vec<f64>,
}

/// The update rates of all display memories with a renderer of limited speed.
#[derive(Clone, Debug, PartialEq)]
pub struct SlowRendererResult {
    pub triangles_per_s: f64,
    /// Updates per second of each display memory.
    pub rates_hz: Vec<f64>,
    /// Number of retraces at which an update was incomplete, for each memory.
    pub missed: Vec<u64>,
}

/// The results of all experiments that reproduce the papers' figures.
#[derive(Clone, Debug)]
pub struct Experiments {
    /// Two fits of the cell side in the gallery: with this project's rules, and with the rules of the smallest error in
    /// the sample without a cascade (rings that double).
    pub fits: [CellFit; 2],
    /// All interpretations of table 1 of the paper CPR05 (update rates).
    pub interpretations: Interpretations,
    /// Thresholds of the image error, each with the cell side that fits the update rates in table 1 of the paper CPR05.
    pub thresholds: Vec<ThresholdRow>,
    /// Number of segments (parts of objects) into which the fitted cells cut the gallery.
    pub segments: usize,
    /// Four walks with the fitted cells. Objects are cut without warping, cut with warping, uncut, or cut with warping
    /// but without a cascade. In a cascade, an update of a memory also updates all more often drawn memories.
    pub walks: Vec<NamedWalk>,
    /// Walks with renderers of decreasing speed.
    pub slowed: Vec<SlowRendererResult>,
    /// Factors by which priority rendering reduces the number of draws of point objects: with 4 memories at 1 m/s, and
    /// with 5 memories at 0.37 m/s.
    pub reductions: [f64; 2],
    /// Limits of the ratio of an object's size to its distance, one for each interpretation. Above the limit, the
    /// growth of the object on the screen determines the validity period.
    pub size_limits: Vec<SizeLimit>,
    /// Largest deviation of a straight edge from a straight line, in pixels: on the screen, and through the lens.
    pub lens_px: [f64; 2],
    /// Number of texels that differ between a single memory and four memories that are all drawn from one position.
    pub composite_differs: u64,
    /// Number of pixels that change in the view of a rotating head if the renderer stalls.
    pub turned_differ: u64,
}

/// Returns the upright orientation of a head that looks from `eye` at a point.
pub(crate) fn looking_at(eye: DVec3, point: DVec3) -> DQuat {
    let back = (eye - point).normalize_or(DVec3::Z);
    let right = DVec3::Y.cross(back).normalize_or(DVec3::X);
    DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back)).normalize()
}

impl Experiments {
    /// Runs all experiments. After a stop, their results are those of short walks and useless.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if a scene or a number is invalid. The built-in scenes and numbers are valid.
    pub fn run(stop: &StopFlag) -> Result<Self, SettingError> {
        // Fit the cell size first: all other experiments use it.
        let (scene, path) = gallery()?;
        let fit = |rules: Rules| -> Result<CellFit, SettingError> {
            let frames = if stop.is_stopped() { 1 } else { EXPERIMENT_FRAMES };
            let (cell_m, rates_hz) = fitted_cell_m(&scene, &path, &rules, frames)?;
            Ok(CellFit { rules, cell_m, rates_hz })
        };
        let doubled = Rules { inner_rings: 1, ring_growth: 2, has_cascade: false, ..Rules::USUAL };
        let fits = [fit(Rules::USUAL)?, fit(doubled)?];
        let side = fits[0].cell_m;
        let world = World::new(&scene, side)?;
        let cells = WalkSettings::CELLS.with_cells(side);
        // Walk four times with the fitted cells.
        let kinds = [
            ("cut, torn", cells.clone()),
            ("cut, warped", WalkSettings::WARPED.with_cells(side)),
            ("uncut", WalkSettings { is_segmented: false, ..cells.clone() }),
            (
                "cut, warped without cascade",
                WalkSettings { has_cascade: false, ..WalkSettings::WARPED.with_cells(side) },
            ),
        ];
        let mut walks = Vec::new();
        for (name, settings) in kinds {
            let (_, tally) =
                walked(&world, &settings, EXPERIMENT_FRAMES, at_frames(&path, 1.0, 60.0), &mut stop.clone())?;
            let report = ArpReport::of(&world, &settings, &tally);
            walks.push(NamedWalk { name, settings, tally, report });
        }
        Ok(Self {
            segments: world.segments.len(),
            slowed: if stop.is_stopped() { Vec::new() } else { slowed(&world, &cells, &path)? },
            interpretations: Interpretations::run(&mut stop.clone())?,
            thresholds: threshold_rows(side),
            fits,
            walks,
            reductions: [point_objects_reduction(1.0, 4), point_objects_reduction(0.37, 5)],
            size_limits: size_limits(),
            lens_px: straight_edge(Lens::Radial { k1: 0.32, k2: 0.0 })?,
            composite_differs: composite_differs(&world, &cells, path.place(6.15))?,
            turned_differ: turned_differ(&world, &cells, path.place(15.0))?,
        })
    }
}

/// Repeats the walk without warping (which has tears between memories), with renderers of decreasing speed.
fn slowed(world: &World, settings: &WalkSettings, path: &Walk) -> Result<Vec<SlowRendererResult>, SettingError> {
    let mut all = Vec::new();
    for triangles_per_s in [100_000.0, 20_000.0, 10_000.0, 5_000.0, 2_500.0] {
        let settings = WalkSettings { source: SourceKind::Timed { triangles_per_s }, ..settings.clone() };
        let tally = walk(world, &settings, 1_800, at_frames(path, 1.0, 60.0))?;
        let missed = tally.memories.iter().map(|memory| memory.missed).collect();
        all.push(SlowRendererResult { triangles_per_s, rates_hz: tally.rates_hz(60.0), missed });
    }
    Ok(all)
}

/// Largest accepted image error in experiments E3 and E4, in degrees: one texel of an ideal face of 512 x 512 texels.
const THETA_DEG: f64 = 90.0 / 512.0;

/// Number of point objects on a disc around the walker with a radius of 100 m. The points are distributed evenly by
/// area.
const POINTS: usize = 20_000;

/// Returns the factor by which priority rendering reduces draws of point objects, relative to drawing all at 60 Hz.
///
/// `speed` is in m/s. The threshold is 90/512 degrees.
pub fn point_objects_reduction(speed: f64, memories: u64) -> f64 {
    let numbers = PriorityTiming { memories, theta_deg: THETA_DEG, ..PriorityTiming::PAPERS };
    // The image of a point is valid until the walker's movement exceeds the threshold.
    let threshold = Threshold::of_degrees(numbers.theta_deg);
    let distances = (0..POINTS).map(|point| 100.0 * libm::sqrt((point as f64 + 0.5) / POINTS as f64));
    let periods: Vec<f64> = distances.map(|distance_m| threshold.way(distance_m) / speed).collect();
    let mut objects = Objects::new(&numbers, POINTS);
    let frames = 64;
    (0..frames).for_each(|frame| {
        objects.frame(frame, &periods);
    });
    frames as f64 * POINTS as f64 / objects.counts()[1] as f64
}

/// A limit of the ratio of an object's size to its distance. Above the limit, the growth of the object on the screen
/// determines the validity period. The papers do not define "size" and "distance", so each interpretation has its own
/// limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeLimit {
    /// Name of the angle whose change is limited: the angle that the sphere's diameter covers, or the angle that the
    /// radius covers.
    pub angle: &'static str,
    /// Allowed change of the angle that the sphere's radius covers, divided by the threshold for translation of the
    /// eye. Both are angles.
    pub factor: f64,
    /// Greatest diameter of the sphere, divided by the distance of its middle, for which translation and not growth
    /// limits the validity period.
    pub of_middle: f64,
    /// Greatest diameter of the sphere, divided by the distance of its nearest point, for which translation and not
    /// growth limits the validity period.
    pub of_nearest: f64,
}

/// Returns the limits for spheres under three interpretations. Translation is always measured at the middle of the
/// sphere.
///
/// The interpretations differ in the limited angle. In the first, the threshold limits the change of the angle that the
/// diameter covers. In the second, the threshold limits the change of the angle that the radius covers. In the third,
/// twice the threshold limits this change.
pub fn size_limits() -> Vec<SizeLimit> {
    let kinds = [("the diameter's, by theta", 0.5), ("the radius', by theta", 1.0), ("the radius', by 2 theta", 2.0)];
    kinds.map(|(angle, factor)| size_limit(angle, factor)).to_vec()
}

/// Number of bisection steps. A double has fewer bits of precision, so more steps would change no result.
const BISECTION_STEPS: usize = 60;

fn size_limit(angle: &'static str, factor: f64) -> SizeLimit {
    let translation = Threshold::of_degrees(THETA_DEG);
    let size = Threshold { angle: factor * translation.angle, size: SizeRule::Sphere, ..translation };
    let decides = |radius: f64| size.max_approach(1.0, radius) < translation.way(1.0);
    let mut range = [0.0, 1.0];
    for _ in 0..BISECTION_STEPS {
        let middle = (range[0] + range[1]) / 2.0;
        range[usize::from(decides(middle))] = middle;
    }
    let radius = range[1];
    SizeLimit { angle, factor, of_middle: 2.0 * radius, of_nearest: 2.0 * radius / (1.0 - radius) }
}
