//! Memory management of long runs: adds the results of old records to the sums of the run and discards the records.

use crate::assembled::Assembled;
use crate::experiment::Experiment;
use crate::head_views::HeadViews;
use crate::keep::Keep;
use crate::observers::{FinalResults, StreamingObserver};
use crate::pipeline::{PictureTimes, Pipeline};
use crate::result_window::ResultWindow;
use crate::tally::Tally;
use pxpl5_machine::Record;
use pxpl5_sim::KEPT_SAMPLES;
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use std::any::Any;
use std::sync::Arc;

/// Number of records (time stamps, arrivals, swaps, poses and reports) below which no record is discarded. A record
/// takes about 80 bytes.
const LEAST_RECORDS: usize = 32_768;

/// Number of newest pictures whose results can still change, because later records may belong to these pictures.
const PICTURES_HELD: usize = 32;
const PERIODS_HELD: u64 = 32;

/// The sums of a run's results so far, and the limits that separate needed records from records to discard.
///
/// A picture is final (its results can no longer change) after [`PICTURES_HELD`] later pictures and [`PERIODS_HELD`]
/// display periods. Records are discarded if the records are at least [`PERIODS_HELD`] periods older than the first
/// picture that is not final. All earlier periods are final too. Records of the head are kept for [`PERIODS_HELD`] more
/// periods, because views are predicted from older reports.
#[derive(Debug)]
pub(crate) struct Window {
    tally: Tally,
    sum: Option<Box<dyn StreamingObserver>>,
    forgets: bool,
    samples: usize,
    /// Latest instant up to which all shown pictures are in the sums of the run.
    taken_to: Option<Time>,
    /// Number of arrivals of regions in memory that are already in the sums of the run.
    arrivals_taken: usize,
    /// Number of records in memory at which results are added to the sums, and old records discarded, the next time.
    next_look: usize,
}

/// Results of a run that has ended: the sums of all results, and the pictures whose records are kept.
#[derive(Debug)]
pub(crate) struct Closed {
    pub(crate) tally: Tally,
    pub(crate) window: Option<ResultWindow>,
    pub(crate) observed: Option<Box<dyn Any + Send + Sync>>,
    pub(crate) pictures: Vec<PictureTimes>,
}

impl Window {
    pub(crate) fn new(experiment: &Experiment, record: &Record) -> Self {
        let may_forget = match experiment.keep {
            Keep::Everything => false,
            Keep::Statistics => !experiment.traffic,
            Keep::Recent => true,
        };
        let forgets = may_forget && experiment.pipeline.can_discard_records();
        let samples = if forgets { KEPT_SAMPLES } else { usize::MAX };
        let tally = Tally::new(experiment.end(), field_ms(record), samples);
        let sums = experiment.sums.filter(|_| forgets && experiment.keep == Keep::Statistics);
        let sum = sums.map(|begin| begin());
        Self { tally, sum, forgets, samples, taken_to: None, arrivals_taken: 0, next_look: LEAST_RECORDS }
    }

    /// Adds results that can no longer change to the sums of the run, and discards the records of these results. Does
    /// nothing if the run has few records or must keep all records.
    pub(crate) fn look(&mut self, experiment: &Experiment, run: &mut Assembled, now: Time) {
        if !self.forgets || run.records() < self.next_look {
            return;
        }
        let record = run.machine.record();
        self.tally.records_read += record.observation().records() as u64;
        // Late regions are counted before their records are discarded.
        if let Some(begin) = self.take_final(experiment, run, now) {
            self.tally.take_late(&experiment.pipeline.late_regions(record, begin));
            let of_head = before(record, begin).unwrap_or_default();
            run.discard_before(begin, of_head);
            self.arrivals_taken = run.machine.record().observation().arrivals.len();
        }
        // The next pass begins when the number of records has doubled, so the cost per record is bounded.
        self.next_look = LEAST_RECORDS.max(2 * run.records());
    }

    /// Adds pictures whose results can no longer change to the sums of the run. Returns the instant from which records
    /// are still needed for all other pictures.
    fn take_final(&mut self, experiment: &Experiment, run: &Assembled, now: Time) -> Option<Time> {
        let record = run.machine.record();
        let fresh = self.fresh(experiment.pipeline.as_ref(), record, now);
        let newest_taken = fresh.len().checked_sub(PICTURES_HELD + 1)?;
        // Only whole periods become final, so that all pictures of each period are known.
        let last = fresh[newest_taken].shown_at.min(before(record, now)?);
        let known = record.display().period_at(last);
        let settled_to = Time(record.tick(known).0.checked_sub(1)?);
        let held = fresh.partition_point(|times| times.shown_at <= settled_to);
        let (pictures, held) = fresh.split_at(held);
        // Records are needed from the earliest sample or TRANSFORM of a picture that is not final.
        let needed =
            held.iter().map(|times| times.sampled_at.unwrap_or(times.transform_at).min(times.transform_at)).min()?;
        let begin = before(record, needed).filter(|begin| *begin > record.observation().forgotten.before)?;
        let until = record.display().period_at(begin);
        let arrivals = &record.observation().arrivals[self.arrivals_taken..];
        let (next, samples) = (held.first(), self.samples);
        let all = experiment.final_results(record, run.head.as_ref());
        // The counts are updated first, because the window depends on them.
        self.tally.count(record, pictures);
        let every = experiment.pipeline.periods_a_picture(record);
        let window = ResultWindow::begun(self.tally.ends(), every, known, experiment.end());
        let window = window.not_before(experiment.results_from, every);
        self.take(&FinalResults { arrivals, pictures, next, until, samples, window, ..all });
        self.taken_to = Some(settled_to);
        Some(begin)
    }

    /// Returns the pictures that are not in the sums of the run yet, in the order in which the pictures are shown.
    fn fresh(&self, pipeline: &dyn Pipeline, record: &Record, now: Time) -> Vec<PictureTimes> {
        let pictures = pipeline.pictures(record, now).into_iter();
        pictures.filter(|times| Some(times.shown_at) > self.taken_to).collect()
    }

    /// Passes final results to all streaming observers.
    fn take(&mut self, results: &FinalResults<'_>) {
        self.tally.take_arrivals(results.arrivals, results.record.message_span());
        self.tally.take(results);
        self.sum.iter_mut().for_each(|sum| sum.take(results));
    }

    /// Adds the remaining results of a run that ended in the period `reached`. Returns the complete results.
    pub(crate) fn close(
        mut self,
        experiment: &Experiment,
        record: &Record,
        head: Option<&Arc<HeadViews>>,
        reached: PeriodNumber,
    ) -> Closed {
        let pipeline = experiment.pipeline.as_ref();
        let end = record.tick(experiment.end());
        // Periods that were not simulated do not count.
        self.tally.end_early(reached);
        self.tally.records_read += record.observation().records() as u64;
        self.tally.take_late(&pipeline.late_regions(record, end));
        let pictures = self.fresh(pipeline, record, end);
        // All remaining pictures and arrivals are final at the end of the run.
        let arrivals = &record.observation().arrivals[self.arrivals_taken..];
        let samples = self.samples;
        let all = experiment.final_results(record, head);
        self.tally.count(record, &pictures);
        let every = pipeline.periods_a_picture(record);
        let window = ResultWindow::of(self.tally.ends(), every, reached, experiment.end());
        let window = window.and_then(|window| window.not_before(experiment.results_from, every));
        self.take(&FinalResults { arrivals, pictures: &pictures, samples, window, ..all });
        Closed { tally: self.tally, window, observed: self.sum.map(|sum| sum.result()), pictures }
    }
}

/// Returns the beginning of the period that is [`PERIODS_HELD`] periods earlier than the period of `instant`.
fn before(record: &Record, instant: Time) -> Option<Time> {
    let period = record.display().period_at(instant).before(PERIODS_HELD)?;
    Some(record.tick(period))
}

/// Returns the mean duration of a period of the first display over 60,000 periods, in milliseconds.
pub(crate) fn field_ms(record: &Record) -> f64 {
    record.tick(PeriodNumber(60_000)).since(Time::ZERO).as_ms() / 60_000.0
}
