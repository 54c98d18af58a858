//! Chart of simulation speed against error.

use super::chart::{Chart, ChartAxes, ChartPoint, ChartSeries, ChartSize};
use super::scale::AxisScale;

/// Speed and error of one way to simulate, such as a level of modelling.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedAndError {
    /// Name beside the marker, such as the name of a level of modelling.
    pub name: String,
    /// Number of simulated display fields per second of computing time.
    pub fields_per_host_second: f64,
    /// Mean absolute error over the free and interpretation rows of the published figures, in per cent.
    pub mean_error_percent: f64,
}

/// Returns an SVG chart of speed against mean error. The speed is the number of simulated fields per second of
/// computing time, on a logarithmic axis.
///
/// The error covers the published figures that were not used to fit parameters. A line joins the best levels of
/// modelling: no other level is both faster and more accurate.
pub fn level_chart(levels: &[SpeedAndError]) -> String {
    let axes = ChartAxes {
        title: "Speed against error at each level".to_owned(),
        across: "simulated fields per host second".to_owned(),
        up: "mean error of free and interpretation rows, %".to_owned(),
    };
    let series = levels.iter().map(series_of).chain(front(levels)).collect();
    Chart { axes, across: AxisScale::Decades, up: AxisScale::FromZero, series, size: ChartSize::Screen }.svg()
}

fn series_of(level: &SpeedAndError) -> ChartSeries {
    let name = format!("{}, {:.1} %", level.name, level.mean_error_percent);
    ChartSeries::point(&name, ChartPoint::at(place_of(level)))
}

/// Returns the chart position of a level of modelling. A speed below one field per second is drawn at one field per
/// second.
const fn place_of(level: &SpeedAndError) -> (f64, f64) {
    (level.fields_per_host_second.max(1.0), level.mean_error_percent)
}

/// Returns a line through the best levels, starting with the fastest level. No other level is both faster and more
/// accurate than one of these levels. Returns `None` if there are fewer than two best levels.
fn front(levels: &[SpeedAndError]) -> Option<ChartSeries> {
    let mut sorted: Vec<&SpeedAndError> = levels.iter().collect();
    sorted.sort_by(|a, b| {
        let slower = b.fields_per_host_second.total_cmp(&a.fields_per_host_second);
        slower.then(a.mean_error_percent.total_cmp(&b.mean_error_percent))
    });
    // From the fastest entry on, an entry is kept if it is more accurate than all faster entries.
    let mut best: Vec<&SpeedAndError> = Vec::new();
    for level in sorted {
        if best.last().is_none_or(|last| level.mean_error_percent < last.mean_error_percent) {
            best.push(level);
        }
    }
    let points: Vec<_> = best.into_iter().map(place_of).collect();
    (points.len() > 1).then(|| ChartSeries::line("front of the best", &points))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(name: &str, speed: f64) -> SpeedAndError {
        SpeedAndError { name: name.to_owned(), fields_per_host_second: speed, mean_error_percent: 2.0 }
    }

    #[test]
    fn the_front_joins_the_points_that_no_other_point_dominates() {
        let at = |speed, error| SpeedAndError {
            name: String::new(),
            fields_per_host_second: speed,
            mean_error_percent: error,
        };
        let front = front(&[at(10.0, 1.0), at(1e4, 5.0), at(5e3, 6.0), at(100.0, 2.0), at(50.0, 2.0)]).expect("three");
        let places: Vec<(f64, f64)> = front.points.iter().map(|point| point.at).collect();
        assert_eq!(places, [(1e4, 5.0), (100.0, 2.0), (10.0, 1.0)]);
        assert_eq!(super::front(&[at(10.0, 1.0)]), None);
    }

    /// Tests the position of a point in a chart with a logarithmic axis. A factor of 10 is a third of the distance from
    /// 100 to 100,000.
    #[test]
    fn a_tenth_of_the_speed_is_one_decade_further_left() {
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
