//! A flag with which one thread stops the work of other threads.

use pxpl5_run::{ExperimentError, Host};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag with which one thread stops a study and its runs on other threads. Clones share the flag.
///
/// The flag is also a [`Host`] without clock and worker threads, which ends its runs when the flag is set.
#[derive(Clone, Debug, Default)]
pub struct StopFlag(Arc<AtomicBool>);

impl StopFlag {
    /// Requests the end of the work. Runs in progress end within a few display periods.
    pub fn stop(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Withdraws the request to stop, so that the flag can be used again.
    pub fn clear(&self) {
        self.0.store(false, Ordering::Relaxed);
    }

    /// Returns true after a call of [`Self::stop`].
    pub fn is_stopped(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Returns an error after a call of [`Self::stop`].
    ///
    /// # Errors
    ///
    /// Returns [`ExperimentError::Stopped`].
    pub fn check(&self) -> Result<(), ExperimentError> {
        if self.is_stopped() { Err(ExperimentError::Stopped("the study was stopped".to_owned())) } else { Ok(()) }
    }
}

impl Host for StopFlag {
    fn is_stopped(&self) -> bool {
        self.is_stopped()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment_file::ExperimentFile;
    use crate::figures::{Bench, Figures};
    use crate::levels::{LevelQuery, compare_with};
    use crate::limit::{LimitQuery, OverQuery};
    use crate::{StudyError, interpretations};
    use pxpl5_run::{Goal, Level};

    /// Tests that each study returns the error `Stopped` after its stop flag was set. The flag is set at the first
    /// report of progress.
    #[test]
    fn a_study_ends_with_an_error_soon_after_its_flag_is_set() {
        let is_stopped = |result: Option<ExperimentError>| matches!(result, Some(ExperimentError::Stopped(_)));
        let text = "pipeline = \"slats\"\nscene = \"full-screen:10\"\nfields = 30\n";
        let file = ExperimentFile::parse(text, "test").expect("TOML");
        let plan = file.resolve().expect("valid");

        let stop = StopFlag::default();
        let limit = LimitQuery { stop: stop.clone(), ..LimitQuery::of_plan(&plan) };
        assert!(is_stopped(limit.search_with(|_, _| stop.stop()).err()));

        let stop = StopFlag::default();
        let (key, goal) = ("machine.n_renderers".to_owned(), Goal::LatencyFields(1.01));
        let values = OverQuery::values(&plan, &key, None, None).expect("a range");
        let over = OverQuery { file, key, values, goal, stop: stop.clone() };
        let ended = over.search(|_, _| stop.stop());
        assert!(matches!(ended, Err(StudyError::Experiment(ExperimentError::Stopped(_)))), "{ended:?}");

        // The first value runs and misses the goal. A stopped search must not report that no value reaches the goal.
        let text = "pipeline = \"rendering-control\"\nscene = \"full-screen:10\"\nfields = 120\n";
        let file = ExperimentFile::parse(text, "test").expect("TOML");
        let plan = file.resolve().expect("valid");
        let stop = StopFlag::default();
        let (key, goal) = ("machine.n_gps".to_owned(), Goal::LatencyFields(0.01));
        let values = OverQuery::values(&plan, &key, Some(3.0), Some(20.0)).expect("a range");
        let unstopped = OverQuery {
            file: file.clone(),
            key: key.clone(),
            values: OverQuery::values(&plan, &key, Some(3.0), Some(4.0)).expect("a range"),
            goal,
            stop: StopFlag::default(),
        };
        assert!(unstopped.search(|_, _| ()).is_ok_and(|limit| !limit.reached));
        let over = OverQuery { file, key, values, goal, stop: stop.clone() };
        let ended = over.search(|_, _| stop.stop());
        assert!(matches!(ended, Err(StudyError::Experiment(ExperimentError::Stopped(_)))), "{ended:?}");

        let stop = StopFlag::default();
        let bench = || Bench::new(Level::Analytic).with_mig(1, 12).with_stop(stop.clone());
        let ended = interpretations::run(&bench(), 2, |_, _| stop.stop()).map(|_| ());
        assert!(matches!(ended, Err(ExperimentError::Stopped(_))), "{ended:?}");
        assert!(Figures::run(&bench(), |_, _| {}, |_, _| {}).is_err_and(|error| error.to_string().contains("stopped")));

        let stop = StopFlag::default();
        let levels = LevelQuery { experiments: 2, speeds: false, stop: stop.clone() };
        assert!(is_stopped(compare_with(levels, |_, _| stop.stop()).err()));
    }
}
