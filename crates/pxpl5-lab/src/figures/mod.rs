//! The published figures, measured: what was printed, what the model gives, how far apart they are.
//!
//! ```text
//!   FIGURES (data) --> Bench::measure (one experiment each) --> Row: published, simulated, error, interval, standing
//! ```
//!
//! Papers about other systems are families of rows ([`FigureFamily`]), which come with the others.
//!
//! All rows come from the same machine parameters. Rows 5, 6 and 3 describe machines with other loads or costs than
//! the presets; their experiments change what the statement itself changes, and nothing else.
//!
//! Sources: TR94, I3D95; the loads of the experiments are ours.

mod applications;
mod document;
mod family;
mod group;
mod heads;
mod jitp;
mod measure;
mod measured;
mod rates;
mod reading;
mod row;
mod table;
mod topics;
mod trackers;

pub use document::markdown;
pub use family::FigureFamily;
pub use group::FigureGroup;
pub use heads::PHOTODIODE_LINE;
pub use measure::Bench;
pub use measured::{Detail, FigureValue};
pub use reading::{FieldCount, ROOM, Reading, Samples};
pub use row::{FigureRow, MISS_PERCENT, mean_error_percent};
pub use table::{Basis, FIGURES, Figure, WITHOUT_CLOSED_FORM};
pub use topics::figure_groups;

use crate::application_time::{ApplicationTime, application_times};
use crate::intervals::{Interval, fill, intervals};
use crate::parallel;
use crate::readings::{self, Readings};
use serde::Serialize;
use std::sync::atomic::{AtomicU64, Ordering};
use thiserror::Error;

/// A figure whose experiment gave no result.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("figure {id}: {reason}")]
pub struct FigureError {
    /// Number of the figure.
    pub id: String,
    /// Why its experiment gave no result.
    pub reason: String,
}

/// All figures, and what the open parameters do to them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// In the order of [`FIGURES`].
    pub rows: Vec<FigureRow>,
    /// The same with the times of primitives that follow from the i860 code, without intervals.
    pub of_code: Vec<FigureRow>,
    /// What the open parameters do to each figure but the one of the scenes.
    pub intervals: Vec<Interval>,
    /// Figures of papers about other systems than Pixel-Planes 5.
    pub families: Vec<FigureFamily>,
    /// Further figures of Pixel-Planes 5 by topic: peak rates, just-in-time pixels, trackers.
    pub groups: Vec<FigureGroup>,
    /// What all readings make of the figures of Rendering Control, at the analytic level.
    pub readings: Readings,
    /// The fly-throughs with the times that the host's application may take, at the analytic level.
    pub application_times: Vec<ApplicationTime>,
}

/// Seeds and frames of the application scenes by which readings are ranked.
const SEEDS: u64 = 6;
const FRAMES: u64 = 150;

/// Measures all figures, several at a time, with their intervals.
///
/// # Errors
///
/// The first [`FigureError`].
pub fn run_all(bench: &Bench) -> Result<Figures, FigureError> {
    run_all_with(bench, |_, _| {})
}

/// The same; `finished` hears how many of all steps are done: one for each figure, and one each for the
/// intervals, the readings, the application's time, the families and the groups.
///
/// # Errors
///
/// As [`run_all`].
pub fn run_all_with(bench: &Bench, finished: impl Fn(u64, u64) + Sync) -> Result<Figures, FigureError> {
    let steps = FIGURES.len() as u64 + 6;
    let done = AtomicU64::new(0);
    let step = || finished(done.fetch_add(1, Ordering::Relaxed) + 1, steps);
    let with_step = |figure: &Figure| {
        let row = row_of(bench, figure);
        step();
        row
    };
    let rows = || parallel::map(&FIGURES, with_step).into_iter().collect::<Result<Vec<_>, _>>();
    let of_code = || {
        let by_code = bench.clone().with_times_of_code();
        let rows = parallel::map(&FIGURES, |figure| row_of(&by_code, figure));
        step();
        rows.into_iter().collect::<Result<Vec<_>, _>>()
    };
    let intervals = || {
        let intervals = intervals(bench);
        step();
        intervals
    };
    let readings = || {
        let readings = readings::run(&bench.clone().with_mig(SEEDS, FRAMES), 0, |_, _| {});
        step();
        readings.map_err(|error| FigureError { id: "7".to_owned(), reason: error.to_string() })
    };
    let families = || {
        let families = FigureFamily::address_recalculation(bench);
        step();
        families
    };
    let groups = || {
        let groups = figure_groups(bench);
        step();
        groups
    };
    let of_application = || {
        let times = application_times(&bench.clone().with_mig(SEEDS, FRAMES));
        step();
        times.map_err(|error| FigureError { id: "7".to_owned(), reason: error.to_string() })
    };
    let of_machine = || parallel::both(|| parallel::both(rows, groups), of_code);
    let of_models =
        || parallel::both(|| parallel::both(readings, intervals), || parallel::both(families, of_application));
    let (((rows, groups), of_code), ((readings, intervals), (families, application_times))) =
        parallel::both(of_machine, of_models);
    let (mut rows, groups, of_code, readings, families) = (rows?, groups?, of_code?, readings?, vec![families?]);
    fill(&mut rows, &intervals);
    Ok(Figures { rows, of_code, intervals, families, groups, readings, application_times: application_times? })
}

/// A figure with what the bench gives for it.
fn row_of(bench: &Bench, figure: &Figure) -> Result<FigureRow, FigureError> {
    match bench.measure(figure.id) {
        Ok(measured) => Ok(FigureRow::new(figure, measured)),
        Err(error) => Err(FigureError { id: figure.id.to_owned(), reason: error.to_string() }),
    }
}
