//! Timelines in the style of the papers' pipeline figures (TR94 figures 1 to 6, I3D95 figures 5 to 8).
//!
//! Each independent resource has a row, and time runs to the right. Retraces and the dependencies of one picture are
//! drawn too. [`Timeline::of`] collects the observations of a run, and [`svg`] draws the timeline. A drawing depends
//! only on simulated time and is therefore the same on every computer.
//!
//! | row | bars |
//! |---|---|
//! | tracker | an instant for each pose that was sampled |
//! | host | SEND |
//! | graphics processors | EDIT and TRANSFORM, from the first board that begins to the last board that ends |
//! | renderers | RENDER: commands to the renderers, until the last command is accepted |
//! | each surface of the displays (frame buffer, left and right) | COPY, from the first word of the first region to the last pixel of the last region; the narrow bar below is dark while the port receives data |
//! | each port of a display that has more ports than surfaces (a display memory) | COPY as above; below it the picture that the port shows, from a swap to the next |
//! | beam | the displayed picture, from the first lit pixel of a period to the last, with the position of the beam |
//!
//! If bars of one row overlap in time, the row is divided into several lanes, one below the other.

mod arrows;
mod collect;
mod draw;
mod legend;
mod model;
mod rows;
mod style;

pub use crate::ports::ShownPicture;
pub use model::{Arrow, Bar, DrawingPlace, MAX_FIELDS, Timeline, TimelineOptions, TimelineRow, TimelineScan};

use crate::results::{count_of, origin_lines};
use draw::Words;
use pxpl5_measure::Report;
use pxpl5_run::{FinalResults, Outcome};

/// Draws a run as an SVG document, 960 units wide. For a run without pictures, the document shows the first display
/// periods.
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

/// Draws a run that has ended or is in progress, without title and texts.
pub fn drawing(run: &FinalResults<'_>, options: &TimelineOptions) -> String {
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
