//! Colours, patterns and labels of a timeline.

use super::model::Bar;
use crate::markup::Element;
pub(super) use crate::palette::class_of;
use crate::palette::{Tints, WAITING, tints_of};
use crate::svg::DARK;
use pxpl5_gp::Stage;
use pxpl5_wire::SurfaceId;
use pxpl5_wire::display::Surface;
use std::fmt::Write;

pub(super) const STAGES: [Stage; 5] = [Stage::Send, Stage::Edit, Stage::Transform, Stage::Render, Stage::Copy];

/// Suffix of the CSS class for work on the first surface or on all surfaces.
const PLAIN: &str = "plain";
const HATCHED: &str = "right";

/// Returns the suffix of the CSS class of a bar. The fill pattern of this class shows for which surface the stage
/// works.
pub(super) const fn pattern(surface: Option<SurfaceId>) -> &'static str {
    match surface {
        Some(SurfaceId(0)) | None => PLAIN,
        Some(_) => HATCHED,
    }
}

/// Returns the letters of a bar as in the papers: E, TL, TR, RL, RR, CL or CR. The first letter is the stage (EDIT,
/// TRANSFORM, RENDER, COPY), and the second letter is the surface (left, right).
///
/// A half of a picture that is copied separately has an additional `t` (top) or `b` (bottom).
pub(super) fn letters(bar: &Bar, surfaces: &[Surface]) -> String {
    let stage = STAGES.contains(&bar.stage).then(|| class_of(bar.stage).to_uppercase().remove(0));
    let surface = bar.surface.and_then(|id| surfaces.get(id.index())).map(Surface::letter);
    let half = bar.bottom.map(|bottom| if bottom { 'b' } else { 't' });
    stage.into_iter().chain(surface).chain(half).collect()
}

pub(super) fn style() -> Element {
    let mut text = String::from(
        ".page{fill:#fff}.row{fill:#f5f5f5}.blank{fill:#fff}.heading{font-size:17px;font-weight:bold}\
         .key{font-size:14px}.mid{text-anchor:middle}.name{text-anchor:end}.label{text-anchor:middle;font-weight:bold;paint-order:stroke;\
         stroke:#fff;stroke-width:3px;stroke-linejoin:round}.sub{font-size:11px}.retrace{stroke:#666;stroke-width:1;\
         stroke-dasharray:5 3;fill:none}.axis{stroke:#222;fill:none}.other{stroke:#888;stroke-width:.8}\
         .chosen{stroke:#111;stroke-width:2.4}.sample.other{fill:#999}.sample.chosen{fill:#c00000;stroke-width:1}\
         .scan.other{fill:#fff}.scan.chosen{fill:#fff3b0}.beam{stroke:#666;stroke-width:1;fill:none}\
         .receiving{fill:#1b6b2f}.arrow{stroke:#c00000;stroke-width:2;fill:none;marker-end:url(#head)}\
         .left-eye{fill:#ddd}.right-eye{fill:url(#eye-right)}",
    );
    for stage in STAGES {
        // Each stage has a plain fill, a hatched fill and a text colour.
        let name = class_of(stage);
        let Tints { ground, ink, .. } = tints_of(name);
        let _ = write!(
            text,
            ".{name}-{PLAIN}{{fill:{ground}}}.{name}-{HATCHED}{{fill:url(#{name}-hatch)}}.{name}-text{{fill:{ink}}}"
        );
    }
    text.push_str(DARK);
    Element::new("style").text(text)
}

/// CSS class of the sample for the first surface in the legend. This sample has no hatching pattern.
pub(super) const PLAIN_SURFACE: &str = "left-eye";
pub(super) const HATCHED_SURFACE: &str = "right-eye";

/// Returns the definitions that the style sheet refers to: arrow heads and hatching patterns.
pub(super) fn definitions() -> Element {
    let hatches = STAGES.map(|stage| hatch(&format!("{}-hatch", class_of(stage)), tints_of(class_of(stage))));
    let grey = hatch("eye-right", Tints { ground: "#ddd", ..WAITING });
    Element::new("defs").child(&arrow_head()).child(&grey).children(hatches)
}

fn arrow_head() -> Element {
    let marker = Element::new("marker").with("id", "head").with("viewBox", "0 0 10 10");
    let marker = marker.with("refX", 9).with("refY", 5).with("markerWidth", 9).with("markerHeight", 9);
    let marker = marker.with("markerUnits", "userSpaceOnUse").with("orient", "auto");
    marker.child(&Element::new("path").with("d", "M0 0L10 5L0 10z").with("fill", "#c00000"))
}

fn hatch(id: &str, Tints { ground, ink, .. }: Tints) -> Element {
    let area = Element::new("path").with("fill", ground).with("d", "M0 0h7v7h-7z");
    let stripe = Element::new("path").with("fill", ink).with("fill-opacity", ".55").with("d", "M0 0h1.6v7h-1.6z");
    let pattern = Element::new("pattern").with("id", id).with("width", 7).with("height", 7);
    let pattern = pattern.with("patternUnits", "userSpaceOnUse").with("patternTransform", "rotate(45)");
    pattern.child(&area).child(&stripe)
}
