//! Latency from the measurement of the head's pose until the picture is lit, by stage.

use crate::distribution::Distribution;
use crate::percentiles::Percentiles;
use pxpl5_run::{FinalResults, Outcome, PictureTimes, SampledPose, Samples, number_or_nan};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, PictureNumber, ViewNumber};
use std::collections::BTreeMap;

/// Mean time of each stage from the measurement of the head's pose until the picture is lit, in milliseconds.
///
/// The stages add up to the total. All means are NaN (null in JSON) if no picture was measured.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Budget {
    /// Time from the measurement of the pose until its report reaches the host: tracker, cable and operating system of
    /// the host.
    #[serde(deserialize_with = "number_or_nan")]
    pub tracking_ms: f64,
    /// Time from the arrival of the tracker's report until the pipeline uses the report.
    #[serde(deserialize_with = "number_or_nan")]
    pub waiting_ms: f64,
    /// Time from the use of the report to the start of TRANSFORM: transfer from the host, EDIT, and the wait for
    /// TRANSFORM.
    #[serde(deserialize_with = "number_or_nan")]
    pub sending_ms: f64,
    /// Time from the start of TRANSFORM until the frame buffer holds the picture: TRANSFORM, RENDER and COPY.
    #[serde(deserialize_with = "number_or_nan")]
    pub drawing_ms: f64,
    /// Time from the end of COPY until the picture is shown: the wait for the retrace or for the display's beam.
    ///
    /// The time is negative if the last pixels arrive after the first pixels are shown.
    #[serde(deserialize_with = "number_or_nan")]
    pub showing_ms: f64,
    /// Time from the start of the display of the picture until the display's beam reaches the middle of the picture.
    ///
    /// The time is negative if a picture arrives in parts, and the beam reaches its middle before the last part is
    /// shown.
    #[serde(deserialize_with = "number_or_nan")]
    pub scanning_ms: f64,
    /// Time from the instant at which a pixel begins to light until the middle of its light: half of the persistence, and
    /// the response of the panel. 0 for a display that lights a pixel for an instant.
    #[serde(deserialize_with = "number_or_nan")]
    pub lighting_ms: f64,
    /// Time from the measurement of the pose until the middle of the light of the picture's middle: `head_to_light_ms` in
    /// reports.
    #[serde(rename = "head_to_light_ms", deserialize_with = "number_or_nan")]
    pub total_ms: f64,
    /// Number of pictures over which the means are computed.
    pub n: u64,
}

impl Default for Budget {
    fn default() -> Self {
        BudgetSum::default().result()
    }
}

impl Budget {
    /// Returns the mean stage times over the pictures of several runs, each run weighted by its number of pictures.
    pub fn pooled(budgets: impl Iterator<Item = Self>) -> Self {
        let with_pictures: Vec<Self> = budgets.filter(|budget| budget.n > 0).collect();
        if with_pictures.is_empty() {
            return Self::default();
        }
        let n: u64 = with_pictures.iter().map(|budget| budget.n).sum();
        let mean = |of: &dyn Fn(&Self) -> f64| -> f64 {
            with_pictures.iter().map(|budget| of(budget) * (budget.n as f64 / n as f64)).sum()
        };
        let means = std::array::from_fn(|stage| mean(&|budget| budget.stages_ms()[stage]));
        Self { total_ms: mean(&|budget| budget.total_ms), ..Self::of_stages(means, n) }
    }

    const fn stages_ms(&self) -> [f64; STAGES] {
        let Self { tracking_ms, waiting_ms, sending_ms, drawing_ms, showing_ms, scanning_ms, lighting_ms, .. } = *self;
        [tracking_ms, waiting_ms, sending_ms, drawing_ms, showing_ms, scanning_ms, lighting_ms]
    }

    fn of_stages(means: [f64; STAGES], n: u64) -> Self {
        let [tracking_ms, waiting_ms, sending_ms, drawing_ms, showing_ms, scanning_ms, lighting_ms] = means;
        let total_ms = means.iter().sum();
        Self { tracking_ms, waiting_ms, sending_ms, drawing_ms, showing_ms, scanning_ms, lighting_ms, total_ms, n }
    }
}

/// Returns the sum of two means that the papers add, in milliseconds. `None` if no picture was measured.
///
/// The first mean is the time from the measurement of the pose until its report reaches the host. The second mean is
/// the time from the start of TRANSFORM until the picture is shown, over both eyes. The sum leaves out these stages of
/// [`Budget::total_ms`]: the wait for the pipeline, SEND and EDIT, the scan to the middle of the picture, and its light.
pub fn tracking_and_rendering_ms(outcome: &Outcome) -> Option<f64> {
    let Budget { tracking_ms, drawing_ms, showing_ms, .. } = Budget::of(outcome);
    let of_eyes = outcome.summary().eye_swap_latencies_ms.statistics();
    // Eyes that share one TRANSFORM have no latency of their own.
    let rendering_ms = if of_eyes.n == 0 { drawing_ms + showing_ms } else { of_eyes.mean };
    Some(tracking_ms + rendering_ms).filter(|sum| sum.is_finite())
}

/// Sums of the time of each latency stage, in milliseconds. The sums cover the pictures in the result window that are
/// complete and have a measured pose.
#[derive(Debug, Default)]
pub(crate) struct BudgetSum {
    /// First period of the result window. `None` while the window is unknown.
    window_from: Option<PeriodNumber>,
    stages_ms: [Samples; STAGES],
    /// Time from the head's pose to the light of each picture, and the error of its prediction interval.
    totals_ms: Distribution,
    misses_ms: Distribution,
    /// Poses of recent and future pictures, by the number of the view.
    ///
    /// Poses are copied for two reasons. A head discards old poses, and later pictures may use the last pose of a
    /// tracker that has failed.
    poses: Poses,
}

/// Number of poses that are kept in addition to the pose of the newest picture. A rarely drawn display memory still
/// shows a view for one of these older poses.
const OLDER_POSES: usize = 64;

/// Head poses that a pipeline requested. The key of a pose is the number of the view that is drawn for the pose.
pub(crate) type Poses = BTreeMap<ViewNumber, SampledPose>;

pub(crate) const STAGES: usize = 7;

impl BudgetSum {
    pub(crate) fn take(&mut self, run: &FinalResults<'_>) {
        let window_from = run.window.map(|window| window.first_period);
        if self.window_from != window_from {
            // The window has moved. All sums so far belong to periods before the window.
            self.window_from = window_from;
            self.stages_ms = std::array::from_fn(|_| Samples::keeping(run.samples));
            [self.totals_ms, self.misses_ms] = [(); 2].map(|()| Distribution::keeping(run.samples));
        }
        // Sum the stages of the new pictures.
        self.poses.append(&mut poses(run));
        for stages in of_pictures(run, &self.poses) {
            self.totals_ms.push(stages.iter().sum());
            self.stages_ms.iter_mut().zip(stages).for_each(|(samples, ms)| samples.push(ms));
        }
        misses_ms(run, &self.poses).for_each(|ms| self.misses_ms.push(ms));
        // Discard poses that no later picture can use.
        if let Some(newest) = run.pictures.last() {
            let oldest = self.poses.range(..newest.view).rev().nth(OLDER_POSES).map(|(view, _)| *view);
            self.poses = self.poses.split_off(&oldest.unwrap_or_default());
        }
    }

    /// Returns the percentiles of the times from head to light, and of the errors of the prediction interval.
    pub(crate) fn percentiles(&self) -> [Percentiles; 2] {
        [&self.totals_ms, &self.misses_ms].map(Distribution::percentiles)
    }

    pub(crate) fn result(self) -> Budget {
        let n = self.stages_ms[0].count();
        Budget::of_stages(self.stages_ms.map(|samples| samples.statistics().mean), n)
    }
}

pub(crate) fn poses(run: &FinalResults<'_>) -> Poses {
    run.head.map(|head| head.sampled()).unwrap_or_default().into_iter().map(|s| (s.number, s)).collect()
}

/// Returns the duration of each stage in milliseconds, for each complete picture in the result window whose head pose is
/// still in memory.
pub(crate) fn of_pictures(run: &FinalResults<'_>, poses: &Poses) -> Vec<[f64; STAGES]> {
    let complete = run.steady_pictures().iter().filter(|times| times.is_shown());
    complete.filter_map(|times| of_picture(run, times, poses.get(&times.view)?)).collect()
}

/// Returns, for each complete picture in the result window, the distance between the instant for which the picture was
/// predicted and the instant at which it should have been predicted, in milliseconds. A pipeline that draws parts of a
/// picture for their own instants computes these instants exactly and has no such distance. Neither has a picture without
/// prediction.
fn misses_ms<'a>(run: &'a FinalResults<'_>, poses: &'a Poses) -> impl Iterator<Item = f64> + 'a {
    let display = run.record.display();
    let nexts = run.pictures.iter().skip(1).map(Some).chain([run.next]);
    let is_counted = |times: &PictureTimes| {
        let is_steady = run.window.is_some_and(|window| window.holds_picture(display.period_at(times.shown_at)));
        is_steady && times.is_shown() && times.layer == 0 && !run.pipeline.properties().knows_when_seen
    };
    let counted = run.pictures.iter().zip(nexts).filter(move |(times, _)| is_counted(times));
    counted.filter_map(|(times, next)| {
        let aimed_at = poses.get(&times.view)?.predicted_for?;
        let right = run.aim.instant(&run.pipeline.shown(run.record, times, next));
        Some(right.0.abs_diff(aimed_at.0) as f64 * 1e-9)
    })
}

/// Times of the head that belong to one picture.
#[derive(Clone, Copy, Debug)]
pub struct HeadTimes {
    /// Time of the measurement that is the newest one in the picture's pose.
    pub measured_at: Option<Time>,
    /// Instant for which the picture is drawn.
    pub aimed_at: Time,
    /// Middle of the light of the picture's middle.
    pub light_at: Time,
}

/// Returns the times of the head for each picture of a run whose records are in memory.
pub fn head_times(outcome: &Outcome) -> BTreeMap<PictureNumber, HeadTimes> {
    let run = outcome.final_results();
    let poses = poses(&run);
    let of = |times: &PictureTimes| {
        let sampled = poses.get(&times.view)?;
        let light_at = light_at(&run, times);
        Some((times.picture, HeadTimes { measured_at: sampled.measured_at, aimed_at: sampled.objects_at, light_at }))
    };
    run.pictures.iter().filter_map(of).collect()
}

fn light_at(run: &FinalResults<'_>, times: &PictureTimes) -> Time {
    run.pipeline.light(run.record, times) + run.record.display().light().centre()
}

/// Returns the durations of a picture's latency stages, from the measurement of the pose until the picture is lit, in
/// milliseconds.
fn of_picture(run: &FinalResults<'_>, times: &PictureTimes, sampled: &SampledPose) -> Option<[f64; STAGES]> {
    let light = run.pipeline.light(run.record, times);
    let taken_at = sampled.reports_until.max(sampled.arrived_at?);
    // The stages lie between these consecutive instants.
    let path = [
        sampled.measured_at?,
        sampled.arrived_at?,
        taken_at,
        times.transform_at,
        times.copied_at?,
        times.shown_at,
        light,
        light_at(run, times),
    ];
    Some(std::array::from_fn(|i| (path[i + 1].0 as f64 - path[i].0 as f64) * 1e-9))
}
