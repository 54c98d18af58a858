//! Output of runs for people: drawings, traces, tables, pages and films.
//!
//! ```text
//!   Outcome --+--> timeline, trace_export, results --> SVG, Chrome's JSON, CSV, Parquet
//!   Report ---+--> page (with pictures and a timeline beside it) --> HTML
//!   Experiment --> film --> animated PNG
//!   numbers ----> charts --> SVG
//! ```
//!
//! | module | output |
//! |---|---|
//! | [`timeline`] | the papers' pipeline figures: a row for each resource that works independently |
//! | [`trace_export`] | all events, for a trace viewer |
//! | [`results`] | a row for each picture, and the origin of each file, from which the file can be reproduced |
//! | [`charts`] | speed of the levels of modelling against their error, error over time, distribution of latencies |
//! | [`page`] | one page of HTML without external resources |
//! | [`Film`] | the displayed pictures, period by period |
//! | [`png_bytes`] | a picture with its origin |
//! | [`Animation`] | a sequence of pictures as animated PNG |
//!
//! One module writes all SVG and HTML, with one escape function (`markup`, with shapes in `svg`). Likewise, one module
//! writes all PNG (`png_bytes` and `Animation`), and one writes all CSV ([`results::csv_table`]).
//!
//! All output depends only on simulated time and is therefore the same on every computer. Names, colours and letters of
//! surfaces come from the machine's displays ([`pxpl5_wire::display::Surface`]).
//!
//! **Not here:** files, threads and clocks of the host. All output goes to a [`std::io::Write`] or is returned as text
//! or bytes.

#![warn(missing_docs)]

mod animation;
pub mod charts;
mod film;
mod frame_time;
mod markup;
pub mod page;
pub mod palette;
mod picture;
mod ports;
pub mod results;
mod svg;
pub mod timeline;
pub mod trace_export;
mod updates;

pub use animation::Animation;
pub use film::{FILM_PERIODS, Film, FilmSurfaces};
pub use frame_time::frame_seconds;
pub use picture::{PictureError, png_bytes};

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
