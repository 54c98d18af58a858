//! What people look at: drawings, traces, tables, pages and films of a run.
//!
//! ```text
//!   Outcome --+--> timeline, trace_export, results --> SVG, Perfetto, Chrome's JSON, CSV, Parquet
//!   Report ---+--> page (with pictures and a timeline beside it) --> HTML
//!   Experiment --> film --> animated PNG
//!   numbers ----> charts --> SVG
//! ```
//!
//! | module | a run as |
//! |---|---|
//! | [`timeline`] | the papers' pipeline figures: a row for each board that works by itself |
//! | [`trace_export`] | everything that happened, for a trace viewer |
//! | [`results`] | a row for each picture, and what every file opens with so that it can be made again |
//! | [`charts`] | speed against error of the levels of modelling, error against time, spread of latencies |
//! | [`page`] | one page of HTML that asks for nothing from outside |
//! | [`Film`] | what the viewer sees, period by period |
//! | [`png_bytes`] | a picture with its origin in it |
//! | [`Animation`] | pictures one after the other, as animated PNG |
//!
//! There is one writer of SVG and HTML with one escaper (`markup`, and `svg` for its shapes), one of PNG (`png_bytes`, and
//! `Animation`), one of CSV ([`results::csv_table`]).
//!
//! What is drawn depends on simulated time alone, so it is the same on every host. Names, colours and letters of surfaces
//! come from the machine's displays ([`pxpl5_display::Surface`]); nothing here knows an eye or a field's lines.
//!
//! **Not here:** files, threads and clocks of the host. Everything goes to a [`std::io::Write`], or comes back as text or
//! bytes.

#![warn(missing_docs)]

mod animation;
pub mod charts;
mod film;
mod frame_time;
mod markup;
pub mod page;
mod picture;
mod ports;
pub mod results;
mod svg;
pub mod timeline;
pub mod trace_export;
mod updates;

pub use animation::Animation;
pub use film::{FILM_PERIODS, Film, FilmError, FilmOf};
pub use frame_time::frame_seconds;
pub use picture::{PngError, png_bytes};
