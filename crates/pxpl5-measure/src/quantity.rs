//! Quantities of a run by name, for tables, CSV files and sweeps.

use crate::Report;
use crate::budget::tracking_and_rendering_ms;
use crate::resource::Resource;
use pxpl5_gp::Stage;
use pxpl5_run::{DuePictures, Outcome, Summary};
use pxpl5_sim::parameters::{SettingError, find_named};
use std::fmt;
use std::str::FromStr;

/// A quantity that can be measured, selected by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measure(&'static Quantity);

/// Definition of a quantity: name, description and computation.
#[derive(Debug)]
pub struct Quantity {
    /// Name with the unit, such as `latency_ms.mean`.
    pub name: &'static str,
    /// Description of the measured interval or count, in one sentence.
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
    /// The quantity is computed from a summary, which every level of modelling provides.
    OfSummary(fn(&Summary) -> f64),
    /// The quantity is computed from a simulated run and its report.
    OfRun(fn(&Outcome, &Report) -> Option<f64>),
}

const fn of_summary(name: &'static str, definition: &'static str, value: fn(&Summary) -> f64) -> Quantity {
    Quantity { name, definition, value: Value::OfSummary(value) }
}

const fn of_run(name: &'static str, definition: &'static str, value: fn(&Outcome, &Report) -> Option<f64>) -> Quantity {
    Quantity { name, definition, value: Value::OfRun(value) }
}

const LATENCY: &str =
    "latency by the definition of the pipeline (see the report), over all complete pictures in the window";

const TO_LIGHT: &str = "from the head's pose to the light of the picture's middle; only with a head.motion";

const PREDICTION_INTERVAL_ERROR: &str = "error of the prediction interval: distance between the instant for which a picture is predicted and the one for which it should be; only with a head.motion, and not for pipelines that draw each part for its own instant";

const EYE_LATENCY: &str = "from the start of an eye's TRANSFORM to the swap of its frame, over both eyes of all complete pictures in the window; none for Slats";

const EYE_RETRACES: &str = "number of retraces from the start of an eye's TRANSFORM to the swap, the retrace of the swap included, over both eyes of all complete pictures in the window; none for Slats";

const ERROR_PX: &str = "distance between a pixel and the right place of its content when the pixel lights, over a grid of pixels and all fields of the window; only pixels of pictures that were complete in time; only with a head.motion";

const PATH: &str = "share of the latency that waits for this resource, 0 to 1, over the last complete pictures of the window; the shares of all resources add up to 1";

/// All quantities that can be measured, by name.
///
/// Quantities that need a simulated run have no value at the analytic level.
pub static QUANTITIES: [Quantity; 67] = [
    of_summary("latency_fields.mean", LATENCY, |s| s.latency_fields().rounded().mean),
    of_summary("latency_fields.sd", LATENCY, |s| s.latency_fields().rounded().sd),
    of_summary("latency_fields.min", LATENCY, |s| s.latency_fields().min),
    of_summary("latency_fields.max", LATENCY, |s| s.latency_fields().max),
    of_summary("latency_ms.mean", LATENCY, |s| s.latency_ms().rounded().mean),
    of_summary("latency_ms.sd", LATENCY, |s| s.latency_ms().rounded().sd),
    of_summary("latency_ms.min", LATENCY, |s| s.latency_ms().min),
    of_summary("latency_ms.max", LATENCY, |s| s.latency_ms().max),
    of_run("latency_ms.p50", LATENCY, |_, r| Some(r.percentiles_ms.latency.p50)),
    of_run("latency_ms.p95", LATENCY, |_, r| Some(r.percentiles_ms.latency.p95)),
    of_run("latency_ms.p99", LATENCY, |_, r| Some(r.percentiles_ms.latency.p99)),
    of_summary("eye_latency_ms.mean", EYE_LATENCY, |s| s.eye_swap_latencies_ms.statistics().rounded().mean),
    of_summary("eye_latency_ms.sd", EYE_LATENCY, |s| s.eye_swap_latencies_ms.statistics().rounded().sd),
    of_summary("eye_retraces.mean", EYE_RETRACES, |s| s.eye_retraces.statistics().rounded().mean),
    of_summary("eye_retraces.sd", EYE_RETRACES, |s| s.eye_retraces.statistics().rounded().sd),
    // NaN counts as no value: see `Measure::of`.
    of_summary(
        "updates_hz",
        "complete pictures shown per second, over the window; none if fewer than two were shown",
        |s| s.updates_hz.unwrap_or(f64::NAN),
    ),
    of_summary("missed_retraces", "pictures due that were not shown: late, incomplete or missed", |s| {
        of_due(s, DuePictures::not_shown)
    }),
    of_summary("missed_share", "missed_retraces divided by pictures_due, 0 to 1", |s| {
        s.due.map_or(f64::NAN, |due| due.not_shown_share())
    }),
    of_summary("pictures_due", "pictures due in the window (see the report); none for frameless rendering", |s| {
        of_due(s, |due| due.due)
    }),
    of_summary("pictures_shown", "due pictures that were complete in time", |s| of_due(s, |due| due.shown)),
    of_summary("pictures_late", "due pictures that were complete before their period ended, but not in time", |s| {
        of_due(s, |due| due.late)
    }),
    of_summary("pictures_incomplete", "due pictures that were begun, and not complete when their period ended", |s| {
        of_due(s, |due| due.incomplete)
    }),
    of_summary("pictures_missed", "due pictures that were never begun, or left out", |s| of_due(s, |due| due.missed)),
    of_summary("region_copy_us", "mean port time of a region of 15,360 pixels", |s| s.region_copy_us),
    of_summary(
        "first_copy_ms",
        "first to last word of the COPY of the left eye (Rendering Control), of the top regions or of all (Slats); mean",
        |s| s.first_copy_ms,
    ),
    of_summary(
        "last_copy_ms",
        "first to last word of the COPY of the right eye, or of the bottom regions; mean; 0 without a second copy",
        |s| s.last_copy_ms,
    ),
    of_summary("copies_ms", "sum of first_copy_ms and last_copy_ms", |s| s.first_copy_ms + s.last_copy_ms),
    of_summary("copy_begins_ms", "from the start of a picture to the first word of its first copy; mean", |s| {
        s.copy_begins_ms
    }),
    of_summary("eye_ms", "from the start of an eye's TRANSFORM to the end of its COPY; mean; none for Slats", |s| {
        s.eye_latencies_ms.statistics().mean
    }),
    of_run("head_to_light_ms.mean", TO_LIGHT, |_, r| Some(r.head.as_ref()?.end_to_end.total_ms)),
    of_run("head_to_light_ms.p50", TO_LIGHT, |_, r| Some(r.percentiles_ms.head_to_light.p50)),
    of_run("head_to_light_ms.p95", TO_LIGHT, |_, r| Some(r.percentiles_ms.head_to_light.p95)),
    of_run("head_to_light_ms.p99", TO_LIGHT, |_, r| Some(r.percentiles_ms.head_to_light.p99)),
    of_run("prediction_interval_error_ms.mean", PREDICTION_INTERVAL_ERROR, |_, r| {
        Some(r.percentiles_ms.prediction_interval_error.mean)
    }),
    of_run("prediction_interval_error_ms.max", PREDICTION_INTERVAL_ERROR, |_, r| {
        Some(r.percentiles_ms.prediction_interval_error.max)
    }),
    of_run(
        "tracking_and_rendering_ms",
        "the sum of two means, as in figure 19: from the pose to the arrival of its report, and from the start of an eye's TRANSFORM to the swap; only with a head.motion",
        |o, r| r.head.as_ref().and_then(|_| tracking_and_rendering_ms(o)),
    ),
    of_run("error_px.n", "evaluated pixels: those of error_px; only with a head.motion", |_, r| {
        Some(r.head.as_ref()?.error.evaluated as f64)
    }),
    of_run("error_px.mean", ERROR_PX, |_, r| Some(r.head.as_ref()?.error.pixels.mean)),
    of_run("error_px.p50", ERROR_PX, |_, r| Some(r.head.as_ref()?.error.pixels.p50)),
    of_run("error_px.p90", ERROR_PX, |_, r| Some(r.head.as_ref()?.error.pixels.p90)),
    of_run("error_px.p95", ERROR_PX, |_, r| Some(r.head.as_ref()?.error.pixels.p95)),
    of_run("error_px.p99", ERROR_PX, |_, r| Some(r.head.as_ref()?.error.pixels.p99)),
    of_run("error_px.max", ERROR_PX, |_, r| Some(r.head.as_ref()?.error.pixels.max)),
    of_run("error_deg.mean", "error_px as an angle", |_, r| Some(r.head.as_ref()?.error.degrees.mean)),
    of_run(
        "rotation_ms",
        "from the measurement of an orientation to the light of the picture's middle; mean; only for a display with faces around the head",
        |_, r| Some(r.arp.as_ref()?.rotation_latency_ms?.mean),
    ),
    of_run("late_regions", "regions that arrived after their deadline", |_, r| Some(r.late_regions as f64)),
    of_run(
        "lines_never_shown",
        "lines of regions that were overwritten before the display had shown them; none for a display that shows whole buffers",
        |_, r| r.lines_never_shown().map(|lines| lines as f64),
    ),
    // No run has this quantity: a sweep searches for it.
    of_summary(
        Measure::TRIANGLES,
        "largest number of triangles that reaches the goal of the pipeline or of `limit.*`, as `pxpl5 limit` finds it; none if 1,000,000 reach it; only in sweeps",
        |_| f64::NAN,
    ),
    of_run("pictures", "complete pictures in the window", |_, r| Some(r.pictures as f64)),
    of_run("events", "events of the simulation", |_, r| Some(r.events as f64)),
    of_run("transform_ms", "mean time of TRANSFORM, per eye or per picture, depending on the pipeline", |o, _| {
        stage_ms(o, Stage::Transform)
    }),
    of_run("render_ms", "mean time of RENDER, per eye or per picture, depending on the pipeline", |o, _| {
        stage_ms(o, Stage::Render)
    }),
    of_run(
        "gp_busy",
        "share of the run in which the CPUs of graphics processors were busy, mean over all, 0 to 1",
        |_, r| Some(r.utilisation.as_ref()?.gps.busy.mean),
    ),
    of_run(
        "gp_busy.max",
        "share of the run in which the CPU of the busiest graphics processor was busy, 0 to 1",
        |_, r| Some(r.utilisation.as_ref()?.gps.busy.max),
    ),
    of_run(
        "renderer_busy.mean",
        "share of the run in which renderers executed commands, mean over all, 0 to 1",
        |_, r| Some(r.utilisation.as_ref()?.renderers.executing.mean),
    ),
    of_run("renderer_busy.max", "share of the run in which the busiest renderer executed commands, 0 to 1", |_, r| {
        Some(r.utilisation.as_ref()?.renderers.executing.max)
    }),
    of_run(
        "ring_busy",
        "share of the run in which channels of the ring were occupied, mean over all, 0 to 1",
        |_, r| Some(r.utilisation.as_ref()?.ring.channels.mean),
    ),
    of_run("port_busy", "share of the run in which the busiest port of a display received, 0 to 1", |_, r| {
        Some(r.utilisation.as_ref()?.ports.busy.max)
    }),
    of_run("critical_path.retrace", PATH, |_, r| Some(r.critical_path.as_ref()?.share(Resource::Retrace))),
    of_run("critical_path.ports", PATH, |_, r| Some(r.critical_path.as_ref()?.share(Resource::Ports))),
    of_run("critical_path.ring", PATH, |_, r| Some(r.critical_path.as_ref()?.share(Resource::Ring))),
    of_run("critical_path.renderers", PATH, |_, r| Some(r.critical_path.as_ref()?.share(Resource::Renderers))),
    of_run("critical_path.backing_store", PATH, |_, r| Some(r.critical_path.as_ref()?.share(Resource::BackingStore))),
    of_run("critical_path.transform", PATH, |_, r| Some(r.critical_path.as_ref()?.share(Resource::Transform))),
    of_run("critical_path.messages", PATH, |_, r| Some(r.critical_path.as_ref()?.share(Resource::Messages))),
    of_run("critical_path.host", PATH, |_, r| Some(r.critical_path.as_ref()?.share(Resource::Host))),
    of_run("critical_path.other", PATH, |_, r| Some(r.critical_path.as_ref()?.share(Resource::Other))),
];

fn of_due(summary: &Summary, count: fn(&DuePictures) -> u64) -> f64 {
    summary.due.map_or(f64::NAN, |due| count(&due) as f64)
}

impl Measure {
    /// Returns the quantity with the name `name`.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] with the most similar name if no quantity is called `name`.
    pub fn named(name: &str) -> Result<Self, SettingError> {
        find_named("quantity", name, QUANTITIES.iter().map(|quantity| (quantity.name, Self(quantity))))
    }

    /// Returns the quantities measured by default, which all levels have: latencies, update rate and missed retraces.
    pub fn usual() -> Vec<Self> {
        let names = ["latency_fields.", "latency_ms.", "updates_hz", "missed_retraces"];
        let is_usual =
            |q: &&Quantity| matches!(q.value, Value::OfSummary(_)) && names.iter().any(|name| q.name.starts_with(name));
        QUANTITIES.iter().filter(is_usual).map(Self).collect()
    }

    /// Returns the counts that every row of results needs: pictures due, pictures not shown, and evaluated pixels.
    /// Without these counts, a mean over few pictures looks like a mean over all pictures.
    pub fn counts() -> Vec<Self> {
        let is_count = |q: &&Quantity| [Self::PICTURES_DUE, Self::MISSED_RETRACES, Self::EVALUATED].contains(&q.name);
        QUANTITIES.iter().filter(is_count).map(Self).collect()
    }

    /// Name of the quantity that counts the due pictures.
    pub const PICTURES_DUE: &'static str = "pictures_due";

    /// Name of the quantity that counts the due pictures that were not shown.
    pub const MISSED_RETRACES: &'static str = "missed_retraces";

    /// Name of the quantity that a sweep searches for: the largest number of triangles that reaches a goal.
    pub const TRIANGLES: &'static str = "triangles_possible";

    /// Name of the quantity that counts the evaluated pixels.
    pub const EVALUATED: &'static str = "error_px.n";

    /// Returns the name of the quantity, which includes the unit.
    pub const fn name(&self) -> &'static str {
        self.0.name
    }

    /// Returns the definition of the quantity: a description of the measured interval or count, in one sentence.
    pub const fn definition(&self) -> &'static str {
        self.0.definition
    }

    /// Returns true if only a run with events has this quantity, and not the analytic level.
    pub const fn needs_events(&self) -> bool {
        matches!(self.0.value, Value::OfRun(_))
    }

    /// Returns the value of this quantity in `results`, or `None` if `results` has no finite value for this quantity.
    pub fn of(&self, results: &Results) -> Option<f64> {
        let value = match self.0.value {
            Value::OfSummary(value) => Some(value(&results.summary)),
            Value::OfRun(value) => results.run.as_ref().and_then(|(outcome, report)| value(outcome, report)),
        };
        value.filter(|value| value.is_finite())
    }

    /// Returns the value of this quantity for a run, or `None` if the run has no finite value for this quantity.
    ///
    /// This method computes a report of the run. If a report already exists, [`Measure::of`] takes less time.
    pub fn of_outcome(&self, outcome: &Outcome) -> Option<f64> {
        let value = match self.0.value {
            Value::OfSummary(value) => Some(value(&outcome.summary())),
            Value::OfRun(value) => value(outcome, &Report::of(outcome)),
        };
        value.filter(|value| value.is_finite())
    }
}

impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Measure {
    type Err = SettingError;

    fn from_str(name: &str) -> Result<Self, SettingError> {
        Self::named(name)
    }
}

/// Results of an experiment at any level of modelling.
#[derive(Debug)]
pub struct Results {
    /// Results that every level of modelling provides.
    pub summary: Summary,
    /// The simulated run and its report. `None` at the analytic level.
    pub run: Option<(Outcome, Report)>,
}

impl Results {
    /// Returns the results of a simulated run.
    pub fn of_run(outcome: Outcome) -> Self {
        let report = Report::of(&outcome);
        Self { summary: outcome.summary(), run: Some((outcome, report)) }
    }

    /// Returns the results of a closed form, without a simulated run.
    pub const fn of_closed_form(summary: Summary) -> Self {
        Self { summary, run: None }
    }
}

fn stage_ms(outcome: &Outcome, stage: Stage) -> Option<f64> {
    let (_, samples) = outcome.tally().stage_ms.iter().find(|(of, _)| *of == stage)?;
    Some(samples.statistics().mean)
}
