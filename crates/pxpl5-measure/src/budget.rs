//! Where the time goes from the head's pose to light.

use pxpl5_run::{Outcome, PictureTimes, Sampled, Statistics};
use pxpl5_wire::ViewNumber;
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
        Self::mean(&[])
    }
}

impl Budget {
    /// Of the complete pictures after the warm-up whose pose was measured.
    #[must_use]
    pub fn of(outcome: &Outcome) -> Self {
        Self::mean(&Self::of_pictures(outcome))
    }

    /// From the pose to the light of each picture's middle, milliseconds, in order.
    #[must_use]
    pub fn totals_ms(outcome: &Outcome) -> Vec<f64> {
        Self::of_pictures(outcome).iter().map(|stages| stages.iter().sum()).collect()
    }

    fn of_pictures(outcome: &Outcome) -> Vec<[f64; 6]> {
        let Some(head) = outcome.head() else { return Vec::new() };
        let sampled: BTreeMap<ViewNumber, Sampled> = head.sampled().into_iter().map(|s| (s.number, s)).collect();
        let pictures = outcome.complete_pictures();
        pictures.filter_map(|times| Self::of_picture(outcome, times, sampled.get(&times.view)?)).collect()
    }

    /// The instants at which a picture's pose passed from stage to stage.
    fn of_picture(outcome: &Outcome, times: &PictureTimes, sampled: &Sampled) -> Option<[f64; 6]> {
        let light = outcome.pipeline().light(outcome.record(), times);
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

    fn mean(each: &[[f64; 6]]) -> Self {
        let stage = |i: usize| Statistics::of(each.iter().map(|stages| stages[i])).mean;
        let [tracking_ms, waiting_ms, sending_ms, drawing_ms, showing_ms, scanning_ms] = std::array::from_fn(stage);
        let total_ms = tracking_ms + waiting_ms + sending_ms + drawing_ms + showing_ms + scanning_ms;
        let n = each.len() as u64;
        Self { tracking_ms, waiting_ms, sending_ms, drawing_ms, showing_ms, scanning_ms, total_ms, n }
    }
}
