//! Charts: numbers as SVG.
//!
//! | chart | shows |
//! |---|---|
//! | [`Chart`] | series of points over two axes, evenly or in powers of ten, for a screen or a column of a paper |
//! | [`level_chart`] | speed against error of the levels of modelling |
//! | [`curve_chart`], [`decade_chart`], [`point_chart`] | anything over anything: a comparison's errors over time, latency or share of pixels |
//! | [`histogram`] | how the latencies of a run are spread |
//! | [`part_bar`] | where the latency of a run goes |
//!
//! All but the last two, whose bars tell what they are under a pointer, are drawn by the crate `plotters`.

mod chart;
mod histogram;
mod levels;
mod look;
mod parts;
mod plane;
mod scale;

pub use chart::{Chart, ChartAxes, ChartPoint, ChartSeries, ChartSize, SeriesLook};
pub use histogram::histogram;
pub(crate) use histogram::histogram_element;
pub use levels::{SpeedAndError, level_chart};
pub use parts::{MeanPart, part_bar};
pub(crate) use parts::{colour_of_part, part_bar_element};
pub use plane::{Curve, MarkedPoint, curve_chart, decade_chart, point_chart};
pub use scale::AxisScale;

/// Round numbers from 0 to a greatest: steps of 1, 2 or 5 times a power of ten, of which there are at most ten.
fn ticks(greatest: f64) -> Vec<f64> {
    let power = 10f64.powf((greatest / 10.0).log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|times| times * power);
    let step = steps.into_iter().find(|step| greatest / step <= 10.0).unwrap_or(greatest);
    let values = (0..=10).map(|i| readable(f64::from(i) * step));
    values.take_while(|value| *value <= greatest).collect()
}

/// Products of whole numbers and a step such as 0.2 have digits that nobody wants to read.
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
