//! Questions over many experiments. The only crate with files and threads: it runs on a [`Workstation`].
//!
//! | question | module |
//! |---|---|
//! | what do the published figures come out as, and how sure is that | [`figures`], [`intervals`], [`pipeline_figures`] |
//! | which reading of the papers explains them | [`readings`] |
//! | what the host's application, of which nothing is printed, does to them | [`application_time`] |
//! | how do the levels of modelling differ | [`levels`] |
//! | what times of primitives follow from code | [`code_times`] |
//! | how many triangles, how fast does cost grow | [`limit`], [`growth`] |
//! | which way to fight latency wins | [`compare`] |
//! | what latency does one measure from outside | [`rig`] |
//! | what does an experiment take of this computer | [`estimate`] |
//! | the same at many points | [`sweep`] |
//! | which files of a folder belong together | [`manifest`] |
//! | an experiment as text, and continued | [`ExperimentFile`], [`Plan`], [`Snapshot`] |
//!
//! [`registry`] lists the pipelines and displays of the papers with their closed forms; an experiment file may be read with
//! another one.

#![warn(missing_docs)]

pub mod application_time;
pub mod code_times;
pub mod compare;
pub mod estimate;
mod experiment_file;
pub mod figures;
pub mod growth;
mod head_names;
mod host;
pub mod intervals;
pub mod levels;
pub mod limit;
pub mod manifest;
mod parallel;
pub mod pipeline_figures;
pub mod readings;
pub mod rig;
mod snapshot;
mod suitability;
pub mod sweep;

pub use experiment_file::{
    ExperimentFile, FileError, FileKey, HeadChoice, MotionChoice, Outputs, PathChoice, Plan, Published, SceneChoice,
    Settings, tracking_parameters,
};
pub use head_names::{MotionError, PREDICTORS, TRACKERS, motion, predictor, tracker};
pub use host::Workstation;
pub use snapshot::{Snapshot, SnapshotError};
pub use suitability::{Suitability, suitability};

use pxpl5_run::Registry;
use std::sync::{Arc, LazyLock};

/// The pipelines and displays of the papers, with the closed forms of those that have one.
#[must_use]
pub fn registry() -> Arc<Registry> {
    static OF_PAPERS: LazyLock<Arc<Registry>> = LazyLock::new(|| {
        let mut registry = Registry::of_papers();
        pxpl5_analytic::add_closed_forms(&mut registry);
        Arc::new(registry)
    });
    Arc::clone(&OF_PAPERS)
}
