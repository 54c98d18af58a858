//! Panels of a figure: a row for each name, and values on a logarithmic axis. The text is as large as that of the page.

use std::fmt::{Result, Write};

/// Width of a figure, as wide as the text of a page.
pub(crate) const WIDTH: f64 = 760.0;

/// Height of the numbers and of the name of an axis.
pub(crate) const AXIS: f64 = 46.0;

/// A panel with a logarithmic axis. Positions and lengths are in pixels.
pub(crate) struct Panel<'a> {
    pub(crate) title: &'a str,
    /// Name of the axis, with its unit.
    pub(crate) axis: &'a str,
    /// Left end of the axis, and top of the first row.
    pub(crate) at: [f64; 2],
    /// Length of the axis.
    pub(crate) length: f64,
    /// Values at both ends of the axis.
    pub(crate) ends: [f64; 2],
    /// Values with a number below the axis.
    pub(crate) marks: &'a [f64],
    /// Number of rows, and the height of a row.
    pub(crate) rows: (usize, f64),
}

impl Panel<'_> {
    /// Returns the horizontal position of a value. A value beyond an end has the position of that end.
    pub(crate) fn across(&self, value: f64) -> f64 {
        let [low, high] = self.ends;
        self.at[0] + (value.clamp(low, high) / low).ln() / (high / low).ln() * self.length
    }

    /// Returns the vertical position of the middle of a row.
    pub(crate) fn middle(&self, row: usize) -> f64 {
        self.at[1] + self.rows.1 * (row as f64 + 0.5)
    }

    /// Returns the lower end of the last row.
    pub(crate) fn bottom(&self) -> f64 {
        self.at[1] + self.rows.1 * self.rows.0 as f64
    }

    /// Draws the title, the axis and a line across the panel between two rows.
    pub(crate) fn frame(&self, svg: &mut String) -> Result {
        let ([left, top], bottom) = (self.at, self.bottom());
        writeln!(svg, r#"<text x="{left}" y="{}" font-weight="bold">{}</text>"#, top - 10.0, self.title)?;
        for row in 0..=self.rows.0 {
            let y = top + self.rows.1 * row as f64;
            writeln!(svg, r##"<path d="M{left} {y}h{}" stroke="#e8e8e8"/>"##, self.length)?;
        }
        for mark in self.marks {
            let x = self.across(*mark);
            writeln!(svg, r##"<path d="M{x:.1} {top}V{bottom}" stroke="#c4c4c4"/>"##)?;
            writeln!(svg, r#"<text x="{x:.1}" y="{}" text-anchor="middle">{mark}</text>"#, bottom + 17.0)?;
        }
        let middle = left + self.length / 2.0;
        writeln!(svg, r#"<text x="{middle}" y="{}" text-anchor="middle">{}</text>"#, bottom + 36.0, self.axis)
    }

    /// Writes the name of a row to the left of the panel.
    pub(crate) fn name(&self, svg: &mut String, row: usize, name: &str) -> Result {
        let (x, y) = (self.at[0] - 10.0, self.middle(row) + 5.0);
        writeln!(svg, r#"<text x="{x}" y="{y}" text-anchor="end">{name}</text>"#)
    }

    /// Draws a value as a dot on a line between two other values. `hint` appears below the mouse.
    pub(crate) fn dot(&self, svg: &mut String, y: f64, values: [f64; 3], colour: &str, hint: &str) -> Result {
        let [from, x, to] = values.map(|value| self.across(value));
        writeln!(svg, r#"<path d="M{from:.1} {y}H{to:.1}" stroke="{colour}" stroke-width="2"/>"#)?;
        writeln!(svg, r#"<circle cx="{x:.1}" cy="{y}" r="4" fill="{colour}"><title>{hint}</title></circle>"#)
    }
}

/// Returns the beginning of a figure of some height, with its title and a legend of names and colours.
pub(crate) fn begin(height: f64, title: &str, legend: &[(&str, &str)]) -> String {
    let mut svg = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" role="img" font-family="system-ui, Helvetica, Arial, sans-serif" font-size="14" fill="#1b2430">
<style>@media (prefers-color-scheme:dark){{svg:root{{filter:invert(.9) hue-rotate(180deg)}}}}</style>
<title>{title}</title>
<rect width="100%" height="100%" fill="#fff"/>
<text x="12" y="24" font-size="16" font-weight="bold">{title}</text>
"##
    );
    let mut x = 18.0;
    for (name, colour) in legend {
        svg += &format!(
            "<circle cx=\"{x}\" cy=\"44\" r=\"5\" fill=\"{colour}\"/><text x=\"{}\" y=\"49\">{name}</text>\n",
            x + 11.0
        );
        x += 40.0 + 7.2 * name.len() as f64;
    }
    svg
}
