//! Charts as inline SVG.

use super::page::{escape, number};
use serde_json::Value;
use std::fmt::Write;

/// Width and height of a chart in its own units.
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 200.0;
/// What stands left of, right of, above and below the bars.
const LEFT: f64 = 44.0;
const RIGHT: f64 = 30.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = 42.0;

/// Most bars of a histogram.
const BINS: usize = 24;

/// A histogram of latencies.
pub(super) fn histogram(values_ms: &[f64]) -> String {
    let (low, high) = values_ms.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
    let (low, width) = bins(low, high);
    let mut counts = [0usize; BINS];
    for value in values_ms {
        counts[(((value - low) / width) as usize).min(BINS - 1)] += 1;
    }
    let most = counts.iter().copied().max().unwrap_or(1).max(1);
    let mut svg = open("Histogram of latency");
    let (step, scale) = ((WIDTH - LEFT - RIGHT) / BINS as f64, (HEIGHT - TOP - BOTTOM) / most as f64);
    for (i, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        let (x, height) = (LEFT + step * i as f64, scale * *count as f64);
        let from = low + width * i as f64;
        let _ = write!(
            svg,
            r##"<rect x="{x:.1}" y="{:.1}" width="{:.1}" height="{height:.1}" fill="#0b5394"><title>{count} pictures, {from:.2} to {:.2} ms</title></rect>"##,
            HEIGHT - BOTTOM - height,
            step - 1.0,
            from + width
        );
    }
    for i in (0..=BINS).step_by(BINS / 4) {
        let _ = write!(
            svg,
            r#"<text x="{:.1}" y="{}" text-anchor="middle">{:.2}</text>"#,
            LEFT + step * i as f64,
            HEIGHT - BOTTOM + 17.0,
            low + width * i as f64
        );
    }
    let _ = write!(
        svg,
        r##"<path d="M{LEFT} {base}H{WIDTH}" stroke="#222"/><text x="{LEFT}" y="{}" >latency, ms</text><text x="{}" y="{}" text-anchor="end">{most}</text><text x="{}" y="{base}" text-anchor="end">0</text></svg>"##,
        HEIGHT - 6.0,
        LEFT - 6.0,
        TOP + 8.0,
        LEFT - 6.0,
        base = HEIGHT - BOTTOM,
    );
    svg
}

/// Begin and width of the bars: values that are all equal stand in the middle.
fn bins(low: f64, high: f64) -> (f64, f64) {
    let width = ((high - low) / BINS as f64).max(0.01);
    let middle = f64::midpoint(low, high);
    ((middle - width * BINS as f64 / 2.0).max(0.0), width * 1.000_001)
}

/// Colours of the parts of latency, waiting in grey.
fn colour(name: &str) -> &'static str {
    match name {
        "send" => "#7f7f7f",
        "edit" => "#8e2a6b",
        "transform" | "last_transform" => "#4a90d0",
        "render" => "#e8973a",
        "copy" => "#3d9a52",
        "scan" => "#c9b400",
        _ => "#d8d8d8",
    }
}

/// The mean parts of latency as one bar; what the papers count is framed.
pub(super) fn parts(parts: &[Value]) -> String {
    let means: Vec<f64> = parts.iter().map(|part| number(&part["mean"])).collect();
    let all: f64 = means.iter().sum();
    if !(all.is_finite() && all > 0.0) {
        return String::new();
    }
    let scale = (WIDTH - 8.0) / all;
    let (mut svg, mut x, mut framed) = (open_of("Parts of latency", 76.0), 4.0, (f64::MAX, 0.0_f64));
    for (part, mean) in parts.iter().zip(&means) {
        let (name, width) = (part["name"].as_str().unwrap_or_default(), scale * mean);
        let _ = write!(
            svg,
            r#"<rect x="{x:.1}" y="14" width="{width:.1}" height="34" fill="{}"><title>{}: {mean:.3} ms</title></rect>"#,
            colour(name),
            escape(name)
        );
        if part["in_published_latency"] == true {
            framed = (framed.0.min(x), framed.1.max(x + width));
        }
        x += width;
    }
    let (from, to) = framed;
    let _ = write!(
        svg,
        r##"<rect x="{from:.1}" y="11" width="{:.1}" height="40" fill="none" stroke="#111" stroke-width="2"/><text x="4" y="68">0</text><text x="{x:.1}" y="68" text-anchor="end">{all:.1} ms</text></svg>"##,
        (to - from).max(0.0)
    );
    svg
}

fn open(title: &str) -> String {
    open_of(title, HEIGHT)
}

fn open_of(title: &str, height: f64) -> String {
    format!(r#"<svg class="chart" viewBox="0 0 {WIDTH} {height}" role="img"><title>{title}</title>"#)
}

/// A square in the colour of a part.
pub(super) fn swatch(name: &str) -> String {
    format!(r#"<span class="swatch" style="background:{}"></span>"#, colour(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_values_give_one_bar_in_the_middle() {
        let svg = histogram(&[16.683; 9]);
        assert_eq!(svg.matches("<rect").count(), 1);
        assert!(svg.contains("9 pictures"));
    }

    #[test]
    fn every_value_is_in_a_bar() {
        let values: Vec<f64> = (0..1_000).map(|i| 50.0 + f64::from(i) * 0.05).collect();
        let counts = histogram(&values);
        let counted: usize =
            counts.split("<title>").filter_map(|rest| rest.split_once(" pictures")?.0.parse::<usize>().ok()).sum();
        assert_eq!(counted, 1_000);
    }

    #[test]
    fn no_parts_give_no_chart() {
        assert_eq!(parts(&[]), "");
        assert_eq!(parts(&[serde_json::json!({"mean": null})]), "");
    }
}
