//! Bounded memory in long runs: adds final results to the statistics of the run, and discards their records.

use crate::build::assembled::Assembled;
use crate::experiment::Experiment;
use crate::head_views::HeadViews;
use crate::kept_records::KeptRecords;
use crate::observe::observers::{FinalResults, StreamingObserver};
use crate::pipeline::{PictureTimes, Pipeline};
use crate::result::result_window::ResultWindow;
use crate::result::tally::Tally;
use pxpl5_machine::Record;
use pxpl5_sim::KEPT_SAMPLES;
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use std::any::Any;
use std::sync::Arc;

/// Number of pictures after which the results of a picture are final. Until then, records of a picture may arrive after
/// records of later pictures.
const PICTURES_HELD: usize = 32;
const PERIODS_HELD: u64 = 32;

/// The statistics of a run so far, and the rule that decides which records are still needed.
///
/// A picture is final after [`PICTURES_HELD`] later pictures and [`PERIODS_HELD`] display periods. Records older than
/// the first picture that is not final are kept for [`PERIODS_HELD`] periods. Requested head poses are kept twice as
/// long, because views are predicted from reports that arrived earlier than these records.
#[derive(Debug)]
pub(crate) struct Window {
    tally: Tally,
    sum: Option<Box<dyn StreamingObserver>>,
    forgets: bool,
    samples: usize,
    taken_to: Option<Time>,
    arrivals_taken: usize,
    /// Number of records in memory at which old records are discarded the next time.
    next_look: usize,
    least_records: usize,
}

#[derive(Debug)]
pub(crate) struct Closed {
    pub(crate) tally: Tally,
    pub(crate) window: Option<ResultWindow>,
    pub(crate) observed: Option<Box<dyn Any + Send + Sync>>,
    pub(crate) pictures: Vec<PictureTimes>,
}

impl Window {
    pub(crate) fn new(experiment: &Experiment, record: &Record) -> Self {
        let may_discard = match experiment.keep {
            KeptRecords::Everything => false,
            KeptRecords::Statistics => !experiment.traffic,
            KeptRecords::Recent => true,
        };
        let forgets = may_discard && experiment.pipeline.properties().can_discard_records;
        let samples = if forgets { KEPT_SAMPLES } else { usize::MAX };
        let tally = Tally::new(experiment.end(), field_ms(record), samples);
        let observer = experiment.observer.filter(|_| forgets && experiment.keep == KeptRecords::Statistics);
        let sum = observer.map(|begin| begin());
        let least_records = experiment.least_records;
        Self {
            tally,
            sum,
            forgets,
            samples,
            taken_to: None,
            arrivals_taken: 0,
            next_look: least_records,
            least_records,
        }
    }

    /// Adds final results to the statistics and discards their records. Does nothing if the run has few records or must
    /// keep all records.
    pub(crate) fn update(&mut self, experiment: &Experiment, run: &mut Assembled, now: Time) {
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
        self.next_look = self.least_records.max(2 * run.records());
    }

    /// Adds final pictures to the statistics. Returns the instant from which records are still needed.
    fn take_final(&mut self, experiment: &Experiment, run: &Assembled, now: Time) -> Option<Time> {
        let record = run.machine.record();
        let fresh = self.fresh(experiment.pipeline.as_ref(), record, now);
        let newest_taken = fresh.len().checked_sub(PICTURES_HELD + 1)?;
        // Only whole periods become final, so that all pictures of each period are known.
        let last = fresh[newest_taken].shown_at.min(before(record, now)?);
        let recorded_to = record.display().period_at(last);
        let settled_to = Time(record.tick(recorded_to).0.checked_sub(1)?);
        let held = fresh.partition_point(|times| times.shown_at <= settled_to);
        let (pictures, held) = fresh.split_at(held);
        // Records are needed from the earliest sample or TRANSFORM of a picture that is not final.
        let needed =
            held.iter().map(|times| times.sampled_at.unwrap_or(times.transform_at).min(times.transform_at)).min()?;
        let begin = before(record, needed).filter(|begin| *begin > record.observation().discarded.before)?;
        let until = record.display().period_at(begin);
        let arrivals = &record.observation().arrivals[self.arrivals_taken..];
        let (next, samples) = (held.first(), self.samples);
        let all = experiment.final_results(record, run.head.as_ref());
        // The counts are updated first, because the window depends on them.
        self.tally.count(record, pictures);
        let every = experiment.pipeline.periods_a_picture(record);
        let window = ResultWindow::begun(&self.tally.ends, every, recorded_to, experiment.end());
        let window = window.not_before(experiment.results_from, every);
        self.take(&FinalResults { arrivals, pictures, next, until, samples, window, ..all });
        self.taken_to = Some(settled_to);
        Some(begin)
    }

    fn fresh(&self, pipeline: &dyn Pipeline, record: &Record, now: Time) -> Vec<PictureTimes> {
        let pictures = pipeline.pictures(record, now).into_iter();
        pictures.filter(|times| Some(times.shown_at) > self.taken_to).collect()
    }

    fn take(&mut self, results: &FinalResults<'_>) {
        self.tally.take_arrivals(results.arrivals, results.record.message_span());
        self.tally.take(results);
        self.sum.iter_mut().for_each(|sum| sum.take(results));
    }

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
        self.tally.end = self.tally.end.min(reached);
        self.tally.records_read += record.observation().records() as u64;
        self.tally.take_late(&pipeline.late_regions(record, end));
        let pictures = self.fresh(pipeline, record, end);
        // All remaining pictures and arrivals are final at the end of the run.
        let arrivals = &record.observation().arrivals[self.arrivals_taken..];
        let samples = self.samples;
        let all = experiment.final_results(record, head);
        self.tally.count(record, &pictures);
        let every = pipeline.periods_a_picture(record);
        let window = ResultWindow::of(&self.tally.ends, every, reached, experiment.end());
        // A run that ends early has a shorter first half, but samples before the start so far are already discarded.
        let from = experiment.results_from.max(self.tally.window_from);
        let window = window.and_then(|window| window.not_before(from, every));
        self.take(&FinalResults { arrivals, pictures: &pictures, samples, window, ..all });
        Closed { tally: self.tally, window, observed: self.sum.map(|sum| sum.result()), pictures }
    }
}

fn before(record: &Record, instant: Time) -> Option<Time> {
    let period = record.display().period_at(instant).before(PERIODS_HELD)?;
    Some(record.tick(period))
}

/// Returns the mean duration of a period of the first display, in milliseconds. Successive periods of NTSC differ by a
/// picosecond, so the mean covers 60,000 periods.
pub(crate) fn field_ms(record: &Record) -> f64 {
    record.tick(PeriodNumber(60_000)).since(Time::ZERO).as_ms() / 60_000.0
}
