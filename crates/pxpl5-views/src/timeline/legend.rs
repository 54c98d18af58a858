use super::model::Timeline;
use super::style::{HATCHED_SURFACE, PLAIN_SURFACE, STAGES, class_of};
use crate::markup::Element;
use crate::svg::{Units, caption, rectangle, segment};
use pxpl5_wire::display::Surface;

/// Draws a legend of two lines. `x` and `y` are the coordinates of the left end of the first line's baseline.
pub(super) fn legend(out: &mut Element, timeline: &Timeline, [x, y]: [i64; 2]) {
    let mut first = Line { out, x, y };
    for stage in STAGES.iter().filter(|stage| timeline.bars().any(|bar| bar.stage == **stage)) {
        let class = class_of(*stage);
        first.swatch(&format!("{class} {class}-plain other"), &class.to_uppercase());
    }
    first.swatch("receiving", "port receives");
    if timeline.bars().any(|bar| bar.bottom.is_some()) {
        first.words(first.x, "t, b: top, bottom half");
    }
    second_line(Line { out, x, y: y + 20 }, timeline);
}

fn second_line(mut line: Line<'_>, timeline: &Timeline) {
    if timeline.bars().any(|bar| bar.surface.is_some()) {
        surfaces(&mut line, &timeline.surfaces);
    }
    if let Some(picture) = timeline.picture {
        line.swatch("blank chosen", &format!("picture {picture}"));
    }
    line.stroke("arrow", "what it waited for");
    line.stroke("retrace", "retrace");
    line.stroke("beam", "beam");
}

/// Adds a sample of the fill pattern of each surface to the legend. The sample of the first surface is plain, and the
/// samples of all other surfaces are hatched.
fn surfaces(line: &mut Line<'_>, surfaces: &[Surface]) {
    match surfaces {
        [first, second] => {
            line.swatch(&format!("{PLAIN_SURFACE} other"), &first.legend());
            line.swatch(&format!("{HATCHED_SURFACE} other"), &second.legend());
        }
        [first, ..] => {
            line.swatch(&format!("{PLAIN_SURFACE} other"), &first.legend());
            line.swatch(&format!("{HATCHED_SURFACE} other"), "other surfaces");
        }
        [] => {}
    }
}

struct Line<'a> {
    out: &'a mut Element,
    x: i64,
    y: i64,
}

impl Line<'_> {
    fn swatch(&mut self, class: &str, title: &str) {
        self.out.add_line(&rectangle(class, [self.x, self.y - 12, 22, 15].map(Units::whole)));
        self.entry(title);
    }

    fn stroke(&mut self, class: &str, title: &str) {
        let middle = self.y - 4;
        self.out.add_line(&segment(class, [self.x, middle, self.x + 22, middle].map(Units::whole)));
        self.entry(title);
    }

    fn entry(&mut self, title: &str) {
        self.words(self.x + 30, title);
        self.x += 30 + width(title) + 18;
    }

    fn words(&mut self, x: i64, text: &str) {
        self.out.add_line(&caption("key", [x, self.y].map(Units::whole)).text(text));
    }
}

/// Estimates the width of a text in SVG units. Capitals count as wider than small letters.
fn width(text: &str) -> i64 {
    text.chars().map(|c| if c.is_uppercase() { 11 } else { 8 }).sum()
}
