//! How a long run goes on with bounded memory: what is behind it is summed up, and its records are given up.

use crate::experiment::Experiment;
use crate::keep::Keep;
use crate::pipeline::{PictureTimes, Pipeline};
use crate::samples::KEPT_SAMPLES;
use crate::tally::Tally;
use pxpl5_machine::{Machine, Observation, Record};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;

/// Records (marks, arrivals and swaps) from which on it is worth looking which can be given up. They take about 80 bytes each.
const LEAST_RECORDS: usize = 32_768;

/// Pictures that are held back, so that what still comes of them, and of those that are drawn beside them, is there when they are
/// summed up; and periods for which a picture is held back, and for which records from before it are.
const PICTURES_HELD: usize = 32;
const PERIODS_HELD: u64 = 32;

/// What of a run has been summed up.
#[derive(Debug)]
pub(crate) struct Window {
    tally: Tally,
    forgets: bool,
    /// Pictures that were shown up to this instant have been taken.
    taken_to: Option<Time>,
    /// Arrivals that have been taken, of those that are held.
    arrivals_taken: usize,
    /// Records from which on the next look is taken.
    next_look: usize,
}

impl Window {
    pub(crate) fn new(experiment: &Experiment, record: &Record) -> Self {
        let looks_back = experiment.head.is_some() || experiment.traffic;
        let may_forget = match experiment.keep {
            Keep::Everything => false,
            Keep::Statistics => !looks_back,
            Keep::Recent => true,
        };
        let forgets = may_forget && experiment.pipeline.can_forget();
        let limit = if forgets { KEPT_SAMPLES } else { usize::MAX };
        let tally = Tally::new(experiment.end(), field_ms(record), limit);
        Self { tally, forgets, taken_to: None, arrivals_taken: 0, next_look: LEAST_RECORDS }
    }

    /// Sums up what nobody will change any more and gives up its records, if that is wanted and there are many.
    pub(crate) fn look(&mut self, pipeline: &dyn Pipeline, machine: &mut Machine, now: Time) {
        if !self.forgets || held(machine.record().observation()) < self.next_look {
            return;
        }
        let record = machine.record();
        self.tally.records_looked_at += record.observation().records() as u64;
        self.take_arrivals(record);
        if let Some(begin) = self.take_old(pipeline, record, now) {
            self.tally.take_late(&pipeline.late_regions(record, begin));
            machine.forget_before(begin);
            self.arrivals_taken = machine.record().observation().arrivals.len();
        }
        self.next_look = LEAST_RECORDS.max(2 * held(machine.record().observation()));
    }

    /// Takes the pictures that are not held back; the instant from which on records are needed for those that are.
    fn take_old(&mut self, pipeline: &dyn Pipeline, record: &Record, now: Time) -> Option<Time> {
        let fresh = self.fresh(pipeline, record, now);
        let newest_taken = fresh.len().checked_sub(PICTURES_HELD + 1)?;
        let until = fresh[newest_taken].shown_at.min(before(record, now)?);
        let held = fresh.partition_point(|times| times.shown_at <= until);
        let (old, held) = fresh.split_at(held);
        let needed =
            held.iter().map(|times| times.sampled_at.unwrap_or(times.transform_at).min(times.transform_at)).min()?;
        let begin = before(record, needed).filter(|begin| *begin > record.observation().forgotten.before)?;
        self.tally.take(pipeline, record, old);
        self.taken_to = Some(until);
        Some(begin)
    }

    /// Pictures that have not been taken, in the order in which they are shown.
    fn fresh(&self, pipeline: &dyn Pipeline, record: &Record, now: Time) -> Vec<PictureTimes> {
        let pictures = pipeline.pictures(record, now).into_iter();
        pictures.filter(|times| Some(times.shown_at) > self.taken_to).collect()
    }

    fn take_arrivals(&mut self, record: &Record) {
        let arrivals = &record.observation().arrivals;
        self.tally.take_arrivals(&arrivals[self.arrivals_taken..], record.message_span());
        self.arrivals_taken = arrivals.len();
    }

    /// Sums up what is left at the end of a run that reached a period; gives also the pictures that are still known one by one.
    pub(crate) fn close(
        mut self,
        pipeline: &dyn Pipeline,
        record: &Record,
        (end, reached): (Time, PeriodNumber),
    ) -> (Tally, Vec<PictureTimes>) {
        self.tally.end_early(reached);
        self.tally.records_looked_at += record.observation().records() as u64;
        self.take_arrivals(record);
        self.tally.take_late(&pipeline.late_regions(record, end));
        let pictures = self.fresh(pipeline, record, end);
        self.tally.take(pipeline, record, &pictures);
        (self.tally, pictures)
    }
}

/// Records that are held, those of messages and FIFOs among them.
fn held(observation: &Observation) -> usize {
    observation.records() + observation.traffic.as_ref().map_or(0, |traffic| traffic.records())
}

/// So many periods as are held before an instant.
fn before(record: &Record, instant: Time) -> Option<Time> {
    let period = record.display().period_at(instant).before(PERIODS_HELD)?;
    Some(record.tick(period))
}

/// A period of the first display in milliseconds, from 60,000 of them.
pub(crate) fn field_ms(record: &Record) -> f64 {
    record.tick(PeriodNumber(60_000)).since(Time::ZERO).as_ms() / 60_000.0
}
