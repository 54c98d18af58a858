//! Speed against error as a picture.

use super::chart::{Chart, ChartAxes, ChartPoint, ChartSeries, ChartSize, SeriesLook};
use super::scale::AxisScale;

/// A way to simulate: how fast it is, and how wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedAndError {
    /// What stands beside its mark, such as the name of a level of modelling.
    pub name: String,
    /// Simulated fields per second of the host's time.
    pub fields_per_host_second: f64,
    /// Mean absolute error of the figures that are free checks, percent.
    pub mean_error_percent: f64,
}

/// An SVG: simulated fields per host second (in powers of ten) against the mean error of the free checks.
#[must_use]
pub fn level_chart(levels: &[SpeedAndError]) -> String {
    let axes = ChartAxes {
        title: "Speed against error at each level".to_owned(),
        across: "simulated fields per host second".to_owned(),
        up: "mean error of the free checks, %".to_owned(),
    };
    let series = levels.iter().map(series_of).collect();
    Chart { axes, across: AxisScale::Decades, up: AxisScale::FromZero, series, size: ChartSize::Screen }.svg()
}

/// Speeds below one field a second stand at one.
fn series_of(level: &SpeedAndError) -> ChartSeries {
    let at = (level.fields_per_host_second.max(1.0), level.mean_error_percent);
    let name = format!("{}, {:.1} %", level.name, level.mean_error_percent);
    ChartSeries { name, points: vec![ChartPoint { at, interval: (f64::NAN, f64::NAN) }], look: SeriesLook::Points }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(name: &str, speed: f64) -> SpeedAndError {
        SpeedAndError { name: name.to_owned(), fields_per_host_second: speed, mean_error_percent: 2.0 }
    }

    /// Marks of the first series are discs, of which the second is its sample; a fifth series has discs again.
    #[test]
    fn a_tenth_of_the_speed_stands_a_power_further_left() {
        let place = |speed: f64| {
            let svg = level_chart(&[level("a", speed), level("b < c", 100.0), level("d", 1e5)]);
            assert!(svg.contains("b &lt; c, 2.0 %"));
            let document = roxmltree::Document::parse(&svg).expect("XML");
            let disc = document.descendants().find(|node| node.has_tag_name("circle")).expect("the first mark");
            disc.attribute("cx").and_then(|cx| cx.parse::<f64>().ok()).expect("a number")
        };
        let [hundred, thousand, most] = [1e2, 1e3, 1e5].map(place);
        assert!(((thousand - hundred) * 3.0 - (most - hundred)).abs() <= 3.0, "{hundred} {thousand} {most}");
    }
}
