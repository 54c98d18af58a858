//! Running an experiment.

use crate::cut::moves;
use crate::display_list::{display_list, hmd_before, poses, views};
use crate::error::ExperimentError;
use crate::experiment::{Experiment, FIELDS_RANGE, Pixels, WARM_UP_PICTURES};
use crate::face_notes::FaceNotes;
use crate::head::Head;
use crate::head_views::{FIELDS_WITH_HEAD, HeadViews};
use crate::level::{Level, with_clocks_of_instructions};
use crate::outcome::Outcome;
use crate::pipeline::{Pipeline, Setup};
use crate::preparation::Preparation;
use crate::views::{FrameStarts, ReportTimes};
use crate::window::Window;
use pxpl5_machine::{ConfigError, DEADLOCK_TICKS, Machine, MachineConfig, RunError};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use std::collections::BTreeSet;
use std::sync::Arc;

/// A machine with its programs, and what is written of a run while it goes on.
struct Assembled {
    machine: Machine,
    head: Option<Arc<HeadViews>>,
    notes: FaceNotes,
}

impl Experiment {
    /// Builds the machine, switched on, with the pipeline's programs loaded; with prediction, after a rehearsal.
    ///
    /// # Errors
    ///
    /// [`ExperimentError`] for a machine, scene or number of fields that cannot be simulated.
    pub fn build(&self) -> Result<Machine, ExperimentError> {
        Ok(self.assemble(self.prepare()?)?.machine)
    }

    fn assemble(&self, preparation: Preparation) -> Result<Assembled, ExperimentError> {
        let expected = if self.head.is_some() { (FIELDS_RANGE.0, FIELDS_WITH_HEAD) } else { FIELDS_RANGE };
        if !(expected.0..=expected.1).contains(&self.fields) {
            return Err(ExperimentError::Fields { expected, found: self.fields });
        }
        let mut adapted = self.pipeline.adapt(self.config.clone());
        check_faces(&adapted, self.pipeline.as_ref())?;
        let [red, green, blue] = self.scene.lighting().background;
        let background = u32::from_be_bytes([0, red, green, blue]);
        adapted.displays.iter_mut().for_each(|display| display.show_behind_all(background));
        let layout = self.pipeline.layout();
        let config = match self.level {
            Level::Analytic => return Err(ExperimentError::Level),
            Level::Transaction => adapted,
            Level::Cycle => with_clocks_of_instructions(&adapted, &layout),
        };
        let mut machine = Machine::new(&config, self.pipeline.eyes(), layout)?;
        if self.level == Level::Cycle {
            machine.run_code();
        }
        let (setup, head) = self.setup(&config, &machine, preparation)?;
        let notes = setup.notes.clone();
        self.pipeline.load(&mut machine, &setup)?;
        if let Some(seed) = self.shuffle {
            machine.shuffle_ties(seed);
        }
        self.given_up.iter().for_each(|saving| machine.give_up(*saving));
        if self.pixels == Pixels::All {
            machine.compute_all_pixels(self.host.pixel_worker());
        }
        if self.traffic {
            machine.record_traffic();
        }
        machine.switch_on();
        Ok(Assembled { machine, head, notes })
    }

    fn setup(
        &self,
        config: &MachineConfig,
        machine: &Machine,
        preparation: Preparation,
    ) -> Result<(Setup, Option<Arc<HeadViews>>), ExperimentError> {
        let surface = machine.record().display().surfaces().first().cloned();
        let hmd = hmd_before(surface.as_ref());
        let eyes = self.pipeline.eyes();
        let period = config.host.view_period_ns * 1_000;
        let cut = self.pipeline.cut(&self.scene, config)?;
        let scene = cut.as_ref().map_or(&self.scene, |cut| &cut.scene);
        let list = Arc::new(display_list(scene).map_err(ExperimentError::Scene)?);
        let (views, wanted) = views(scene, self.seed, hmd, eyes);
        let reports: ReportTimes = Arc::new(move |after: Time| Some(Time((after.0 / period + 1) * period)));
        let starts: FrameStarts = Arc::new(Some);
        let aim = self.aim();
        let pixels = self.pixels != Pixels::Off;
        let poses = poses(scene, self.seed);
        let notes = FaceNotes::default();
        let moving = scene.structures().iter().map(moves).collect();
        let cells = cut.as_ref().map_or_else(Arc::default, |cut| Arc::clone(&cut.cells));
        let host = config.host;
        let setup = Setup { list, views, wanted, poses, moving, cells, notes, aim, reports, starts, host, pixels };
        let Some(head) = preparation.head.or_else(|| self.head.clone()) else { return Ok((setup, None)) };
        let until = machine.record().tick(self.end());
        check_recording(&head, until)?;
        let head = Arc::new(HeadViews::new(head, scene, (hmd, eyes), until, preparation.rehearsal));
        let (views, wanted, reports) = HeadViews::functions(&head);
        let setup = Setup { views, wanted, reports, poses: HeadViews::poses(&head), ..setup };
        if !self.on_demand {
            return Ok((setup, Some(head)));
        }
        let asked = Arc::clone(&head);
        Ok((Setup { starts: Arc::new(move |ready| asked.report_from(ready)), ..setup }, Some(head)))
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

    pub(crate) fn perform(
        &self,
        preparation: Preparation,
        stops: &[PeriodNumber],
        mut at: impl FnMut(PeriodNumber, &mut Machine) -> Result<(), ExperimentError>,
    ) -> Result<Outcome, ExperimentError> {
        let begun_s = self.host.seconds();
        let Assembled { mut machine, head, notes } = self.assemble(preparation.clone())?;
        let mut window = Window::new(self, machine.record());
        let mut result = Ok(());
        for field in self.stops(stops) {
            let until = machine.record().tick(field);
            result = machine.run_until(until);
            if result.is_err() {
                break;
            }
            if self.host.is_given_up() {
                return Err(ExperimentError::Stopped("the run was given up".to_owned()));
            }
            at(field, &mut machine)?;
            window.look(self.pipeline.as_ref(), &mut machine, until);
        }
        // Where frames are begun on demand, a host without a further report is at rest for good reason.
        if result.is_ok() && !self.on_demand && self.may_be_stuck(&machine) {
            result = self.deadlock(preparation).map_or(Ok(()), Err);
        }
        machine.finish_pixels();
        let host_seconds = begun_s.zip(self.host.seconds()).map(|(begin, end)| end - begin);
        let record = machine.into_record();
        let stopped = result.as_ref().err().map(|error| record.display().period_at(error.time()));
        let reached = stopped.unwrap_or(self.end()).min(self.end());
        let outcome = Outcome::new(self.clone(), record, (head, notes), window, reached, host_seconds);
        match result {
            Err(error) => Err(ExperimentError::Run { error, partial: Box::new(outcome) }),
            Ok(()) if shown_in(&outcome) <= WARM_UP_PICTURES as u64 => Err(self.too_short(outcome)),
            Ok(()) => Ok(outcome),
        }
    }

    /// Whether a machine at the end of the run may never go on. A pipeline that waits for a swap is at rest until the next tick; only
    /// a run that was over soon could have come to rest for ever in the last periods before its end, and not before.
    fn may_be_stuck(&self, machine: &Machine) -> bool {
        machine.is_at_rest() && (self.fields <= SHORT_RUN || machine.idle_ticks() >= IDLE_TICKS)
    }

    /// Whether a machine that is at rest at the end of the run, which may be too short to tell, would be so for ever: the run
    /// is repeated for as long as that takes, so that the record of this one ends where it was asked to.
    fn deadlock(&self, preparation: Preparation) -> Option<RunError> {
        let longer = Self { fields: self.fields + DEADLOCK_TICKS + 2, pixels: Pixels::Off, ..self.clone() };
        let Assembled { mut machine, .. } = longer.assemble(preparation).ok()?;
        for field in longer.stops(&[]) {
            let until = machine.record().tick(field);
            if let Err(error) = machine.run_until(until) {
                return Some(error).filter(|error| matches!(error, RunError::Deadlock { .. }));
            }
            machine.forget_before(until);
        }
        None
    }

    fn too_short(&self, partial: Outcome) -> ExperimentError {
        let needed = self.estimates.and_then(|estimates| (estimates.fields_needed)(self));
        let pictures = partial.tally().pictures as usize;
        ExperimentError::TooShort { fields: self.fields, pictures, needed, partial: Box::new(partial) }
    }

    /// Fields at which to stop: those asked for, every so many for the progress, the last.
    fn stops(&self, asked: &[PeriodNumber]) -> impl Iterator<Item = PeriodNumber> {
        let end = self.end();
        let mut asked: BTreeSet<PeriodNumber> = asked.iter().copied().filter(|field| *field < end).collect();
        let mut regular =
            PeriodNumber(PROGRESS_FIELDS).until(end).step_by(PROGRESS_FIELDS as usize).chain([end]).peekable();
        std::iter::from_fn(move || {
            let next = regular.peek().into_iter().chain(asked.first()).copied().min()?;
            regular.next_if_eq(&next);
            asked.remove(&next);
            Some(next)
        })
    }
}

/// Pictures of a run, those included for which nothing had to be drawn.
fn shown_in(outcome: &Outcome) -> u64 {
    outcome.tally().pictures.max(outcome.pipeline().turned_periods(outcome.record(), outcome.end()))
}

/// Fields of a run that may be over before a deadlock has been noticed, and ticks without work from which on a longer one may be in one
/// that it was too short to notice.
const SHORT_RUN: u64 = 2 * DEADLOCK_TICKS;
const IDLE_TICKS: u64 = 2;

/// Fields between two reports of progress.
const PROGRESS_FIELDS: u64 = 60;

/// A display that shows faces needs a pipeline that draws them, and the other way round.
///
/// # Errors
///
/// [`ConfigError`] says what was expected of the pipeline and what was found.
pub fn check_faces(config: &MachineConfig, pipeline: &dyn Pipeline) -> Result<(), ConfigError> {
    let Some(display) = config.displays.first() else { return Ok(()) };
    let name = display.name();
    let pipeline_name = pipeline.name();
    match (display.takes_faces(), pipeline.draws_faces().is_some()) {
        (true, false) => Err(ConfigError::Board(format!(
            "display {name} shows six faces around the head: expected a pipeline that draws faces, such as arp-full, found {pipeline_name}"
        ))),
        (false, true) => Err(ConfigError::Board(format!(
            "{pipeline_name} draws six faces around the head: expected the display arp, found {name}"
        ))),
        _ => Ok(()),
    }
}

/// A motion that ends must not end before the run.
fn check_recording(head: &Head, until: Time) -> Result<(), ExperimentError> {
    match head.motion.ends_ps().filter(|ends_ps| *ends_ps < until.0) {
        Some(ends_ps) => Err(ExperimentError::Recording { recording: Time(ends_ps), run: until }),
        None => Ok(()),
    }
}
