//! Interpretations of table 1 of the paper CPR05 (update rates). Each question that the paper leaves open has several
//! possible answers, which are simulated and ranked.
//!
//! In a hall and on a path that are measured in cells, the update rates depend only on the product of threshold and
//! cell side. One number is therefore fitted to three rates. Each cell side in the results stands for all pairs of
//! threshold and cell side with the same product.

use super::fit::{RATES_HZ, policy_rates_hz, rates_hz};
use super::rules::Rules;
use crate::hall::{Route, path_of, scaled};
use crate::walk::at_frames;
use address_recalculation::priority::{Cell, PriorityTiming};
use glam::DVec3;
use pxpl5_scene::{Scene, builtin};
use pxpl5_sim::Watcher;
use pxpl5_sim::parameters::SettingError;
use serde::Serialize;
use tracking::motion::Walk;

/// A hall and a path through this hall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Situation {
    /// A straight path through the middle of a hall of seven by seven cells.
    Straight,
    /// A path from corner to corner of a hall of seven by seven cells.
    Diagonal,
    /// A path once around the middle of a hall of seven by seven cells, halfway between middle and walls.
    Round,
    /// The path of the scene `gallery`, scaled to 20 m, for one minute.
    Gallery,
}

/// Number of cells along a side of every hall except the gallery.
const CELLS_ACROSS: i64 = 7;

const GALLERY_FRAMES: u64 = 3_600;

impl Situation {
    pub const ALL: [Self; 4] = [Self::Straight, Self::Diagonal, Self::Round, Self::Gallery];

    /// Returns the name of the hall and path for table headings.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Straight => "straight, 7 cells",
            Self::Diagonal => "diagonal, 7 cells",
            Self::Round => "round, 7 cells",
            Self::Gallery => "gallery, 20 m",
        }
    }

    /// Returns the corners of the path, in units of cells.
    fn corners(self) -> Vec<[f64; 2]> {
        let across = CELLS_ACROSS as f64;
        let [near, middle, far] = [0.1, across / 2.0, across - 0.1];
        let [low, high] = [across / 4.0, across * 0.75];
        match self {
            Self::Straight => vec![[middle, near], [middle, far]],
            Self::Diagonal => vec![[near, near], [far, far]],
            Self::Round => vec![[low, low], [high, low], [high, high], [low, high]],
            Self::Gallery => Vec::new(),
        }
    }

    /// Returns the updates per second of each display memory for a viewer's walk at 1 m/s.
    fn rates(self, rules: &Rules, cell_m: f64) -> Result<[f64; 4], SettingError> {
        let numbers = rules.numbers(cell_m);
        let rates = if self == Self::Gallery {
            let (scene, path) = gallery()?;
            policy_rates_hz(&scene, &path, &numbers, rules.has_cascade, GALLERY_FRAMES)?
        } else {
            let corners: Vec<DVec3> = self.corners().iter().map(|[x, z]| DVec3::new(*x, 0.0, *z) * cell_m).collect();
            let path = Walk::new(&corners, 1.0)?;
            // A walk between two corners returns to the first corner. Only the way to the second corner counts.
            let way_m = if self == Self::Round { path.length_m() } else { path.length_m() / 2.0 };
            let cells = (0..CELLS_ACROSS).flat_map(|x| (0..CELLS_ACROSS).map(move |z| Cell { x, z }));
            let frames = (way_m * numbers.frame_hz) as u64;
            rates_hz(cells, at_frames(&path, 1.0, numbers.frame_hz), &numbers, rules.has_cascade, frames)
        };
        Ok([0, 1, 2, 3].map(|memory| rates[memory]))
    }
}

/// Update rates of the memories for one side length of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// Side of a square cell of the floor, in metres. The threshold of the image error ([`PriorityTiming::theta_deg`])
    /// has its default value.
    pub cell_m: f64,
    /// Updates per second of display memories 0 to 3.
    pub rates_hz: [f64; 4],
}

impl Trial {
    /// Returns the error of the update rates of `memories`, relative to table 1 of the paper CPR05: the root mean
    /// square in percent.
    pub fn error_percent(&self, memories: &[usize]) -> f64 {
        let squares = memories.iter().map(|memory| self.miss(*memory).powi(2)).sum::<f64>();
        100.0 * (squares / memories.len() as f64).sqrt()
    }

    fn miss(&self, memory: usize) -> f64 {
        self.rates_hz[memory] / RATES_HZ[memory] - 1.0
    }
}

/// Indices of the compared display memories. Memory 0 is left out, because all rules draw it in every frame.
const COMPARED: [usize; 3] = [1, 2, 3];

/// Results of one set of rules on one path through one hall.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tried {
    pub rules: Rules,
    pub situation: Situation,
    /// Results for every cell side that was tried.
    #[serde(skip)]
    pub trials: Vec<Trial>,
    /// The trial with the smallest error over the rates of all compared memories.
    pub best: Trial,
    /// Error of the update rates of the best trial, in percent.
    pub error_percent: f64,
    /// Cross-validation error in percent: each rate is predicted with the cell side that fits the other two rates best.
    pub left_out_percent: f64,
}

/// Results of one set of rules over all halls and paths.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RankedRules {
    pub rules: Rules,
    /// Mean error of the update rates over all halls and paths, in percent.
    pub mean_error_percent: f64,
    /// Mean cross-validation error over all halls and paths, in percent.
    pub mean_left_out_percent: f64,
    pub tried: Vec<Tried>,
}

/// The update rate of one memory, predicted by the fit that is best for the update rates of the other two memories.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftOutRate {
    /// Index of the memory whose update rate was left out of the fit.
    pub memory: usize,
    /// Rules of the fit that is best for the other two memories.
    pub rules: Rules,
    /// Hall and path of the fit that is best for the other two memories.
    pub situation: Situation,
    /// Cell side and update rates of the fit that is best for the other two memories.
    pub trial: Trial,
    /// Relative error of the predicted update rate, in percent.
    pub error_percent: f64,
}

/// All interpretations of table 1 of the paper CPR05 (update rates), best first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Interpretations {
    /// Sets of rules with their results, in ascending order of the mean error of prediction.
    pub ranked: Vec<RankedRules>,
    /// Predictions of the three update rates. For each rate, the rules, the hall, the path and the cell side are chosen
    /// to fit the other two rates.
    pub left_out: Vec<LeftOutRate>,
}

/// Smallest cell side to try, in metres.
const FIRST_SIDE_M: f64 = 1.4;
/// Ratio of each cell side to the next smaller cell side.
const STEP: f64 = 1.06;
/// Number of cell sides that are tried before the search near the best side.
const STEPS: i32 = 20;

impl Tried {
    /// Tries all cell sides, and then four more sides near the best side.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`policy_rates_hz`].
    pub fn of(rules: Rules, situation: Situation) -> Result<Self, SettingError> {
        let trial = |cell_m| Ok(Trial { cell_m, rates_hz: situation.rates(&rules, cell_m)? });
        // First pass with coarse steps.
        let coarse = (0..STEPS).map(|step| trial(FIRST_SIDE_M * STEP.powi(step)));
        let mut trials = coarse.collect::<Result<Vec<Trial>, SettingError>>()?;
        let middle = best_of(&trials, &COMPARED).map_or(FIRST_SIDE_M, |best| best.cell_m);
        // Second pass around the best side.
        for factor in [0.96, 0.98, 1.02, 1.04] {
            trials.push(trial(middle * factor)?);
        }
        let best = best_of(&trials, &COMPARED).copied().unwrap_or(Trial { cell_m: f64::NAN, rates_hz: [f64::NAN; 4] });
        // Cross-validation: predict each rate from the other two.
        let misses = COMPARED.map(|memory| {
            let chosen = best_of(&trials, &others(memory));
            chosen.map_or(f64::NAN, |chosen| chosen.error_percent(&[memory]).powi(2))
        });
        let left_out_percent = (misses.iter().sum::<f64>() / COMPARED.len() as f64).sqrt();
        Ok(Self { rules, situation, error_percent: best.error_percent(&COMPARED), best, left_out_percent, trials })
    }
}

/// Returns the indices of all memories whose update rates are compared with the paper CPR05, except `memory`.
fn others(memory: usize) -> Vec<usize> {
    COMPARED.into_iter().filter(|other| *other != memory).collect()
}

/// Returns the trial with the smallest error over the memories `memories`. Of several trials with equal errors, returns
/// the first.
fn best_of<'a>(trials: &'a [Trial], memories: &[usize]) -> Option<&'a Trial> {
    trials.iter().min_by(|a, b| a.error_percent(memories).total_cmp(&b.error_percent(memories)))
}

impl Interpretations {
    /// Simulates each set of rules in each situation of [`Situation::ALL`]: a hall with one path. After a stop, the
    /// ranking has the sets of rules that were finished.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`policy_rates_hz`].
    pub fn run(watcher: &mut dyn Watcher) -> Result<Self, SettingError> {
        let all = Rules::all();
        let runs = (all.len() * Situation::ALL.len()) as u64;
        let mut ranked = Vec::new();
        let stop = watcher.stop();
        // Try each set of rules in every situation.
        for rules in all.into_iter().take_while(|_| !stop.is_stopped()) {
            let mut tried = Vec::new();
            for situation in Situation::ALL {
                tried.push(Tried::of(rules, situation)?);
                watcher.progress((ranked.len() * Situation::ALL.len() + tried.len()) as u64, runs);
            }
            // Average over the situations, because the paper's path and hall are unknown.
            let mean = |value: fn(&Tried) -> f64| tried.iter().map(value).sum::<f64>() / tried.len() as f64;
            let mean_error_percent = mean(|tried| tried.error_percent);
            let mean_left_out_percent = mean(|tried| tried.left_out_percent);
            ranked.push(RankedRules { rules, mean_error_percent, mean_left_out_percent, tried });
        }
        // Rank the rules, then cross-validate.
        ranked.sort_by(|a, b| a.mean_left_out_percent.total_cmp(&b.mean_left_out_percent));
        let left_out = COMPARED.into_iter().filter_map(|memory| left_out(&ranked, memory)).collect();
        Ok(Self { ranked, left_out })
    }

    /// Returns the rules of this project with their rank, counted from 1.
    pub fn usual(&self) -> Option<(usize, &RankedRules)> {
        (1..).zip(&self.ranked).find(|(_, ranked)| ranked.rules == Rules::USUAL)
    }
}

fn left_out(ranked: &[RankedRules], memory: usize) -> Option<LeftOutRate> {
    let others = others(memory);
    let best = |tried: &Tried| best_of(&tried.trials, &others).copied();
    let all = ranked.iter().flat_map(|ranked| &ranked.tried).filter_map(|tried| Some((tried, best(tried)?)));
    let (tried, trial) = all.min_by(|(_, a), (_, b)| a.error_percent(&others).total_cmp(&b.error_percent(&others)))?;
    let Tried { rules, situation, .. } = *tried;
    Some(LeftOutRate { memory, rules, situation, trial, error_percent: 100.0 * trial.miss(memory) })
}

/// Angle of a pixel of the display in degrees, averaged over a line of pixels.
pub const PIXEL_DEG: f64 = 60.0 / 640.0;
/// Angle of a texel of an ideal face in degrees, averaged over an edge of the face.
const TEXEL_DEG: f64 = 90.0 / 512.0;

/// A threshold of the image error, and the cell side and the tears (gaps between memories) that result from this
/// threshold. The product of threshold and cell side is fixed, because it fits the update rates in table 1 of the paper
/// CPR05.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ThresholdRow {
    /// The threshold of the image error as text, in pixels of the display or texels of an ideal face.
    pub threshold: &'static str,
    pub theta_deg: f64,
    pub cell_m: f64,
    /// Widest tear (gap between two memories) if each update is shown in the frame in which the update is due, in
    /// pixels of the display.
    pub at_once_px: f64,
    /// Widest tear (gap between two memories), in pixels of the display, if the less often drawn memory is shown one
    /// frame too late.
    pub frame_late_px: f64,
}

/// Returns the rows of several thresholds, which are given in pixels or texels. `fitted_cell_m` is the cell side that
/// fits table 1 of the paper CPR05 at the default threshold.
pub fn threshold_rows(fitted_cell_m: f64) -> Vec<ThresholdRow> {
    let product = fitted_cell_m * PriorityTiming::PAPERS.theta_deg;
    let row = |(threshold, theta_deg): (&'static str, f64)| {
        let cell_m = product / theta_deg;
        // The nearest border between memories is one side of a cell away.
        let frame_deg = (1.0 / PriorityTiming::PAPERS.frame_hz / cell_m).to_degrees();
        let [at_once_px, frame_late_px] = [theta_deg, theta_deg + frame_deg].map(|angle| angle / PIXEL_DEG);
        ThresholdRow { threshold, theta_deg, cell_m, at_once_px, frame_late_px }
    };
    let rows = [
        ("1 pixel", PIXEL_DEG),
        ("1 texel", TEXEL_DEG),
        ("2 pixels", 2.0 * PIXEL_DEG),
        ("2 texels", 2.0 * TEXEL_DEG),
        ("5 pixels", 5.0 * PIXEL_DEG),
        ("3 texels", 3.0 * TEXEL_DEG),
        ("5 texels", 5.0 * TEXEL_DEG),
    ];
    rows.map(row).to_vec()
}

/// Scale of the gallery in the experiments. The scaled gallery is 20 m wide: eight cells of 2.5 m. The gallery then has
/// 191 segments (parts of objects in one cell). The two rows of table 2 of the paper CPR05 have 183 and 213 segments.
const HALL_SCALE: f64 = 0.5;

pub(crate) fn gallery() -> Result<(Scene, Walk), SettingError> {
    let scene = builtin("gallery")?;
    let scene = scaled(&scene, HALL_SCALE)?;
    let path = path_of(&scene, Route::Scene)?;
    Ok((scene, path))
}
