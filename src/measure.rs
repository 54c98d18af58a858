//! Quantities of an outcome by name, for tables, CSV and sweep rows.

use crate::config::nearest;
use crate::experiment::Outcome;
use crate::observation::StageSpan;
use crate::report::{Report, Statistics};
use pxpl5_gp::Stage;
use pxpl5_wire::MAX_MESSAGE_WORDS;
use std::collections::BTreeMap;

/// A quantity that can be measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measure(&'static Quantity);

/// What a quantity is, and how it is had.
#[derive(Debug)]
pub struct Quantity {
    /// Its name, with the unit.
    pub name: &'static str,
    /// Its definition.
    pub definition: &'static str,
    value: Value,
}

impl PartialEq for Quantity {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Quantity {}

#[derive(Debug)]
enum Value {
    OfReport(fn(&Report) -> f64),
    OfOutcome(fn(&Outcome) -> Option<f64>),
}

const fn of_report(name: &'static str, definition: &'static str, value: fn(&Report) -> f64) -> Quantity {
    Quantity { name, definition, value: Value::OfReport(value) }
}

const fn of_outcome(name: &'static str, definition: &'static str, value: fn(&Outcome) -> Option<f64>) -> Quantity {
    Quantity { name, definition, value: Value::OfOutcome(value) }
}

const LATENCY: &str = "latency as the pipeline defines it (see the report), over all pictures after the warm-up";

/// All quantities.
pub static QUANTITIES: [Quantity; 19] = [
    of_report("latency_fields.mean", LATENCY, |r| r.latency_fields.statistics.mean),
    of_report("latency_fields.sd", LATENCY, |r| r.latency_fields.statistics.sd),
    of_report("latency_fields.min", LATENCY, |r| r.latency_fields.statistics.min),
    of_report("latency_fields.max", LATENCY, |r| r.latency_fields.statistics.max),
    of_report("latency_ms.mean", LATENCY, |r| r.latency_ms.statistics.mean),
    of_report("latency_ms.sd", LATENCY, |r| r.latency_ms.statistics.sd),
    of_report("latency_ms.min", LATENCY, |r| r.latency_ms.statistics.min),
    of_report("latency_ms.max", LATENCY, |r| r.latency_ms.statistics.max),
    of_report("updates_hz", "complete pictures per second of simulated time", |r| r.updates_hz),
    of_report("missed_retraces", "retraces missed, as the pipeline defines it", |r| r.missed_retraces as f64),
    of_report("late_regions", "regions that came after their deadline", |r| r.late_regions as f64),
    of_report("pictures", "pictures after the warm-up", |r| r.pictures as f64),
    of_report("events", "events of the simulation", |r| r.events as f64),
    of_outcome("region_copy_us", "mean time of one region's transfer into a frame buffer", region_copy_us),
    of_outcome(
        "copy_ms",
        "mean time from the begin of a picture's first region transfer to the end of its last, both eyes",
        |outcome| mean_ms(pictures(outcome).iter().filter_map(|p| span_ms(p, Stage::Copy, Stage::Copy))),
    ),
    of_outcome(
        "before_copy_ms",
        "mean time from the begin of a picture's TRANSFORM to the begin of its first region transfer",
        |outcome| mean_ms(pictures(outcome).iter().filter_map(|p| before_copy_ms(p))),
    ),
    of_outcome("transform_ms", "mean time of TRANSFORM, an eye or a picture as the pipeline takes them", |outcome| {
        stage_ms(outcome, Stage::Transform)
    }),
    of_outcome("render_ms", "mean time of RENDER, an eye or a picture as the pipeline takes them", |outcome| {
        stage_ms(outcome, Stage::Render)
    }),
    of_outcome("eye_ms", "mean time from the begin of an eye's TRANSFORM to the end of its COPY", eye_ms),
];

impl Measure {
    /// The quantity of this name.
    ///
    /// # Errors
    ///
    /// The nearest valid name.
    pub fn named(name: &str) -> Result<Self, &'static str> {
        let found = QUANTITIES.iter().find(|quantity| quantity.name == name).map(Self);
        found.ok_or_else(|| nearest(name, QUANTITIES.iter().map(|q| q.name)).unwrap_or_default())
    }

    /// What is measured when nobody says what.
    #[must_use]
    pub fn usual() -> Vec<Self> {
        let names = ["latency_fields.", "latency_ms.", "updates_hz", "missed_retraces"];
        QUANTITIES.iter().filter(|q| names.iter().any(|name| q.name.starts_with(name))).map(Self).collect()
    }

    /// Its name, with the unit.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        self.0.name
    }

    /// Its definition.
    #[must_use]
    pub const fn definition(&self) -> &'static str {
        self.0.definition
    }

    /// Its value; `None` when the run shows none.
    #[must_use]
    pub fn of(&self, outcome: &Outcome, report: &Report) -> Option<f64> {
        match self.0.value {
            Value::OfReport(value) => Some(value(report)),
            Value::OfOutcome(value) => value(outcome),
        }
    }
}

/// The stages of each picture after the warm-up that is whole.
fn pictures(outcome: &Outcome) -> Vec<Vec<StageSpan>> {
    let message = outcome.machine().ring().timing().occupancy(MAX_MESSAGE_WORDS);
    let mut by_picture: BTreeMap<u64, Vec<StageSpan>> = BTreeMap::new();
    for span in outcome.observation().stages(message) {
        by_picture.entry(span.picture).or_default().push(span);
    }
    let steady = outcome.steady_pictures().iter().filter(|times| times.complete);
    steady.filter_map(|times| by_picture.remove(&times.picture)).collect()
}

fn mean_ms(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values = values.peekable();
    values.peek()?;
    Some(Statistics::of(values).mean)
}

/// From the first begin of a stage to the last end of another.
fn span_ms(spans: &[StageSpan], from: Stage, to: Stage) -> Option<f64> {
    let begin = spans.iter().filter(|span| span.stage == from).map(|span| span.begin).min()?;
    let end = spans.iter().filter(|span| span.stage == to).map(|span| span.end).max()??;
    Some((end - begin).as_ms())
}

fn before_copy_ms(spans: &[StageSpan]) -> Option<f64> {
    let first = |stage: Stage| spans.iter().filter(|span| span.stage == stage).map(|span| span.begin).min();
    Some((first(Stage::Copy)? - first(Stage::Transform)?).as_ms())
}

fn stage_ms(outcome: &Outcome, stage: Stage) -> Option<f64> {
    let spans = pictures(outcome).into_iter().flatten().filter(|span| span.stage == stage);
    mean_ms(spans.filter_map(|span| Some((span.end? - span.begin).as_ms())))
}

fn eye_ms(outcome: &Outcome) -> Option<f64> {
    let eyes = pictures(outcome).into_iter().flat_map(|spans| {
        let transforms: Vec<_> = spans.iter().filter(|s| s.stage == Stage::Transform).copied().collect();
        let copies = spans.into_iter().filter(|span| span.stage == Stage::Copy);
        copies.filter_map(move |copy| {
            let begin = transforms.iter().filter(|t| t.eye.is_none() || t.eye == copy.eye).map(|t| t.begin).min()?;
            Some((copy.end? - begin).as_ms())
        })
    });
    mean_ms(eyes)
}

fn region_copy_us(outcome: &Outcome) -> Option<f64> {
    let message = outcome.machine().ring().timing().occupancy(MAX_MESSAGE_WORDS);
    let arrivals = outcome.observation().arrivals.iter();
    mean_ms(arrivals.map(|arrival| (arrival.last_part_at - arrival.first_part_at + message).as_ms() * 1e3))
}
