use crate::markup::Element;
use crate::svg::{Tenths, anchored, hint, line};

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 200.0;
const LEFT: f64 = 44.0;
const RIGHT: f64 = 30.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = 42.0;
const FLOOR: f64 = HEIGHT - BOTTOM;

const BINS: usize = 24;
/// Distance between the left edges of neighbouring bars: the width of a bar and of the gap.
const STEP: f64 = (WIDTH - LEFT - RIGHT) / BINS as f64;

/// Returns a histogram of latencies in milliseconds, as SVG for a page.
pub fn histogram(values_ms: &[f64]) -> String {
    histogram_element(values_ms).to_string()
}

pub(crate) fn histogram_element(values_ms: &[f64]) -> Element {
    let bins = Bins::of(values_ms);
    let most = bins.counts.iter().copied().max().unwrap_or(1).max(1);
    let mut svg = Element::new("svg").with("class", "chart").with("viewBox", format_args!("0 0 {WIDTH} {HEIGHT}"));
    svg = svg.with("role", "img").child(&hint("Histogram of latency"));
    // Draw a bar for each bin with values, then labels at every quarter of the range.
    for (bin, count) in bins.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        svg.add(&bins.bar(bin, *count, most));
    }
    for bin in (0..=BINS).step_by(BINS / 4) {
        let value = format!("{:.2}", bins.begin_of(bin));
        svg.add(&anchored(Tenths(place_of(bin)), FLOOR + 17.0, "middle").text(value));
    }
    // The axis and its labels come last.
    svg.add(&line(format_args!("M{LEFT} {FLOOR}H{WIDTH}"), "#222"));
    svg.add(&Element::new("text").with("x", LEFT).with("y", HEIGHT - 6.0).text("latency, ms"));
    svg.add(&anchored(LEFT - 6.0, TOP + 8.0, "end").text(most));
    svg.child(&anchored(LEFT - 6.0, FLOOR, "end").text(0))
}

fn place_of(bin: usize) -> f64 {
    LEFT + STEP * bin as f64
}

/// Number of values for each bar of a histogram. The range of the values is divided into intervals of equal width.
struct Bins {
    begin: f64,
    width: f64,
    counts: [usize; BINS],
}

impl Bins {
    /// Counts the values in each interval. If all values are equal, the middle interval gets all of them.
    fn of(values: &[f64]) -> Self {
        let low = values.iter().copied().fold(f64::MAX, f64::min);
        let high = values.iter().copied().fold(f64::MIN, f64::max);
        let width = ((high - low) / BINS as f64).max(0.01);
        let begin = (f64::midpoint(low, high) - width * BINS as f64 / 2.0).max(0.0);
        // The range is slightly enlarged, so that the greatest value lies in the last bin.
        let mut bins = Self { begin, width: width * 1.000_001, counts: [0; BINS] };
        for value in values {
            bins.counts[(((value - begin) / bins.width) as usize).min(BINS - 1)] += 1;
        }
        bins
    }

    fn begin_of(&self, bin: usize) -> f64 {
        self.begin + self.width * bin as f64
    }

    fn bar(&self, bin: usize, count: usize, most: usize) -> Element {
        let height = (FLOOR - TOP) / most as f64 * count as f64;
        let from = self.begin_of(bin);
        let about = format!("{count} pictures, {from:.2} to {:.2} ms", from + self.width);
        let bar = Element::new("rect").with("x", Tenths(place_of(bin))).with("y", Tenths(FLOOR - height));
        let bar = bar.with("width", Tenths(STEP - 1.0)).with("height", Tenths(height)).with("fill", "#0b5394");
        bar.child(&hint(about))
    }
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
    fn every_value_belongs_to_a_bar() {
        let values: Vec<f64> = (0..1_000).map(|i| 50.0 + f64::from(i) * 0.05).collect();
        let counts = histogram(&values);
        let counted: usize =
            counts.split("<title>").filter_map(|rest| rest.split_once(" pictures")?.0.parse::<usize>().ok()).sum();
        assert_eq!(counted, 1_000);
    }
}
