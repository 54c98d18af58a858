//! Shapes of SVG and formats of their numbers.

use crate::markup::Element;
use std::fmt::{self, Display};

/// A length in hundredths of an SVG unit. Numbers with two decimals come from integers, so a drawing has the same bytes
/// on every computer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Units(pub(crate) i64);

impl Units {
    pub(crate) const fn whole(units: i64) -> Self {
        Self(units * 100)
    }
}

impl std::ops::Add for Units {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl std::ops::Sub for Units {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Display for Units {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.0 < 0 { "-" } else { "" };
        let hundredths = self.0.unsigned_abs();
        write!(f, "{sign}{}.{:02}", hundredths / 100, hundredths % 100)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(crate) struct Tenths(pub(crate) f64);

impl Display for Tenths {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.1}", self.0)
    }
}

/// Style of a drawing that is a document of its own: for a reader with dark pages, lightness is inverted, and hues stay.
pub(crate) const DARK: &str = "@media (prefers-color-scheme:dark){svg:root{filter:invert(1) hue-rotate(180deg)}}";

pub(crate) fn document() -> Element {
    Element::new("svg").with("xmlns", "http://www.w3.org/2000/svg")
}

pub(crate) fn finished(document: &Element) -> String {
    format!("{document}\n")
}

/// Returns a rectangle with a CSS class. The numbers are left, top, width and height.
pub(crate) fn rectangle(class: &str, [x, y, width, height]: [Units; 4]) -> Element {
    Element::new("rect").with("class", class).with("x", x).with("y", y).with("width", width).with("height", height)
}

/// Returns a straight line with a CSS class. The numbers are the coordinates of the line's two ends.
pub(crate) fn segment(class: &str, [x1, y1, x2, y2]: [Units; 4]) -> Element {
    Element::new("path").with("class", class).with("d", format_args!("M{x1} {y1}L{x2} {y2}"))
}

/// Returns an empty text element with a CSS class at the point (`x`, `y`). The text is added later.
pub(crate) fn caption(class: &str, [x, y]: [Units; 2]) -> Element {
    Element::new("text").with("class", class).with("x", x).with("y", y)
}

/// Returns a curve of a chart. `course` is the text of the SVG attribute `d`, which describes the path of the curve.
pub(crate) fn line(course: impl Display, colour: &str) -> Element {
    Element::new("path").with("d", course).with("stroke", colour)
}

/// Returns an empty text element of a chart at the point (`x`, `y`). `anchor` states which part of the text lies at
/// this point: `middle` or `end`.
pub(crate) fn anchored(x: impl Display, y: impl Display, anchor: &str) -> Element {
    Element::new("text").with("x", x).with("y", y).with("text-anchor", anchor)
}

/// Returns a tooltip. A browser shows the tooltip while the mouse is over the element that contains it.
pub(crate) fn hint(text: impl Display) -> Element {
    Element::new("title").text(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_print_with_two_decimals_on_both_sides_of_zero() {
        let printed = [0, 5, -5, 1_234].map(|hundredths| Units(hundredths).to_string());
        assert_eq!(printed, ["0.00", "0.05", "-0.05", "12.34"]);
    }

    #[test]
    fn a_shape_opens_with_its_class() {
        let places = [1, 2, 3, 4].map(Units::whole);
        let expected = r#"<rect class="row" x="1.00" y="2.00" width="3.00" height="4.00"/>"#;
        assert_eq!(rectangle("row", places).to_string(), expected);
        assert_eq!(segment("axis", places).to_string(), r#"<path class="axis" d="M1.00 2.00L3.00 4.00"/>"#);
    }

    #[test]
    fn a_text_of_a_chart_is_escaped() {
        let text = anchored(Tenths(0.25), 7, "end").text("a < b");
        assert_eq!(text.to_string(), r#"<text x="0.2" y="7" text-anchor="end">a &lt; b</text>"#);
    }

    #[test]
    fn an_empty_drawing_is_a_document_of_one_line() {
        assert_eq!(finished(&document()), "<svg xmlns=\"http://www.w3.org/2000/svg\"/>\n");
    }
}
