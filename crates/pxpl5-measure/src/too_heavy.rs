//! A scene that is too heavy for a pipeline, and what would do.

use pxpl5_run::{DuePictures, Experiment};
use serde::Serialize;
use std::fmt;

/// That the load was too heavy ([`DuePictures::is_too_heavy`]), and how many triangles would do.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct TooHeavy {
    /// Pictures that were due.
    pub due: u64,
    /// Those that were late, incomplete or missed.
    pub not_shown: u64,
    /// Triangles and spheres of the scene.
    pub triangles: u64,
    /// How many of them, the scene's first ones, would be shown in time, by the pipeline's closed form; nothing where it has
    /// none, or where that has so many in time.
    pub triangles_in_time: Option<u64>,
    /// How to get pictures in time: a number of triangles, or how to find one.
    pub advice: String,
}

impl TooHeavy {
    /// Of an experiment; `None` where the load was not too heavy.
    #[must_use]
    pub fn of(experiment: &Experiment, due: &DuePictures) -> Option<Self> {
        if !due.is_too_heavy() {
            return None;
        }
        let triangles = (experiment.scene().triangles().len() + experiment.scene().spheres().len()) as u64;
        let triangles_in_time = experiment.triangles_in_time().filter(|in_time| *in_time < triangles);
        let advice = advice(experiment.pipeline().name(), triangles_in_time);
        Some(Self { due: due.due, not_shown: due.not_shown(), triangles, triangles_in_time, advice })
    }
}

fn advice(pipeline: &str, triangles_in_time: Option<u64>) -> String {
    let search = format!("`pxpl5 limit --pipeline {pipeline}` finds how many test triangles it draws in time");
    match triangles_in_time {
        Some(0) => format!("by the closed form not even one triangle of this scene would be in time; {search}"),
        Some(some) => format!("by the closed form about {some} would do (--triangles {some})"),
        None => search,
    }
}

/// The ending of a noun behind a number.
const fn ending(count: u64) -> &'static str {
    if count == 1 { "" } else { "s" }
}

/// In a line.
impl fmt::Display for TooHeavy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { due, not_shown, triangles, advice, .. } = self;
        write!(
            f,
            "TOO HEAVY: with {triangles} triangle{} {not_shown} of {due} picture{} due {} not shown in time; {advice}.",
            ending(*triangles),
            ending(*due),
            if *not_shown == 1 { "was" } else { "were" }
        )
    }
}
