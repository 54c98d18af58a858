//! Where the time goes from the head's pose to light.

use pxpl5_run::{PictureTimes, Sampled, Samples, Settled};
use pxpl5_wire::{PeriodNumber, ViewNumber};
use std::collections::BTreeMap;

/// Mean time in each stage from the head's pose to light, in milliseconds. The stages add up to the total. Of no picture there
/// is none of these (NaN; null in JSON).
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Budget {
    /// From the pose to the arrival of its report at the host: tracker, cable, host's kernel.
    pub tracking_ms: f64,
    /// From there until the pipeline takes it.
    pub waiting_ms: f64,
    /// From there to the start of TRANSFORM: host's link, edits, wait for the stage.
    pub sending_ms: f64,
    /// From there until the frame buffer has it: TRANSFORM, RENDER, COPY.
    pub drawing_ms: f64,
    /// From there until it may be shown: wait for the retrace or for the beam. Negative where the last pixels come
    /// after the first are shown.
    pub showing_ms: f64,
    /// From there until the beam is at the middle of the picture.
    pub scanning_ms: f64,
    /// From the pose to the light of the picture's middle.
    pub total_ms: f64,
    /// Pictures that this is the mean of.
    pub n: u64,
}

impl Default for Budget {
    fn default() -> Self {
        BudgetSum::default().said()
    }
}

impl Budget {
    /// The mean over the pictures of several runs.
    #[must_use]
    pub fn pooled(budgets: impl Iterator<Item = Self>) -> Self {
        let known: Vec<Self> = budgets.filter(|budget| budget.n > 0).collect();
        let n: u64 = known.iter().map(|budget| budget.n).sum();
        let mean = |of: fn(&Self) -> f64| {
            // Of no picture there is no number.
            known.iter().map(|budget| of(budget) * budget.n as f64).sum::<f64>() / n as f64
        };
        Self {
            tracking_ms: mean(|budget| budget.tracking_ms),
            waiting_ms: mean(|budget| budget.waiting_ms),
            sending_ms: mean(|budget| budget.sending_ms),
            drawing_ms: mean(|budget| budget.drawing_ms),
            showing_ms: mean(|budget| budget.showing_ms),
            scanning_ms: mean(|budget| budget.scanning_ms),
            total_ms: mean(|budget| budget.total_ms),
            n,
        }
    }
}

/// Stages of the complete pictures in the window whose pose was measured, milliseconds.
#[derive(Debug, Default)]
pub(crate) struct BudgetSum {
    /// The first period of the window as it is known by now.
    window_from: Option<PeriodNumber>,
    stages_ms: [Samples; STAGES],
    /// Poses of the last pictures and of those to come: a head gives up what is old, and a silent tracker leaves one pose to all that
    /// come.
    poses: Poses,
}

/// Poses before the newest picture's that are held: a slow display memory shows older views than a fast one.
const OLDER_POSES: usize = 64;

/// What is held of views, by their numbers.
pub(crate) type Poses = BTreeMap<ViewNumber, Sampled>;

/// Stages from the head's pose to light.
pub(crate) const STAGES: usize = 6;

impl BudgetSum {
    pub(crate) fn take(&mut self, run: &Settled<'_>) {
        let window_from = run.window.map(|window| window.first_period);
        if self.window_from != window_from {
            // All that was taken before lies before the window.
            self.window_from = window_from;
            self.stages_ms = std::array::from_fn(|_| Samples::keeping(run.samples));
        }
        self.poses.append(&mut poses(run));
        for stages in of_pictures(run, &self.poses, run.steady_pictures()) {
            self.stages_ms.iter_mut().zip(stages).for_each(|(samples, ms)| samples.push(ms));
        }
        if let Some(newest) = run.pictures.last() {
            let oldest = self.poses.range(..newest.view).rev().nth(OLDER_POSES).map(|(view, _)| *view);
            self.poses = self.poses.split_off(&oldest.unwrap_or_default());
        }
    }

    /// The means.
    pub(crate) fn said(self) -> Budget {
        let n = self.stages_ms[0].count();
        let means = self.stages_ms.map(|samples| samples.statistics().mean);
        let [tracking_ms, waiting_ms, sending_ms, drawing_ms, showing_ms, scanning_ms] = means;
        let total_ms = tracking_ms + waiting_ms + sending_ms + drawing_ms + showing_ms + scanning_ms;
        Budget { tracking_ms, waiting_ms, sending_ms, drawing_ms, showing_ms, scanning_ms, total_ms, n }
    }
}

/// Those that a head holds.
pub(crate) fn poses(run: &Settled<'_>) -> Poses {
    run.head.map(|head| head.sampled()).unwrap_or_default().into_iter().map(|s| (s.number, s)).collect()
}

/// Of complete pictures whose pose was measured and is held.
pub(crate) fn of_pictures<'a>(
    run: &Settled<'_>,
    poses: &Poses,
    pictures: impl Iterator<Item = &'a PictureTimes>,
) -> Vec<[f64; STAGES]> {
    let complete = pictures.filter(|times| times.is_shown());
    complete.filter_map(|times| of_picture(run, times, poses.get(&times.view)?)).collect()
}

/// From each instant at which a picture's pose passed from stage to stage to the next one.
fn of_picture(run: &Settled<'_>, times: &PictureTimes, sampled: &Sampled) -> Option<[f64; STAGES]> {
    let light = run.pipeline.light(run.record, times);
    let taken_at = sampled.known.max(sampled.arrived_at?);
    let path = [
        sampled.measured_at?,
        sampled.arrived_at?,
        taken_at,
        times.transform_at,
        times.copied_at?,
        times.shown_at,
        light,
    ];
    Some(std::array::from_fn(|i| (path[i + 1].0 as f64 - path[i].0 as f64) * 1e-9))
}
