//! The HTML page that contains the sections of all experiments.

use super::run::PageRun;
use super::section::sections;
use super::summary::summary;
use crate::markup::Element;

const STYLE: &str = "*{box-sizing:border-box}body{font:16px/1.45 system-ui,sans-serif;max-width:62rem;margin:auto;padding:0 1rem;color:#111;\
background:#fff}h1,h2,h3,p,figcaption,code{overflow-wrap:anywhere}h1{font-size:1.6rem}h2{margin-top:2.2rem;border-bottom:2px solid #0b5394}h3{margin-bottom:.4rem}\
img{max-width:100%;height:auto}figure{margin:0;min-width:0}.chart{width:100%;max-width:40rem;height:auto;font:15px system-ui,sans-serif}.wide{overflow-x:auto;max-width:100%}\
.wide img{min-width:40rem;width:100%}.pair{display:flex;flex-wrap:wrap;gap:1rem}.pair figure{flex:1 1 16rem}\
.pair img{width:100%}table{border-collapse:collapse;font-variant-numeric:tabular-nums}\
td,th{padding:.25rem .6rem;border-bottom:1px solid #ccc;text-align:left;vertical-align:top}.wide td{min-width:4rem}td.n{text-align:right;white-space:nowrap}\
.swatch{display:inline-block;width:.8em;height:.8em;margin-right:.4em}.dim{color:#555}.loud{color:#a00;font-weight:bold}.wide code{overflow-wrap:normal}\
@media screen and (prefers-color-scheme:dark){:root{color-scheme:dark}body{color:#e6e9ed;background:#14171a}td,th{border-color:#3a4047}\
.dim{color:#a5aeb8}.loud{color:#ff8f8f}.chart,.swatch{filter:invert(1) hue-rotate(180deg)}}\
@media print{body{max-width:none;font-size:10pt}section,figure,table{break-inside:avoid}.wide img{min-width:0}\
*{print-color-adjust:exact;-webkit-print-color-adjust:exact}}";

const TITLE: &str = "Pixel-Planes 5: results";

/// Returns a page with all experiments. The page needs no external resources.
pub fn html(runs: &[PageRun]) -> String {
    page(std::iter::once(summary(runs)).chain(runs.iter().flat_map(sections)))
}

pub(super) fn page(sections: impl IntoIterator<Item = Element>) -> String {
    let mut body = Element::new("body");
    body.end_line();
    body.add_line(&Element::new("h1").text(TITLE));
    sections.into_iter().for_each(|section| body.add_line(&section));
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
    fn markup_in_a_report_is_escaped() {
        let report = json!({"scene": "<script>", "latency_ms": {"definition": "<b>", "mean": 1.0, "sd": 0.0}});
        let page = html(&[PageRun { name: "<img src=x>".to_owned(), report, ..PageRun::default() }]);
        assert!(!page.contains("<script>") && !page.contains("<b>") && !page.contains("<img src=x>"));
        assert!(page.contains("&lt;script&gt;"));
    }

    #[test]
    fn the_page_of_a_run_with_a_head_shows_its_stages_and_its_errors() {
        let head = json!({"tracker": "T", "predictor": "P", "display": "vdrt", "end_to_end": {"head_to_light_ms": 76.5},
            "error": {"pixels": {"p99": 14.25}, "degrees": {"mean": 0.5}}});
        let page = html(&[PageRun { report: json!({"head": head}), ..PageRun::default() }]);
        for text in ["T, prediction P, display vdrt", "76.500", "14.250", "0.500"] {
            assert!(page.contains(text), "{text}");
        }
        assert!(!page.contains("<th>head</th>") && !html(&[PageRun::default()]).contains("From the head to light"));
    }

    #[test]
    fn a_page_loads_nothing_from_outside() {
        let run = PageRun { timeline: Some(b"<svg/>".to_vec()), latencies_ms: vec![1.0], ..PageRun::default() };
        let page = html(&[run]);
        assert!(!page.contains("http://") && !page.contains("https://"));
        assert!(page.contains("data:image/svg+xml;base64,PHN2Zy8+"));
    }

    /// Tests that a page fits on a screen of 390 px. Tables and the timeline must scroll, and long words must break.
    #[test]
    fn a_page_is_never_wider_than_a_telephone() {
        let report = json!({"scene": "x".repeat(200), "config_hash": "f".repeat(32), "latency_parts_ms": [{"name": "copy"}],
            "latency_ms": {"definition": "d".repeat(300), "mean": 1.0, "sd": 0.0},
            "head": {"tracker": "T", "end_to_end": {"head_to_light_ms": 76.5}, "error": {}}});
        let timeline = Some(b"<svg/>".to_vec());
        let run =
            PageRun { name: "n".repeat(200), report, timeline, latencies_ms: vec![1.0, 2.0], ..PageRun::default() };
        let page = html(&[run]);
        let document =
            roxmltree::Document::parse(page.strip_prefix("<!DOCTYPE html>\n").expect("HTML")).expect("closed");
        let in_wide = |node: roxmltree::Node<'_, '_>| node.ancestors().any(|a| a.attribute("class") == Some("wide"));
        let mut tables = document.descendants().filter(|node| node.has_tag_name("table"));
        assert!(tables.all(in_wide));
        for (selector, rule) in [
            (".wide", "overflow-x:auto"),
            ("h1,h2,h3,p,figcaption,code", "overflow-wrap:anywhere"),
            ("img", "max-width:100%"),
            (".chart", "width:100%"),
            ("figure", "min-width:0"),
        ] {
            let block = STYLE.split('}').find_map(|block| block.rsplit_once('{').filter(|(name, _)| *name == selector));
            assert!(block.is_some_and(|(_, rules)| rules.contains(rule)), "{selector}: {rule}");
        }
        let rem = 16;
        let basis = STYLE.split("flex:1 1 ").nth(1).and_then(|rest| rest.split("rem").next()).expect("a pair");
        assert!(basis.parse::<u32>().expect("rem") * rem <= 390 - 2 * rem);
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
