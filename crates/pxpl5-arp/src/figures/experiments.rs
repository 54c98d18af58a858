//! Experiments E2 to E9 of an ideal renderer, run once for all rows.

use super::compared::{composite_differs, turned_differ};
use super::fit::fitted_cell_m;
use super::gallery::gallery;
use super::interpretations::{Interpretations, ThresholdRow, threshold_rows};
use super::lens::straight_edge;
use super::rules::Rules;
use crate::error::ExperimentError;
use crate::report::Report;
use crate::settings::{Settings, SourceKind};
use crate::walk::{WalkTally, at_frames, walk};
use crate::world::World;
use address_recalculation::Lens;
use glam::{DMat3, DQuat, DVec3};
use priority_rendering::{Objects, PriorityTiming, SizeRule, Threshold};
use tracking::motion::Walk;

/// Frames of each walk: two minutes, four fifths of a round. The specification asks for 1,800 at least.
pub const EXPERIMENT_FRAMES: u64 = 7_200;

/// A walk of an experiment and what it gave.
#[derive(Clone, Debug)]
pub struct Walked {
    /// What it is called.
    pub name: &'static str,
    /// What it was made of.
    pub settings: Settings,
    /// What was counted.
    pub tally: WalkTally,
    /// The same as a report.
    pub report: Report,
}

/// A side of a cell that was fitted to one rate of table 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The rules that it was fitted for.
    pub rules: Rules,
    /// The side, m.
    pub cell_m: f64,
    /// Updates a second of each memory.
    pub rates_hz: Vec<f64>,
}

/// A renderer that is too slow or nearly so.
#[derive(Clone, Debug, PartialEq)]
pub struct Slowed {
    /// Triangles that it draws a second.
    pub triangles_per_s: f64,
    /// Pictures a second of each memory.
    pub rates_hz: Vec<f64>,
    /// Retraces at which an update was not whole, of each memory.
    pub missed: Vec<u64>,
}

/// Results of everything that is simulated.
#[derive(Clone, Debug)]
pub struct Experiments {
    /// The side of a cell that was fitted in the gallery, for the usual rules and for equal rings.
    pub fits: [Fit; 2],
    /// All interpretations of table 1.
    pub interpretations: Interpretations,
    /// Thresholds, with the sides of cells that go with them.
    pub thresholds: Vec<ThresholdRow>,
    /// Segments of the gallery with the cells that were fitted.
    pub segments: usize,
    /// Cut and torn, cut and warped, uncut, warped without cascade; cells as fitted.
    pub walks: Vec<Walked>,
    /// A renderer that is slowed down.
    pub slowed: Vec<Slowed>,
    /// Reduction of point objects: 4 memories at 1 m/s, 5 at 0.37 m/s.
    pub reductions: [f64; 2],
    /// Which component of validity decides, by size over distance.
    pub sizes: Vec<SizeRow>,
    /// From which size on the size component decides, by interpretation.
    pub size_limits: Vec<SizeLimit>,
    /// How an edge bends on the screen and through the lens, pixels.
    pub lens_px: [f64; 2],
    /// Texels in which four memories, drawn at once from one place, together are not what one memory shows.
    pub composite_differs: u64,
    /// Pixels that a stalled renderer changes in what a head sees that turns.
    pub turned_differ: u64,
}

/// A head that looks at a point, upright.
pub(crate) fn looking_at(eye: DVec3, point: DVec3) -> DQuat {
    let back = (eye - point).normalize_or(DVec3::Z);
    let right = DVec3::Y.cross(back).normalize_or(DVec3::X);
    DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back)).normalize()
}

impl Experiments {
    /// Runs all of them.
    ///
    /// # Errors
    ///
    /// [`ExperimentError`], where a scene or number is none; those here are.
    pub fn run() -> Result<Self, ExperimentError> {
        let (scene, path) = gallery()?;
        let fit = |rules: Rules| -> Result<Fit, ExperimentError> {
            let (cell_m, rates_hz) = fitted_cell_m(&scene, &path, &rules, EXPERIMENT_FRAMES)?;
            Ok(Fit { rules, cell_m, rates_hz })
        };
        let fits = [fit(Rules::USUAL)?, fit(Rules { ring_growth: 1, ..Rules::USUAL })?];
        let side = fits[0].cell_m;
        let world = World::new(&scene, side)?;
        let cells = Settings::CELLS.with_cells(side);
        let kinds = [
            ("cut, torn", cells.clone()),
            ("cut, warped", Settings::WARPED.with_cells(side)),
            ("uncut", Settings { is_segmented: false, ..cells.clone() }),
            ("cut, warped without cascade", Settings { has_cascade: false, ..Settings::WARPED.with_cells(side) }),
        ];
        let mut walks = Vec::new();
        for (name, settings) in kinds {
            let tally = walk(&world, &settings, EXPERIMENT_FRAMES, at_frames(&path, 1.0, 60.0))?;
            let report = Report::of(&world, &settings, &tally, None);
            walks.push(Walked { name, settings, tally, report });
        }
        Ok(Self {
            segments: world.segments.len(),
            slowed: slowed(&world, &cells, &path)?,
            interpretations: Interpretations::run(|_, _| {})?,
            thresholds: threshold_rows(side),
            fits,
            walks,
            reductions: [point_objects_reduction(1.0, 4), point_objects_reduction(0.37, 5)],
            sizes: size_rows(),
            size_limits: size_limits(),
            lens_px: straight_edge(Lens::Radial { k1: 0.32, k2: 0.0 })?,
            composite_differs: composite_differs(&world, &cells, path.place(6.15))?,
            turned_differ: turned_differ(&world, &cells, path.place(15.0))?,
        })
    }
}

/// The torn walk with renderers of less and less triangles a second.
fn slowed(world: &World, settings: &Settings, path: &Walk) -> Result<Vec<Slowed>, ExperimentError> {
    let mut all = Vec::new();
    for triangles_per_s in [100_000.0, 20_000.0, 10_000.0, 5_000.0, 2_500.0] {
        let settings = Settings { source: SourceKind::Timed { triangles_per_s }, ..settings.clone() };
        let tally = walk(world, &settings, 1_800, at_frames(path, 1.0, 60.0))?;
        let missed = tally.memories.iter().map(|memory| memory.missed).collect();
        all.push(Slowed { triangles_per_s, rates_hz: tally.rates_hz(60.0), missed });
    }
    Ok(all)
}

/// The threshold of E3 and E4, degrees: a texel of an ideal face.
const THETA_DEG: f64 = 90.0 / 512.0;

/// Points on a disc of 100 m around a walker, evenly by area.
const POINTS: usize = 20_000;

/// 60 times the points over the draws of a second, at a speed (m/s), with so many memories and a threshold of 90/512 degrees.
#[must_use]
pub fn point_objects_reduction(speed: f64, memories: u64) -> f64 {
    let numbers = PriorityTiming { memories, theta_deg: THETA_DEG, ..PriorityTiming::PAPERS };
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

/// Validity of an object of some size at 10 m before somebody who walks towards it at 1 m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeRow {
    /// Diameter over distance of the middle.
    pub size_over_distance: f64,
    /// Translation, by the middle's distance, s.
    pub translation_s: f64,
    /// Size, by the disc and by the sphere, s.
    pub size_s: [f64; 2],
}

/// Rows from 0.1 to 20.
#[must_use]
pub fn size_rows() -> Vec<SizeRow> {
    let threshold = Threshold::of_degrees(THETA_DEG);
    let sizes = [0.1, 0.2, 0.5, 1.0, 1.4, 1.5, 1.9, 2.0, 5.0, 10.0, 20.0];
    sizes.map(|size| size_row(&threshold, size)).to_vec()
}

fn size_row(threshold: &Threshold, size: f64) -> SizeRow {
    let radius = size * 10.0 / 2.0;
    let rules = [SizeRule::Disc, SizeRule::Sphere];
    let size_s = rules.map(|rule| Threshold { size: rule, ..*threshold }.way_of_size(10.0, radius));
    SizeRow { size_over_distance: size, translation_s: threshold.way(10.0), size_s }
}

/// The size over distance from which on the size component decides, for an interpretation of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeLimit {
    /// The angle that may change by the threshold, or by twice the threshold, before the size is wrong.
    pub angle: &'static str,
    /// Threshold of the radius' angle, in those of translation.
    pub factor: f64,
    /// Diameter over the distance of the sphere's middle.
    pub of_middle: f64,
    /// Diameter over the distance of the sphere's nearest point.
    pub of_nearest: f64,
}

/// Limits for spheres, translation being that of the middle: for a change of the diameter's angle, of the radius' angle (both by the
/// threshold), and of the radius' angle by twice the threshold.
#[must_use]
pub fn size_limits() -> Vec<SizeLimit> {
    let kinds = [("the diameter's, by theta", 0.5), ("the radius', by theta", 1.0), ("the radius', by 2 theta", 2.0)];
    kinds.map(|(angle, factor)| size_limit(angle, factor)).to_vec()
}

/// Bisections: more than a double has bits.
const HALVINGS: usize = 60;

fn size_limit(angle: &'static str, factor: f64) -> SizeLimit {
    let translation = Threshold::of_degrees(THETA_DEG);
    let size = Threshold { angle: factor * translation.angle, size: SizeRule::Sphere, ..translation };
    let decides = |radius: f64| size.way_of_size(1.0, radius) < translation.way(1.0);
    let mut range = [0.0, 1.0];
    for _ in 0..HALVINGS {
        let middle = (range[0] + range[1]) / 2.0;
        range[usize::from(decides(middle))] = middle;
    }
    let radius = range[1];
    SizeLimit { angle, factor, of_middle: 2.0 * radius, of_nearest: 2.0 * radius / (1.0 - radius) }
}
