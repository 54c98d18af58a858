//! Error against time for some latencies, as a curve and as SVG.

use super::ticks;
use crate::markup::Element;
use crate::svg::{self, Tenths, anchored, line};
use tracking::motion::Motion;
use tracking::time::{NTSC_FIELD_PS, PS_PER_MS, PS_PER_S};
use tracking::view::HmdView;

/// The error in the middle of the picture that a latency alone makes of a motion, field by field.
#[derive(Clone, Debug, PartialEq)]
pub struct LatencyCurve {
    /// Milliseconds from the pose that is drawn to its light.
    pub latency_ms: u64,
    /// Time in seconds and error in pixels.
    pub points: Vec<(f64, f64)>,
}

impl LatencyCurve {
    /// What is drawn at t for the pose of t - latency, over `seconds`; the point is `distance_m` ahead.
    #[must_use]
    pub fn of(motion: &dyn Motion, latency_ms: u64, seconds: u64, distance_m: f64) -> Self {
        let view = HmdView::ntsc();
        let latency_ps = latency_ms * PS_PER_MS;
        let times = (0..).map(|n| latency_ps + n * NTSC_FIELD_PS).take_while(|t| *t < seconds * PS_PER_S);
        let points = times.filter_map(|t| {
            let error = view.centre_error(&motion.pose(t - latency_ps), &motion.pose(t), distance_m)?;
            Some((t as f64 / PS_PER_S as f64, error.pixels))
        });
        Self { latency_ms, points: points.collect() }
    }

    /// Mean error in pixels.
    #[must_use]
    pub fn mean_px(&self) -> f64 {
        self.points.iter().map(|p| p.1).sum::<f64>() / self.points.len().max(1) as f64
    }
}

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 360.0;
const MARGIN: f64 = 48.0;
/// Where the axes end: the lower edge and the right edge of the chart.
const FLOOR: f64 = HEIGHT - MARGIN;
const RIGHT: f64 = WIDTH - MARGIN;
const COLOURS: [&str; 4] = ["#c0392b", "#2471a3", "#1e8449", "#7d3c98"];

/// An SVG: curves of error against time, with their means in the legend.
#[must_use]
pub fn error_chart(title: &str, curves: &[LatencyCurve]) -> String {
    let scale = Scale::of(curves);
    let svg = svg::document().with("width", WIDTH).with("height", HEIGHT);
    let mut svg = svg.with("font-family", "sans-serif").with("font-size", 12);
    svg.end_line();
    svg.add_line(&Element::new("rect").with("width", "100%").with("height", "100%").with("fill", "white"));
    svg.add_line(&Element::new("text").with("x", MARGIN).with("y", 20).with("font-size", 14).text(title));
    axes(&mut svg);
    scale.times(&mut svg);
    scale.errors(&mut svg);
    for (i, curve) in curves.iter().enumerate() {
        let colour = COLOURS[i % COLOURS.len()];
        svg.add_line(&scale.curve(curve, colour));
        let legend = Element::new("text").with("x", WIDTH - 210.0).with("y", 20 + 16 * i).with("fill", colour);
        svg.add_line(&legend.text(format_args!("{} ms: mean {:.1} px", curve.latency_ms, curve.mean_px())));
    }
    svg::finished(&svg)
}

/// The range of both axes.
struct Scale {
    end_s: f64,
    top_px: f64,
}

impl Scale {
    fn of(curves: &[LatencyCurve]) -> Self {
        let mut scale = Self { end_s: 1e-9, top_px: 1e-9 };
        for (time_s, error_px) in curves.iter().flat_map(|curve| &curve.points) {
            scale.end_s = scale.end_s.max(*time_s);
            scale.top_px = scale.top_px.max(*error_px);
        }
        scale
    }

    fn x(&self, time_s: f64) -> f64 {
        MARGIN + time_s / self.end_s * (RIGHT - MARGIN)
    }

    fn y(&self, error_px: f64) -> f64 {
        FLOOR - error_px / self.top_px * (FLOOR - MARGIN)
    }

    fn curve(&self, curve: &LatencyCurve, colour: &str) -> Element {
        let points = curve.points.iter();
        let points: Vec<String> =
            points.map(|(time_s, px)| format!("{},{}", Tenths(self.x(*time_s)), Tenths(self.y(*px)))).collect();
        Element::new("polyline").with("fill", "none").with("stroke", colour).with("points", points.join(" "))
    }

    fn times(&self, svg: &mut Element) {
        for value in ticks(self.end_s) {
            let x = Tenths(self.x(value));
            svg.add(&line(format_args!("M{x} {FLOOR} v5"), "black"));
            svg.add_line(&anchored(x, FLOOR + 18.0, "middle").text(value));
        }
    }

    fn errors(&self, svg: &mut Element) {
        for value in ticks(self.top_px) {
            let y = self.y(value);
            svg.add(&line(format_args!("M{MARGIN} {} H{RIGHT}", Tenths(y)), "#ddd"));
            svg.add_line(&anchored(MARGIN - 6.0, Tenths(y + 4.0), "end").text(value));
        }
    }
}

fn axes(svg: &mut Element) {
    let course = format!("M{MARGIN} {MARGIN} V{FLOOR} H{RIGHT}");
    svg.add_line(&Element::new("path").with("d", course).with("fill", "none").with("stroke", "black"));
    svg.add_line(&anchored(RIGHT, FLOOR + 32.0, "end").text("time, s"));
    let name = Element::new("text").with("x", MARGIN).with("y", MARGIN - 12.0);
    svg.add_line(&name.text("error in the middle, pixels"));
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracking::motion::Pan;

    #[test]
    fn the_curve_of_a_pan_is_the_focal_length_times_the_tangent() {
        let curve = LatencyCurve::of(&Pan::at(40.0), 90, 2, 3.0);
        let expected = 320.0 / 30f64.to_radians().tan() * 3.6f64.to_radians().tan();
        assert!((curve.mean_px() - expected).abs() < 1e-9, "{} {expected}", curve.mean_px());
    }

    #[test]
    fn a_chart_names_its_curves_and_survives_odd_titles() {
        let curves = [90, 50].map(|ms| LatencyCurve::of(&Pan::at(40.0), ms, 2, 3.0));
        let svg = error_chart("a < b & c", &curves);
        assert!(svg.contains("90 ms: mean") && svg.contains("50 ms: mean") && svg.contains("a &lt; b &amp; c"));
        assert_eq!(svg.matches("<polyline").count(), 2);
        assert!(roxmltree::Document::parse(&svg).is_ok());
    }
}
