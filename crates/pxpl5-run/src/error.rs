//! Why an experiment gives no result.

use crate::outcome::Outcome;
use crate::picture_ends::WARM_UP_PICTURES;
use pxpl5_machine::{ConfigError, RunError};
use pxpl5_sim::Time;
use thiserror::Error;

/// Why an experiment gave no result.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// The machine or its numbers are impossible, or the pipeline cannot run on it.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The number of fields is out of range.
    #[error("fields must be {} to {}, found {found}", expected.0, expected.1)]
    Fields {
        /// Smallest and largest number.
        expected: (u64, u64),
        /// What was asked for.
        found: u64,
    },
    /// Nothing but pictures of the warm-up was shown in the time given; what was observed is kept.
    #[error(
        "only {} shown in {} and the first {WARM_UP_PICTURES} are discarded; {}",
        were(*pictures as u64, "picture"),
        count_of(*fields, "field"),
        advice(*needed)
    )]
    TooShort {
        /// Fields simulated.
        fields: u64,
        /// Pictures that were shown; the first ones are discarded.
        pictures: usize,
        /// About how many fields it takes until a picture after the warm-up is shown, by the pipeline's closed form;
        /// `None` where there is none ([`crate::Experiment::estimated_by`]).
        needed: Option<u64>,
        /// Everything that was observed.
        partial: Box<Outcome>,
    },
    /// The head's motion ends before the run does.
    #[error(
        "the recording of the head ends after {:.3} s and the run takes {:.3} s: simulate fewer fields, or say what comes after its end \
         (head.end = \"hold\" or \"loop\")",
        seconds(*recording),
        seconds(*run)
    )]
    Recording {
        /// The end of the recording.
        recording: Time,
        /// The end of the run.
        run: Time,
    },
    /// The run needs a stretch of which the recording of the head has no pose.
    #[error(
        "the recording of the head has no pose from {:.3} s to {:.3} s and the run takes {:.3} s: simulate fewer fields, or let the head \
         stand still there (head.end = \"hold\")",
        seconds(*from),
        seconds(*to),
        seconds(*run)
    )]
    RecordingGap {
        /// The last pose before it.
        from: Time,
        /// The first pose after it.
        to: Time,
        /// The end of the run.
        run: Time,
    },
    /// The analytic level has no events that an experiment could observe.
    #[error("level: expected transaction or cycle, found analytic, which has no events (it is for sweeps and limits)")]
    Level,
    /// The scene has nothing to draw, or too many moving structures.
    #[error("{0}")]
    Scene(String),
    /// Whoever watched the run ended it ([`crate::Experiment::run_stopping`]).
    #[error("{0}")]
    Stopped(String),
    /// The run ended early; what was observed until then is kept.
    #[error("{error} ({} had been shown)", count_of(partial.tally().pictures, "picture"))]
    Run {
        /// What the machine could not do.
        error: RunError,
        /// Everything until then.
        partial: Box<Outcome>,
    },
}

fn seconds(at: Time) -> f64 {
    at.since(Time::ZERO).as_ms() * 1e-3
}

/// A number of things with their name in the right form.
fn count_of(count: u64, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}

fn were(count: u64, name: &str) -> String {
    format!("{} {}", count_of(count, name), if count == 1 { "was" } else { "were" })
}

/// How long a run must be.
fn advice(needed: Option<u64>) -> String {
    match needed {
        Some(fields) => format!("simulate more fields: the next one is shown after about {fields}"),
        None => "simulate more fields".to_owned(),
    }
}
