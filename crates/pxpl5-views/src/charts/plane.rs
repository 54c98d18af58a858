//! Curves and points over two axes of numbers, with their names beside them.

use super::ticks;
use crate::markup::Element;
use crate::svg::{self, Tenths, anchored, hint, line};

/// What a chart is about.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartAxes {
    /// What stands above the chart.
    pub title: String,
    /// Name and unit of what goes to the right.
    pub across: String,
    /// Name and unit of what goes up.
    pub up: String,
}

/// A named course of numbers, in the order in which they are joined. Where a number is none (NaN) the line is broken.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What stands beside its colour.
    pub name: String,
    /// Numbers across and up.
    pub points: Vec<(f64, f64)>,
}

/// A named point with the interval in which its height lies.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkedPoint {
    /// What stands beside it.
    pub name: String,
    /// Numbers across and up; a point one of which is none (NaN) is left out.
    pub at: (f64, f64),
    /// Lower and upper end of its interval; no numbers where there is none.
    pub interval: (f64, f64),
}

const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 480.0;
const LEFT: f64 = 64.0;
const TOP: f64 = 48.0;
/// Where the axes end; to the right of them stand the names.
const RIGHT: f64 = WIDTH - 220.0;
const FLOOR: f64 = HEIGHT - 52.0;

/// Colours that people with any colour vision tell apart (Okabe and Ito 2008); beyond them lines are dashed.
const COLOURS: [&str; 8] = ["#000000", "#e69f00", "#56b4e9", "#009e73", "#0072b2", "#d55e00", "#cc79a7", "#b8a900"];
const DASHES: [&str; 3] = ["none", "6 3", "2 3"];

fn colour(i: usize) -> &'static str {
    COLOURS[i % COLOURS.len()]
}

fn dash(i: usize) -> &'static str {
    DASHES[i / COLOURS.len() % DASHES.len()]
}

/// An SVG: curves with a legend. Both axes begin at 0.
#[must_use]
pub fn curve_chart(axes: &ChartAxes, curves: &[Curve]) -> String {
    let plane = Plane::reaching(curves.iter().flat_map(|curve| curve.points.iter().copied()));
    let mut svg = plane.empty(axes);
    for (i, curve) in curves.iter().enumerate() {
        svg.add_line(&plane.course(&curve.points, colour(i), dash(i)));
        legend(&mut svg, i, &curve.name);
    }
    svg::finished(&svg)
}

/// An SVG: curves with a legend, the upward axis in powers of ten; what is not above 0 breaks its line.
#[must_use]
pub fn decade_chart(axes: &ChartAxes, curves: &[Curve]) -> String {
    let in_decades = |curve: &Curve| {
        let up = |(across, up): &(f64, f64)| (*across, if *up > 0.0 { up.log10() } else { f64::NAN });
        Curve { name: curve.name.clone(), points: curve.points.iter().map(up).collect() }
    };
    let curves: Vec<Curve> = curves.iter().map(in_decades).collect();
    let known = curves.iter().flat_map(|curve| curve.points.iter().map(|point| point.1)).filter(|up| up.is_finite());
    let lowest = known.fold(f64::INFINITY, f64::min).floor();
    let lowest = if lowest.is_finite() { lowest } else { 0.0 };
    let mut plane = Plane::reaching(curves.iter().flat_map(|curve| curve.points.iter().copied()));
    plane.up = plane.up.ceil().max(lowest + 1.0);
    plane.lowest = Some(lowest);
    let mut svg = plane.empty(axes);
    for (i, curve) in curves.iter().enumerate() {
        svg.add_line(&plane.course(&curve.points, colour(i), dash(i)));
        legend(&mut svg, i, &curve.name);
    }
    svg::finished(&svg)
}

/// An SVG: points with their intervals and a legend. Both axes begin at 0.
#[must_use]
pub fn point_chart(axes: &ChartAxes, points: &[MarkedPoint]) -> String {
    let tops = points.iter().map(|point| (point.at.0, point.at.1.max(point.interval.1)));
    let plane = Plane::reaching(tops);
    let mut svg = plane.empty(axes);
    for (i, point) in points.iter().enumerate() {
        if point.at.0.is_finite() && point.at.1.is_finite() {
            plane.point(&mut svg, point, colour(i), i);
        }
        legend(&mut svg, i, &point.name);
    }
    svg::finished(&svg)
}

fn legend(svg: &mut Element, i: usize, name: &str) {
    let y = TOP + 20.0 * i as f64;
    let sample = format_args!("M{} {} h24", RIGHT + 16.0, Tenths(y));
    svg.add(&line(sample, colour(i)).with("stroke-width", 2).with("stroke-dasharray", dash(i)));
    let text = Element::new("text").with("x", RIGHT + 48.0).with("y", Tenths(y + 4.0));
    svg.add_line(&text.text(name));
}

/// The greatest numbers that are shown.
struct Plane {
    across: f64,
    up: f64,
    /// The lowest power of ten, where the upward axis has powers of ten; it begins at 0 otherwise.
    lowest: Option<f64>,
}

impl Plane {
    fn reaching(points: impl Iterator<Item = (f64, f64)>) -> Self {
        let mut plane = Self { across: 1e-9, up: 1e-9, lowest: None };
        for (across, up) in points {
            // `max` leaves out what is no number.
            plane.across = plane.across.max(across);
            plane.up = plane.up.max(up);
        }
        plane
    }

    fn x(&self, across: f64) -> f64 {
        LEFT + across / self.across * (RIGHT - LEFT)
    }

    fn y(&self, up: f64) -> f64 {
        let lowest = self.lowest.unwrap_or(0.0);
        FLOOR - (up - lowest) / (self.up - lowest) * (FLOOR - TOP)
    }

    /// Where lines are drawn across, and what stands beside them.
    fn levels(&self) -> Vec<(f64, f64)> {
        let Some(lowest) = self.lowest else { return ticks(self.up).into_iter().map(|value| (value, value)).collect() };
        let powers = (lowest as i32)..=(self.up as i32);
        powers.map(|power| (f64::from(power), 10f64.powi(power))).collect()
    }

    fn empty(&self, axes: &ChartAxes) -> Element {
        let svg = svg::document().with("viewBox", format_args!("0 0 {WIDTH} {HEIGHT}"));
        let mut svg = svg.with("font-family", "sans-serif").with("font-size", 12);
        svg.end_line();
        svg.add_line(&Element::new("rect").with("width", WIDTH).with("height", HEIGHT).with("fill", "white"));
        let title = Element::new("text").with("x", LEFT).with("y", 22).with("font-size", 15);
        svg.add_line(&title.text(&axes.title));
        for (value, label) in self.levels() {
            let y = self.y(value);
            svg.add(&line(format_args!("M{LEFT} {}H{RIGHT}", Tenths(y)), "#ddd"));
            svg.add_line(&anchored(LEFT - 6.0, Tenths(y + 4.0), "end").text(label));
        }
        for value in ticks(self.across) {
            let x = Tenths(self.x(value));
            svg.add(&line(format_args!("M{x} {FLOOR} v5"), "black"));
            svg.add_line(&anchored(x, FLOOR + 18.0, "middle").text(value));
        }
        let course = format!("M{LEFT} {TOP} V{FLOOR} H{RIGHT}");
        svg.add_line(&Element::new("path").with("d", course).with("fill", "none").with("stroke", "black"));
        svg.add_line(&anchored(f64::midpoint(LEFT, RIGHT), FLOOR + 38.0, "middle").text(&axes.across));
        svg.add_line(&Element::new("text").with("x", LEFT).with("y", TOP - 8.0).text(&axes.up));
        svg
    }

    /// A line through points, broken where one is none.
    fn course(&self, points: &[(f64, f64)], colour: &str, dash: &str) -> Element {
        let mut course = String::new();
        let mut pen = 'M';
        for (across, up) in points {
            if across.is_finite() && up.is_finite() {
                course.push_str(&format!("{pen}{} {}", Tenths(self.x(*across)), Tenths(self.y(*up))));
                pen = 'L';
            } else {
                pen = 'M';
            }
        }
        line(course, colour).with("fill", "none").with("stroke-width", 1.5).with("stroke-dasharray", dash)
    }

    fn point(&self, svg: &mut Element, point: &MarkedPoint, colour: &str, i: usize) {
        let x = Tenths(self.x(point.at.0));
        let (low, high) = point.interval;
        if low.is_finite() && high.is_finite() {
            svg.add(&line(format_args!("M{x} {}V{}", Tenths(self.y(low)), Tenths(self.y(high))), colour));
        }
        let about = format!("{}: {:.2}, {:.2}", point.name, point.at.0, point.at.1);
        let y = self.y(point.at.1);
        // Points beyond the last colour are hollow.
        let fill = if i < COLOURS.len() { colour } else { "white" };
        let dot = Element::new("circle").with("cx", x).with("cy", Tenths(y)).with("r", 4.5).with("fill", fill);
        svg.add_line(&dot.with("stroke", colour).child(&hint(about)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes() -> ChartAxes {
        ChartAxes { title: "a < b".to_owned(), across: "time, s".to_owned(), up: "error, px".to_owned() }
    }

    fn attributes(svg: &str, tag: &str, name: &str) -> Vec<String> {
        let document = roxmltree::Document::parse(svg).expect("XML");
        let found = document.descendants().filter(|node| node.has_tag_name(tag));
        found.filter_map(|node| node.attribute(name)).map(str::to_owned).collect()
    }

    #[test]
    fn what_is_no_number_breaks_the_line() {
        let points = vec![(0.0, 0.0), (1.0, 2.0), (2.0, f64::NAN), (3.0, 4.0), (4.0, 4.0)];
        let svg = curve_chart(&axes(), &[Curve { name: "slats".to_owned(), points }]);
        let courses = attributes(&svg, "path", "d");
        let course = courses.iter().find(|d| d.contains('L')).expect("the curve");
        assert_eq!(course, "M64.0 428.0L233.0 238.0M571.0 48.0L740.0 48.0");
    }

    /// 0.1 to 100 are three decades: 1 stands a third of the way up, and 0 has no place.
    #[test]
    fn decades_are_equally_high() {
        let points = vec![(0.0, 0.1), (1.0, 1.0), (2.0, 0.0), (3.0, 100.0), (4.0, 10.0)];
        let svg = decade_chart(&axes(), &[Curve { name: "error".to_owned(), points }]);
        let courses = attributes(&svg, "path", "d");
        let course = courses.iter().find(|d| d.contains('L')).expect("the curve");
        assert_eq!(course, "M64.0 428.0L233.0 301.3M571.0 48.0L740.0 174.7");
    }

    #[test]
    fn a_point_without_numbers_is_in_the_legend_alone() {
        let point =
            |name: &str, up: f64| MarkedPoint { name: name.to_owned(), at: (10.0, up), interval: (up - 1.0, up + 1.0) };
        let svg = point_chart(&axes(), &[point("shown", 3.0), point("too heavy", f64::NAN)]);
        assert_eq!(attributes(&svg, "circle", "cy"), ["143.0"], "three quarters of the height");
        assert!(svg.contains("too heavy"));
    }
}
