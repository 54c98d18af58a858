//! The writer of all SVG and HTML: elements, attributes and escaped text.

use std::fmt::{self, Display, Write};

#[derive(Clone, Debug)]
pub(crate) struct Element {
    name: &'static str,
    attributes: String,
    /// Content, or `None` for a self-closing element.
    content: Option<String>,
}

impl Element {
    pub(crate) const fn new(name: &'static str) -> Self {
        Self { name, attributes: String::new(), content: None }
    }

    pub(crate) fn with(mut self, attribute: &str, value: impl Display) -> Self {
        // Writing to a string cannot fail.
        let _ = write!(self.attributes, " {attribute}=\"{}\"", escape(&value.to_string()));
        self
    }

    /// Appends text to the content. Even an empty text gives the element a closing tag.
    pub(crate) fn text(mut self, text: impl Display) -> Self {
        self.content().push_str(&escape(&text.to_string()));
        self
    }

    pub(crate) fn child(mut self, child: &Self) -> Self {
        self.add(child);
        self
    }

    pub(crate) fn children(mut self, children: impl IntoIterator<Item = Self>) -> Self {
        children.into_iter().for_each(|child| self.add(&child));
        self
    }

    pub(crate) fn add(&mut self, child: &Self) {
        let _ = write!(self.content(), "{child}");
    }

    pub(crate) fn add_line(&mut self, child: &Self) {
        self.add(child);
        self.end_line();
    }

    pub(crate) fn end_line(&mut self) {
        self.content().push('\n');
    }

    fn content(&mut self) -> &mut String {
        self.content.get_or_insert_default()
    }
}

impl Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, attributes, content } = self;
        match content {
            Some(content) => write!(f, "<{name}{attributes}>{content}</{name}>"),
            None => write!(f, "<{name}{attributes}/>"),
        }
    }
}

/// Escapes text for content or an attribute value. Characters that XML forbids are removed.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars().filter(|c| is_allowed(*c)) {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            c => escaped.push(c),
        }
    }
    escaped
}

/// Returns true for characters that an XML document may contain.
pub(crate) const fn is_allowed(c: char) -> bool {
    matches!(c, '\n' | '\t') || !(c.is_ascii_control() || matches!(c, '\u{80}'..='\u{9f}' | '\u{fffe}' | '\u{ffff}'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_a_title_is_escaped() {
        assert_eq!(escape("a<b>&\"c\"\u{7}"), "a&lt;b&gt;&amp;&quot;c&quot;");
    }

    #[test]
    fn line_breaks_are_kept_and_characters_forbidden_in_xml_are_removed() {
        assert_eq!(escape("one\r\n\ttwo\u{0}\u{85}\u{ffff}"), "one\n\ttwo");
    }

    #[test]
    fn attributes_keep_their_order() {
        let element = Element::new("rect").with("y", 2).with("x", 1);
        assert_eq!(element.to_string(), r#"<rect y="2" x="1"/>"#);
    }

    #[test]
    fn quotes_in_attributes_are_escaped() {
        let element = Element::new("a").with("b", r#"" onload="x"#);
        assert_eq!(element.to_string(), r#"<a b="&quot; onload=&quot;x"/>"#);
    }

    #[test]
    fn nested_elements_are_escaped_once() {
        let inner = Element::new("title").text("a & b");
        assert_eq!(Element::new("g").child(&inner).to_string(), "<g><title>a &amp; b</title></g>");
    }

    #[test]
    fn empty_text_keeps_the_closing_tag() {
        assert_eq!(Element::new("td").text("").to_string(), "<td></td>");
    }

    #[test]
    fn line_feeds_between_elements_keep_their_place() {
        let mut element = Element::new("svg");
        element.end_line();
        element.add_line(&Element::new("rect"));
        assert_eq!(element.to_string(), "<svg>\n<rect/>\n</svg>");
    }
}
