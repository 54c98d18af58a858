//! Charts as SVG.
//!
//! | chart | shows |
//! |---|---|
//! | [`Chart`] | series of points over two axes, linear or in powers of ten, for a screen or a column of a paper |
//! | [`level_chart`] | speed against error of the levels of modelling |
//! | [`curve_chart`], [`decade_chart`] | any value over another, such as the errors of a comparison over time |
//! | [`histogram`] | distribution of the latencies of a run |
//!
//! The crate `plotters` draws all charts except the last two, whose bars have tooltips.

mod appearance;
mod chart;
mod histogram;
mod levels;
mod parts;
mod plane;
mod scale;

pub use chart::{Chart, ChartAxes, ChartPoint, ChartSeries, ChartSize, SeriesStyle};
pub use histogram::histogram;
pub(crate) use histogram::histogram_element;
pub use levels::{SpeedAndError, level_chart};
pub(crate) use parts::{MeanPart, part_bar_element};
pub use plane::{curve_chart, decade_chart};
pub use scale::AxisScale;

/// Returns the values of the marks on an axis: round numbers from 0 to at most `greatest`, at equal steps. The step is
/// 1, 2 or 5 times a power of ten. There are at most ten steps.
fn ticks(greatest: f64) -> Vec<f64> {
    let power = 10f64.powf((greatest / 10.0).log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|times| times * power);
    let step = steps.into_iter().find(|step| greatest / step <= 10.0).unwrap_or(greatest);
    let values = (0..=10).map(|i| readable(f64::from(i) * step));
    values.take_while(|value| *value <= greatest).collect()
}

/// Removes the rounding errors in the last digits of a mark's value. For example, 3 x 0.2 gives 0.6000000000000001.
fn readable(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

#[cfg(test)]
mod tests {
    use super::ticks;

    #[test]
    fn ticks_are_round_and_at_most_eleven() {
        assert_eq!(ticks(10.0), (0..=10).map(f64::from).collect::<Vec<_>>());
        assert_eq!(ticks(97.3), (0..=9).map(|i| f64::from(i) * 10.0).collect::<Vec<_>>());
        assert_eq!(ticks(1.1), [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]);
        assert_eq!(ticks(0.024), [0.0, 0.005, 0.01, 0.015, 0.02]);
    }
}
