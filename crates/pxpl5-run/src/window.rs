//! How a long run goes on with bounded memory: what is behind it is summed up, and its records are given up.

use crate::assembled::Assembled;
use crate::experiment::Experiment;
use crate::face_notes::FaceNotes;
use crate::head_views::HeadViews;
use crate::keep::Keep;
use crate::pipeline::{PictureTimes, Pipeline};
use crate::result_window::ResultWindow;
use crate::samples::KEPT_SAMPLES;
use crate::sums::{Settled, Summing};
use crate::tally::Tally;
use pxpl5_machine::Record;
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use std::any::Any;
use std::sync::Arc;

/// Records (marks, arrivals, swaps, poses and reports) from which on it is worth looking which can be given up. They take about 80 bytes each.
const LEAST_RECORDS: usize = 32_768;

/// Pictures that are held back, so that what still comes of them, and of those that are drawn beside them, is there when they are
/// summed up; and periods for which a picture is held back, and for which records from before it are.
const PICTURES_HELD: usize = 32;
const PERIODS_HELD: u64 = 32;

/// What of a run has been summed up, and how far back anybody may look: all who hold something of it are told here what they may give up.
///
/// Pictures are settled when they are not among the last [`PICTURES_HELD`] and [`PERIODS_HELD`] have passed. Records of what came
/// [`PERIODS_HELD`] before those that are not settled are given up, and periods before that are settled too. Of a head as many periods more
/// are held: what is shown in a period was predicted before it from reports that are older.
#[derive(Debug)]
pub(crate) struct Window {
    tally: Tally,
    sum: Option<Box<dyn Summing>>,
    forgets: bool,
    samples: usize,
    /// Pictures that were shown up to this instant have been taken.
    taken_to: Option<Time>,
    /// Arrivals that have been taken, of those that are held.
    arrivals_taken: usize,
    /// Records from which on the next look is taken.
    next_look: usize,
}

/// What came of a run: its sums, and the pictures that are still known one by one.
#[derive(Debug)]
pub(crate) struct Closed {
    pub(crate) tally: Tally,
    pub(crate) window: Option<ResultWindow>,
    pub(crate) said: Option<Box<dyn Any + Send + Sync>>,
    pub(crate) pictures: Vec<PictureTimes>,
}

impl Window {
    pub(crate) fn new(experiment: &Experiment, record: &Record) -> Self {
        let may_forget = match experiment.keep {
            Keep::Everything => false,
            Keep::Statistics => !experiment.traffic,
            Keep::Recent => true,
        };
        let forgets = may_forget && experiment.pipeline.can_forget();
        let samples = if forgets { KEPT_SAMPLES } else { usize::MAX };
        let tally = Tally::new(experiment.end(), field_ms(record), samples);
        let sums = experiment.sums.filter(|_| forgets && experiment.keep == Keep::Statistics);
        let sum = sums.map(|begin| begin());
        Self { tally, sum, forgets, samples, taken_to: None, arrivals_taken: 0, next_look: LEAST_RECORDS }
    }

    /// Sums up what nobody will change any more and gives up its records, if that is wanted and there are many.
    pub(crate) fn look(&mut self, experiment: &Experiment, run: &mut Assembled, now: Time) {
        if !self.forgets || run.records() < self.next_look {
            return;
        }
        let record = run.machine.record();
        self.tally.records_looked_at += record.observation().records() as u64;
        if let Some(begin) = self.take_old(experiment, run, now) {
            self.tally.take_late(&experiment.pipeline.late_regions(record, begin));
            let of_head = before(record, begin).unwrap_or_default();
            run.forget_before(begin, of_head);
            self.arrivals_taken = run.machine.record().observation().arrivals.len();
        }
        self.next_look = LEAST_RECORDS.max(2 * run.records());
    }

    /// Takes the pictures that are not held back; the instant from which on records are needed for those that are.
    fn take_old(&mut self, experiment: &Experiment, run: &Assembled, now: Time) -> Option<Time> {
        let record = run.machine.record();
        let fresh = self.fresh(experiment.pipeline.as_ref(), record, now);
        let newest_taken = fresh.len().checked_sub(PICTURES_HELD + 1)?;
        // Whole periods are taken, so that all pictures of each are known.
        let last = fresh[newest_taken].shown_at.min(before(record, now)?);
        let known = record.display().period_at(last);
        let settled_to = Time(record.tick(known).0.checked_sub(1)?);
        let held = fresh.partition_point(|times| times.shown_at <= settled_to);
        let (pictures, held) = fresh.split_at(held);
        let needed =
            held.iter().map(|times| times.sampled_at.unwrap_or(times.transform_at).min(times.transform_at)).min()?;
        let begin = before(record, needed).filter(|begin| *begin > record.observation().forgotten.before)?;
        let until = record.display().period_at(begin);
        let arrivals = &record.observation().arrivals[self.arrivals_taken..];
        let (next, samples) = (held.first(), self.samples);
        let all = experiment.settled(record, run.head.as_ref(), &run.notes);
        self.tally.count(record, pictures);
        let every = experiment.pipeline.periods_a_picture(record);
        let window = Some(ResultWindow::begun(self.tally.ends(), every, known, experiment.end()));
        self.take(&Settled { arrivals, pictures, next, until, samples, window, ..all });
        self.taken_to = Some(settled_to);
        Some(begin)
    }

    /// Pictures that have not been taken, in the order in which they are shown.
    fn fresh(&self, pipeline: &dyn Pipeline, record: &Record, now: Time) -> Vec<PictureTimes> {
        let pictures = pipeline.pictures(record, now).into_iter();
        pictures.filter(|times| Some(times.shown_at) > self.taken_to).collect()
    }

    /// Hands on what is settled to all who sum up.
    fn take(&mut self, settled: &Settled<'_>) {
        self.tally.take_arrivals(settled.arrivals, settled.record.message_span());
        self.tally.take(settled);
        self.sum.iter_mut().for_each(|sum| sum.take(settled));
    }

    /// Sums up what is left of a run at its end; it reached a period.
    pub(crate) fn close(
        mut self,
        experiment: &Experiment,
        record: &Record,
        (head, notes): (Option<&Arc<HeadViews>>, &FaceNotes),
        reached: PeriodNumber,
    ) -> Closed {
        let pipeline = experiment.pipeline.as_ref();
        let end = record.tick(experiment.end());
        self.tally.end_early(reached);
        self.tally.records_looked_at += record.observation().records() as u64;
        self.tally.take_late(&pipeline.late_regions(record, end));
        let pictures = self.fresh(pipeline, record, end);
        let arrivals = &record.observation().arrivals[self.arrivals_taken..];
        let samples = self.samples;
        let all = experiment.settled(record, head, notes);
        self.tally.count(record, &pictures);
        let every = pipeline.periods_a_picture(record);
        let window = ResultWindow::of(self.tally.ends(), every, reached, experiment.end());
        self.take(&Settled { arrivals, pictures: &pictures, samples, window, ..all });
        Closed { tally: self.tally, window, said: self.sum.map(|sum| sum.said()), pictures }
    }
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
