//! Statistics of the latency of pictures and its parts.

use crate::percentiles::Percentiles;
use pxpl5_run::{DefinedStatistics, LATENCY_PARTS, Outcome, Samples};

pub(crate) fn latency_part_statistics(outcome: &Outcome) -> Vec<LatencyPartStatistics> {
    let parts = LATENCY_PARTS.iter().zip(&outcome.tally().parts_ms);
    let named = parts.map(|(part, ms): (_, &Samples)| LatencyPartStatistics {
        name: part.name.to_owned(),
        in_published_latency: part.published,
        statistics: ms.statistics().defined(part.definition),
    });
    named.collect()
}

/// Percentiles of the times of pictures in milliseconds, over the complete pictures in the result window.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct LatencyPercentiles {
    /// Latency by the definition of the pipeline. Covers the first [`KEPT_SAMPLES`](pxpl5_run::KEPT_SAMPLES) pictures.
    pub latency: Percentiles,
    /// Time from the measurement of the head's pose until the middle of the light of the picture's middle.
    pub head_to_light: Percentiles,
    /// Error of the prediction interval: distance between the instant for which the picture was predicted and the
    /// instant for which it should have been. Empty for pipelines that draw each part for its own instant.
    pub prediction_interval_error: Percentiles,
}

/// One part of the latency of pictures, with its statistics.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct LatencyPartStatistics {
    /// Name of the part, as in [`LATENCY_PARTS`].
    pub name: String,
    /// True if the latency stated in the papers includes this part.
    pub in_published_latency: bool,
    /// Statistics of this part of the latency in milliseconds, and the definition of the part.
    #[serde(flatten)]
    pub statistics: DefinedStatistics,
}

/// Latency of one surface or of a pair of surfaces.
///
/// The latency ends at the end of COPY, at the swap, or when the pixels are lit.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct SurfaceStatistics {
    /// Label of the surface (`left`, `right`), or `pair`. The latency of a pair lasts from the first TRANSFORM until
    /// both surfaces have reached the end `until`.
    pub of: String,
    /// Name of the end of the latency: `end_of_copy`, `swap` or `light`.
    pub until: &'static str,
    /// Statistics of the latency in milliseconds, and the definition of the latency.
    #[serde(flatten)]
    pub statistics: DefinedStatistics,
}

/// Returns the latencies of each surface and of the pair of surfaces, over the complete pictures in the result window.
///
/// The result is empty if the surfaces share one TRANSFORM.
pub fn latency_by_surface(outcome: &Outcome) -> Vec<SurfaceStatistics> {
    let labels: Vec<&str> = outcome.record().surfaces().map(|(_, surface)| surface.label).collect();
    let label_of = |surface: usize| labels.get(surface).copied().unwrap_or_default();
    let of_surfaces = outcome.tally().latencies_of_surfaces().map(|latency| {
        let label = label_of(latency.first);
        let of = if latency.first == latency.last { label } else { "pair" };
        let definition = format!("from the start of the {label} eye's TRANSFORM to {}", latency.event);
        let statistics = latency.ms.statistics().defined(&definition);
        SurfaceStatistics { of: of.to_owned(), until: latency.until, statistics }
    });
    of_surfaces.collect()
}
