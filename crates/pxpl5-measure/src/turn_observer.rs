//! Latency from a rotation of the head until the middle pixel is lit, over all fields of the result window.

use pxpl5_run::{FinalResults, RotationLatency, Samples, Statistics};
use pxpl5_wire::PeriodNumber;
use serde::Serialize;

/// One part of the latency from a rotation of the head until the middle pixel is lit, with its statistics.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotationPart {
    /// Name of the part, as in [`RotationLatency`](pxpl5_run::RotationLatency).
    pub name: &'static str,
    /// Statistics over the middle pixel of all fields of the result window, in milliseconds.
    #[serde(flatten)]
    pub statistics: Statistics,
}

/// Statistics of the rotation latency of the middle pixel, over all fields of the result window, in milliseconds.
#[derive(Debug, Default)]
pub(crate) struct RotationLatencySum {
    next: PeriodNumber,
    /// First period of the result window. `None` while the window is unknown.
    window_from: Option<PeriodNumber>,
    total: Samples,
    parts: Vec<Samples>,
}

/// Statistics of the latency, and of its parts. `None` without any latency.
pub(crate) type Turns = (Option<Statistics>, Vec<RotationPart>);

impl RotationLatencySum {
    pub(crate) fn take(&mut self, run: &FinalResults<'_>) {
        let window_from = run.window.map(|window| window.first_period);
        // The window has moved. All sums so far belong to periods before the window.
        if self.parts.is_empty() || self.window_from != window_from {
            self.window_from = window_from;
            self.total = Samples::keeping(run.samples);
            self.parts = vec![self.total.clone(); RotationLatency::default().parts().len()];
        }
        for latency in run.rotation_latencies(run.periods_from(self.next)) {
            self.total.push(latency.total().as_ms());
            let parts = self.parts.iter_mut().zip(latency.parts());
            parts.for_each(|(samples, (_, span))| samples.push(span.as_ms()));
        }
        self.next = run.until;
    }

    pub(crate) fn result(self) -> Turns {
        if self.total.count() == 0 {
            return Turns::default();
        }
        let named = RotationLatency::default().parts().map(|(name, _)| name).into_iter().zip(&self.parts);
        let parts = named.map(|(name, samples)| RotationPart { name, statistics: samples.statistics() });
        (Some(self.total.statistics()), parts.collect())
    }
}
