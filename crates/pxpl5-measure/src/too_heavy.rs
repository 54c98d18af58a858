//! Warning about a scene that is too heavy for a pipeline, with advice.

use pxpl5_run::{DuePictures, Experiment};
use serde::Serialize;
use std::fmt;

/// Warning that the load was too heavy ([`DuePictures::is_too_heavy`]).
///
/// The warning states how many triangles the pipeline can show in time.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct TooHeavy {
    /// Number of pictures that were due.
    pub due: u64,
    /// Number of pictures due that were late, incomplete or missed.
    pub not_shown: u64,
    /// Number of triangles and spheres in the scene.
    pub triangles: u64,
    /// Number of primitives to which the scene must be decimated for pictures in time, by the pipeline's closed form.
    ///
    /// `None` if the pipeline has no closed form, or if the closed form predicts that the whole scene is in time.
    pub triangles_in_time: Option<u64>,
    /// Advice to the user: a number of triangles to try, or a search that finds this number.
    pub advice: String,
}

impl TooHeavy {
    /// Returns the warning that the load of an experiment was too heavy, or `None` if the load was acceptable.
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
    let search = format!("a search with `limit` finds the number of test triangles that {pipeline} draws in time");
    match triangles_in_time {
        Some(0) => {
            format!("the analytic level predicts that not even one triangle of this scene would be in time; {search}")
        }
        Some(some) => {
            format!("the analytic level predicts that about {some} triangles would be in time (triangles = {some})")
        }
        None => search,
    }
}

const fn ending(count: u64) -> &'static str {
    if count == 1 { "" } else { "s" }
}

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
