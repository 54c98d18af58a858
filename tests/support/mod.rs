//! Functions that several tests share.

use pxpl5::{ExperimentError, NtscDisplay, Outcome, Record};
use pxpl5_framebuffer::{FrameBuffer, Video};

/// Returns true if campaigns run all cases instead of a sample, as in scripts/nightly.
pub(crate) fn runs_all_cases() -> bool {
    std::env::var_os("PXPL5_ALL_CASES").is_some()
}

/// Returns the first value in a sample, and the second value if all cases run.
pub(crate) fn sample_or_all<T>(sample: T, all: T) -> T {
    if runs_all_cases() { all } else { sample }
}

/// Returns the NTSC display of a run.
pub(crate) fn ntsc(record: &Record) -> &NtscDisplay {
    record.display_of_kind().expect("the papers' machines have one")
}

/// Returns the retraces and the beam of a run.
pub(crate) fn video(outcome: &Outcome) -> &Video {
    ntsc(outcome.record()).video()
}

/// Returns the frame buffers of a run: left, right.
pub(crate) fn boards(outcome: &Outcome) -> &[FrameBuffer] {
    ntsc(outcome.record()).boards()
}

/// Returns the outcome of a run, also of one that is too short for statistics. `what` names the run if it fails.
pub(crate) fn outcome(run: Result<Outcome, ExperimentError>, what: impl std::fmt::Display) -> Outcome {
    match run {
        Ok(outcome) => outcome,
        Err(ExperimentError::TooShort { partial, .. }) => *partial,
        Err(error) => panic!("{what}: {error}"),
    }
}
