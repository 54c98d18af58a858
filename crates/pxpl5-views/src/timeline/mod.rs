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
//! | each surface of the displays (frame buffer, left and right) | COPY, from the first word of the first region to the last pixel of the last; the strip below is dark where the port receives |
//! | each port of a display that has more of them than surfaces (a display memory) | COPY as above; below it what the port shows, from a swap to the next |
//! | beam | what the first display shows, from its first light of a period to its last, and how far down the beam is |
//!
//! Where bars of one row overlap in time, the row has lanes.

mod arrows;
mod collect;
mod draw;
mod legend;
mod model;
mod options;
mod rows;
mod style;

pub use crate::ports::PortShown;
pub use model::{Arrow, Bar, DrawingPlace, Scan, Timeline, TimelineRow};
pub use options::{MAX_FIELDS, TimelineOptions};

use crate::results::{count_of, origin_lines};
use draw::Words;
use pxpl5_measure::Report;
use pxpl5_run::{Outcome, SoFar};

/// Draws a run as an SVG document, 960 units wide; of a run without a picture it shows the first periods.
#[must_use]
pub fn svg(outcome: &Outcome, options: &TimelineOptions) -> String {
    let report = Report::of(outcome);
    let subject = format!("{} on {}, {}", report.pipeline, report.machine, report.scene);
    let words = Words {
        title: options.title.clone().unwrap_or_else(|| subject.clone()),
        subtitle: format!("simulated: {subject}, {}, seed {}", primitives(&report), report.seed),
        origin: origin_lines(&report, ""),
    };
    draw::document(&Timeline::of(outcome, options), &words)
}

/// Draws a run as far as it has come, without words around it.
#[must_use]
pub fn drawing(run: &SoFar<'_>, options: &TimelineOptions) -> String {
    let title = options.title.clone().unwrap_or_default();
    draw::document(&Timeline::so_far(run, options), &Words { title, subtitle: String::new(), origin: String::new() })
}

fn primitives(report: &Report) -> String {
    let triangles = count_of(report.triangles, "triangle");
    match report.spheres {
        0 => triangles,
        spheres => format!("{triangles}, {}", count_of(spheres, "sphere")),
    }
}
