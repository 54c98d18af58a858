//! The drawing.

use super::model::{Bar, Row, Scan, Timeline};
use super::path::{Arrow, Place};
use super::style::{STAGES, colours, letters, name, pattern};
use super::writer::{Units, Writer, escape};
use pxpl5_sim::{Span, Time};
use std::fmt::Write;

/// Width of the document, and of what stands left and right of the time axis.
const WIDTH: i64 = 960;
const LEFT: i64 = 152;
const RIGHT: i64 = 14;
/// Height of what stands above the rows, of a lane, and of the space between rows.
const HEAD: i64 = 84;
const LANE: i64 = 34;
const GAP: i64 = 18;
/// Height of the row of samples and of what stands below the rows.
const TRACKER: i64 = 14;
const FOOT: i64 = 84;
/// Height of the strip that shows when a port receives.
const STRIP: i64 = 6;

/// A timeline and where its parts stand.
struct Drawing<'a> {
    timeline: &'a Timeline,
    out: Writer,
    /// Top of the tracker, of each row, and of the beam.
    tracker: i64,
    rows: Vec<i64>,
    beam: i64,
}

/// What stands around a timeline.
pub(super) struct Words {
    pub(super) title: String,
    pub(super) subtitle: String,
    /// Facts that the drawing can be made again from, one a line.
    pub(super) origin: String,
}

pub(super) fn document(timeline: &Timeline, words: &Words) -> String {
    let mut drawing = Drawing::new(timeline);
    drawing.begin(words);
    let rows: Vec<_> = timeline.rows.iter().zip(drawing.rows.clone()).collect();
    rows.iter().for_each(|(row, top)| drawing.row(row, *top));
    drawing.axis();
    rows.iter().for_each(|(row, top)| drawing.bars(row, *top));
    drawing.samples();
    drawing.scans();
    timeline.arrows.iter().for_each(|arrow| drawing.arrow(arrow));
    // Labels come last: their outline keeps them legible on arrows.
    rows.iter().for_each(|(row, top)| drawing.labels(row, *top));
    drawing.legend();
    drawing.out.line("</svg>");
    drawing.out.0
}

impl<'a> Drawing<'a> {
    fn new(timeline: &'a Timeline) -> Self {
        let mut top = HEAD;
        let tracker = top;
        if timeline.samples.is_some() {
            top += TRACKER + GAP;
        }
        let mut rows = Vec::new();
        for row in &timeline.rows {
            rows.push(top);
            top += LANE * row.lanes as i64 + GAP;
        }
        Self { timeline, out: Writer::default(), tracker, rows, beam: top }
    }

    fn height(&self) -> i64 {
        self.beam + LANE + FOOT
    }

    /// Where a time stands, clipped to the time axis.
    fn x(&self, time: Time) -> Units {
        let Timeline { from, to, .. } = self.timeline;
        let (at, all) = (time.since(*from).0, (*to - *from).0);
        let width = u128::from((WIDTH - LEFT - RIGHT) as u64) * 100;
        let place = width * u128::from(at.min(all)) / u128::from(all.max(1));
        Units::whole(LEFT) + Units(place as i64)
    }

    fn begin(&mut self, Words { title, subtitle, origin }: &Words) {
        let height = self.height();
        self.out.line(format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" role="img" font-family="Helvetica, Arial, 'Liberation Sans', sans-serif" font-size="15">"#
        ));
        self.out.line(format!("<title>{}</title>", escape(title)));
        self.out.line(format!("<desc>{}</desc>", escape(origin)));
        self.out.line(style());
        self.out.line(patterns());
        self.out.rectangle([Units(0), Units(0), Units::whole(WIDTH), Units::whole(height)], "page", "");
        self.out.text([Units::whole(LEFT), Units::whole(22)], "heading", &escape(title));
        self.out.text([Units::whole(LEFT), Units::whole(41)], "key", &escape(subtitle));
    }

    /// Fields above, milliseconds below, retraces across.
    fn axis(&mut self) {
        let (top, bottom) = (Units::whole(HEAD - 14), Units::whole(self.beam + LANE + 6));
        for (_, time) in &self.timeline.retraces {
            let x = self.x(*time);
            self.out.segment([x, top, x, bottom], "retrace");
        }
        for pair in self.timeline.retraces.windows(2) {
            let x = Units(self.x(pair[0].1).0.midpoint(self.x(pair[1].1).0));
            let label = if self.timeline.retraces.len() > 9 { "" } else { "field " };
            self.out.text([x, Units::whole(HEAD - 20)], "mid", &format!("{label}{}", pair[0].0));
        }
        self.milliseconds(bottom);
    }

    fn milliseconds(&mut self, y: Units) {
        let all = (self.timeline.to - self.timeline.from).0;
        let step: u64 = if all > 140_000_000_000 { 20 } else { 10 };
        let ticks = all / (step * 1_000_000_000);
        self.out.segment([self.x(self.timeline.from), y, self.x(self.timeline.to), y], "axis");
        for tick in 0..=ticks {
            let ms = tick * step;
            let x = self.x(self.timeline.from + Span(ms * 1_000_000_000));
            self.out.segment([x, y, x, y + Units::whole(5)], "axis");
            let label = if tick == 0 { "0 ms".to_owned() } else { ms.to_string() };
            self.out.text([x, y + Units::whole(20)], "mid", &label);
        }
    }

    fn name(&mut self, text: &str, top: i64, height: i64) {
        let y = Units::whole(top + height / 2 + 5);
        self.out.text([Units::whole(LEFT - 12), y], "name", &escape(text));
    }

    fn row(&mut self, row: &Row, top: i64) {
        let height = LANE * row.lanes as i64;
        self.name(row.name, top, height);
        let (left, width) = (Units::whole(LEFT), Units::whole(WIDTH - LEFT - RIGHT));
        self.out.rectangle([left, Units::whole(top), width, Units::whole(height)], "row", "");
    }

    fn bars(&mut self, row: &Row, top: i64) {
        // The chosen picture's outlines lie on top.
        for chosen in [false, true] {
            for bar in row.bars.iter().filter(|bar| self.timeline.is_chosen(bar) == chosen) {
                self.bar(bar, Units::whole(top + LANE * bar.lane as i64));
            }
        }
    }

    fn labels(&mut self, row: &Row, top: i64) {
        for bar in &row.bars {
            self.label(bar, Units::whole(top + LANE * bar.lane as i64));
        }
    }

    fn bar(&mut self, bar: &Bar, y: Units) {
        let (x, end) = (self.x(bar.begin), self.x(bar.end));
        // An instant is drawn as a line.
        let width = (end - x).max(Units(120));
        let chosen = if self.timeline.is_chosen(bar) { "chosen" } else { "other" };
        let stage = name(bar.stage);
        let class = format!("{stage} {stage}-{} {chosen}", pattern(bar.eye));
        self.out.rectangle([x, y, width, Units::whole(LANE)], &class, &about(bar));
        for (begin, end) in &bar.receiving {
            let (x, end) = (self.x(*begin), self.x(*end));
            let strip = [x, y + Units::whole(LANE - STRIP), end - x, Units::whole(STRIP)];
            self.out.rectangle(strip, "receiving", "");
        }
    }

    /// Letters and number where there is room, letters alone in less, nothing in still less.
    fn label(&mut self, bar: &Bar, y: Units) {
        let (x, end) = (self.x(bar.begin), self.x(bar.end));
        let (letters, number) = (letters(bar), bar.picture.to_string());
        let short = 10 * letters.len() as i64 + 4;
        let long = short + 8 * number.len() as i64;
        let room = (end - x).0 / 100;
        if room < short {
            return;
        }
        let mut text = letters;
        if room >= long {
            let _ = write!(text, r#"<tspan class="sub" dy="3">{number}</tspan>"#);
        }
        let strip = if bar.receiving.is_empty() { 0 } else { STRIP / 2 };
        let place = [Units(x.0.midpoint(end.0)), y + Units::whole(LANE / 2 + 5 - strip)];
        self.out.text(place, &format!("label {}-text", name(bar.stage)), &text);
    }

    fn samples(&mut self) {
        let Some(samples) = &self.timeline.samples else { return };
        self.name("tracker", self.tracker, TRACKER);
        for (update, time) in samples {
            let chosen = if Some(*update) == self.timeline.update { "chosen" } else { "other" };
            let (x, y) = (self.x(*time), Units::whole(self.tracker));
            self.out.line(format!(r#"<path class="sample {chosen}" d="M{x} {y}l5 7l-5 7l-5 -7z"/>"#));
        }
    }

    fn scans(&mut self) {
        self.name("beam", self.beam, LANE);
        for scan in &self.timeline.scans {
            self.scan(scan);
        }
    }

    /// The beam's way down, and what it shows.
    fn scan(&mut self, scan: &Scan) {
        let (x, end) = (self.x(scan.begin), self.x(scan.end));
        let (y, low) = (Units::whole(self.beam), Units::whole(self.beam + LANE));
        let chosen = if scan.picture.is_some() && scan.picture == self.timeline.picture { "chosen" } else { "other" };
        self.out.rectangle([x, y, end - x, Units::whole(LANE)], &format!("scan {chosen}"), "");
        self.out.segment([x, y, end, low], "beam");
        if let Some(picture) = scan.picture {
            let place = [Units(x.0.midpoint(end.0)), y + Units::whole(LANE / 2 + 5)];
            self.out.text(place, "label", &picture.to_string());
        }
    }

    fn arrow(&mut self, arrow: &Arrow) {
        let from = [self.x(arrow.begin), self.low(arrow.from)];
        let to = [self.x(arrow.end), self.high(arrow.to)];
        if arrow.from == arrow.to && arrow.begin == arrow.end {
            return;
        }
        let (from, to) = if to[1] > from[1] { (from, to) } else { self.sideways(arrow) };
        self.out.segment([from[0], from[1], to[0], to[1]], "arrow");
    }

    /// Within a row, or upwards between its lanes: at half height.
    fn sideways(&self, arrow: &Arrow) -> ([Units; 2], [Units; 2]) {
        let middle = |place| self.high(place) + Units::whole(LANE / 2);
        ([self.x(arrow.begin), middle(arrow.from)], [self.x(arrow.end), middle(arrow.to)])
    }

    fn high(&self, place: Place) -> Units {
        Units::whole(match place {
            Place::Tracker => self.tracker,
            Place::Lane { row, lane } => self.rows[row] + LANE * lane as i64,
            Place::Beam => self.beam,
        })
    }

    fn low(&self, place: Place) -> Units {
        self.high(place) + Units::whole(if place == Place::Tracker { TRACKER } else { LANE })
    }

    fn legend(&mut self) {
        let y = self.beam + LANE + 44;
        let has = |wanted: &dyn Fn(&Bar) -> bool| self.timeline.rows.iter().flat_map(|row| &row.bars).any(wanted);
        let stages: Vec<_> = STAGES.iter().filter(|entry| has(&|bar| bar.stage == entry.0)).collect();
        let (eyes, halves) = (has(&|bar| bar.eye.is_some()), has(&|bar| bar.bottom.is_some()));
        let mut x = LEFT;
        for (stage, title) in stages {
            x = self.swatch(x, y, &format!("{0} {0}-plain other", name(*stage)), title);
        }
        x = self.swatch(x, y, "receiving", "port receives");
        if halves {
            self.out.text([x, y].map(Units::whole), "key", "t, b: top, bottom half");
        }
        self.second_legend(y + 20, eyes);
    }

    fn second_legend(&mut self, y: i64, eyes: bool) {
        let mut x = LEFT;
        if eyes {
            x = self.swatch(x, y, "left-eye other", "left eye");
            x = self.swatch(x, y, "right-eye other", "right eye");
        }
        if let Some(picture) = self.timeline.picture {
            x = self.swatch(x, y, "blank chosen", &format!("picture {picture}"));
        }
        for (class, title) in [("arrow", "what it waited for"), ("retrace", "retrace"), ("beam", "beam")] {
            let middle = y - 4;
            self.out.segment([x, middle, x + 22, middle].map(Units::whole), class);
            self.out.text([x + 30, y].map(Units::whole), "key", title);
            x += 30 + width(title) + 18;
        }
    }

    fn swatch(&mut self, x: i64, y: i64, class: &str, title: &str) -> i64 {
        self.out.rectangle([x, y - 12, 22, 15].map(Units::whole), class, "");
        self.out.text([Units::whole(x + 30), Units::whole(y)], "key", &escape(title));
        x + 30 + width(title) + 18
    }
}

/// About the width of a text: capitals are wider.
fn width(text: &str) -> i64 {
    text.chars().map(|c| if c.is_uppercase() { 11 } else { 8 }).sum()
}

/// What a viewer shows when the pointer rests on a bar.
fn about(bar: &Bar) -> String {
    let ms = |time: Time| format!("{}.{:03}", time.0 / 1_000_000_000, time.0 / 1_000_000 % 1_000);
    let span = ms(Time::ZERO + (bar.end - bar.begin));
    format!("{} of {}: {} to {} ms ({span} ms)", letters(bar), bar.picture, ms(bar.begin), ms(bar.end))
}

fn style() -> String {
    let mut text = String::from("<style>");
    text.push_str(
        ".page{fill:#fff}.row{fill:#f5f5f5}.blank{fill:#fff}.heading{font-size:17px;font-weight:bold}\
         .key{font-size:14px}.mid{text-anchor:middle}.name{text-anchor:end}.label{text-anchor:middle;font-weight:bold;paint-order:stroke;\
         stroke:#fff;stroke-width:3px;stroke-linejoin:round}.sub{font-size:11px}.retrace{stroke:#666;stroke-width:1;\
         stroke-dasharray:5 3;fill:none}.axis{stroke:#222;fill:none}.other{stroke:#888;stroke-width:.8}\
         .chosen{stroke:#111;stroke-width:2.4}.sample.other{fill:#999}.sample.chosen{fill:#c00000;stroke-width:1}\
         .scan.other{fill:#fff}.scan.chosen{fill:#fff3b0}.beam{stroke:#666;stroke-width:1;fill:none}\
         .receiving{fill:#1b6b2f}.arrow{stroke:#c00000;stroke-width:2;fill:none;marker-end:url(#head)}\
         .left-eye{fill:#ddd}.right-eye{fill:url(#eye-right)}",
    );
    for (stage, _) in STAGES {
        let (name, colours) = (name(stage), colours(stage));
        let _ = write!(
            text,
            ".{name}-plain{{fill:{}}}.{name}-right{{fill:url(#{name}-hatch)}}.{name}-text{{fill:{}}}",
            colours.light, colours.dark
        );
    }
    text + "</style>"
}

fn patterns() -> String {
    let mut text = String::from(
        r##"<defs><marker id="head" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="9" markerHeight="9" markerUnits="userSpaceOnUse" orient="auto"><path d="M0 0L10 5L0 10z" fill="#c00000"/></marker>"##,
    );
    text.push_str(&hatch("eye-right", "#ddd", "#777"));
    for (stage, _) in STAGES {
        let colours = colours(stage);
        text.push_str(&hatch(&format!("{}-hatch", name(stage)), colours.light, colours.dark));
    }
    text + "</defs>"
}

fn hatch(id: &str, light: &str, dark: &str) -> String {
    format!(
        r#"<pattern id="{id}" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)"><path fill="{light}" d="M0 0h7v7h-7z"/><path fill="{dark}" fill-opacity=".55" d="M0 0h1.6v7h-1.6z"/></pattern>"#
    )
}
