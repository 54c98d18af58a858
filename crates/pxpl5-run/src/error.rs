use crate::outcome::Outcome;
use crate::picture_ends::WARM_UP_PICTURES;
use pxpl5_machine::RunError;
use pxpl5_sim::Time;
use pxpl5_sim::parameters::SettingError;
use thiserror::Error;

/// The reasons why an experiment cannot run, or ended without a result.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// The machine or one of its parameters is invalid, or the pipeline cannot run on the machine.
    #[error(transparent)]
    Config(#[from] SettingError),
    /// The number of fields is out of range.
    #[error("fields must be {} to {}, found {found}", expected.0, expected.1)]
    Fields {
        /// Smallest and largest valid number of fields.
        expected: (u64, u64),
        /// Number of fields that was requested.
        found: u64,
    },
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
        /// The number is computed by the pipeline's closed form ([`crate::Experiment::with_estimates`]). Without a
        /// closed form, the number is extrapolated from the run.
        needed: Option<u64>,
        /// Outcome of the run, with all observations.
        partial: Box<Outcome>,
    },
    /// The recording of the head's motion ends before the end of the run.
    #[error(
        "the recording of the head ends after {:.3} s and the run takes {:.3} s: simulate fewer fields, or set the behaviour after its end \
         (head.end = \"hold\" or \"loop\")",
        seconds(*recording),
        seconds(*run)
    )]
    Recording {
        /// Time at which the recording ends.
        recording: Time,
        /// Time at which the run ends.
        run: Time,
    },
    /// The recording of the head's motion has a gap within the time of the run.
    #[error(
        "the recording of the head has no pose from {:.3} s to {:.3} s and the run takes {:.3} s: simulate fewer fields, or let the head \
         stand still there (head.end = \"hold\")",
        seconds(*from),
        seconds(*to),
        seconds(*run)
    )]
    RecordingGap {
        /// Time of the last pose before the gap.
        from: Time,
        /// Time of the first pose after the gap.
        to: Time,
        /// Time at which the run ends.
        run: Time,
    },
    /// A run at the analytic level was requested. The analytic level has no simulated events, so there is nothing to
    /// run.
    #[error("level: expected transaction or cycle, found analytic, which has no events (it is for sweeps and limits)")]
    Level,
    /// The scene has no triangles or spheres, or too many moving structures. The text states which.
    #[error("{0}")]
    Scene(String),
    /// The host ([`crate::Host::is_stopped`]) or the observing function ([`crate::Experiment::run_stopping`]) ended the
    /// run early.
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

fn seconds(at: Time) -> f64 {
    at.since(Time::ZERO).as_ms() * 1e-3
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
