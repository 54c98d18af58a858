use super::arrows::arrows;
use super::model::{MAX_FIELDS, Timeline, TimelineOptions, TimelineRow, TimelineScan};
use super::rows::{rows, set_lanes};
use crate::updates::Updates;
use pxpl5_gp::{Stage, StageEdge};
use pxpl5_run::{FinalResults, Outcome, PictureTimes, WARM_UP_PICTURES};
use pxpl5_sim::Time;
use pxpl5_wire::display::Display;
use pxpl5_wire::{PeriodNumber, PictureNumber};
use std::ops::Range;

/// Divisor of the drawn time. Two bars that overlap by more than 1/300 of the drawn time get separate lanes (parts of a
/// row).
const TOUCHING: u64 = 300;

/// Smallest number of display periods in a drawing, if the user gives no number.
const MIN_FIELDS: u64 = 4;

impl Timeline {
    /// Returns a timeline of the part of a run that the options select.
    pub fn of(outcome: &Outcome, options: &TimelineOptions) -> Self {
        Self::so_far(&outcome.final_results(), options)
    }

    /// Returns a timeline of the selected part of a run that has ended or is in progress.
    pub fn so_far(run: &FinalResults<'_>, options: &TimelineOptions) -> Self {
        let record = run.record;
        let display = record.display();
        // The chosen picture decides which periods are drawn, unless the options do.
        let chosen = chosen(run.pictures, options.picture);
        let stages = run.record.stages();
        let mut rows = rows(run, &stages, options);
        let update = chosen.and_then(|times| Updates::of(run, &stages).shown_by(times));
        let periods = periods(run, options, chosen, sent_at(&rows, update));
        let from = display.tick(periods.start);
        let to = display.tick(periods.end);
        // Only bars and pictures within the drawn time remain.
        for row in &mut rows {
            row.bars.retain(|bar| bar.begin < to && bar.end >= from);
            row.shown.retain(|shown| shown.begin < to && shown.end > from);
            set_lanes(row, (to - from) / TOUCHING);
        }
        let mut timeline = Self {
            from,
            to,
            retraces: periods.start.until(periods.end.next()).map(|period| (period, display.tick(period))).collect(),
            samples: (!options.without_host).then(|| samples(run, from..to)),
            scans: periods.start.until(periods.end).filter_map(|period| scan(display, run.pictures, period)).collect(),
            surfaces: record.surfaces().map(|(_, surface)| surface.clone()).collect(),
            rows,
            picture: chosen.map(|times| times.picture),
            update,
            arrows: Vec::new(),
        };
        // Arrows need the lanes of the bars, so they come last.
        timeline.arrows = arrows(&timeline, display, chosen);
        timeline
    }
}

fn chosen(pictures: &[PictureTimes], wanted: Option<PictureNumber>) -> Option<&PictureTimes> {
    match wanted {
        Some(picture) => pictures.iter().find(|times| times.picture == picture),
        None => pictures.get(WARM_UP_PICTURES).or(pictures.last()),
    }
}

fn sent_at(rows: &[TimelineRow], update: Option<PictureNumber>) -> Option<Time> {
    let bar = rows.first()?.bars.iter().find(|bar| Some(bar.picture) == update)?;
    (bar.stage == Stage::Send).then_some(bar.begin)
}

fn periods(
    run: &FinalResults<'_>,
    options: &TimelineOptions,
    chosen: Option<&PictureTimes>,
    sent_at: Option<Time>,
) -> Range<PeriodNumber> {
    let display = run.record.display();
    let begin = chosen.map_or(Time::ZERO, |times| sent_at.or(times.sampled_at).unwrap_or(times.transform_at));
    let first =
        options.first_field.unwrap_or_else(|| display.period_at(begin)).min(PeriodNumber::FIRST.after(run.fields));
    let last = chosen.map_or(first.after(MIN_FIELDS), |times| display.period_at(times.shown_at).after(2));
    let count = options.fields.unwrap_or_else(|| last.since(first).max(MIN_FIELDS));
    first..first.after(count.clamp(1, MAX_FIELDS))
}

fn samples(run: &FinalResults<'_>, within: Range<Time>) -> Vec<(PictureNumber, Time)> {
    let marks = run.record.observation().marks.iter();
    let begun = marks.filter(|mark| mark.stage == Stage::Send && mark.edge == StageEdge::Begin);
    begun.filter(|mark| within.contains(&mark.time)).map(|mark| (mark.picture, mark.time)).collect()
}

fn scan(display: &dyn Display, pictures: &[PictureTimes], period: PeriodNumber) -> Option<TimelineScan> {
    let next = display.tick(period.next());
    let shown = pictures.iter().rev().find(|times| times.shown_at < next);
    Some(TimelineScan {
        period,
        picture: shown.map(|times| times.picture),
        begin: display.first_light(0, period)?,
        end: display.last_light(0, period)?,
    })
}
