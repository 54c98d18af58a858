//! Timelines in the manner of the papers' pipeline figures (TR94 figures 1 to 6, I3D95 figures 5 to 8): a row for
//! each resource that works independently, time to the right, retraces marked, and the dependencies of one picture.
//!
//! [`Timeline::of`] collects what was simulated; [`svg`] draws it. A drawing depends on simulated time alone, so it is
//! the same on every host.
//!
//! | row | bars |
//! |---|---|
//! | tracker | an instant for each pose that was sampled |
//! | host | SEND |
//! | graphics processors | EDIT and TRANSFORM, from the first board that begins to the last one that ends |
//! | renderers | RENDER: commands to the renderers, until the last is accepted |
//! | frame buffer, left and right | COPY, from the first word of the first region to the last pixel of the last; the strip below is dark where the port receives |
//! | beam | what is scanned out, from the first visible line to the last, and how far down the beam is |
//!
//! Where bars of one row overlap in time, the row has lanes.

mod draw;
mod model;
mod path;
mod published;
mod style;
mod writer;

pub use model::{Bar, Row, Scan, Timeline};
pub(crate) use path::Updates;
pub use path::{Arrow, Place};
pub use published::{FigureError, PIPELINE_FIGURES, PipelineFigure};

use crate::experiment::Outcome;
use crate::report::Report;
use crate::results::origin_lines;

/// What of a run is drawn, and how.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TimelineOptions {
    /// The picture whose dependencies are drawn; else the first after the warm-up.
    pub picture: Option<u64>,
    /// The first field drawn; else the one in which that picture's pose is sampled.
    pub first_field: Option<u64>,
    /// The number of fields drawn, at most [`MAX_FIELDS`]; else until a field after the picture is shown.
    pub fields: Option<u64>,
    /// What stands above the drawing.
    pub title: Option<String>,
    /// The host's row is left out, and so is the tracker's.
    pub without_host: bool,
}

/// More fields than this cannot be told apart at page width.
pub const MAX_FIELDS: u64 = 16;

fn primitives(report: &Report) -> String {
    let count = |n: usize, name: &str| format!("{n} {name}{}", if n == 1 { "" } else { "s" });
    let spheres = (report.spheres > 0).then(|| format!(", {}", count(report.spheres, "sphere")));
    count(report.triangles, "triangle") + &spheres.unwrap_or_default()
}

/// Draws a run as an SVG document, 960 units wide; of a run without a picture it shows the first fields.
#[must_use]
pub fn svg(outcome: &Outcome, options: &TimelineOptions) -> String {
    let report = outcome.report();
    let subject = format!("{} on {}, {}", report.pipeline, report.machine, report.scene);
    let words = draw::Words {
        title: options.title.clone().unwrap_or_else(|| subject.clone()),
        subtitle: format!("simulated: {subject}, {}, seed {}", primitives(&report), report.seed),
        origin: origin_lines(&report, ""),
    };
    draw::document(&Timeline::of(outcome, options), &words)
}
