//! Figures of trackers and of the host's serial line.

use super::measurement::{Measurement, figure};
use super::settings::FigureSettings;
use super::value::{FigureValue, Result, detail, scene_named};
use crate::error::StudyError;
use pxpl5_measure::Budget;
use pxpl5_run::{Experiment, ExperimentError, Head, Pixels};
use pxpl5_sim::figures::Basis;
use std::sync::Arc;
use tracking::Pose;
use tracking::config::Tables;
use tracking::motion::{Motion, Pan, Still};
use tracking::predict::PredictorKind;
use tracking::tracker::{TrackerConfig, TrackerModel, TrackerReport};

pub(super) const TITLE: &str = "Trackers";

pub(super) const ABOUT: &str = "The host's unpatched operating system polls the serial line every 30 ms (TR94), and a report waits for the next poll. \
From a report x and its last output x', the filter of the Fastrak makes a x + (1 - a) x', which delays a steady turn by dt (1 - a) / a. \
Here dt is the 1/120 s between two reports.";

const PF: (&str, &str) = ("PF", "filter");

const FILTER: &str = "a tracker without noise and a head that turns by 2 degrees a second: the angle between the reported pose and that of the head \
    when the first character of the report is sent, over the rate of the turn";

const OF_FILTER: &str = "The rate of 120 Hz, the latency of 3.75 ms and the filter come from other pages of the manual";

/// The figures of trackers, in the order of their numbers.
pub(super) const FIGURES: &[Measurement] = &[
    Measurement {
        range: Some(0.25),
        basis: Basis::Derived("the polling interval of 30 ms"),
        ..figure(
            ("T1", ("TR94", "serial line"), 1.75, "fields"),
            "polling adds almost two fields (taken as 1.5 to 2)",
            "a Fastrak with the polled and with the patched kernel, 200 seeds of 2 s: the longest wait of a report for the kernel. The mean in a run \
            is the difference between both kernels in the mean time from the pose to the start of TRANSFORM, for full-screen:12 on small-hmd",
            polling,
        )
    },
    Measurement {
        reason: OF_FILTER,
        ..figure(("T2", PF, 4.2, "ms"), "apparent latency with a filter of 0.95", FILTER, |_| apparent_latency(0.95))
    },
    Measurement {
        reason: OF_FILTER,
        ..figure(("T3", PF, 162.0, "ms"), "the same with 0.05", FILTER, |_| apparent_latency(0.05))
    },
];

fn model(config: TrackerConfig) -> Result<TrackerModel> {
    Ok(TrackerModel::new(config)?)
}

/// Number of seeds. The timer of the host's operating system has a different phase for each seed.
const SEEDS: u64 = 200;
const REPORTS: usize = 240;

fn polling(settings: &FigureSettings) -> Result<FigureValue> {
    let patched = TrackerConfig::fastrak();
    let polled = patched.clone().with_polling_by(&Tables::PAPERS);
    let mut waits_ms = Vec::new();
    // Each seed gives the timer of the operating system another phase relative to the tracker.
    for seed in 1..=SEEDS {
        let arrivals = |config: &TrackerConfig| {
            let reports: Vec<TrackerReport> =
                model(config.clone())?.reports(Still(Pose::IDENTITY), seed).take(REPORTS).collect();
            Ok::<_, StudyError>(reports)
        };
        let pairs = arrivals(&polled)?.into_iter().zip(arrivals(&patched)?);
        waits_ms.extend(pairs.map(|(late, early)| (late.arrives_ps - early.arrives_ps) as f64 / 1e9));
    }
    let field_ms = 1001.0 / 60.0;
    let mean = waits_ms.iter().sum::<f64>() / waits_ms.len() as f64 / field_ms;
    let greatest = waits_ms.iter().copied().fold(0.0, f64::max) / field_ms;
    // A run of the pipeline shows the same delay from outside.
    let in_a_run = (pose_to_transform_ms(settings, polled)? - pose_to_transform_ms(settings, patched)?) / field_ms;
    let details = vec![detail("mean of all reports", mean, "fields"), detail("mean in a run", in_a_run, "fields")];
    Ok(FigureValue::with(greatest, details))
}

/// Number of display fields in a run: ten seconds.
const FIELDS: u64 = 600;

/// Returns the mean time in ms from the measurement of a head pose to the start of TRANSFORM for this pose.
fn pose_to_transform_ms(settings: &FigureSettings, tracker: TrackerConfig) -> Result<f64> {
    let head = Head::new(Arc::new(Still(Pose::IDENTITY)), tracker, PredictorKind::None, 1)?;
    let machine = settings.interpreted("small-hmd")?;
    let experiment = Experiment::new(machine, settings.interpretation.pipeline(), scene_named("full-screen:12")?);
    let outcome = experiment.head(head).fields(FIELDS).pixels(Pixels::Off).stopped_by(settings.stop.clone()).run()?;
    let Budget { tracking_ms, waiting_ms, sending_ms, .. } = Budget::of(&outcome);
    Ok(tracking_ms + waiting_ms + sending_ms)
}

/// Rate of the head's turn in degrees per second. The rate is low, so that a quarter of a second is half a degree.
const SLOW: f64 = 2.0;

/// Measures how much older the orientation in a report of the Fastrak is than the head's orientation, in ms. The head
/// turns steadily. `gain` is the gain of the tracker's filter.
fn apparent_latency(gain: f64) -> Result<FigureValue> {
    let mut tables = Tables::PAPERS;
    tables.fastrak.filter_gain = gain;
    let config = TrackerConfig::fastrak_by(&tables).without_noise();
    let (output_ps, rate_hz) = (config.sync_to_output_ps, u64::from(config.rate_hz));
    let motion = Pan::at(SLOW);
    // After 1,000 reports the filter has settled.
    let settled = model(config)?.reports(&motion, 1).nth(1_000);
    let report = settled.ok_or_else(|| ExperimentError::Scene("the Fastrak fell silent".to_owned()))?;
    let sent_ps = report.solution * tracking::time::PS_PER_S / rate_hz + output_ps;
    let behind_deg = report.pose.angle_deg(&motion.pose(sent_ps));
    Ok((behind_deg / SLOW * 1e3).into())
}
