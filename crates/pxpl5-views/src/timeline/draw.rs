use super::legend::legend;
use super::model::{Arrow, Bar, DrawingPlace, Timeline, TimelineRow, TimelineScan};
use super::style::{class_of, definitions, letters, pattern, style};
use crate::markup::Element;
use crate::svg::{self, Units, caption, hint, rectangle, segment};
use pxpl5_sim::{Span, Time};

const WIDTH: i64 = 960;
const LEFT: i64 = 172;
const RIGHT: i64 = 14;
/// Height of the space above the rows of the timeline, in SVG units.
const HEAD: i64 = 84;
const LANE: i64 = 34;
const GAP: i64 = 18;
/// Height of the row for sampled poses, in SVG units.
const TRACKER: i64 = 14;
const FOOT: i64 = 84;
/// Height of the narrow bar that shows when a port receives data, in SVG units.
const STRIP: i64 = 6;
const SHOWN: i64 = 18;

/// Number of drawn retraces from which the axis omits the word `field`, because space is short.
const CROWDED: usize = 10;

/// A timeline while it is drawn, with the vertical positions of its rows.
struct Drawing<'a> {
    timeline: &'a Timeline,
    out: Element,
    tracker: i64,
    rows: Vec<i64>,
    beam: i64,
}

pub(super) struct Words {
    pub(super) title: String,
    pub(super) subtitle: String,
    /// Facts from which the drawing can be reproduced, one per line.
    pub(super) origin: String,
}

pub(super) fn document(timeline: &Timeline, words: &Words) -> String {
    let mut drawing = Drawing::new(timeline);
    drawing.begin(words);
    // Later elements cover earlier elements: background, axis, bars, then arrows.
    drawing.for_each_row(Drawing::row);
    drawing.axis();
    drawing.for_each_row(Drawing::bars);
    drawing.for_each_row(Drawing::shown);
    drawing.samples();
    drawing.scans();
    timeline.arrows.iter().for_each(|arrow| drawing.arrow(arrow));
    // Labels come last, because their outline keeps them legible on arrows.
    drawing.for_each_row(Drawing::labels);
    legend(&mut drawing.out, timeline, [LEFT, drawing.beam + LANE + 44]);
    svg::finished(&drawing.out)
}

impl<'a> Drawing<'a> {
    fn new(timeline: &'a Timeline) -> Self {
        let tracker = HEAD;
        let mut top = tracker;
        if timeline.samples.is_some() {
            top += TRACKER + GAP;
        }
        let mut rows = Vec::new();
        for row in &timeline.rows {
            rows.push(top);
            top += height_of(row) + GAP;
        }
        Self { timeline, out: outermost(top + LANE + FOOT), tracker, rows, beam: top }
    }

    fn for_each_row(&mut self, draw: impl Fn(&mut Self, &TimelineRow, i64)) {
        let timeline = self.timeline;
        for (i, row) in timeline.rows.iter().enumerate() {
            draw(self, row, self.rows[i]);
        }
    }

    fn x(&self, time: Time) -> Units {
        let Timeline { from, to, .. } = self.timeline;
        let all = (*to - *from).0;
        let at = time.since(*from).0.min(all);
        let width = u128::from((WIDTH - LEFT - RIGHT) as u64) * 100;
        let place = width * u128::from(at) / u128::from(all.max(1));
        Units::whole(LEFT) + Units(place as i64)
    }

    fn begin(&mut self, Words { title, subtitle, origin }: &Words) {
        self.out.end_line();
        self.out.add_line(&Element::new("title").text(title));
        self.out.add_line(&Element::new("desc").text(origin));
        self.out.add_line(&style());
        self.out.add_line(&definitions());
        let page = [0, 0, WIDTH, self.beam + LANE + FOOT].map(Units::whole);
        self.out.add_line(&rectangle("page", page));
        self.out.add_line(&caption("heading", [LEFT, 22].map(Units::whole)).text(title));
        self.out.add_line(&caption("key", [LEFT, 41].map(Units::whole)).text(subtitle));
    }

    /// Draws the axis: field numbers above, milliseconds below, and a vertical line at each retrace.
    fn axis(&mut self) {
        let top = Units::whole(HEAD - 14);
        let bottom = Units::whole(self.beam + LANE + 6);
        for (_, time) in &self.timeline.retraces {
            let x = self.x(*time);
            self.out.add_line(&segment("retrace", [x, top, x, bottom]));
        }
        let word = if self.timeline.retraces.len() < CROWDED { "field " } else { "" };
        // The number of a field stands in the middle between two retraces.
        for pair in self.timeline.retraces.windows(2) {
            let middle = Units(self.x(pair[0].1).0.midpoint(self.x(pair[1].1).0));
            let number = caption("mid", [middle, Units::whole(HEAD - 20)]);
            self.out.add_line(&number.text(format_args!("{word}{}", pair[0].0)));
        }
        self.milliseconds(bottom);
    }

    fn milliseconds(&mut self, y: Units) {
        let all = (self.timeline.to - self.timeline.from).0;
        let step: u64 = if all > 140_000_000_000 { 20 } else { 10 };
        let ticks = all / (step * 1_000_000_000);
        self.out.add_line(&segment("axis", [self.x(self.timeline.from), y, self.x(self.timeline.to), y]));
        for tick in 0..=ticks {
            let ms = tick * step;
            let x = self.x(self.timeline.from + Span(ms * 1_000_000_000));
            self.out.add_line(&segment("axis", [x, y, x, y + Units::whole(5)]));
            let label = if tick == 0 { "0 ms".to_owned() } else { ms.to_string() };
            self.out.add_line(&caption("mid", [x, y + Units::whole(20)]).text(label));
        }
    }

    fn name(&mut self, text: &str, top: i64, height: i64) {
        let place = [LEFT - 12, top + height / 2 + 5].map(Units::whole);
        self.out.add_line(&caption("name", place).text(text));
    }

    fn row(&mut self, row: &TimelineRow, top: i64) {
        let height = height_of(row);
        self.name(&row.name, top, LANE * row.lanes as i64);
        self.out.add_line(&rectangle("row", [LEFT, top, WIDTH - LEFT - RIGHT, height].map(Units::whole)));
    }

    /// Draws the pictures that a port shows, below the data that the port receives. Each picture lasts from its swap to
    /// the next swap.
    fn shown(&mut self, row: &TimelineRow, top: i64) {
        let y = Units::whole(top + LANE * row.lanes as i64);
        for shown in &row.shown {
            let [x, end] = [shown.begin.max(self.timeline.from), shown.end].map(|time| self.x(time));
            let class = format!("scan {}", emphasis(Some(shown.picture) == self.timeline.picture));
            let about = hint(format_args!("shows {} from {} ms", shown.picture, milliseconds(shown.begin)));
            self.out.add_line(&rectangle(&class, [x, y, end - x, Units::whole(SHOWN)]).child(&about));
            if (end - x).0 / 100 >= 8 * shown.picture.to_string().len() as i64 {
                let place = [Units(x.0.midpoint(end.0)), y + Units::whole(SHOWN - 4)];
                self.out.add_line(&caption("mid", place).text(shown.picture));
            }
        }
    }

    fn bars(&mut self, row: &TimelineRow, top: i64) {
        // The bars of the chosen picture are drawn last, so that their outlines are on top.
        for chosen in [false, true] {
            for bar in row.bars.iter().filter(|bar| self.timeline.is_chosen(bar) == chosen) {
                self.bar(bar, Units::whole(top + LANE * bar.lane as i64));
            }
        }
    }

    fn bar(&mut self, bar: &Bar, y: Units) {
        let x = self.x(bar.begin);
        // A bar without duration is drawn as a line.
        let width = (self.x(bar.end) - x).max(Units(120));
        let stage = class_of(bar.stage);
        let emphasis = emphasis(self.timeline.is_chosen(bar));
        let class = format!("{stage} {stage}-{} {emphasis}", pattern(bar.surface));
        let about = hint(about(bar, self.timeline));
        self.out.add_line(&rectangle(&class, [x, y, width, Units::whole(LANE)]).child(&about));
        // A narrow dark bar at the foot of a COPY shows when data arrives.
        for (begin, end) in &bar.receiving {
            let x = self.x(*begin);
            let strip = [x, y + Units::whole(LANE - STRIP), self.x(*end) - x, Units::whole(STRIP)];
            self.out.add_line(&rectangle("receiving", strip));
        }
    }

    fn labels(&mut self, row: &TimelineRow, top: i64) {
        for bar in &row.bars {
            self.label(bar, Units::whole(top + LANE * bar.lane as i64));
        }
    }

    /// Draws the label of a bar. The label of a wide bar has letters and a number, and the label of a narrower bar has
    /// only letters. The narrowest bars have no label.
    fn label(&mut self, bar: &Bar, y: Units) {
        let begin = self.x(bar.begin).0;
        let end = self.x(bar.end).0;
        let letters = letters(bar, &self.timeline.surfaces);
        let number = bar.picture.to_string();
        let short = 10 * letters.len() as i64 + 4;
        // The width of a text is estimated from its length.
        let long = short + 8 * number.len() as i64;
        let room = (end - begin) / 100;
        if room < short {
            return;
        }
        // The label moves up to make room for this narrow bar.
        let strip = if bar.receiving.is_empty() { 0 } else { STRIP / 2 };
        let place = [Units(begin.midpoint(end)), y + Units::whole(LANE / 2 + 5 - strip)];
        let mut label = caption(&format!("label {}-text", class_of(bar.stage)), place).text(letters);
        if room >= long {
            label.add(&Element::new("tspan").with("class", "sub").with("dy", 3).text(number));
        }
        self.out.add_line(&label);
    }

    fn samples(&mut self) {
        let Some(samples) = &self.timeline.samples else { return };
        self.name("tracker", self.tracker, TRACKER);
        for (update, time) in samples {
            let class = format!("sample {}", emphasis(Some(*update) == self.timeline.update));
            let x = self.x(*time);
            let y = Units::whole(self.tracker);
            let course = format!("M{x} {y}l5 7l-5 7l-5 -7z");
            self.out.add_line(&Element::new("path").with("class", class).with("d", course));
        }
    }

    fn scans(&mut self) {
        self.name("beam", self.beam, LANE);
        for scan in &self.timeline.scans {
            self.scan(scan);
        }
    }

    /// Draws the path of the display's beam in a period, and the number of the displayed picture.
    fn scan(&mut self, scan: &TimelineScan) {
        let x = self.x(scan.begin);
        let end = self.x(scan.end);
        let y = Units::whole(self.beam);
        let chosen = scan.picture.is_some() && scan.picture == self.timeline.picture;
        let class = format!("scan {}", emphasis(chosen));
        self.out.add_line(&rectangle(&class, [x, y, end - x, Units::whole(LANE)]));
        self.out.add_line(&segment("beam", [x, y, end, y + Units::whole(LANE)]));
        if let Some(picture) = scan.picture {
            let place = [Units(x.0.midpoint(end.0)), y + Units::whole(LANE / 2 + 5)];
            self.out.add_line(&caption("label", place).text(picture));
        }
    }

    fn arrow(&mut self, arrow: &Arrow) {
        if arrow.from == arrow.to && arrow.begin == arrow.end {
            return;
        }
        let mut from = self.low(arrow.from);
        let mut to = self.high(arrow.to);
        if to <= from {
            // An arrow within a row, also upwards between the row's lanes, begins and ends at half the height of a bar.
            from = self.high(arrow.from) + Units::whole(LANE / 2);
            to = self.high(arrow.to) + Units::whole(LANE / 2);
        }
        self.out.add_line(&segment("arrow", [self.x(arrow.begin), from, self.x(arrow.end), to]));
    }

    fn high(&self, place: DrawingPlace) -> Units {
        Units::whole(match place {
            DrawingPlace::Tracker => self.tracker,
            DrawingPlace::Lane { row, lane } => self.rows[row] + LANE * lane as i64,
            DrawingPlace::Beam => self.beam,
        })
    }

    fn low(&self, place: DrawingPlace) -> Units {
        self.high(place) + Units::whole(if place == DrawingPlace::Tracker { TRACKER } else { LANE })
    }
}

fn outermost(height: i64) -> Element {
    let svg = svg::document().with("viewBox", format_args!("0 0 {WIDTH} {height}"));
    let svg = svg.with("width", WIDTH).with("height", height).with("role", "img");
    svg.with("font-family", "Helvetica, Arial, 'Liberation Sans', sans-serif").with("font-size", 15)
}

const fn height_of(row: &TimelineRow) -> i64 {
    LANE * row.lanes as i64 + if row.shown.is_empty() { 0 } else { SHOWN }
}

const fn emphasis(chosen: bool) -> &'static str {
    if chosen { "chosen" } else { "other" }
}

fn about(bar: &Bar, timeline: &Timeline) -> String {
    let letters = letters(bar, &timeline.surfaces);
    let begin = milliseconds(bar.begin);
    let end = milliseconds(bar.end);
    let span = milliseconds(Time::ZERO + (bar.end - bar.begin));
    format!("{letters} of {}: {begin} to {end} ms ({span} ms)", bar.picture)
}

fn milliseconds(time: Time) -> String {
    format!("{}.{:03}", time.0 / 1_000_000_000, time.0 / 1_000_000 % 1_000)
}
