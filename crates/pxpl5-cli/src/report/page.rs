//! The page.

use super::chart::{histogram, parts, swatch};
use super::load::Run;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;
use std::fmt::Write;

const STYLE: &str = "body{font:16px/1.45 system-ui,sans-serif;max-width:62rem;margin:auto;padding:0 1rem;color:#111;\
background:#fff}h1{font-size:1.6rem}h2{margin-top:2.2rem;border-bottom:2px solid #0b5394}h3{margin-bottom:.4rem}\
img{max-width:100%;height:auto}.chart{width:100%;max-width:40rem;height:auto;font:15px system-ui,sans-serif}.wide{overflow-x:auto}\
.wide img{min-width:40rem;width:100%}.pair{display:flex;flex-wrap:wrap;gap:1rem}.pair figure{flex:1 1 18rem;margin:0}\
.pair img{width:100%}table{border-collapse:collapse;font-variant-numeric:tabular-nums}\
td,th{padding:.25rem .6rem;border-bottom:1px solid #ccc;text-align:left;vertical-align:top}td.n{text-align:right;white-space:nowrap}\
.swatch{display:inline-block;width:.8em;height:.8em;margin-right:.4em}.dim{color:#555}code{overflow-wrap:anywhere}\
@media print{body{max-width:none;font-size:10pt}section,figure,table{break-inside:avoid}.wide img{min-width:0}\
*{print-color-adjust:exact;-webkit-print-color-adjust:exact}}";

/// All experiments on one page without anything from outside.
pub(super) fn html(runs: &[Run]) -> String {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\
         <title>Pixel-Planes 5: results</title><style>{STYLE}</style></head><body>\n\
         <h1>Pixel-Planes 5: results</h1>\n"
    );
    page.push_str(&summary(runs));
    for run in runs {
        page.push_str(&section(run));
    }
    page + "</body></html>\n"
}

/// A row for each experiment.
fn summary(runs: &[Run]) -> String {
    let mut text = String::from(
        "<div class=\"wide\"><table><tr><th>experiment</th><th>primitives</th><th>latency, fields</th>\
         <th>latency, ms</th><th>updates, Hz</th><th>missed retraces</th><th>published</th></tr>\n",
    );
    for run in runs {
        let report = &run.report;
        let primitives = number(&report["triangles"]) + number(&report["spheres"]);
        let _ = writeln!(
            text,
            "<tr><td>{}</td><td class=\"n\">{primitives}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>\
             <td class=\"n\">{:.2}</td><td class=\"n\">{}</td><td>{}</td></tr>",
            escape(&run.name),
            spread(&report["latency_fields"]),
            spread(&report["latency_ms"]),
            number(&report["updates_hz"]),
            number(&report["missed_retraces"]),
            published(&run.published),
        );
    }
    text + "</table></div>\n"
}

/// Mean and standard deviation.
fn spread(statistics: &Value) -> String {
    format!("{:.3} ± {:.3}", number(&statistics["mean"]), number(&statistics["sd"]))
}

fn published(published: &Value) -> String {
    if published.is_null() {
        return String::new();
    }
    let error = number(&published["error_percent"]);
    let (quantity, value) = (plain(&published["quantity"]), plain(&published["published"]));
    format!("{} {} ({error:+.1} %), {}", escape(&quantity), escape(&value), escape(&plain(&published["source"])))
}

fn section(run: &Run) -> String {
    let report = &run.report;
    let mut text = format!("<section><h2>{}</h2>\n", escape(&run.name));
    if let Some(svg) = &run.timeline {
        let _ = writeln!(text, "<div class=\"wide\">{}</div>", image("image/svg+xml", svg, "Timeline of the stages"));
    }
    text.push_str(&pictures(run));
    text.push_str("</section><section>\n");
    text.push_str(&latency(run));
    text.push_str(&head(&report["head"]));
    text.push_str("</section><section>\n");
    text.push_str(&speed(report));
    text.push_str(&configuration(report));
    text + "</section>\n"
}

fn pictures(run: &Run) -> String {
    let names = ["left eye", "right eye"];
    let figures: Vec<String> = run
        .pictures
        .iter()
        .zip(names)
        .filter_map(|(picture, name)| {
            let picture = image("image/png", picture.as_ref()?, &format!("What the {name} sees at the end"));
            Some(format!("<figure>{picture}<figcaption>{name}</figcaption></figure>"))
        })
        .collect();
    if figures.is_empty() {
        return "<p class=\"dim\">No pictures in this folder.</p>\n".to_owned();
    }
    format!("<h3>Last displayed pictures</h3><div class=\"pair\">{}</div>\n", figures.join(""))
}

fn latency(run: &Run) -> String {
    let report = &run.report;
    let mut text = format!("<h3>Latency</h3><p>{}.</p>\n", escape(&plain(&report["latency_ms"]["definition"])));
    if !run.latencies_ms.is_empty() {
        text.push_str(&histogram(&run.latencies_ms));
    }
    let all = report["latency_parts_ms"].as_array().map(Vec::as_slice).unwrap_or_default();
    if all.is_empty() {
        return text;
    }
    text.push_str("<h3>Where it goes</h3><p>Mean over all pictures; the frame holds what the papers count.</p>\n");
    text.push_str(&parts(all));
    text.push_str("<div class=\"wide\"><table><tr><th>part</th><th>mean, ms</th><th>sd</th><th>definition</th></tr>\n");
    for part in all {
        let name = plain(&part["name"]);
        let _ = writeln!(
            text,
            "<tr><td>{}{}</td><td class=\"n\">{:.3}</td><td class=\"n\">{:.3}</td><td>{}</td></tr>",
            swatch(&name),
            escape(&name.replace('_', " ")),
            number(&part["mean"]),
            number(&part["sd"]),
            escape(&plain(&part["definition"])),
        );
    }
    text + "</table></div>\n"
}

/// From the head to light, of a run with a tracker.
fn head(head: &Value) -> String {
    if head.is_null() {
        return String::new();
    }
    let [tracker, predictor, display] = ["tracker", "predictor", "display"].map(|key| escape(&plain(&head[key])));
    let mut text = format!(
        "<h3>From the head to light</h3><p>{tracker}, prediction {predictor}, display {display}.</p>\n\
         <div class=\"wide\"><table><tr><th>stage</th><th>mean, ms</th></tr>\n"
    );
    let stages = ["tracking", "waiting", "sending", "drawing", "showing", "scanning", "total"];
    for stage in stages {
        let ms = number(&head["end_to_end"][format!("{stage}_ms")]);
        let _ = writeln!(text, "<tr><td>{stage}</td><td class=\"n\">{ms:.3}</td></tr>");
    }
    text.push_str("</table></div>\n<div class=\"wide\"><table><tr><th>error</th><th>mean</th><th>50 %</th><th>90 %</th><th>99 %</th><th>greatest</th></tr>\n");
    for (key, name) in [("pixels", "pixels"), ("degrees", "degrees")] {
        let _ = write!(text, "<tr><td>{name}</td>");
        for value in ["mean", "p50", "p90", "p99", "max"] {
            let _ = write!(text, "<td class=\"n\">{:.3}</td>", number(&head["error"][key][value]));
        }
        text.push_str("</tr>\n");
    }
    text + "</table></div>\n"
}

fn speed(report: &Value) -> String {
    let (fields, seconds, events) =
        (number(&report["fields"]), number(&report["host_seconds"]), number(&report["events"]));
    let rate = |n: f64| if seconds > 0.0 { format!("{:.0}", n / seconds) } else { "?".to_owned() };
    format!(
        "<h3>Speed of the emulation</h3><p>{fields} fields in {seconds:.3} s: {} fields and {} events a second \
         (real time is 60 fields a second).</p>\n",
        rate(fields),
        rate(events)
    )
}

/// Everything of the report that is one value; the head has a table of its own.
fn configuration(report: &Value) -> String {
    let mut text = String::from("<h3>Configuration</h3><div class=\"wide\"><table>\n");
    for (key, value) in
        report.as_object().into_iter().flatten().filter(|(key, value)| *key != "head" && !value.is_array())
    {
        let shown = match value {
            Value::Object(all) if all.contains_key("definition") => continue,
            Value::Object(all) => {
                all.iter().map(|(key, value)| format!("{key}={}", plain(value))).collect::<Vec<_>>().join(" ")
            }
            value => plain(value),
        };
        let _ = writeln!(text, "<tr><th>{}</th><td><code>{}</code></td></tr>", escape(key), escape(&shown));
    }
    text + "</table></div>\n"
}

fn image(kind: &str, bytes: &[u8], about: &str) -> String {
    format!("<img src=\"data:{kind};base64,{}\" alt=\"{}\">", STANDARD.encode(bytes), escape(about))
}

/// A number; not a number where there is none.
pub(super) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// A value as text, without the quotes of a string.
fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Text as HTML content or attribute.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn markup_in_a_report_is_text() {
        let report = json!({"scene": "<script>", "latency_ms": {"definition": "<b>", "mean": 1.0, "sd": 0.0}});
        let page = html(&[Run { name: "<img src=x>".to_owned(), report, ..Run::default() }]);
        assert!(!page.contains("<script>") && !page.contains("<b>") && !page.contains("<img src=x>"));
        assert!(page.contains("&lt;script&gt;"));
    }

    #[test]
    fn a_head_has_its_stages_and_its_errors() {
        let head = json!({"tracker": "T", "predictor": "P", "display": "vdrt", "end_to_end": {"total_ms": 76.5},
            "error": {"pixels": {"p99": 14.25}, "degrees": {"mean": 0.5}}});
        let page = html(&[Run { report: json!({"head": head}), ..Run::default() }]);
        for text in ["T, prediction P, display vdrt", "76.500", "14.250", "0.500"] {
            assert!(page.contains(text), "{text}");
        }
        assert!(!page.contains("<th>head</th>") && !html(&[Run::default()]).contains("From the head to light"));
    }

    #[test]
    fn a_page_asks_for_nothing_from_outside() {
        let run = Run { timeline: Some(b"<svg/>".to_vec()), latencies_ms: vec![1.0], ..Run::default() };
        let page = html(&[run]);
        assert!(!page.contains("http://") && !page.contains("https://"));
        assert!(page.contains("data:image/svg+xml;base64,PHN2Zy8+"));
    }
}
