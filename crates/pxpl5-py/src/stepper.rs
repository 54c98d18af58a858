//! A running experiment that Python advances step by step.
//!
//! The machine belongs to a thread of its own, because its programs cannot move to another thread. Python sends jobs to
//! this thread and waits for the results without the interpreter's lock.

use crate::background::{recv, spawn};
use crate::catalogue::python;
use crate::errors::{failed_run, wrong_setting};
use crate::outcome::{outcome_of_run, surface_named};
use crate::picture::Picture;
use crate::policy::PythonFunctions;
use pxpl5::{Board, ExperimentError, Pause, PeriodNumber, SettingError, Stepper as Native, StopFlag, Time};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel, sync_channel};
use std::sync::{Mutex, PoisonError};

/// Work for the thread of the machine. After [`Stepper::finish`], the job gets `None` instead of the machine.
type Job = Box<dyn FnOnce(&mut Option<Native>) + Send>;

/// A thread that owns a machine and executes jobs on it, one after the other.
pub(crate) struct MachineThread {
    jobs: Mutex<Sender<Job>>,
    stop: StopFlag,
}

impl MachineThread {
    pub(crate) fn start(
        py: Python<'_>,
        experiment: pxpl5::Experiment,
        stop: StopFlag,
    ) -> PyResult<Result<Self, ExperimentError>> {
        let (jobs, received) = channel::<Job>();
        let (sender, begun) = sync_channel(1);
        spawn("pxpl5-stepper", move || {
            let mut stepper = match experiment.stepper() {
                Ok(stepper) => Some(stepper),
                Err(error) => {
                    let _ = sender.send(Err(error));
                    return;
                }
            };
            // If the caller no longer waits, the loop ends at once.
            let _ = sender.send(Ok(()));
            received.iter().for_each(|job: Job| job(&mut stepper));
        })?;
        let begun = wait(py, begun, &stop)?;
        Ok(begun.map(|()| Self { jobs: Mutex::new(jobs), stop }))
    }

    fn ask<T: Send + 'static>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut Option<Native>, &StopFlag) -> T + Send + 'static,
    ) -> PyResult<T> {
        let (sender, result) = sync_channel(1);
        let stop = self.stop.clone();
        stop.clear();
        let job: Job = Box::new(move |stepper| {
            let _ = sender.send(job(stepper, &stop));
        });
        let sent = self.jobs.lock().unwrap_or_else(PoisonError::into_inner).send(job);
        sent.map_err(|_| failed_run("a bug of the emulator: its thread panicked"))?;
        wait(py, result, &self.stop)
    }

    /// Executes a job on the machine, or raises an exception if the run has finished.
    fn execute<T: Send + 'static>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut Native, &StopFlag) -> T + Send + 'static,
    ) -> PyResult<T> {
        let found = self.ask(py, |stepper, stop| stepper.as_mut().map(|stepper| job(stepper, stop)))?;
        found.ok_or_else(|| failed_run("the run is finished: expected a stepper before finish()"))
    }

    pub(crate) fn finish(&self, py: Python<'_>) -> PyResult<Result<pxpl5::Outcome, Box<ExperimentError>>> {
        let found = self.ask(py, |stepper, _| stepper.take().map(|stepper| stepper.finish().map_err(Box::new)))?;
        found.ok_or_else(|| failed_run("the run is finished: expected a stepper before finish()"))
    }
}

/// Waits for the result of another thread without the interpreter's lock. Ctrl-C sets `stop` and raises
/// `KeyboardInterrupt`.
pub(crate) fn wait<T: Send>(py: Python<'_>, mut results: Receiver<T>, stop: &StopFlag) -> PyResult<T> {
    loop {
        match py.detach(|| recv(&mut results)) {
            Ok(result) => return Ok(result),
            Err(RecvTimeoutError::Timeout) => {
                py.check_signals().inspect_err(|_| stop.stop())?;
            }
            Err(RecvTimeoutError::Disconnected) => {
                return Err(failed_run("a bug of the emulator: its thread panicked"));
            }
        }
    }
}

/// Runs the machine to an instant in steps of one field, so that the flag `stop` takes effect soon.
fn run_to(stepper: &mut Native, time: Time, stop: &StopFlag) -> Pause {
    loop {
        let next = stepper.record().tick(stepper.period().next());
        let pause = stepper.run_to(next.min(time));
        if next >= time || pause != Pause::Reached || stop.is_stopped() {
            return pause;
        }
    }
}

fn pause_text(pause: &Pause) -> String {
    match pause {
        Pause::Reached => "reached".to_owned(),
        Pause::Breakpoints(_) => "breakpoint".to_owned(),
        Pause::End => "end".to_owned(),
        Pause::Failed(error) => format!("failed: {error}"),
    }
}

/// Parses the name of a board, such as `host`, `gp 3`, `renderer 0`, `display 0` or `ring`.
fn board_named(name: &str) -> PyResult<Board> {
    name.parse().map_err(|error: SettingError| wrong_setting(error.at("board")))
}

/// A running experiment that advances on request.
#[pyclass(frozen, module = "pxpl5._native")]
pub(crate) struct Stepper {
    pub(crate) thread: MachineThread,
    /// Python functions that the run calls, such as the function of the head's motion.
    pub(crate) checks: PythonFunctions,
    pub(crate) measures: Vec<pxpl5::Measure>,
}

impl Stepper {
    /// Executes a step of the run on the thread of the machine, and returns the reason for the end of the step in
    /// words.
    fn step(
        &self,
        py: Python<'_>,
        step: impl FnOnce(&mut Native, &StopFlag) -> Pause + Send + 'static,
    ) -> PyResult<String> {
        let pause = self.thread.execute(py, step);
        self.checks.check()?;
        Ok(pause_text(&pause?))
    }
}

#[pymethods]
impl Stepper {
    /// Runs to an instant in picoseconds of simulated time. Returns ``reached``, ``end``, ``breakpoint`` or ``failed``
    /// with the reason.
    fn run_to_ps(&self, py: Python<'_>, time_ps: u64) -> PyResult<String> {
        self.step(py, move |stepper, stop| run_to(stepper, Time(time_ps), stop))
    }

    /// Runs to the start of a field, counted from 0. Returns the same texts as :meth:`run_to_ps`.
    fn run_to_field(&self, py: Python<'_>, field: u64) -> PyResult<String> {
        self.step(py, move |stepper, stop| {
            let time = stepper.record().tick(PeriodNumber(field));
            run_to(stepper, time, stop)
        })
    }

    /// Runs to the start of the next field. Returns the same texts as :meth:`run_to_ps`.
    fn step_field(&self, py: Python<'_>) -> PyResult<String> {
        self.step(py, |stepper, _| stepper.step_period())
    }

    /// Runs until the first surface begins to light its next line. Returns the same texts as :meth:`run_to_ps`.
    fn step_line(&self, py: Python<'_>) -> PyResult<String> {
        self.step(py, |stepper, _| stepper.step_line())
    }

    /// Handles one event, or the events up to the next event of a board. Returns the same texts as :meth:`run_to_ps`.
    ///
    /// Raises :class:`pxpl5.SettingError` for an unknown board.
    #[pyo3(signature = (board = None))]
    fn step_event(&self, py: Python<'_>, board: Option<&str>) -> PyResult<String> {
        match board.map(board_named).transpose()? {
            Some(board) => self.step(py, move |stepper, _| stepper.step_board(board)),
            None => self.step(py, |stepper, _| stepper.step_event()),
        }
    }

    /// Returns the instant at which the last step ended, in picoseconds of simulated time.
    #[getter]
    fn now_ps(&self, py: Python<'_>) -> PyResult<u64> {
        self.thread.execute(py, |stepper, _| stepper.now().0)
    }

    /// Returns the instant at which the run ends, in picoseconds of simulated time.
    #[getter]
    fn end_ps(&self, py: Python<'_>) -> PyResult<u64> {
        self.thread.execute(py, |stepper, _| stepper.end().0)
    }

    /// Returns the number of the current field, counted from 0.
    #[getter]
    fn field(&self, py: Python<'_>) -> PyResult<u64> {
        self.thread.execute(py, |stepper, _| stepper.period().0)
    }

    /// Returns the last event as a dictionary with time_ps, board and what. Returns None if the last step did not end
    /// with an event.
    fn last_event<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let event = self.thread.execute(py, |stepper, _| stepper.last())?;
        python(
            py,
            &event
                .map(|event| json!({ "time_ps": event.time.0, "board": event.board.to_string(), "what": event.what })),
        )
    }

    /// Returns the state of a processor or a renderer as a dictionary. The result is None for a board of any other
    /// kind, and for a board that the machine does not have.
    ///
    /// Raises :class:`pxpl5.SettingError` for an unknown kind of board.
    fn board<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let board = board_named(name)?;
        let state = self.thread.execute(py, move |stepper, _| match board {
            Board::Renderer(number) => stepper.renderer(number).map(renderer_state),
            board => stepper.processor(board).map(|snapshot| processor_state(&snapshot)),
        })?;
        python(py, &state)
    }

    /// Returns the messages that occupy channels of the ring now, as dictionaries.
    fn channels<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let channels = self.thread.execute(py, |stepper, _| stepper.channels())?;
        let all: Vec<Value> = channels
            .iter()
            .map(|message| {
                json!({
                    "channel": message.channel,
                    "source": message.source.0,
                    "destination": message.destination.0,
                    "words": message.words,
                    "granted_ps": message.granted.0,
                    "ends_at_ps": message.ends_at.map(|time| time.0),
                })
            })
            .collect();
        python(py, &all)
    }

    /// Returns the picture that the viewer of a surface sees now, with the beam at its present position. Returns None
    /// if no pixels are computed, or if the surface does not exist.
    fn picture(&self, py: Python<'_>, surface: &str) -> PyResult<Option<Picture>> {
        let name = surface.to_owned();
        let picture = self
            .thread
            .execute(py, move |stepper, _| surface_named(stepper.record(), &name).map(|id| stepper.seen(id)))?;
        picture.map_err(wrong_setting)?.map(|picture| Picture::of(py, picture, Vec::new())).transpose()
    }

    /// Returns the hash of the trace up to now.
    #[getter]
    fn trace_hash(&self, py: Python<'_>) -> PyResult<String> {
        self.thread.execute(py, |stepper, _| stepper.record().trace_hash().to_string())
    }

    /// Returns the number of complete pictures that the machine has shown so far.
    #[getter]
    fn shown(&self, py: Python<'_>) -> PyResult<usize> {
        self.thread.execute(py, |stepper, _| stepper.pictures().iter().filter(|times| times.is_shown()).count())
    }

    /// Runs to the end of the experiment and returns the outcome, which equals the outcome of a run without steps.
    ///
    /// Raises the same exceptions as :meth:`Experiment.run`.
    fn finish(&self, py: Python<'_>) -> PyResult<crate::outcome::Outcome> {
        let result = self.thread.finish(py);
        self.checks.check()?;
        outcome_of_run(py, result?, &self.measures)
    }
}

/// Returns the state of a processor as JSON, with times in picoseconds.
fn processor_state(snapshot: &pxpl5::snapshots::GpSnapshot) -> Value {
    let programs: Vec<Value> = snapshot
        .programs
        .iter()
        .map(|program| {
            json!({
                "priority": format!("{:?}", program.priority).to_lowercase(),
                "waits_for": program.waits_for,
                "work_left_ps": program.work_left.map(|span| span.0),
            })
        })
        .collect();
    let inbox: Vec<Value> = snapshot
        .inbox
        .iter()
        .map(|message| json!({ "arrived_ps": message.arrived.0, "source": message.source.0 }))
        .collect();
    let memory: serde_json::Map<String, Value> = snapshot
        .memory
        .iter()
        .map(|(account, bytes)| (format!("{account:?}").to_lowercase(), Value::from(*bytes)))
        .collect();
    json!({
        "programs": programs,
        "inbox": inbox,
        "unaccepted": snapshot.unaccepted.iter().map(|node| node.0).collect::<Vec<_>>(),
        "chains": snapshot.chains,
        "memory_bytes": memory,
        "busy_ps": snapshot.busy.0,
    })
}

/// Returns the state of a renderer as JSON, with times in picoseconds.
fn renderer_state(snapshot: pxpl5::snapshots::RendererSnapshot) -> Value {
    json!({
        "fifo_words": snapshot.fifo_words,
        "fifo_depth_words": snapshot.fifo_depth_words,
        "stands_at_copy": snapshot.stands_at_copy,
        "copying_region": snapshot.copying.map(|copy| copy.target.region.0),
        "stored_regions": snapshot.stored_regions,
        "busy_ps": snapshot.busy.0,
    })
}
