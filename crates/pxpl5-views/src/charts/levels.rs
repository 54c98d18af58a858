//! Speed against error as a picture.

use crate::markup::Element;
use crate::svg::{self, Tenths, anchored, line};

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 400.0;
const LEFT: f64 = 80.0;
const BOTTOM: f64 = 60.0;
const TOP: f64 = 50.0;
const RIGHT: f64 = 60.0;
/// Where the axis of errors crosses that of speeds, from the top.
const FLOOR: f64 = HEIGHT - BOTTOM;

/// A way to simulate: how fast it is, and how wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedAndError {
    /// What stands beside its point, such as the name of a level of modelling.
    pub name: String,
    /// Simulated fields per second of the host's time.
    pub fields_per_host_second: f64,
    /// Mean absolute error of the figures that are free checks, percent.
    pub mean_error_percent: f64,
}

/// An SVG: simulated fields per host second (logarithmic) against the mean error of the free checks.
#[must_use]
pub fn level_chart(levels: &[SpeedAndError]) -> String {
    let scale = Scale::of(levels);
    let svg = svg::document().with("viewBox", format_args!("0 0 {WIDTH} {HEIGHT}"));
    let mut svg = svg.with("font-family", "sans-serif").with("font-size", 13);
    svg.end_line();
    svg.add_line(&Element::new("rect").with("width", WIDTH).with("height", HEIGHT).with("fill", "#fff"));
    let title = Element::new("text").with("x", LEFT).with("y", 24).with("font-size", 16);
    svg.add_line(&title.text("Speed against error at each level"));
    scale.speeds(&mut svg);
    scale.errors(&mut svg);
    axis_names(&mut svg);
    for level in levels {
        scale.point(&mut svg, level);
    }
    svg::finished(&svg)
}

/// The range of both axes.
struct Scale {
    /// Powers of ten of the least and the greatest speed.
    first_power: i32,
    last_power: i32,
    /// The greatest error, a whole number of percent.
    most_percent: f64,
}

impl Scale {
    fn of(levels: &[SpeedAndError]) -> Self {
        let powers: Vec<f64> = levels.iter().map(|level| power_of(level.fields_per_host_second)).collect();
        let first_power = powers.iter().copied().fold(f64::INFINITY, f64::min).floor() as i32;
        let last_power = powers.iter().copied().fold(f64::NEG_INFINITY, f64::max).ceil() as i32;
        let most_percent = levels.iter().map(|level| level.mean_error_percent).fold(1.0, f64::max).ceil();
        Self { first_power, last_power, most_percent }
    }

    fn x(&self, speed: f64) -> f64 {
        let first = f64::from(self.first_power);
        let powers = (f64::from(self.last_power) - first).max(1.0);
        LEFT + (power_of(speed) - first) / powers * (WIDTH - LEFT - RIGHT)
    }

    fn y(&self, error_percent: f64) -> f64 {
        FLOOR - error_percent / self.most_percent * (FLOOR - TOP)
    }

    fn speeds(&self, svg: &mut Element) {
        for power in self.first_power..=self.last_power {
            let x = Tenths(self.x(10_f64.powi(power)));
            svg.add(&line(format_args!("M{x} {TOP}V{FLOOR}"), "#ccc"));
            svg.add_line(&anchored(x, Tenths(FLOOR + 18.0), "middle").text(format_args!("10^{power}")));
        }
    }

    fn errors(&self, svg: &mut Element) {
        for percent in 0..=self.most_percent as u32 {
            let y = self.y(f64::from(percent));
            svg.add(&line(format_args!("M{LEFT} {}H{}", Tenths(y), WIDTH - RIGHT), "#eee"));
            svg.add_line(&anchored(LEFT - 8.0, Tenths(y + 4.0), "end").text(format_args!("{percent} %")));
        }
    }

    fn point(&self, svg: &mut Element, level: &SpeedAndError) {
        let x = Tenths(self.x(level.fields_per_host_second));
        let y = self.y(level.mean_error_percent);
        let dot = Element::new("circle").with("cx", x).with("cy", Tenths(y)).with("r", 6);
        svg.add_line(&dot.with("fill", "#1f5fa8"));
        let name = format!("{}, {:.1} %", level.name, level.mean_error_percent);
        svg.add_line(&anchored(x, Tenths(y - 12.0), "middle").text(name));
    }
}

/// The power of ten of a speed; speeds below one field a second stand at one.
fn power_of(speed: f64) -> f64 {
    speed.max(1.0).log10()
}

fn axis_names(svg: &mut Element) {
    let middle = f64::midpoint(LEFT, WIDTH - RIGHT);
    svg.add_line(&anchored(middle, HEIGHT - 16.0, "middle").text("simulated fields per host second"));
    let upright = format!("translate(22 {}) rotate(-90)", f64::midpoint(TOP, FLOOR));
    let name = Element::new("text").with("transform", upright).with("text-anchor", "middle");
    svg.add_line(&name.text("mean error of the free checks"));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(name: &str, speed: f64) -> SpeedAndError {
        SpeedAndError { name: name.to_owned(), fields_per_host_second: speed, mean_error_percent: 2.0 }
    }

    #[test]
    fn a_tenth_of_the_speed_stands_a_power_further_left() {
        let svg = level_chart(&[level("a", 1_000.0), level("b < c", 100.0)]);
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let dots = document.descendants().filter(|node| node.has_tag_name("circle"));
        let places: Vec<&str> = dots.filter_map(|node| node.attribute("cx")).collect();
        assert_eq!(places, ["580.0", "80.0"]);
        assert!(svg.contains(">b &lt; c, 2.0 %</text>"));
    }
}
