//! Tools for questions that need many experiments.
//!
//! This is the only crate that uses files and threads of the host computer, which a [`Workstation`] represents.
//!
//! | question | module |
//! |---|---|
//! | values of the published figures in the model, with intervals | [`figures`], [`intervals`] |
//! | the interpretation of the papers that explains the figures best | [`interpretations`] |
//! | differences between the levels of detail | [`levels`] |
//! | largest number of triangles drawn in time | [`limit`] |
//! | range of any setting in which an experiment reaches a goal | [`limit::OverQuery`] |
//! | differences between two results | [`diff`] |
//! | effect of 10 % more of each resource | [`WhatIfQuery`] |
//! | results that a small change moves by a whole field | [`near_edges`] |
//! | comparison of all low-latency methods | [`compare`] |
//! | latency measured from outside | [`rig`] |
//! | memory and time of an experiment on this computer | [`estimate`] |
//! | experiments at many points of a parameter space | [`sweep`] |
//! | walks and volumes | [`walks`], [`volumes`] |
//! | the files of a folder that belong to one run | [`manifest`] |
//! | experiments in text files | [`ExperimentFile`], [`Plan`] |
//!
//! Each question is a [`Study`]: it estimates its cost, tells a [`Watcher`] its progress, and returns its report.
//!
//! [`registry`] lists the built-in pipelines and displays. A pipeline's entry contains its closed form, if there is
//! one. An experiment file may also use a registry with pipelines and displays of the caller.

#![warn(missing_docs)]

pub mod compare;
pub mod diff;
mod edges;
mod error;
pub mod estimate;
mod experiment_file;
pub mod figures;
mod head_parts;
mod host;
pub mod interpretations;
pub mod intervals;
pub mod levels;
pub mod limit;
pub mod manifest;
mod parallel;
pub mod rig;
mod study;
mod suitability;
pub mod sweep;
pub mod volumes;
pub mod walks;
mod what_if;

pub use edges::{NEAR_FIELDS, near_edges};
pub use error::StudyError;
pub use experiment_file::{
    ExperimentFile, FileKey, HeadChoice, ModelPlace, MotionChoice, Origin, Outputs, PathChoice, Plan, Published,
    SceneChoice, Settings, tracking_parameters,
};
pub use head_parts::{PREDICTORS, TRACKERS, motion, predictor, tracker};
pub use host::Workstation;
pub use parallel::map as in_parallel;
pub use pxpl5_sim::{StopFlag, Watcher};
pub use study::Study;
pub use suitability::{Suitability, suitability};
pub use what_if::{WhatIf, WhatIfQuery};

use pxpl5_run::Registry;
use std::sync::{Arc, LazyLock};

/// Returns the registry of the built-in pipelines and displays.
///
/// Some pipelines have a closed form.
pub fn registry() -> Arc<Registry> {
    static OF_PAPERS: LazyLock<Arc<Registry>> = LazyLock::new(|| {
        let mut registry = Registry::of_papers();
        pxpl5_analytic::add_closed_forms(&mut registry);
        Arc::new(registry)
    });
    Arc::clone(&OF_PAPERS)
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
