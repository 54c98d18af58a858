//! Charts for a screen that compare results: curves, and points with confidence intervals.

use super::chart::{Chart, ChartAxes, ChartSeries, ChartSize};
use super::scale::AxisScale;

/// Returns an SVG chart of curves or points with a legend. Both axes begin at 0.
pub fn curve_chart(axes: ChartAxes, series: Vec<ChartSeries>) -> String {
    on_screen(axes, AxisScale::FromZero, series)
}

/// Returns an SVG chart of curves with a legend. The vertical axis is logarithmic. Zero and negative values leave gaps
/// in the line.
pub fn decade_chart(axes: ChartAxes, series: Vec<ChartSeries>) -> String {
    on_screen(axes, AxisScale::Decades, series)
}

fn on_screen(axes: ChartAxes, up: AxisScale, series: Vec<ChartSeries>) -> String {
    Chart { axes, across: AxisScale::FromZero, up, series, size: ChartSize::Screen }.svg()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::charts::ChartPoint;

    fn axes() -> ChartAxes {
        ChartAxes { title: "a < b".to_owned(), across: "time, s".to_owned(), up: "error, px".to_owned() }
    }

    fn attributes(svg: &str, tag: &str, name: &str) -> Vec<String> {
        let document = roxmltree::Document::parse(svg).expect("XML");
        let found = document.descendants().filter(|node| node.has_tag_name(tag));
        found.filter_map(|node| node.attribute(name)).map(str::to_owned).collect()
    }

    /// Returns the corners of the curves in an SVG chart. Curves are recognized by the width of their strokes, because
    /// the axes can have the colour of a curve.
    fn courses(svg: &str) -> Vec<Vec<(f64, f64)>> {
        let document = roxmltree::Document::parse(svg).expect("XML");
        let lines = document.descendants().filter(|node| node.has_tag_name("polyline"));
        let curves = lines.filter(|node| node.attribute("stroke-width") == Some("15"));
        let pair = |text: &str| {
            let (x, y) = text.split_once(',')?;
            Some((x.parse().ok()?, y.parse().ok()?))
        };
        let corners = curves.filter_map(|node| node.attribute("points"));
        corners.map(|text| text.split_whitespace().filter_map(pair).collect()).collect()
    }

    #[test]
    fn a_missing_value_breaks_the_line() {
        let points = vec![(0.0, 0.0), (1.0, 2.0), (2.0, f64::NAN), (3.0, 4.0), (4.0, 4.0)];
        let svg = curve_chart(axes(), vec![ChartSeries::line("slats", &points)]);
        let courses = courses(&svg);
        // The last line is the sample in the legend.
        assert_eq!(courses.len(), 3, "{courses:?}");
        let (first, second) = (&courses[0], &courses[1]);
        assert_eq!((first.len(), second.len()), (2, 2));
        let (left, floor) = first[0];
        let (right, top) = second[1];
        assert!(((first[1].0 - left) - (right - left) / 4.0).abs() <= 1.0, "a quarter of the way across: {courses:?}");
        assert!(((floor - first[1].1) - (floor - top) / 2.0).abs() <= 1.0, "half of the way up: {courses:?}");
        assert!(svg.contains("a &lt; b") && svg.contains("error, px"));
    }

    /// Tests a logarithmic axis from 0.1 to 100, which has three decades. The value 1 lies at a third of the height.
    /// The value 0 has no place on the axis.
    #[test]
    fn decades_are_equally_high() {
        let points = vec![(0.0, 0.1), (1.0, 1.0), (2.0, 0.0), (3.0, 100.0), (4.0, 10.0)];
        let svg = decade_chart(axes(), vec![ChartSeries::line("error", &points)]);
        let courses = courses(&svg);
        let (floor, third) = (courses[0][0].1, courses[0][1].1);
        let (top, two_thirds) = (courses[1][0].1, courses[1][1].1);
        let decade = (floor - top) / 3.0;
        assert!((floor - third - decade).abs() <= 1.0 && (floor - two_thirds - 2.0 * decade).abs() <= 1.0);
    }

    #[test]
    fn a_point_without_numbers_is_only_in_the_legend() {
        let point = |name: &str, up: f64| {
            ChartSeries::point(name, ChartPoint { interval: (up - 1.0, up + 1.0), ..ChartPoint::at((10.0, up)) })
        };
        let shown = curve_chart(axes(), vec![point("shown", 3.0)]);
        assert_eq!(attributes(&shown, "circle", "cy").len(), 2, "the point and its sample");
        let heavy = curve_chart(axes(), vec![point("too heavy", f64::NAN)]);
        assert_eq!(attributes(&heavy, "circle", "cy").len(), 1, "its sample");
        assert!(heavy.contains("too heavy"));
    }
}
