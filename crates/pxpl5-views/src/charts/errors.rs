//! Error against time for two latencies, as a curve and as SVG.

use std::fmt::Write as _;
use tracking::motion::Motion;
use tracking::time::{NTSC_FIELD_PS, PS_PER_MS, PS_PER_S};
use tracking::view::HmdView;

/// The error in the middle of the picture that a latency alone makes of a motion, field by field.
#[derive(Clone, Debug, PartialEq)]
pub struct LatencyCurve {
    /// Latency, milliseconds.
    pub latency_ms: u64,
    /// Time in seconds and error in pixels.
    pub points: Vec<(f64, f64)>,
}

impl LatencyCurve {
    /// What is drawn at t for the pose of t - latency, over `seconds`; the point is `distance_m` ahead.
    #[must_use]
    pub fn of(motion: &dyn Motion, latency_ms: u64, seconds: u64, distance_m: f64) -> Self {
        let (view, latency_ps) = (HmdView::ntsc(), latency_ms * PS_PER_MS);
        let times = (0..).map(|n| latency_ps + n * NTSC_FIELD_PS).take_while(|t| *t < seconds * PS_PER_S);
        let point = |t: u64| {
            let error = view.centre_error(&motion.pose(t - latency_ps), &motion.pose(t), distance_m)?;
            Some((t as f64 / PS_PER_S as f64, error.pixels))
        };
        Self { latency_ms, points: times.filter_map(point).collect() }
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
const COLOURS: [&str; 4] = ["#c0392b", "#2471a3", "#1e8449", "#7d3c98"];

/// Curves of error against time, with their means in the legend.
#[must_use]
pub fn chart(title: &str, curves: &[LatencyCurve]) -> String {
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let end_s = all().map(|p| p.0).fold(1e-9, f64::max);
    let top_px = all().map(|p| p.1).fold(1e-9, f64::max);
    let place = |(t, px): &(f64, f64)| {
        let x = MARGIN + t / end_s * (WIDTH - 2.0 * MARGIN);
        (x, HEIGHT - MARGIN - px / top_px * (HEIGHT - 2.0 * MARGIN))
    };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{MARGIN}\" y=\"20\" font-size=\"14\">{}</text>\n",
        escaped(title)
    );
    axes(&mut svg, end_s, top_px);
    for (i, curve) in curves.iter().enumerate() {
        let colour = COLOURS[i % COLOURS.len()];
        let points: Vec<String> = curve.points.iter().map(place).map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(svg, "<polyline fill=\"none\" stroke=\"{colour}\" points=\"{}\"/>", points.join(" "));
        let (x, y) = (WIDTH - 210.0, 20.0 + 16.0 * i as f64);
        let legend = format!("{} ms: mean {:.1} px", curve.latency_ms, curve.mean_px());
        let _ = writeln!(svg, "<text x=\"{x}\" y=\"{y}\" fill=\"{colour}\">{legend}</text>");
    }
    svg + "</svg>\n"
}

fn axes(svg: &mut String, end_s: f64, top_px: f64) {
    let (bottom, right) = (HEIGHT - MARGIN, WIDTH - MARGIN);
    let _ = writeln!(
        svg,
        "<path d=\"M{MARGIN} {MARGIN} V{bottom} H{right}\" fill=\"none\" stroke=\"black\"/>\n\
         <text x=\"{right}\" y=\"{}\" text-anchor=\"end\">time, s</text>\n\
         <text x=\"{MARGIN}\" y=\"{}\">error in the middle, pixels</text>",
        bottom + 32.0,
        MARGIN - 12.0
    );
    for value in ticks(end_s) {
        let x = MARGIN + value / end_s * (right - MARGIN);
        let _ = writeln!(
            svg,
            "<path d=\"M{x:.1} {bottom} v5\" stroke=\"black\"/><text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{value}</text>",
            bottom + 18.0
        );
    }
    for value in ticks(top_px) {
        let y = bottom - value / top_px * (bottom - MARGIN);
        let _ = writeln!(
            svg,
            "<path d=\"M{MARGIN} {y:.1} H{right}\" stroke=\"#ddd\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{value}</text>",
            MARGIN - 6.0,
            y + 4.0
        );
    }
}

/// Round numbers from 0 to a greatest: steps of 1, 2 or 5 times a power of ten, of which there are at most ten.
fn ticks(greatest: f64) -> Vec<f64> {
    let power = 10f64.powf((greatest / 10.0).log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|step| greatest / step <= 10.0);
    let step = step.unwrap_or(greatest);
    // Products of whole numbers and a step such as 0.2 have digits that nobody wants to read.
    let rounded = |value: f64| (value * 1e9).round() / 1e9;
    (0..=10).map(|i| rounded(f64::from(i) * step)).take_while(|value| *value <= greatest).collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
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
    fn ticks_are_round_and_at_most_eleven() {
        assert_eq!(ticks(10.0), (0..=10).map(f64::from).collect::<Vec<_>>());
        assert_eq!(ticks(97.3), (0..=9).map(|i| f64::from(i) * 10.0).collect::<Vec<_>>());
        assert_eq!(ticks(1.1), [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]);
        assert_eq!(ticks(0.024), [0.0, 0.005, 0.01, 0.015, 0.02]);
    }

    #[test]
    fn a_chart_names_its_curves_and_survives_odd_titles() {
        let curves = [90, 50].map(|ms| LatencyCurve::of(&Pan::at(40.0), ms, 2, 3.0));
        let svg = chart("a < b & c", &curves);
        assert!(svg.contains("90 ms: mean") && svg.contains("50 ms: mean") && svg.contains("a &lt; b &amp; c"));
        assert_eq!(svg.matches("<polyline").count(), 2);
    }
}
