//! Sweeps: one experiment at every point of a parameter space.
//!
//! ```text
//!  FILE.toml --> Sweep --> points 0 .. n --> threads --> rows.jsonl   one line a point, appended when it is finished
//!                  |          |                      `-> times.jsonl  how long each took on this host
//!                  `-> Header `-> shard i/n          `-> results.csv  at the end
//! ```
//!
//! # Behaviour
//!
//! - The row of a point depends only on the file and the point, not on threads, shards, order or host. Data that depend
//!   on the host are in times.jsonl.
//! - Each row is appended by one write when its point is finished. At the end the rows are sorted by the number of
//!   their point. The finished file is therefore the same, byte for byte, for every order of execution.
//! - After a crash the last line may be incomplete. [`Store::open`] removes this line, and only its point is computed
//!   again.
//! - A point that cannot be simulated has a row with the reason. All other points continue.
//! - Two processes never write into one folder. The second process gets an error.
//! - Every row has the numbers of due pictures, of pictures not shown, and of evaluated pixels, even if the file
//!   selects other quantities. Without these counts, a mean over few pictures looks like a mean over all.
//!
//! # Not modelled
//!
//! Random sampling and adaptive refinement of the space are not supported. Several hosts can share a sweep only if each
//! host runs a different shard (part) of the sweep.

mod chunk;
mod cost;
mod header;
mod inputs;
mod joined;
mod lines;
mod merge;
mod point;
mod replacement;
mod resources;
mod rows;
mod run;
mod scenes;
mod shard;
mod space;
mod store;
mod table;

pub(crate) use inputs::inputs_of;
pub(crate) use lines::{LineFile, line_of};
pub(crate) use store::lock;

pub use header::Header;
pub use inputs::hash_of_model;
pub use merge::{Merged, merge};
pub use point::{PointResults, Status, SweepRow, Swept};
pub use resources::{PointSample, TaskResources};
pub use rows::ROWS_FILE;
pub use run::{RunOptions, SweepQuery};
pub use scenes::SceneCache;
pub use shard::Shard;
pub use space::{Axis, AxisValues, MAX_POINTS, SweepSpace, leaves};
pub use store::{RESULTS_FILE, Store, TIMES_FILE};

use crate::experiment_file::{ExperimentFile, Plan};
use pxpl5_measure::Measure;
use pxpl5_sim::parameters::SettingError;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A sweep: an experiment file with a parameter space.
#[derive(Clone, Debug)]
pub struct Sweep {
    base: ExperimentFile,
    space: SweepSpace,
    scenes: Arc<SceneCache>,
}

impl Sweep {
    /// Reads a sweep from a file.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`ExperimentFile::load`] and [`Sweep::new`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SettingError> {
        Self::new(ExperimentFile::load(path)?)
    }

    /// Creates the sweep that the table `sweep` of a file describes.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the table is missing or invalid.
    pub fn new(base: ExperimentFile) -> Result<Self, SettingError> {
        let of_file = base.sweep.as_ref();
        let place = of_file.map_or("", |sweep| &sweep.place);
        let key_of = |path: &str, place: &str| base.canonical_key(path, place);
        let space = SweepSpace::read(of_file.map(|sweep| &sweep.value), (place, &base.sweep_places), key_of)?;
        Ok(Self { base, space, scenes: Arc::default() })
    }

    /// Returns the settings that all points of the sweep share.
    pub const fn base(&self) -> &ExperimentFile {
        &self.base
    }

    fn folder(&self) -> PathBuf {
        self.base.sweep.as_ref().map(|sweep| sweep.folder.clone()).unwrap_or_default()
    }

    /// Returns the parameter space. Each of its points is an experiment.
    pub const fn space(&self) -> &SweepSpace {
        &self.space
    }
}

/// Returns the quantities of a row: the quantities in the experiment file, then the counts that a comparison of means
/// requires ([`Measure::counts`]). A point without a run has no counts.
fn measures(plan: &Plan) -> Vec<Measure> {
    let mut all = plan.measure.clone();
    all.extend(Measure::counts().into_iter().filter(|count| is_run(plan) && !plan.measure.contains(count)));
    all
}

/// Returns true unless the only quantity of a point is the result of a search.
fn is_run(plan: &Plan) -> bool {
    plan.measure.iter().map(Measure::name).ne([Measure::TRIANGLES])
}

#[cfg(test)]
mod tests;
