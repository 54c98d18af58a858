//! How well one reading explains the figures.

use super::FIGURES;
use crate::figures::{Bench, Figure, Reading};
use pxpl5_run::ExperimentError;
use serde::Serialize;

/// What a reading makes of one figure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FitOfFigure {
    /// Number of the figure.
    pub id: &'static str,
    /// The value that the paper prints.
    pub published: f64,
    /// The model's value.
    pub simulated: f64,
    /// Unit of both.
    pub unit: &'static str,
    /// (simulated - published) / published, in percent; 0 within a printed range.
    pub error_percent: f64,
    /// The deviation that the paper prints, of figures whose samples vary.
    pub published_sd: Option<f64>,
    /// The deviation of the samples.
    pub simulated_sd: Option<f64>,
}

/// What a reading makes of all figures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// The reading, as a value and in words.
    pub reading: Reading,
    /// The same in words.
    pub words: String,
    /// Each figure, in the order of [`FIGURES`].
    pub figures: Vec<FitOfFigure>,
    /// Mean of the absolute errors, percent.
    pub mean_error_percent: f64,
    /// The greatest of them.
    pub greatest_error_percent: f64,
    /// Logarithm of the likelihood of the printed means and deviations, up to a constant; see [`FitOfFigure::log_likelihood`].
    pub log_likelihood: f64,
    /// Figures that it does not explain: off by more than 8 %, or a deviation off by more than a quarter.
    pub unexplained: Vec<&'static str>,
}

/// Error of a mean that is still an explanation, percent (the project\'s own bound).
const EXPLAINED_PERCENT: f64 = 8.0;

/// The same of a deviation, as a ratio less 1.
const EXPLAINED_SD: f64 = 0.25;

/// What the model may be wrong besides, as a part of a mean: clocks and costs that no paper gives.
const DISCREPANCY: f64 = 0.02;

/// Samples of the papers\' means with a deviation: 4.47 with 0.502 are samples of 4 and 5 only if there were 67 to 119.
const SAMPLES: f64 = 87.0;

/// Deviations of an application scene: those that the paper prints.
fn published_sd(figure: &Figure) -> Option<f64> {
    ["7", "7b", "7c"].contains(&figure.id).then_some(figure.spread).flatten()
}

impl FitOfFigure {
    fn new(bench: &Bench, figure: &Figure) -> Result<Self, ExperimentError> {
        let measured = bench.measure(figure.id)?;
        let published_sd = published_sd(figure);
        let sd = measured.details.iter().find(|detail| detail.name == "standard deviation").map(|detail| detail.value);
        let off = measured.value - figure.value;
        let range = figure.spread.filter(|_| published_sd.is_none()).unwrap_or(0.0);
        let beyond = off.signum() * (off.abs() - range).max(0.0);
        Ok(Self {
            id: figure.id,
            published: figure.value,
            simulated: measured.value,
            unit: figure.unit,
            error_percent: 100.0 * beyond / figure.value,
            published_sd,
            simulated_sd: sd.filter(|_| published_sd.is_some()),
        })
    }

    /// Of a normal error of the mean (the printed digits, the error of a mean of so many samples, and a fiftieth for what the model does
    /// not know), and of the logarithm of the deviations\' ratio (a quarter).
    #[must_use]
    pub fn log_likelihood(&self) -> f64 {
        let of_samples = self.published_sd.map_or(0.0, |sd| sd / SAMPLES.sqrt());
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
    /// Measures all figures with a reading.
    ///
    /// # Errors
    ///
    /// As [`Bench::measure`].
    pub fn of(bench: &Bench, reading: Reading) -> Result<Self, ExperimentError> {
        let bench = Bench { reading, ..bench.clone() };
        let of_reading = crate::figures::FIGURES.iter().filter(|figure| FIGURES.contains(&figure.id));
        let figures = of_reading.map(|figure| FitOfFigure::new(&bench, figure)).collect::<Result<Vec<_>, _>>()?;
        Ok(Self {
            reading,
            words: reading.to_string(),
            mean_error_percent: mean_without(&figures, None),
            greatest_error_percent: figures.iter().map(|figure| figure.error_percent.abs()).fold(0.0, f64::max),
            log_likelihood: figures.iter().map(FitOfFigure::log_likelihood).sum(),
            unexplained: figures.iter().filter(|figure| !figure.is_explained()).map(|figure| figure.id).collect(),
            figures,
        })
    }

    /// Mean of the absolute errors without one figure, percent.
    #[must_use]
    pub fn mean_error_without(&self, id: &str) -> f64 {
        mean_without(&self.figures, Some(id))
    }
}

/// Half of the last digit of a value of which three are printed.
pub(super) fn half_a_digit(value: f64) -> f64 {
    0.5 * 10f64.powf(value.log10().floor() - 2.0)
}

fn mean_without(figures: &[FitOfFigure], left_out: Option<&str>) -> f64 {
    let counted: Vec<f64> =
        figures.iter().filter(|figure| Some(figure.id) != left_out).map(|figure| figure.error_percent.abs()).collect();
    counted.iter().sum::<f64>() / counted.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXACT: FitOfFigure = FitOfFigure {
        id: "7",
        published: 4.0,
        simulated: 4.0,
        unit: "fields",
        error_percent: 0.0,
        published_sd: Some(0.5),
        simulated_sd: Some(0.5),
    };

    #[test]
    fn what_is_printed_is_the_likeliest_and_a_deviation_of_nothing_is_no_explanation() {
        assert_eq!(EXACT.log_likelihood(), 0.0);
        let off = FitOfFigure { simulated: 4.2, error_percent: 5.0, ..EXACT };
        // 0.2 in units of the three parts: 0.5 / sqrt(87), a fiftieth of 4, half of a hundredth.
        let expected = -0.5 * (0.2f64.powi(2) / (0.25 / 87.0 + 0.0064 + 0.000_025));
        assert!((off.log_likelihood() - expected).abs() < 1e-12);
        assert!(off.is_explained() && !FitOfFigure { simulated_sd: Some(0.0), ..EXACT }.is_explained());
        assert!(!FitOfFigure { error_percent: -8.1, ..EXACT }.is_explained());
    }

    #[test]
    fn a_figure_left_out_does_not_count() {
        let figures = [EXACT, FitOfFigure { id: "3", error_percent: -20.0, ..EXACT }];
        assert_eq!((mean_without(&figures, None), mean_without(&figures, Some("3"))), (10.0, 0.0));
    }
}
