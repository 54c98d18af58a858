use crate::markup::Element;
use crate::palette::tints_of;
use crate::svg::{Tenths, anchored, hint};

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 76.0;
const MARGIN: f64 = 4.0;

/// Mean of one part of the latency of a run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MeanPart {
    /// Name of the part, as in `pxpl5_measure::LATENCY_PARTS`.
    pub(crate) name: String,
    /// Mean duration of the part over all pictures, in milliseconds.
    pub(crate) mean_ms: f64,
    /// True if the latency stated in the papers includes this part.
    pub(crate) published: bool,
}

/// Returns a single bar with the mean parts of the latency, as SVG for a page. An outline marks the parts that the papers
/// count as latency. Without a positive sum there is no bar.
pub(crate) fn part_bar_element(parts: &[MeanPart]) -> Option<Element> {
    let all_ms: f64 = parts.iter().map(|part| part.mean_ms).sum();
    if !(all_ms.is_finite() && all_ms > 0.0) {
        return None;
    }
    let scale = (WIDTH - 2.0 * MARGIN) / all_ms;
    let mut svg = Element::new("svg").with("class", "chart").with("viewBox", format_args!("0 0 {WIDTH} {HEIGHT}"));
    svg = svg.with("role", "img").child(&hint("Parts of latency"));
    // The frame grows with each published part.
    let mut frame = Frame { from: f64::MAX, to: 0.0 };
    let mut x = MARGIN;
    for part in parts {
        let width = scale * part.mean_ms;
        svg.add(&piece(part, x, width));
        if part.published {
            frame.include(x, x + width);
        }
        x += width;
    }
    // The frame and the labels lie above the parts.
    svg.add(&frame.drawn());
    svg.add(&Element::new("text").with("x", MARGIN).with("y", 68).text(0));
    Some(svg.child(&anchored(Tenths(x), 68, "end").text(format_args!("{all_ms:.1} ms"))))
}

fn piece(part: &MeanPart, x: f64, width: f64) -> Element {
    let piece = Element::new("rect").with("x", Tenths(x)).with("y", 14).with("width", Tenths(width));
    let piece = piece.with("height", 34).with("fill", tints_of(&part.name).fill);
    piece.child(&hint(format_args!("{}: {:.3} ms", part.name, part.mean_ms)))
}

/// Horizontal range, in chart units, of the outline around the parts that the papers count as latency.
struct Frame {
    from: f64,
    to: f64,
}

impl Frame {
    fn include(&mut self, from: f64, to: f64) {
        self.from = self.from.min(from);
        self.to = self.to.max(to);
    }

    /// Returns the outline as an SVG rectangle. If the papers count no part as latency, the width is 0.
    fn drawn(&self) -> Element {
        let width = (self.to - self.from).max(0.0);
        let frame = Element::new("rect").with("x", Tenths(self.from.min(WIDTH))).with("y", 11);
        let frame = frame.with("width", Tenths(width)).with("height", 40).with("fill", "none");
        frame.with("stroke", "#111").with("stroke-width", 2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(name: &str, mean_ms: f64, published: bool) -> MeanPart {
        MeanPart { name: name.to_owned(), mean_ms, published }
    }

    #[test]
    fn a_chart_without_parts_is_empty() {
        assert!(part_bar_element(&[]).is_none());
        assert!(part_bar_element(&[part("send", f64::NAN, false)]).is_none());
    }

    #[test]
    fn in_the_chart_of_parts_the_frame_surrounds_the_published_values() {
        let parts = [part("send", 1.0, false), part("copy", 2.0, true), part("scan", 1.0, false)];
        let svg = part_bar_element(&parts).expect("a bar").to_string();
        // 4 ms take 632 units, and the frame begins at unit 4.
        assert!(svg.contains(r#"<rect x="162.0" y="11" width="316.0""#), "{svg}");
    }
}
