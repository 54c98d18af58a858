//! The fit of one interpretation of the papers to the published figures.

use super::figures;
use crate::error::StudyError;
use crate::figures::{DEVIATION, FigureSettings, Interpretation, Measurement};
use serde::Serialize;

/// Agreement of one published figure with the model under one interpretation of the papers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FigureFit {
    /// Number of the figure in ACCURACY.md.
    pub id: &'static str,
    /// Value printed in the paper, in `unit`.
    pub published: f64,
    /// Value of the model, in `unit`.
    pub simulated: f64,
    /// Unit of the published and the simulated value.
    pub unit: &'static str,
    /// Relative error in percent: (simulated - published) / published. The error is 0 within a printed range.
    pub error_percent: f64,
    /// Printed standard deviation of the samples, if the paper prints one.
    pub published_sd: Option<f64>,
    /// Standard deviation of the simulated samples, if the paper prints a standard deviation.
    pub simulated_sd: Option<f64>,
}

/// Agreement of all published figures with the model under one interpretation of the papers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// The interpretation: one answer to each open question of the papers.
    pub interpretation: Interpretation,
    /// The interpretation in words.
    pub words: String,
    /// Fit of each figure of [`figures`](super::figures).
    pub figures: Vec<FigureFit>,
    /// Mean of the figures' absolute errors in percent.
    pub mean_error_percent: f64,
    /// Largest absolute error of a figure in percent.
    pub greatest_error_percent: f64,
    /// Logarithm of the likelihood of the printed means and standard deviations, up to a constant
    /// ([`FigureFit::log_likelihood`]).
    pub log_likelihood: f64,
    /// Numbers of the figures that the interpretation does not explain. Their errors exceed 8 %, or their standard
    /// deviations differ by more than a quarter.
    pub unexplained: Vec<&'static str>,
}

/// Largest error in percent at which an interpretation still explains a mean. This project chose the limit.
const EXPLAINED_PERCENT: f64 = 8.0;

/// Largest relative error at which an interpretation still explains a standard deviation.
const EXPLAINED_SD: f64 = 0.25;

/// Relative uncertainty of the model itself, because some of its clocks and costs are not in any paper.
const DISCREPANCY: f64 = 0.02;

/// Number of samples behind the papers' printed means. The printed mean is 4.47 fields with a standard deviation of
/// 0.502. Samples of 4 or 5 fields have these values only if there are 67 to 119 samples.
const SAMPLES: f64 = 87.0;

impl FigureFit {
    fn new(settings: &FigureSettings, figure: &Measurement) -> Result<Self, StudyError> {
        let measured = figure.value(settings)?;
        let sd = measured.detail(DEVIATION);
        let off = measured.value - figure.value;
        // A printed range counts as exact within its bounds.
        let beyond = off.signum() * (off.abs() - figure.range.unwrap_or(0.0)).max(0.0);
        Ok(Self {
            id: figure.id,
            published: figure.value,
            simulated: measured.value,
            unit: figure.unit,
            error_percent: 100.0 * beyond / figure.value,
            published_sd: figure.deviation,
            simulated_sd: sd.filter(|_| figure.deviation.is_some()),
        })
    }

    /// Returns the logarithm of the likelihood of the figure's printed values.
    ///
    /// The error of the mean has a normal distribution. Its variance has three parts: the printed digits, the error of
    /// a mean of 87 samples, and 2 % for the model. The logarithm of the ratio of the simulated to the published
    /// standard deviation has a normal distribution. The standard deviation of this distribution is 0.25.
    pub fn log_likelihood(&self) -> f64 {
        let of_samples = self.published_sd.map_or(0.0, |sd| sd / SAMPLES.sqrt());
        // Three independent errors of the mean.
        let sigma = of_samples.hypot(DISCREPANCY * self.published).hypot(half_a_digit(self.published));
        let of_mean = -0.5 * (self.error_percent / 100.0 * self.published / sigma).powi(2);
        let ratio =
            self.published_sd.zip(self.simulated_sd).map(|(published, simulated)| simulated.max(1e-3) / published);
        of_mean - ratio.map_or(0.0, |ratio| 0.5 * (ratio.ln() / EXPLAINED_SD).powi(2))
    }

    fn is_explained(&self) -> bool {
        let sds = self.published_sd.zip(self.simulated_sd);
        let is_sd = sds.is_none_or(|(published, simulated)| (simulated / published - 1.0).abs() <= EXPLAINED_SD);
        self.error_percent.abs() <= EXPLAINED_PERCENT && is_sd
    }
}

impl Fit {
    /// Measures all figures under an interpretation of the papers.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`FigureSettings::measure`].
    pub fn of(settings: &FigureSettings, interpretation: Interpretation) -> Result<Self, StudyError> {
        let settings = FigureSettings { interpretation, ..settings.clone() };
        let figures = figures().map(|figure| FigureFit::new(&settings, figure)).collect::<Result<Vec<_>, _>>()?;
        Ok(Self {
            interpretation,
            words: interpretation.to_string(),
            mean_error_percent: mean(&figures),
            greatest_error_percent: figures.iter().map(|figure| figure.error_percent.abs()).fold(0.0, f64::max),
            log_likelihood: figures.iter().map(FigureFit::log_likelihood).sum(),
            unexplained: figures.iter().filter(|figure| !figure.is_explained()).map(|figure| figure.id).collect(),
            figures,
        })
    }

    /// Returns the logarithm of the likelihood of the printed values of all figures except `id`.
    pub fn log_likelihood_without(&self, id: &str) -> f64 {
        self.figures.iter().filter(|figure| figure.id != id).map(FigureFit::log_likelihood).sum()
    }
}

/// Returns half of the last digit of a value with three printed digits.
fn half_a_digit(value: f64) -> f64 {
    0.5 * 10f64.powf(value.log10().floor() - 2.0)
}

fn mean(figures: &[FigureFit]) -> f64 {
    figures.iter().map(|figure| figure.error_percent.abs()).sum::<f64>() / figures.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXACT: FigureFit = FigureFit {
        id: "7",
        published: 4.0,
        simulated: 4.0,
        unit: "fields",
        error_percent: 0.0,
        published_sd: Some(0.5),
        simulated_sd: Some(0.5),
    };

    #[test]
    fn the_likelihood_of_a_figure_follows_from_its_error_and_three_deviations() {
        assert_eq!(EXACT.log_likelihood(), 0.0);
        let off = FigureFit { simulated: 4.2, error_percent: 5.0, ..EXACT };
        // The error of 0.2 is divided by three deviations: 0.5 / sqrt(87), a fiftieth of 4, and half of a hundredth.
        let expected = -0.5 * (0.2f64.powi(2) / (0.25 / 87.0 + 0.0064 + 0.000_025));
        assert!((off.log_likelihood() - expected).abs() < 1e-12);
        assert!(off.is_explained() && !FigureFit { simulated_sd: Some(0.0), ..EXACT }.is_explained());
        assert!(!FigureFit { error_percent: -8.1, ..EXACT }.is_explained());
    }
}
