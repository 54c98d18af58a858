use super::configuration::{configuration, speed};
use super::latency::{due, head_to_light, latency};
use super::run::{PagePicture, PageRun};
use super::utilisation::utilisation;
use super::values::{heading, wide};
use crate::markup::Element;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Returns the three sections of an experiment: pictures, latencies, and all other values of the report. In print, each
/// section stays together.
pub(super) fn sections(run: &PageRun) -> [Element; 3] {
    [pictures(run), latencies(run), details(run)]
}

fn pictures(run: &PageRun) -> Element {
    let mut section = Element::new("section").child(&Element::new("h2").text(&run.name));
    section.end_line();
    if let Some(svg) = &run.timeline {
        section.add_line(&wide(&image("image/svg+xml", svg, "Timeline of the stages")));
    }
    if run.pictures.is_empty() {
        let nothing = Element::new("p").with("class", "dim").text("No pictures in this folder.");
        return section.child(&nothing);
    }
    let about = |picture: &PagePicture| format!("What the {} sees at the end", picture.label);
    let figures = run.pictures.iter().map(|picture| figure("image/png", picture, &about(picture)));
    let pair = Element::new("div").with("class", "pair").children(figures);
    section.child(&heading("Last displayed pictures")).child(&pair)
}

fn latencies(run: &PageRun) -> Element {
    let section = Element::new("section").children(due(&run.report)).children(latency(&run.report, &run.latencies_ms));
    section.children(utilisation(&run.report)).children(head_to_light(&run.report["head"]))
}

fn details(run: &PageRun) -> Element {
    Element::new("section").children(speed(&run.report)).children(configuration(&run.report))
}

/// Returns a picture with its caption. `about` describes it to readers who cannot see it.
pub(super) fn figure(kind: &str, picture: &PagePicture, about: &str) -> Element {
    let caption = Element::new("figcaption").text(&picture.label);
    Element::new("figure").child(&image(kind, &picture.png, about)).child(&caption)
}

fn image(kind: &str, bytes: &[u8], about: &str) -> Element {
    let source = format!("data:{kind};base64,{}", STANDARD.encode(bytes));
    Element::new("img").with("src", source).with("alt", about)
}
