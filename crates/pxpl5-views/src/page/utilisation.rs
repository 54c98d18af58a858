//! Page section about the fraction of time for which each board was busy, and about the waits in the latency.

use super::values::{cell, decimal, heading, list, number, number_cell, paragraph, plain, row, table, text_or_dash};
use crate::markup::Element;
use serde_json::Value;

/// Returns the page section about the busy times and waits in a report. The result is empty for a report of an older
/// version without these values.
pub(super) fn utilisation(report: &Value) -> Vec<Element> {
    let mut all = boards(&report["utilisation"]);
    all.extend(path(&report["critical_path"]));
    all
}

/// A kind of board in the report: its name on the page, and the two keys that lead to its busy fractions. The list at
/// the end has more fractions of time for this kind of board, each with its key and its name on the page.
type Kind = (&'static str, [&'static str; 2], &'static [(&'static str, &'static str)]);

const KINDS: [Kind; 4] = [
    ("graphics processors", ["gps", "busy"], &[("work", "work"), ("messages", "messages"), ("tokens", "tokens")]),
    ("renderers", ["renderers", "executing"], &[("copying", "copying"), ("waiting", "waiting for commands")]),
    ("channels of the ring", ["ring", "channels"], &[]),
    ("ports of displays", ["ports", "busy"], &[]),
];

fn boards(utilisation: &Value) -> Vec<Element> {
    if !utilisation.is_object() {
        return Vec::new();
    }
    let rows = KINDS.iter().map(|(name, [kind, shares], others)| {
        let of = &utilisation[*kind];
        let shares = &of[*shares];
        let others = others.iter().map(|(key, text)| format!("{text} {}", percent(&of[*key])));
        row([
            cell(name),
            number_cell(percent(&shares["mean"])),
            number_cell(percent(&shares["max"])),
            number_cell(text_or_dash(&shares["busiest"])),
            number_cell(text_or_dash(&shares["idle"])),
            cell(others.collect::<Vec<_>>().join(", ")),
        ])
    });
    let of_ms = decimal(&utilisation["of_ms"], 1);
    vec![
        heading("How busy the boards were"),
        paragraph(format_args!("Shares of {of_ms} ms, from the start of the machine to the end of the run.")),
        table(&["boards", "mean", "busiest", "its number", "idle boards", "of that"], rows),
    ]
}

fn path(path: &Value) -> Vec<Element> {
    if !path.is_object() {
        return Vec::new();
    }
    let rows = list(&path["parts"]).iter().map(|part| {
        row([
            cell(plain(&part["resource"]).replace('_', " ")),
            number_cell(percent(&part["share"])),
            number_cell(decimal(&part["ms"], 3)),
            cell(part["board"].as_str().unwrap_or_default()),
        ])
    });
    // The chain goes backwards in time, so the arrows point to the earlier work.
    let chain = list(&path["chain"]).iter().map(plain).collect::<Vec<_>>().join(" \u{2190} ");
    vec![
        heading("What limits the latency"),
        paragraph(format_args!("Limited by {}.", plain(&path["limited_by"]))),
        paragraph(format_args!("Over the last {} complete pictures.", text_or_dash(&path["pictures"]))),
        table(&["waits for", "share", "mean, ms", "mostly"], rows),
        paragraph(format_args!("The last picture: {chain}.")),
    ]
}

fn percent(share: &Value) -> String {
    if share.is_number() { format!("{:.1} %", number(share) * 100.0) } else { "-".to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn text(elements: &[Element]) -> String {
        elements.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_report_without_utilisation_has_no_section() {
        assert!(utilisation(&json!({})).is_empty());
        assert!(utilisation(&json!({"utilisation": null, "critical_path": null})).is_empty());
    }

    #[test]
    fn shares_are_printed_as_percent_with_the_busiest_board() {
        let shares = json!({"mean": 0.47, "max": 1.0, "busiest": 3, "idle": 9});
        let report = json!({"utilisation": {"of_ms": 2002.0, "renderers": {"executing": shares, "copying": 0.125, "waiting": 0.4}}});
        let page = text(&utilisation(&report));
        for expected in ["47.0 %", "100.0 %", "<td class=\"n\">3</td>", "copying 12.5 %", "2002.0 ms"] {
            assert!(page.contains(expected), "{expected}: {page}");
        }
    }

    #[test]
    fn the_critical_path_is_printed_with_its_links() {
        let part = json!({"resource": "backing_store", "share": 0.25, "ms": 3.5, "board": "renderer 2"});
        let report =
            json!({"critical_path": {"pictures": 24, "limited_by": "COPY", "parts": [part], "chain": ["a", "b"]}});
        let page = text(&utilisation(&report));
        for expected in ["backing store", "25.0 %", "renderer 2", "a \u{2190} b", "Limited by COPY."] {
            assert!(page.contains(expected), "{expected}: {page}");
        }
    }
}
