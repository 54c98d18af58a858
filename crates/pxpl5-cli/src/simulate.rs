//! Runs an experiment within its budget.

use crate::budget::{BudgetArgs, EARLY_CHECK_FIELDS};
use crate::error::CliError;
use crate::interrupt;
use crate::progress::Bar;
use crate::scenes;
use crate::terminal::{print_error, warn};
use crate::too_heavy::too_heavy;
use pxpl5::lab::estimate::RunWork;
use pxpl5::{
    ExperimentError, KeptRecords, Observation, Optimization, Outcome, PeriodNumber, Plan, StopFlag, Traffic,
    Workstation,
};

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct How<'a> {
    pub(crate) threads: Option<u64>,
    pub(crate) without: &'a [Optimization],
    pub(crate) keep: KeptRecords,
    /// Records every message of the ring, for a trace.
    pub(crate) traffic: bool,
    pub(crate) budget: BudgetArgs,
    pub(crate) quiet: bool,
}

#[derive(Debug)]
pub(crate) struct Simulated {
    pub(crate) outcome: Outcome,
    /// Error with which the command ends although there is an outcome: a run that was too short or interrupted.
    pub(crate) too_short: Option<CliError>,
}

impl Simulated {
    /// Returns the outcome of the run. Fails if the run was too short for statistics.
    pub(crate) fn long_enough(self) -> Result<Outcome, CliError> {
        self.too_short.map_or(Ok(self.outcome), Err)
    }
}

/// Bytes in memory for each event of the trace while the file is made (measured, rounded up).
const EVENT_BYTES: f64 = 200.0;

/// Returns the memory that the trace of the records so far will take, in bytes. A message is an event of two ports.
fn trace_bytes(observation: &Observation) -> f64 {
    let of_traffic =
        |traffic: &Traffic| 2 * traffic.transfers.len() + traffic.busy_channels.len() + traffic.fifo_changes.len();
    observation
        .traffic
        .as_deref()
        .map_or(0.0, |traffic| EVENT_BYTES * (observation.records() + of_traffic(traffic)) as f64)
}

pub(crate) fn simulate(plan: &Plan, how: How<'_>) -> Result<Simulated, CliError> {
    let scene = scenes::load(plan, how.quiet)?;
    warn(too_heavy(plan, &scene, plan.fields).as_slice(), how.quiet);
    let host = how.threads.map_or_else(Workstation::new, |threads| Workstation::with_threads(threads as usize));
    let (experiment, choice) = plan.with_chosen_level(scene, true);
    choice.filter(|_| !how.quiet).into_iter().for_each(|choice| print_error(&format!("pxpl5: {choice}\n")));
    let experiment = experiment.host(host).keep(how.keep).record_traffic(how.traffic);
    how.budget.admit(&RunWork::of(&experiment, how.keep == KeptRecords::Everything))?;
    let experiment = how.without.iter().fold(experiment, |experiment, saving| experiment.without(*saving));
    // The run stops at these fields to extrapolate its cost early.
    let stops = EARLY_CHECK_FIELDS.map(|field| PeriodNumber::FIRST.after(field));
    let mut bar = Bar::new("fields", how.quiet);
    bar.advance(0, plan.fields);
    let monitor = how.budget.monitor(plan.fields);
    // Ctrl-C ends a dry run without a result, and a run with that of the fields so far.
    let experiment = experiment.stopped_by(interrupt::flag()).after_dry_run();
    let outcome = experiment.and_then(|experiment| {
        experiment.stopped_by(StopFlag::default()).run_stopping(&stops, |field, run| {
            let done = field.since(PeriodNumber::FIRST);
            bar.advance(done, plan.fields);
            if interrupt::flag().is_stopped() {
                run.end_early();
            }
            monitor.check(done, trace_bytes(run.record().observation())).map_err(ExperimentError::Stopped)
        })
    });
    bar.clear();
    let ended = bar.check("only these fields are reported, and no file was written").err();
    let error = match outcome {
        Ok(outcome) => return Ok(Simulated { outcome, too_short: ended }),
        Err(error) => error,
    };
    let reason = ended.unwrap_or_else(|| CliError::failure(&error));
    match error {
        ExperimentError::TooShort { partial, .. } => Ok(Simulated { outcome: *partial, too_short: Some(reason) }),
        ExperimentError::Stopped(_) => Err(reason),
        error => Err(error.into()),
    }
}
