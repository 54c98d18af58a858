//! Warning about a scene that is too heavy for a pipeline, with advice.

use pxpl5_run::{DuePictures, Experiment};
use serde::Serialize;
use std::fmt;

/// Warning that the load was too heavy ([`DuePictures::is_too_heavy`]).
///
/// The warning states how many primitives (triangles and spheres) the pipeline can show in time.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct TooHeavy {
    /// Number of pictures that were due.
    pub pictures_due: u64,
    /// Number of pictures due that were late, incomplete or missed.
    pub missed_retraces: u64,
    /// Number of primitives in the scene: triangles and spheres.
    pub primitives: u64,
    /// Number of primitives to which the scene must be decimated for pictures in time, by the pipeline's closed form.
    ///
    /// `None` if the pipeline has no closed form, or if the closed form predicts that the whole scene is in time.
    pub primitives_in_time: Option<u64>,
    /// Advice to the user: a number of primitives to try, or a search that finds this number.
    pub advice: String,
}

impl TooHeavy {
    /// Returns the warning that the load of an experiment was too heavy, or `None` if the load was acceptable.
    pub fn of(experiment: &Experiment, due: &DuePictures) -> Option<Self> {
        if !due.is_too_heavy() {
            return None;
        }
        let primitives = experiment.scene().primitives() as u64;
        let primitives_in_time = experiment.estimates.and_then(|estimates| (estimates.primitives_in_time)(experiment));
        let primitives_in_time = primitives_in_time.filter(|in_time| *in_time < primitives);
        let advice = advice(experiment.pipeline().name(), primitives_in_time);
        Some(Self { pictures_due: due.due, missed_retraces: due.not_shown(), primitives, primitives_in_time, advice })
    }
}

fn advice(pipeline: &str, primitives_in_time: Option<u64>) -> String {
    let search = format!("a search with `limit` finds the number of test triangles that {pipeline} draws in time");
    match primitives_in_time {
        Some(0) => {
            format!("the analytic level predicts that not even one primitive of this scene would be in time; {search}")
        }
        Some(some) => {
            format!("the analytic level predicts that about {some} primitives would be in time (triangles = {some})")
        }
        None => search,
    }
}

const fn ending(count: u64) -> &'static str {
    if count == 1 { "" } else { "s" }
}

impl fmt::Display for TooHeavy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pictures_due, missed_retraces, primitives, advice, .. } = self;
        write!(
            f,
            "TOO HEAVY: with {primitives} primitive{} {missed_retraces} of {pictures_due} picture{} due {} not shown in time; {advice}.",
            ending(*primitives),
            ending(*pictures_due),
            if *missed_retraces == 1 { "was" } else { "were" }
        )
    }
}
