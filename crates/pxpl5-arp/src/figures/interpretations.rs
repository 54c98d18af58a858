//! What the paper leaves open about table 1: each interpretation is run and ranked.
//!
//! Rates depend on the product of threshold and side of a cell alone, if hall and path are measured in cells. So one number is fitted
//! to three rates, and a side stands for all pairs of a threshold and a side with the same product.

use super::fit::{RATES_HZ, policy_rates_hz, rates_hz};
use super::gallery::gallery;
use super::rules::Rules;
use crate::error::ExperimentError;
use crate::walk::at_frames;
use glam::DVec3;
use priority_rendering::{Cell, PriorityTiming};
use serde::Serialize;
use tracking::motion::Walk;

/// A hall and a path through it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Situation {
    /// Straight through the middle of a hall of seven cells by seven.
    Straight,
    /// From corner to corner of the same hall.
    Diagonal,
    /// Once around the middle of the same hall, halfway to its walls.
    Round,
    /// The gallery of 20 m and its path, one minute.
    Gallery,
}

/// Cells along a side of the hall of all situations but the gallery.
const CELLS_ACROSS: i64 = 7;

/// Frames of the walk through the gallery.
const GALLERY_FRAMES: u64 = 3_600;

impl Situation {
    /// All situations.
    pub const ALL: [Self; 4] = [Self::Straight, Self::Diagonal, Self::Round, Self::Gallery];

    /// As a heading of a table.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Straight => "straight, 7 cells",
            Self::Diagonal => "diagonal, 7 cells",
            Self::Round => "round, 7 cells",
            Self::Gallery => "gallery, 20 m",
        }
    }

    /// Corners of the path, in cells.
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

    /// Updates a second of each memory on a walk of a metre a second.
    fn rates(self, rules: &Rules, cell_m: f64) -> Result<[f64; 4], ExperimentError> {
        let numbers = rules.numbers(cell_m);
        let rates = if self == Self::Gallery {
            let (scene, path) = gallery()?;
            policy_rates_hz(&scene, &path, &numbers, rules.has_cascade, GALLERY_FRAMES)?
        } else {
            let corners: Vec<DVec3> = self.corners().iter().map(|[x, z]| DVec3::new(*x, 0.0, *z) * cell_m).collect();
            let path = Walk::new(&corners, 1.0)?;
            // A walk between two corners leads back to the first one. Only the way there is walked.
            let way_m = if self == Self::Round { path.length_m() } else { path.length_m() / 2.0 };
            let cells = (0..CELLS_ACROSS).flat_map(|x| (0..CELLS_ACROSS).map(move |z| Cell { x, z }));
            let frames = (way_m * numbers.frame_hz) as u64;
            rates_hz(cells, at_frames(&path, 1.0, numbers.frame_hz), &numbers, rules.has_cascade, frames)
        };
        Ok([0, 1, 2, 3].map(|memory| rates[memory]))
    }
}

/// Rates with a side of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// Side of a cell, m, for the usual threshold.
    pub cell_m: f64,
    /// Updates a second of memories 0 to 3.
    pub rates_hz: [f64; 4],
}

impl Trial {
    /// Root mean square of the relative errors of some memories, percent.
    #[must_use]
    pub fn error_percent(&self, memories: &[usize]) -> f64 {
        let squares = memories.iter().map(|memory| self.miss(*memory).powi(2)).sum::<f64>();
        100.0 * (squares / memories.len() as f64).sqrt()
    }

    fn miss(&self, memory: usize) -> f64 {
        self.rates_hz[memory] / RATES_HZ[memory] - 1.0
    }
}

/// Memories whose rates are compared: memory 0 is drawn in every frame by all rules.
const COMPARED: [usize; 3] = [1, 2, 3];

/// Rules in a situation, with every side that was tried.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tried {
    /// The rules.
    pub rules: Rules,
    /// Hall and path.
    pub situation: Situation,
    /// Sides that were tried.
    #[serde(skip)]
    pub trials: Vec<Trial>,
    /// The one with the least error of all three rates.
    pub best: Trial,
    /// Its error, percent.
    pub error_percent: f64,
    /// Error of each rate as predicted with the side that fits the other two best, root mean square, percent.
    pub left_out_percent: f64,
}

/// Rules over all situations.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RankedRules {
    /// The rules.
    pub rules: Rules,
    /// Mean of the errors in all situations, percent.
    pub mean_error_percent: f64,
    /// Mean of the errors of what is left out, percent.
    pub mean_left_out_percent: f64,
    /// In each situation.
    pub tried: Vec<Tried>,
}

/// A rate that was left out, predicted by what fits the other two best.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftOutRate {
    /// The memory whose rate was left out.
    pub memory: usize,
    /// The rules that fit the others best.
    pub rules: Rules,
    /// Hall and path of that fit.
    pub situation: Situation,
    /// Side of a cell of that fit.
    pub trial: Trial,
    /// Error of the rate that was left out, percent.
    pub error_percent: f64,
}

/// All interpretations, the best first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Interpretations {
    /// Rules by their mean error.
    pub ranked: Vec<RankedRules>,
    /// Each of three rates left out in turn, rules, hall and path chosen by the other two.
    pub left_out: Vec<LeftOutRate>,
}

/// Sides that are tried first: from 1.4 m on, each 1.06 times the one before.
const FIRST_SIDE_M: f64 = 1.4;
const STEP: f64 = 1.06;
const STEPS: i32 = 20;

impl Tried {
    /// Tries all sides, and then four more around the best.
    ///
    /// # Errors
    ///
    /// As [`policy_rates_hz`].
    pub fn of(rules: Rules, situation: Situation) -> Result<Self, ExperimentError> {
        let trial = |cell_m| Ok(Trial { cell_m, rates_hz: situation.rates(&rules, cell_m)? });
        let coarse = (0..STEPS).map(|step| trial(FIRST_SIDE_M * STEP.powi(step)));
        let mut trials = coarse.collect::<Result<Vec<Trial>, ExperimentError>>()?;
        let middle = best_of(&trials, &COMPARED).map_or(FIRST_SIDE_M, |best| best.cell_m);
        for factor in [0.96, 0.98, 1.02, 1.04] {
            trials.push(trial(middle * factor)?);
        }
        let best = best_of(&trials, &COMPARED).copied().unwrap_or(Trial { cell_m: f64::NAN, rates_hz: [f64::NAN; 4] });
        let misses = COMPARED.map(|memory| {
            let chosen = best_of(&trials, &others(memory));
            chosen.map_or(f64::NAN, |chosen| chosen.error_percent(&[memory]).powi(2))
        });
        let left_out_percent = (misses.iter().sum::<f64>() / COMPARED.len() as f64).sqrt();
        Ok(Self { rules, situation, error_percent: best.error_percent(&COMPARED), best, left_out_percent, trials })
    }
}

/// The compared memories but one.
fn others(memory: usize) -> Vec<usize> {
    COMPARED.into_iter().filter(|other| *other != memory).collect()
}

/// The trial with the least error of some memories, the first on ties.
fn best_of<'a>(trials: &'a [Trial], memories: &[usize]) -> Option<&'a Trial> {
    trials.iter().min_by(|a, b| a.error_percent(memories).total_cmp(&b.error_percent(memories)))
}

impl Interpretations {
    /// Runs all rules in all situations; `finished` hears how many of them are done.
    ///
    /// # Errors
    ///
    /// As [`policy_rates_hz`].
    pub fn run(finished: impl Fn(u64, u64)) -> Result<Self, ExperimentError> {
        let all = Rules::all();
        let runs = (all.len() * Situation::ALL.len()) as u64;
        let mut ranked = Vec::new();
        for rules in all {
            let mut tried = Vec::new();
            for situation in Situation::ALL {
                tried.push(Tried::of(rules, situation)?);
                finished((ranked.len() * Situation::ALL.len() + tried.len()) as u64, runs);
            }
            let mean = |value: fn(&Tried) -> f64| tried.iter().map(value).sum::<f64>() / tried.len() as f64;
            let mean_error_percent = mean(|tried| tried.error_percent);
            let mean_left_out_percent = mean(|tried| tried.left_out_percent);
            ranked.push(RankedRules { rules, mean_error_percent, mean_left_out_percent, tried });
        }
        ranked.sort_by(|a, b| a.mean_error_percent.total_cmp(&b.mean_error_percent));
        let left_out = COMPARED.into_iter().filter_map(|memory| left_out(&ranked, memory)).collect();
        Ok(Self { ranked, left_out })
    }

    /// The rules of this project, and their place from 1 among those with or without cascade as they are.
    #[must_use]
    pub fn usual(&self) -> Option<(usize, &RankedRules)> {
        let alike = self.ranked.iter().filter(|ranked| ranked.rules.has_cascade == Rules::USUAL.has_cascade);
        (1..).zip(alike).find(|(_, ranked)| ranked.rules == Rules::USUAL)
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

/// Angle of a pixel of the display, mean over a line, and of a texel of an ideal face, degrees.
pub const PIXEL_DEG: f64 = 60.0 / 640.0;
const TEXEL_DEG: f64 = 90.0 / 512.0;

/// A threshold, and what follows from it with the product of threshold and side that fits table 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ThresholdRow {
    /// The threshold as text, in pixels of the display or in texels of an ideal face.
    pub threshold: &'static str,
    /// The same in degrees.
    pub theta_deg: f64,
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Widest tear where pictures are shown as they become due, pixels of the display.
    pub at_once_px: f64,
    /// Widest tear where the slower memory is one frame of a walker's way late, pixels of the display.
    pub frame_late_px: f64,
}

/// Thresholds in pixels of the display or in texels, with the side that was fitted for the usual threshold.
#[must_use]
pub fn threshold_rows(fitted_cell_m: f64) -> Vec<ThresholdRow> {
    let product = fitted_cell_m * PriorityTiming::PAPERS.theta_deg;
    let row = |(threshold, theta_deg): (&'static str, f64)| {
        let cell_m = product / theta_deg;
        // The nearest border between memories is as far away as a cell is long.
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
