//! Ranks all interpretations of the papers by their agreement with the published figures.

use super::figures;
use super::fit::Fit;
use crate::error::StudyError;
use crate::estimate::{BUSY, Estimate};
use crate::figures::{FigureSettings, Interpretation};
use crate::parallel;
use crate::study::Study;
use pxpl5_run::{ExperimentError, Level};
use pxpl5_sim::{SharedWatcher, Watcher};
use serde::Serialize;
use std::collections::BTreeMap;

/// Test of the interpretations on one published figure (leave-one-out cross-validation).
///
/// An interpretation is a set of answers to the questions that the papers leave open. The interpretation under which all
/// other published figures are likeliest predicts the value of this figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeaveOneOut {
    /// Number of the figure in ACCURACY.md.
    pub id: &'static str,
    /// Interpretation under which all other figures are likeliest.
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
    /// Fits of all interpretations at the analytic level, the likeliest first.
    pub analytic: Vec<Fit>,
    /// Fits at the transaction level, the likeliest first: the interpretations that the analytic level finds likeliest,
    /// and the interpretation of this project. The analytic level alone cannot rank them, because its error is larger
    /// than the distance of some latencies to the next retrace.
    pub transaction: Vec<Fit>,
    /// Prediction of each figure by the interpretation under which all other figures are likeliest.
    pub left_out: Vec<LeaveOneOut>,
}

/// Ratio of two likelihoods up to which the figures do not tell two interpretations apart. A ratio below the root of 10
/// is not worth more than a bare mention (Jeffreys 1961).
pub const ALIKE: f64 = 3.162_277_66;

impl Interpretations {
    /// Returns the ranking at the most exact level that was simulated.
    pub fn ranked(&self) -> &[Fit] {
        if self.transaction.is_empty() { &self.analytic } else { &self.transaction }
    }

    /// Returns the interpretations that the figures do not tell apart from the likeliest ([`ALIKE`]).
    pub fn alike(&self) -> &[Fit] {
        let ranked = self.ranked();
        let least = ranked.first().map_or(0.0, |fit| fit.log_likelihood) - ALIKE.ln();
        &ranked[..ranked.partition_point(|fit| fit.log_likelihood >= least)]
    }
}

/// A ranking of all interpretations.
#[derive(Clone, Debug)]
pub struct InterpretationQuery {
    /// Settings of all measurements, with the numbers of seeds and frames of a fly-through.
    pub settings: FigureSettings,
    /// Number of likeliest interpretations that are also simulated with events, besides that of this project.
    pub best: usize,
}

/// CPU seconds to rank all interpretations with one frame of an application scene, on one core of 3 GHz with the build
/// profile `dist`.
const FRAME_S: f64 = 0.0172;
/// Additional time for each interpretation that is also simulated with events, as a fraction of the time to rank all
/// interpretations.
const BEST: f64 = 0.1;
/// Peak memory in bytes with two threads, rounded up.
const BYTES: f64 = 60e6;

impl Study for InterpretationQuery {
    type Report = Interpretations;

    fn estimate(&self, threads: usize) -> Estimate {
        let FigureSettings { seeds, frames, .. } = self.settings;
        // The scene "mig" has all seeds, "molecules" a third of the seeds, and "head" a fifth.
        let frames = frames * (seeds + seeds.div_ceil(3) + seeds.div_ceil(5));
        let seconds = FRAME_S * frames as f64 * (1.0 + BEST * self.best as f64);
        Estimate { bytes: BYTES, seconds: BUSY * seconds / threads.max(1) as f64 }
    }

    /// Ranks all interpretations at the analytic level, and then the likeliest at the transaction level.
    fn run(&self, watcher: &mut dyn Watcher) -> Result<Interpretations, StudyError> {
        let interpretations = Interpretation::all();
        let best = self.best.min(interpretations.len());
        let watcher = SharedWatcher::new(watcher, (interpretations.len() + best) as u64 + u64::from(best > 0));
        let settings = FigureSettings { stop: watcher.stop(), ..self.settings.clone() };
        // The same steps serve both levels.
        let fits = |level: Level, interpretations: &[Interpretation]| {
            let settings = FigureSettings { level, ..settings.clone() };
            let of_group = |group: &Vec<Interpretation>| {
                let fit = |interpretation: &Interpretation| watcher.part(|| Fit::of(&settings, *interpretation));
                group.iter().map(fit).collect::<Result<Vec<_>, _>>()
            };
            let fits = parallel::map(&groups(interpretations), of_group);
            fits.into_iter().collect::<Result<Vec<_>, _>>().map(|fits| ranked(fits.concat()))
        };
        let analytic = fits(Level::Analytic, &interpretations)?;
        // Only the likeliest interpretations are simulated with all events, which takes long.
        let mut chosen: Vec<Interpretation> = analytic.iter().take(best).map(|fit| fit.interpretation).collect();
        if best > 0 && !chosen.contains(&Interpretation::USUAL) {
            chosen.push(Interpretation::USUAL);
        }
        let transaction = match fits(Level::Transaction, &chosen) {
            // The ranking at the analytic level is a result of its own.
            Err(StudyError::Experiment(ExperimentError::Stopped(_))) => Vec::new(),
            fits => fits?,
        };
        let mut ranking =
            Interpretations { schema: "pxpl5-interpretations/2", analytic, transaction, left_out: Vec::new() };
        ranking.left_out = figures().filter_map(|figure| left_out(ranking.ranked(), figure.id)).collect();
        Ok(ranking)
    }
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
    fits.sort_by(|a, b| b.log_likelihood.total_cmp(&a.log_likelihood).then(a.interpretation.cmp(&b.interpretation)));
    fits
}

fn left_out(fits: &[Fit], id: &'static str) -> Option<LeaveOneOut> {
    let chosen = fits.iter().max_by(|a, b| a.log_likelihood_without(id).total_cmp(&b.log_likelihood_without(id)))?;
    let figure = chosen.figures.iter().find(|figure| figure.id == id)?;
    Some(LeaveOneOut {
        id,
        chosen: chosen.interpretation,
        words: chosen.words.clone(),
        error_percent: figure.error_percent,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests that the fit of an interpretation is the same with a shared cache of runs and with an empty cache.
    #[test]
    fn sharing_runs_among_interpretations_changes_no_fit() {
        let shared = FigureSettings::new(Level::Analytic).with_mig(1, 12);
        for interpretation in Interpretation::all().into_iter().step_by(67) {
            let alone = FigureSettings::new(Level::Analytic).with_mig(1, 12);
            let [one, other] = [&shared, &alone].map(|settings| Fit::of(settings, interpretation).expect("it runs"));
            assert_eq!(serde_json::to_string(&one).ok(), serde_json::to_string(&other).ok(), "{}", one.words);
        }
    }
}
