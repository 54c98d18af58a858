//! Running an experiment.

use crate::error::ExperimentError;
use crate::experiment::Experiment;
use crate::outcome::Outcome;
use crate::preparation::Preparation;
use crate::stepper::Stepper;
use pxpl5_machine::Machine;
use pxpl5_wire::PeriodNumber;

impl Experiment {
    /// Builds the machine, switched on, with the pipeline's programs loaded; with prediction, after a rehearsal.
    ///
    /// # Errors
    ///
    /// [`ExperimentError`] for a machine, scene or number of fields that cannot be simulated.
    pub fn build(&self) -> Result<Machine, ExperimentError> {
        Ok(self.assemble(self.prepare()?)?.machine)
    }

    /// Runs it.
    ///
    /// # Errors
    ///
    /// As [`Experiment::build`]; [`ExperimentError::Run`] with everything observed so far when the run ends early;
    /// [`ExperimentError::TooShort`], with the same, when nothing but pictures of the warm-up was shown.
    pub fn run(&self) -> Result<Outcome, ExperimentError> {
        self.run_with(|_, _| {})
    }

    /// Runs it and reports progress: fields simulated, of all.
    ///
    /// # Errors
    ///
    /// As [`Experiment::run`].
    pub fn run_with(&self, mut progress: impl FnMut(u64, u64)) -> Result<Outcome, ExperimentError> {
        self.run_stopping(&[], |field, _| {
            progress(field.since(PeriodNumber::FIRST), self.fields);
            Ok(())
        })
    }

    /// Runs it and stops at the retrace that begins each of some fields, and now and then between: `at` sees the field
    /// and the machine, before anything of that field has happened, and may end the run.
    ///
    /// # Errors
    ///
    /// As [`Experiment::run`], and what `at` says.
    pub fn run_stopping(
        &self,
        stops: &[PeriodNumber],
        at: impl FnMut(PeriodNumber, &mut Machine) -> Result<(), ExperimentError>,
    ) -> Result<Outcome, ExperimentError> {
        self.perform(self.prepare()?, stops, at)
    }

    /// The machine of the experiment, switched on, to be run in pieces and looked at between them; with prediction, after a rehearsal.
    /// [`Stepper::finish`] gives what [`Experiment::run`] does.
    ///
    /// With [`Experiment::record_traffic`] more can be seen: the words in FIFOs, and pixel memory.
    ///
    /// # Errors
    ///
    /// As [`Experiment::build`].
    pub fn stepper(&self) -> Result<Stepper, ExperimentError> {
        Stepper::begin(self, self.prepare()?)
    }

    pub(crate) fn perform(
        &self,
        preparation: Preparation,
        stops: &[PeriodNumber],
        mut at: impl FnMut(PeriodNumber, &mut Machine) -> Result<(), ExperimentError>,
    ) -> Result<Outcome, ExperimentError> {
        let mut stepper = Stepper::begin(self, preparation)?;
        for field in self.stops(stops) {
            stepper.run_to(stepper.record().tick(field));
            if stepper.failure().is_some() {
                break;
            }
            self.go_on()?;
            at(field, stepper.machine_mut())?;
        }
        stepper.finish()
    }

    /// Whether somebody still wants the result.
    pub(crate) fn go_on(&self) -> Result<(), ExperimentError> {
        if self.host.is_given_up() {
            return Err(ExperimentError::Stopped("the run was given up".to_owned()));
        }
        Ok(())
    }
}
