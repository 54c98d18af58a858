//! Ranks all interpretations of the papers by their agreement with the published figures.

use super::FIGURES;
use super::fit::{Fit, half_a_digit};
use crate::figures::{Bench, Interpretation};
use crate::parallel;
use pxpl5_run::{ExperimentError, Level};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};

/// Test of the interpretations on one published figure (leave-one-out cross-validation).
///
/// An interpretation is a set of answers to the questions that the papers leave open. The interpretation that fits all
/// other published figures best predicts the value of this figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeaveOneOut {
    /// Number of the figure in ACCURACY.md.
    pub id: &'static str,
    /// Interpretation with the smallest mean error over all other figures.
    pub chosen: Interpretation,
    /// The interpretation `chosen` in words.
    pub words: String,
    /// Relative error in percent of the figure under the interpretation `chosen`.
    pub error_percent: f64,
}

/// Ranking of all interpretations of the papers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Interpretations {
    /// Name and version of the JSON layout.
    pub schema: &'static str,
    /// Fits of all interpretations at the analytic level, by ascending mean error.
    pub analytic: Vec<Fit>,
    /// Fits of the best interpretations at the transaction level, by ascending mean error.
    pub transaction: Vec<Fit>,
    /// Prediction of each figure by the interpretation that fits all other figures best, at the analytic level.
    pub left_out: Vec<LeaveOneOut>,
    /// Number of interpretations with the same mean error as the best interpretation, within the printed digits.
    pub as_good: usize,
    /// Part of a mean error, in percent, that the rounding of printed digits can explain.
    pub rounding_percent: f64,
}

/// Ranks all interpretations at the analytic level, with the numbers of seeds and frames in `bench`. The first `best`
/// interpretations are then simulated at the transaction level. Calls `finished` with the number of finished runs and
/// the number of all runs.
///
/// # Errors
///
/// Fails in the same cases as [`Bench::measure`].
pub fn run(bench: &Bench, best: usize, finished: impl Fn(u64, u64) + Sync) -> Result<Interpretations, ExperimentError> {
    let interpretations = Interpretation::all();
    let best = best.min(interpretations.len());
    let steps = (interpretations.len() + best) as u64;
    let done = AtomicU64::new(0);
    let step = || finished(done.fetch_add(1, Ordering::Relaxed) + 1, steps);
    // The same steps serve both levels.
    let fits = |level: Level, interpretations: &[Interpretation]| {
        let bench = Bench { level, ..bench.clone() };
        let of_group = |group: &Vec<Interpretation>| {
            let fit = |interpretation: &Interpretation| {
                let fit = Fit::of(&bench, *interpretation);
                step();
                fit
            };
            group.iter().map(fit).collect::<Result<Vec<_>, _>>()
        };
        let fits = parallel::map(&groups(interpretations), of_group);
        fits.into_iter().collect::<Result<Vec<_>, _>>().map(|fits| ranked(fits.concat()))
    };
    let analytic = fits(Level::Analytic, &interpretations)?;
    // Only the best interpretations are simulated with all events, which takes long.
    let chosen: Vec<Interpretation> = analytic.iter().take(best).map(|fit| fit.interpretation).collect();
    let transaction = fits(Level::Transaction, &chosen)?;
    let rounding_percent = rounding_percent(&analytic);
    let least = analytic.first().map_or(f64::NAN, |fit| fit.mean_error_percent);
    // Errors within the rounding of printed digits are indistinguishable.
    let as_good = analytic.iter().filter(|fit| fit.mean_error_percent <= least + rounding_percent).count();
    let left_out = FIGURES.iter().filter_map(|id| left_out(&analytic, id)).collect();
    Ok(Interpretations {
        schema: "pxpl5-interpretations/1",
        analytic,
        transaction,
        left_out,
        as_good,
        rounding_percent,
    })
}

/// Groups the interpretations that differ at most in the number of regions in a backing store. Each group begins with
/// the interpretation with the fewest regions. If no backing store is ever full in the run of this interpretation, the
/// result also holds for the rest of the group.
fn groups(interpretations: &[Interpretation]) -> Vec<Vec<Interpretation>> {
    let mut groups: BTreeMap<Interpretation, Vec<Interpretation>> = BTreeMap::new();
    for interpretation in interpretations {
        let Interpretation { samples, fields, kept, .. } = Interpretation::USUAL;
        groups.entry(Interpretation { samples, fields, kept, ..*interpretation }).or_default().push(*interpretation);
    }
    let mut groups: Vec<Vec<Interpretation>> = groups.into_values().collect();
    groups.iter_mut().for_each(|group| group.sort_by_key(|interpretation| interpretation.kept));
    groups
}

fn ranked(mut fits: Vec<Fit>) -> Vec<Fit> {
    fits.sort_by(|a, b| {
        a.mean_error_percent.total_cmp(&b.mean_error_percent).then(a.interpretation.cmp(&b.interpretation))
    });
    fits
}

fn left_out(fits: &[Fit], id: &'static str) -> Option<LeaveOneOut> {
    let chosen = fits.iter().min_by(|a, b| a.mean_error_without(id).total_cmp(&b.mean_error_without(id)))?;
    let figure = chosen.figures.iter().find(|figure| figure.id == id)?;
    Some(LeaveOneOut {
        id,
        chosen: chosen.interpretation,
        words: chosen.words.clone(),
        error_percent: figure.error_percent,
    })
}

/// Returns the mean rounding error of the figures in percent. The rounding error of a figure is half of its last digit,
/// with three printed digits.
fn rounding_percent(fits: &[Fit]) -> f64 {
    let published = fits.first().into_iter().flat_map(|fit| &fit.figures).map(|figure| figure.published);
    let halves: Vec<f64> = published.map(|value| 100.0 * half_a_digit(value) / value).collect();
    halves.iter().sum::<f64>() / halves.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests that the fit of an interpretation is the same with a shared cache of runs and with an empty cache.
    #[test]
    fn sharing_runs_among_interpretations_changes_no_fit() {
        let shared = Bench::new(Level::Analytic).with_mig(1, 12);
        for interpretation in Interpretation::all().into_iter().step_by(67) {
            let alone = Bench::new(Level::Analytic).with_mig(1, 12);
            let [one, other] = [&shared, &alone].map(|bench| Fit::of(bench, interpretation).expect("it runs"));
            assert_eq!(serde_json::to_string(&one).ok(), serde_json::to_string(&other).ok(), "{}", one.words);
        }
    }
}
