//! Sweeps: one experiment at every point of a space of settings.
//!
//! ```text
//!  FILE.toml --> Sweep --> points 0 .. n --> threads --> rows.jsonl   one line a point, appended when it is finished
//!                  |          |                      `-> times.jsonl  how long each took on this host
//!                  `-> Header `-> shard i/n          `-> results.csv  at the end
//! ```
//!
//! # Behaviour
//!
//! - A point's row depends on the file and the point alone: not on threads, shards, order or host. What does depend on
//!   the host is kept apart, in times.jsonl.
//! - Rows are appended as they come, each with one write. When all are there they are put in order of their points, so
//!   that the finished file is the same bytes however it came about.
//! - After a kill at any moment the last line may be torn: [`Store::open`] cuts it off, and that point is computed
//!   again; no other.
//! - A point that cannot be simulated has a row that says why; the others go on.
//! - Two processes never write into one folder: the second is refused.
//!
//! # Not modelled
//!
//! Random sampling and adaptive refinement of the space; points of one sweep on several hosts other than by shards.

mod chunk;
mod cost;
mod error;
mod header;
mod inputs;
mod joined;
mod merge;
mod point;
mod points;
mod replacement;
mod rows;
mod run;
mod scenes;
mod shard;
mod space;
mod store;
mod table;

pub use error::SweepError;
pub use header::Header;
pub use merge::{Merged, merge};
pub use point::{Status, SweepRow};
pub use run::{RunOptions, run};
pub use shard::Shard;
pub use space::{Axis, MAX_POINTS, SweepSpace, Values};
pub use store::{RESULTS_FILE, ROWS_FILE, Store, TIMES_FILE};

use crate::experiment_file::{ExperimentFile, FileError};
use scenes::Scenes;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An experiment file with a space of settings.
#[derive(Clone, Debug)]
pub struct Sweep {
    base: ExperimentFile,
    space: SweepSpace,
    /// What its points have loaded so far; clones share it.
    scenes: Arc<Scenes>,
}

impl Sweep {
    /// Reads a file.
    ///
    /// # Errors
    ///
    /// As [`ExperimentFile::load`] and [`Sweep::new`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self, FileError> {
        Self::new(ExperimentFile::load(path)?)
    }

    /// The sweep that a file describes in its table `sweep`.
    ///
    /// # Errors
    ///
    /// [`FileError`] when it has none, or one that makes no sense.
    pub fn new(base: ExperimentFile) -> Result<Self, FileError> {
        let space = SweepSpace::read(&base)?;
        Ok(Self { base, space, scenes: Arc::default() })
    }

    /// The settings that all points share.
    #[must_use]
    pub const fn base(&self) -> &ExperimentFile {
        &self.base
    }

    /// The folder of the sweep's file, to which names of files are relative.
    fn folder(&self) -> PathBuf {
        self.base.sweep.as_ref().map(|sweep| sweep.folder.clone()).unwrap_or_default()
    }

    /// The space of settings, whose points are the experiments.
    #[must_use]
    pub const fn space(&self) -> &SweepSpace {
        &self.space
    }
}

#[cfg(test)]
mod tests;
