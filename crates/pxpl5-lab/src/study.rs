//! The shape of all studies, which answer a question by many experiments.

use crate::error::StudyError;
use crate::estimate::Estimate;
use pxpl5_run::ExperimentError;
use pxpl5_sim::{StopFlag, Watcher};
use serde::Serialize;

/// A question that many experiments answer.
///
/// ```
/// use pxpl5_lab::levels::LevelQuery;
/// use pxpl5_lab::{Study, StopFlag, StudyError};
///
/// let mut stop = StopFlag::default();
/// stop.stop();
/// assert!(matches!(LevelQuery::default().run(&mut stop), Err(StudyError::Experiment(_))));
/// ```
pub trait Study {
    /// The answer.
    type Report: Serialize;

    /// Estimates the memory and time of the study on `threads` threads. The default is
    /// almost nothing, for a study whose work depends on no setting.
    fn estimate(&self, _threads: usize) -> Estimate {
        Estimate::NOTHING
    }

    /// Answers the question. The watcher gets the progress and the finished rows. After it has stopped the study, the
    /// report has the rows that were finished.
    ///
    /// # Errors
    ///
    /// Returns [`StudyError`] for an invalid setting, if an experiment or a file fails, and
    /// [`ExperimentError::Stopped`] if the study was stopped before a part of its report was final.
    fn run(&self, watcher: &mut dyn Watcher) -> Result<Self::Report, StudyError>;
}

/// Returns an error if a study was stopped.
///
/// # Errors
///
/// Returns [`ExperimentError::Stopped`].
pub(crate) fn check(stop: &StopFlag) -> Result<(), ExperimentError> {
    if stop.is_stopped() { Err(ExperimentError::Stopped("the study was stopped".to_owned())) } else { Ok(()) }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::experiment_file::ExperimentFile;
    use crate::figures::{FigureQuery, FigureSettings};
    use crate::interpretations::InterpretationQuery;
    use crate::levels::LevelQuery;
    use crate::limit::{LimitQuery, OverQuery};
    use pxpl5_run::{Goal, Level};
    use std::fmt::Display;

    /// A watcher that stops the study when some parts are finished, and counts its rows.
    #[derive(Default)]
    pub(crate) struct StopsAfter {
        pub(crate) parts: u64,
        pub(crate) rows: u64,
        pub(crate) stop: StopFlag,
    }

    impl Watcher for StopsAfter {
        fn progress(&mut self, done: u64, _: u64) {
            if done >= self.parts {
                self.stop.stop();
            }
        }

        fn row(&mut self, _: &'static str, _: &dyn Display) {
            self.rows += 1;
        }

        fn stop(&self) -> StopFlag {
            self.stop.clone()
        }
    }

    fn is_stopped<S: Study>(study: &S) -> bool {
        let ended = study.run(&mut StopsAfter { parts: 1, ..StopsAfter::default() });
        matches!(ended, Err(StudyError::Experiment(ExperimentError::Stopped(_))))
    }

    #[test]
    fn a_study_ends_with_an_error_soon_after_its_flag_is_set() {
        let text = "pipeline = \"slats\"\nscene = \"full-screen:10\"\nfields = 30\n";
        let file = ExperimentFile::parse(text, "test").expect("TOML");
        let plan = file.resolve().expect("valid");
        assert!(is_stopped(&LimitQuery::of_plan(&plan)));

        let (key, goal) = ("machine.n_renderers".to_owned(), Goal::LatencyFields(1.01));
        let values = OverQuery::values(&plan, &key, None, None).expect("a range");
        assert!(is_stopped(&OverQuery { file, key, values, goal }));

        // The first value runs and misses the goal. A stopped search must not report that no value reaches the goal.
        let text = "pipeline = \"rendering-control\"\nscene = \"full-screen:10\"\nfields = 120\n";
        let file = ExperimentFile::parse(text, "test").expect("TOML");
        let plan = file.resolve().expect("valid");
        let (key, goal) = ("machine.n_gps".to_owned(), Goal::LatencyFields(0.01));
        let values = |to| OverQuery::values(&plan, "machine.n_gps", Some(3.0), Some(to)).expect("a range");
        let unstopped = OverQuery { file, key, values: values(4.0), goal };
        assert!(unstopped.run(&mut ()).is_ok_and(|limit| !limit.reached));
        assert!(is_stopped(&OverQuery { values: values(20.0), ..unstopped }));

        let settings = FigureSettings::new(Level::Analytic).with_mig(1, 12);
        assert!(is_stopped(&InterpretationQuery { settings: settings.clone(), best: 2 }));
        assert!(is_stopped(&FigureQuery { settings, intervals: false, only: Vec::new() }));
        assert!(is_stopped(&LevelQuery { experiments: 2, speeds: false }));
    }
}
