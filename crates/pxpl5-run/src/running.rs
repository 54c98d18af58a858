use crate::build::preparation::Preparation;
use crate::error::ExperimentError;
use crate::experiment::Experiment;
use crate::level::Level;
use crate::result::outcome::Outcome;
use crate::stepper::{Pause, Stepper};
use pxpl5_machine::Machine;
use pxpl5_wire::PeriodNumber;

impl Experiment {
    /// Builds the machine, loads the pipeline's programs and starts the machine. If the head's pose is predicted, a dry
    /// run comes first.
    ///
    /// # Errors
    ///
    /// Returns [`ExperimentError`] for a machine, scene or number of fields that cannot be simulated.
    pub fn build(&self) -> Result<Machine, ExperimentError> {
        Ok(self.assemble(self.prepare()?)?.machine)
    }

    /// Checks that the machine can be built and that the programs can be loaded, without a dry run. At the analytic
    /// level, nothing is built.
    ///
    /// # Errors
    ///
    /// Returns the error with which a run would be refused.
    pub fn check(&self) -> Result<(), ExperimentError> {
        if self.level == Level::Analytic { Ok(()) } else { self.assemble(Preparation::default()).map(drop) }
    }

    /// Runs the experiment and returns the outcome.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Experiment::build`]. Returns [`ExperimentError::Run`] with all observations so far
    /// if the run ends early. Returns [`ExperimentError::TooShort`] with all observations if only pictures of the
    /// warm-up were shown.
    pub fn run(&self) -> Result<Outcome, ExperimentError> {
        self.run_stopping(&[], |_, _| Ok(()))
    }

    /// Runs the experiment and calls `at` at the start of each field in `stops`, at every 60th field (at every field of the
    /// cycle level), and at the end of the run.
    ///
    /// `at` receives the field and the run, before the machine handles any event of this field. An error from `at`
    /// ends the run without a result, and [`Stepper::end_early`] ends it with the result of the fields so far.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Experiment::run`], and with any error that `at` returns.
    pub fn run_stopping(
        &self,
        stops: &[PeriodNumber],
        at: impl FnMut(PeriodNumber, &mut Stepper) -> Result<(), ExperimentError>,
    ) -> Result<Outcome, ExperimentError> {
        self.perform(self.prepare()?, stops, at)
    }

    /// Builds and starts the machine, and returns a [`Stepper`], which runs the experiment in steps.
    ///
    /// If the head's pose is predicted, a dry run comes first. [`Stepper::finish`] returns the same result as
    /// [`Experiment::run`]. With [`Experiment::record_traffic`], the stepper can also read FIFOs and pixel memory.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Experiment::build`].
    pub fn stepper(&self) -> Result<Stepper, ExperimentError> {
        Stepper::begin(self, self.prepare()?)
    }

    pub(crate) fn perform(
        &self,
        preparation: Preparation,
        stops: &[PeriodNumber],
        mut at: impl FnMut(PeriodNumber, &mut Stepper) -> Result<(), ExperimentError>,
    ) -> Result<Outcome, ExperimentError> {
        // Run from stop to stop. A failed machine ends the loop, and `finish` returns the error.
        let mut stepper = Stepper::begin(self, preparation)?;
        for field in self.stops(stops) {
            if stepper.run_to(stepper.record().tick(field)) != Pause::Reached {
                break;
            }
            self.check_stopped()?;
            at(field, &mut stepper)?;
        }
        stepper.finish()
    }

    /// Returns an error if the result is no longer needed ([`Experiment::stopped_by`]).
    ///
    /// # Errors
    ///
    /// Returns [`ExperimentError::Stopped`] in this case.
    pub fn check_stopped(&self) -> Result<(), ExperimentError> {
        if self.stop.is_stopped() {
            return Err(ExperimentError::Stopped("the run was stopped".to_owned()));
        }
        Ok(())
    }
}
