//! Speed against error as a picture.

use super::compare::LevelReport;
use std::fmt::Write as _;

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 400.0;
const LEFT: f64 = 80.0;
const BOTTOM: f64 = 60.0;
const TOP: f64 = 50.0;
const RIGHT: f64 = 60.0;

/// An SVG: simulated fields per host second (logarithmic) against the mean error of the free checks.
#[must_use]
pub fn svg(reports: &[LevelReport]) -> String {
    let speeds = reports.iter().map(|report| report.fields_per_host_second.max(1.0).log10());
    let (first, last) =
        (speeds.clone().fold(f64::INFINITY, f64::min).floor(), speeds.fold(f64::NEG_INFINITY, f64::max).ceil());
    let most = reports.iter().map(|report| report.mean_error_percent).fold(1.0, f64::max).ceil();
    let x = |speed: f64| LEFT + (speed.max(1.0).log10() - first) / (last - first).max(1.0) * (WIDTH - LEFT - RIGHT);
    let y = |error: f64| HEIGHT - BOTTOM - error / most * (HEIGHT - BOTTOM - TOP);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"sans-serif\" \
         font-size=\"13\">\n<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#fff\"/>\n\
         <text x=\"{LEFT}\" y=\"24\" font-size=\"16\">Speed against error at each level</text>\n"
    );
    axes(&mut svg, (first as i32, last as i32), most, &x, &y);
    for report in reports {
        let (cx, cy) = (x(report.fields_per_host_second), y(report.mean_error_percent));
        let name = format!("{:?}", report.level).to_lowercase();
        let _ = writeln!(
            svg,
            "<circle cx=\"{cx:.1}\" cy=\"{cy:.1}\" r=\"6\" fill=\"#1f5fa8\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{name}, {:.1} %</text>",
            cx,
            cy - 12.0,
            report.mean_error_percent
        );
    }
    svg.push_str("</svg>\n");
    svg
}

fn axes(svg: &mut String, (first, last): (i32, i32), most: f64, x: &impl Fn(f64) -> f64, y: &impl Fn(f64) -> f64) {
    let (floor, middle) = (HEIGHT - BOTTOM, (LEFT + WIDTH - RIGHT) / 2.0);
    for power in first..=last {
        let at = x(10_f64.powi(power));
        let _ = writeln!(
            svg,
            "<path d=\"M{at:.1} {TOP}V{floor}\" stroke=\"#ccc\"/>\
             <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">10^{power}</text>",
            floor + 18.0
        );
    }
    for percent in 0..=most as u32 {
        let at = y(f64::from(percent));
        let _ = writeln!(
            svg,
            "<path d=\"M{LEFT} {at:.1}H{}\" stroke=\"#eee\"/>\
             <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{percent} %</text>",
            WIDTH - RIGHT,
            LEFT - 8.0,
            at + 4.0
        );
    }
    let _ = writeln!(
        svg,
        "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">simulated fields per host second</text>\n\
         <text transform=\"translate(22 {}) rotate(-90)\" text-anchor=\"middle\">mean error of the free checks</text>",
        HEIGHT - 16.0,
        (TOP + floor) / 2.0
    );
}
