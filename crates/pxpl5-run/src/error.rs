use crate::result::outcome::Outcome;
use crate::result::picture_ends::WARM_UP_PICTURES;
use pxpl5_machine::RunError;
use pxpl5_sim::parameters::SettingError;
use thiserror::Error;

/// The reasons why an experiment cannot run, or ended without a result.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// The machine or one of its parameters is invalid, or the pipeline cannot run on the machine, or the number of fields
    /// is out of range.
    #[error(transparent)]
    Config(#[from] SettingError),
    /// Only pictures of the warm-up were shown. The observations of the run are kept.
    #[error(
        "only {} shown in {} and the first {WARM_UP_PICTURES} are discarded; {}",
        were(*pictures as u64, "picture"),
        count_of(*fields, "field"),
        advice(*needed)
    )]
    TooShort {
        /// Number of simulated fields.
        fields: u64,
        /// Number of pictures that were shown. All these pictures belong to the warm-up and are not evaluated.
        pictures: usize,
        /// Approximate number of fields until a picture after the warm-up is shown. `None` if no picture was shown.
        ///
        /// The number is computed by the pipeline's closed form ([`crate::Experiment::estimates`]). Without a
        /// closed form, the number is extrapolated from the run.
        needed: Option<u64>,
        /// Outcome of the run, with all observations.
        partial: Box<Outcome>,
    },
    /// The recording of the head's motion ends before the end of the run, or has a gap within the run. The text states
    /// the times.
    #[error("{0}")]
    Recording(String),
    /// A run at the analytic level was requested. The analytic level has no simulated events, so there is nothing to
    /// run.
    #[error("level: expected transaction or cycle, found analytic, which has no events (it is for sweeps and limits)")]
    Level,
    /// The scene has no triangles or spheres, or too many moving structures. The text states which.
    #[error("{0}")]
    Scene(String),
    /// A flag ([`crate::Experiment::stopped_by`]) or the observing function ([`crate::Experiment::run_stopping`]) ended
    /// the run early.
    #[error("{0}")]
    Stopped(String),
    /// The machine failed. All observations before the failure are kept.
    #[error("{error} ({} had been shown)", count_of(partial.tally().pictures, "picture"))]
    Run {
        /// The machine's reason for the failure.
        error: RunError,
        /// Outcome of the run until the error.
        partial: Box<Outcome>,
    },
}

fn count_of(count: u64, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}

fn were(count: u64, name: &str) -> String {
    format!("{} {}", count_of(count, name), if count == 1 { "was" } else { "were" })
}

fn advice(needed: Option<u64>) -> String {
    match needed {
        Some(fields) => format!("simulate more fields: the next one is shown after about {fields}"),
        None => "simulate more fields".to_owned(),
    }
}
