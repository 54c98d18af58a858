//! Published figures compared with the model: the printed value, the simulated value and their difference.
//!
//! ```text
//!   FIGURES (data) --> Bench::measure (one experiment each) --> Row: published, simulated, error, interval, provenance
//! ```
//!
//! Papers about other systems have separate families of rows ([`FigureFamily`]), measured together with the figures of
//! Pixel-Planes 5.
//!
//! All rows come from the same machine parameters. Rows 3, 5 and 6 describe machines with other loads or costs than the
//! presets. The experiments of these rows change only the parameters that the paper's statement changes.
//!
//! Sources: TR94, I3D95. This project chose the loads of the experiments.

mod applications;
mod document;
mod family;
mod group;
mod heads;
mod interpretation;
mod jitp;
mod measure;
mod measured;
mod rates;
mod row;
mod table;
mod tables;
mod trackers;

pub use document::markdown;
pub use family::FigureFamily;
pub use group::FigureGroup;
pub use heads::PHOTODIODE_LINE;
pub use interpretation::{FieldCount, Interpretation, LatencySamples, ROOM};
pub use measure::Bench;
pub use measured::FigureValue;
pub use pxpl5_sim::figures::{Basis, Detail, FigureRow};
pub use row::{MISS_PERCENT, mean_error_percent};
pub use table::{FIGURES, Figure, WITHOUT_CLOSED_FORM};
pub use tables::{FigureTable, figure_groups, run_all, run_all_in_order, run_all_with};

use crate::application_time::{ApplicationTime, application_times};
use crate::error::StudyError;
use crate::interpretations::{self, Interpretations};
use crate::intervals::Interval;
use crate::parallel;
use serde::Serialize;
use std::sync::atomic::{AtomicU64, Ordering};

/// All published figures with the model's values and intervals.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Rows of the main table, in the order of [`FIGURES`].
    pub rows: Vec<FigureRow>,
    /// Interval of each figure while the unpublished parameters vary. Figures that depend only on scenes have no
    /// interval. The list is empty if the settings leave out intervals ([`Bench::without_intervals`]).
    pub intervals: Vec<Interval>,
    /// Figures of papers about other systems than Pixel-Planes 5.
    pub families: Vec<FigureFamily>,
    /// Other figures of Pixel-Planes 5 by topic: peak rates, just-in-time pixels, trackers.
    pub groups: Vec<FigureGroup>,
}

/// Published figures under other assumptions than in [`Figures`]. ACCURACY.md shows all members. The JSON of `pxpl5
/// figures` has only the member `of_code`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Alternatives {
    /// Rows of the main table with the times of executed i860 code, without intervals.
    pub of_code: Vec<FigureRow>,
    /// Fit of the model to the published figures of Rendering Control, for each interpretation of the papers, at the
    /// analytic level.
    pub interpretations: Interpretations,
    /// Latencies of the fly-throughs for several times of the application on the host, at the analytic level.
    pub application_times: Vec<ApplicationTime>,
}

/// Number of seeds for each application scene in the ranking of interpretations of the papers.
const SEEDS: u64 = 6;
/// Number of frames for each seed in the ranking of interpretations of the papers.
const FRAMES: u64 = 150;

/// Measures the members of [`Alternatives`] in parallel. Calls `finished` with the number of finished members and the
/// number of all members.
///
/// # Errors
///
/// Returns the first [`StudyError`].
pub fn alternatives_with(bench: &Bench, finished: impl Fn(u64, u64) + Sync) -> Result<Alternatives, StudyError> {
    let done = AtomicU64::new(0);
    let step = || finished(done.fetch_add(1, Ordering::Relaxed) + 1, 3);
    let by_code = bench.clone().with_times_of_code();
    let ranked = bench.clone().with_mig(SEEDS, FRAMES);
    let of_code = || {
        let rows = stepped(&step, || parallel::map(&FIGURES, |figure| row_of(&by_code, figure)));
        rows.into_iter().collect::<Result<Vec<_>, _>>()
    };
    let interpretations = || stepped(&step, || interpretations::run(&ranked, 0, |_, _| {}));
    let of_application = || stepped(&step, || application_times(&ranked));
    let (of_code, (interpretations, times)) =
        parallel::both(of_code, || parallel::both(interpretations, of_application));
    Ok(Alternatives {
        of_code: of_code?,
        interpretations: interpretations.map_err(StudyError::of_figure("7"))?,
        application_times: times.map_err(StudyError::of_figure("7"))?,
    })
}

fn stepped<T>(step: &impl Fn(), part: impl FnOnce() -> T) -> T {
    let result = part();
    step();
    result
}

fn row_of(bench: &Bench, figure: &Figure) -> Result<FigureRow, StudyError> {
    bench.measure(figure.id).map(|measured| figure.row(measured)).map_err(StudyError::of_figure(figure.id))
}
