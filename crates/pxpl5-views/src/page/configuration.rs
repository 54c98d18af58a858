//! Page section with the speed of emulation and all other values of a report.

use super::values::{heading, number, paragraph, plain, row, table};
use crate::markup::Element;
use serde_json::{Map, Value};

pub(super) fn speed(report: &Value) -> [Element; 2] {
    let fields = number(&report["fields"]);
    let seconds = number(&report["host_seconds"]);
    let text = if seconds > 0.0 {
        let fields_rate = fields / seconds;
        let events_rate = number(&report["events"]) / seconds;
        format!(
            "{fields} fields in {seconds:.3} s: {fields_rate:.0} fields and {events_rate:.0} events a second{}.",
            real_time(report)
        )
    } else {
        format!("{fields} fields; the host time is not known.")
    };
    [heading("Speed of the emulation"), paragraph(text)]
}

/// Returns the emulated display's fields per second, computed from the latency in fields and in milliseconds.
fn real_time(report: &Value) -> String {
    let fields = number(&report["latency_fields"]["mean"]);
    let ms = number(&report["latency_ms"]["mean"]);
    let rate = fields / ms * 1e3;
    if rate.is_finite() { format!(" (real time is {rate:.2} fields a second)") } else { String::new() }
}

/// Returns a table of all values of the report that are not lists or statistics. The values of the head have a separate
/// table.
pub(super) fn configuration(report: &Value) -> [Element; 2] {
    let values = report.as_object().into_iter().flatten().filter(|(key, _)| *key != "head");
    let rows = values.filter_map(|(key, value)| Some(value_row(key, &shown(value)?)));
    [heading("Configuration"), table(&[], rows)]
}

fn value_row(key: &str, value: &str) -> Element {
    let code = Element::new("code").text(value);
    row([Element::new("th").text(key), Element::new("td").child(&code)])
}

fn shown(value: &Value) -> Option<String> {
    match value {
        Value::Array(all) if all.is_empty() || !all.iter().all(Value::is_string) => None,
        Value::Array(all) => Some(all.iter().map(plain).collect::<Vec<_>>().join("; ")),
        Value::Object(all) if all.contains_key("definition") => None,
        Value::Object(all) => Some(pairs(all)),
        value => Some(plain(value)),
    }
}

fn pairs(all: &Map<String, Value>) -> String {
    let pairs: Vec<String> = all.iter().map(|(key, value)| format!("{key}={}", plain(value))).collect();
    pairs.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn real_time_is_the_rate_of_the_display() {
        // 2 fields of 1001/60000 s.
        let latency = json!({"latency_fields": {"mean": 2.0}, "latency_ms": {"mean": 2_002.0 / 60.0}});
        assert_eq!(real_time(&latency), " (real time is 59.94 fields a second)");
        assert_eq!(real_time(&json!({})), "");
    }

    #[test]
    fn a_run_without_a_known_host_time_has_no_rate() {
        let [_, text] = speed(&json!({"fields": 12, "host_seconds": null}));
        assert_eq!(text.to_string(), "<p>12 fields; the host time is not known.</p>");
    }
}
