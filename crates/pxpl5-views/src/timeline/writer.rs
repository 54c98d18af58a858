//! SVG text with numbers of two decimals, from integers.

use std::fmt::{self, Display, Write};

/// Hundredths of a unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Units(pub(super) i64);

impl Units {
    pub(super) const fn whole(units: i64) -> Self {
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
        let (whole, rest) = (self.0.unsigned_abs() / 100, self.0.unsigned_abs() % 100);
        write!(f, "{sign}{whole}.{rest:02}")
    }
}

/// An SVG document being written.
#[derive(Debug, Default)]
pub(super) struct Writer(pub(super) String);

impl Writer {
    pub(super) fn line(&mut self, text: impl Display) {
        let _ = writeln!(self.0, "{text}");
    }

    pub(super) fn rectangle(&mut self, [x, y, width, height]: [Units; 4], class: &str, title: &str) {
        let shape = format!(r#"<rect class="{class}" x="{x}" y="{y}" width="{width}" height="{height}""#);
        if title.is_empty() {
            self.line(format!("{shape}/>"));
        } else {
            self.line(format!("{shape}><title>{}</title></rect>", escape(title)));
        }
    }

    pub(super) fn segment(&mut self, [x1, y1, x2, y2]: [Units; 4], class: &str) {
        self.line(format!(r#"<path class="{class}" d="M{x1} {y1}L{x2} {y2}"/>"#));
    }

    /// `content` is markup.
    pub(super) fn text(&mut self, [x, y]: [Units; 2], class: &str, content: &str) {
        self.line(format!(r#"<text class="{class}" x="{x}" y="{y}">{content}</text>"#));
    }
}

/// Text as XML content.
pub(super) fn escape(text: &str) -> String {
    let allowed = text.chars().filter(|c| !c.is_control());
    allowed.fold(String::with_capacity(text.len()), |mut out, c| {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c => out.push(c),
        }
        out
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_print_with_two_decimals_on_both_sides_of_zero() {
        let print = |hundredths| Units(hundredths).to_string();
        assert_eq!([print(0), print(5), print(-5), print(1_234)], ["0.00", "0.05", "-0.05", "12.34"]);
    }

    #[test]
    fn markup_in_a_title_is_text() {
        assert_eq!(escape("a<b>&\"c\"\u{7}"), "a&lt;b&gt;&amp;&quot;c&quot;");
    }
}
