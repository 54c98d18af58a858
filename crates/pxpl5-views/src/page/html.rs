//! The page as a whole.

use super::run::PageRun;
use super::section::sections;
use super::summary::summary;
use crate::markup::Element;

const STYLE: &str = "body{font:16px/1.45 system-ui,sans-serif;max-width:62rem;margin:auto;padding:0 1rem;color:#111;\
background:#fff}h1{font-size:1.6rem}h2{margin-top:2.2rem;border-bottom:2px solid #0b5394}h3{margin-bottom:.4rem}\
img{max-width:100%;height:auto}.chart{width:100%;max-width:40rem;height:auto;font:15px system-ui,sans-serif}.wide{overflow-x:auto}\
.wide img{min-width:40rem;width:100%}.pair{display:flex;flex-wrap:wrap;gap:1rem}.pair figure{flex:1 1 18rem;margin:0}\
.pair img{width:100%}table{border-collapse:collapse;font-variant-numeric:tabular-nums}\
td,th{padding:.25rem .6rem;border-bottom:1px solid #ccc;text-align:left;vertical-align:top}td.n{text-align:right;white-space:nowrap}\
.swatch{display:inline-block;width:.8em;height:.8em;margin-right:.4em}.dim{color:#555}.loud{color:#a00;font-weight:bold}code{overflow-wrap:anywhere}\
@media print{body{max-width:none;font-size:10pt}section,figure,table{break-inside:avoid}.wide img{min-width:0}\
*{print-color-adjust:exact;-webkit-print-color-adjust:exact}}";

const TITLE: &str = "Pixel-Planes 5: results";

/// All experiments on one page without anything from outside.
#[must_use]
pub fn html(runs: &[PageRun]) -> String {
    let mut body = Element::new("body");
    body.end_line();
    body.add_line(&Element::new("h1").text(TITLE));
    body.add_line(&summary(runs));
    for section in runs.iter().flat_map(sections) {
        body.add_line(&section);
    }
    format!("<!DOCTYPE html>\n{}\n", Element::new("html").with("lang", "en").child(&head()).child(&body))
}

fn head() -> Element {
    let viewport = Element::new("meta").with("name", "viewport");
    Element::new("head")
        .child(&Element::new("meta").with("charset", "utf-8"))
        .child(&viewport.with("content", "width=device-width, initial-scale=1"))
        .child(&Element::new("title").text(TITLE))
        .child(&Element::new("style").text(STYLE))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn markup_in_a_report_is_text() {
        let report = json!({"scene": "<script>", "latency_ms": {"definition": "<b>", "mean": 1.0, "sd": 0.0}});
        let page = html(&[PageRun { name: "<img src=x>".to_owned(), report, ..PageRun::default() }]);
        assert!(!page.contains("<script>") && !page.contains("<b>") && !page.contains("<img src=x>"));
        assert!(page.contains("&lt;script&gt;"));
    }

    #[test]
    fn a_head_has_its_stages_and_its_errors() {
        let head = json!({"tracker": "T", "predictor": "P", "display": "vdrt", "end_to_end": {"total_ms": 76.5},
            "error": {"pixels": {"p99": 14.25}, "degrees": {"mean": 0.5}}});
        let page = html(&[PageRun { report: json!({"head": head}), ..PageRun::default() }]);
        for text in ["T, prediction P, display vdrt", "76.500", "14.250", "0.500"] {
            assert!(page.contains(text), "{text}");
        }
        assert!(!page.contains("<th>head</th>") && !html(&[PageRun::default()]).contains("From the head to light"));
    }

    #[test]
    fn a_page_asks_for_nothing_from_outside() {
        let run = PageRun { timeline: Some(b"<svg/>".to_vec()), latencies_ms: vec![1.0], ..PageRun::default() };
        let page = html(&[run]);
        assert!(!page.contains("http://") && !page.contains("https://"));
        assert!(page.contains("data:image/svg+xml;base64,PHN2Zy8+"));
    }

    #[test]
    fn every_tag_of_a_page_is_closed() {
        let run =
            PageRun { report: json!({"latency_parts_ms": [{"name": "copy", "mean": 1.0}]}), ..PageRun::default() };
        let page = html(&[run]);
        let document = page.strip_prefix("<!DOCTYPE html>\n").expect("HTML");
        roxmltree::Document::parse(document).expect("every element is closed");
    }
}
