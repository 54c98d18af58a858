//! Where the latency of pictures goes, as statistics.

use pxpl5_run::{DefinedStatistics, LATENCY_PARTS, LatencyParts, Outcome, Samples};

/// The parts of the latency of the complete pictures in the window that are kept ([`pxpl5_run::Keep`]).
#[must_use]
pub fn latency_parts(outcome: &Outcome) -> Vec<LatencyParts> {
    outcome.latency_parts()
}

/// Their statistics in milliseconds, by name and definition, of all complete pictures in the window.
pub(crate) fn latency_part_statistics(outcome: &Outcome) -> Vec<NamedStatistics> {
    let parts = LATENCY_PARTS.iter().zip(&outcome.tally().parts_ms);
    let named = parts.map(|(part, ms): (_, &Samples)| NamedStatistics {
        name: part.name.to_owned(),
        in_published_latency: part.published,
        statistics: ms.statistics().defined(part.definition),
    });
    named.collect()
}

/// Statistics of one part.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct NamedStatistics {
    /// Name of the part.
    pub name: String,
    /// Whether it belongs to the latency that the papers state.
    pub in_published_latency: bool,
    /// The numbers and their definition.
    #[serde(flatten)]
    pub statistics: DefinedStatistics,
}

/// Latency of a surface, or of a pair of them, up to some event.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct SurfaceStatistics {
    /// The surface's label (`left`, `right`), or `pair`: from the first one's TRANSFORM until both have come so far.
    pub of: String,
    /// `end_of_copy`, `swap` or `light`.
    pub until: &'static str,
    /// The numbers, in milliseconds, and their definition.
    #[serde(flatten)]
    pub statistics: DefinedStatistics,
}

/// Latencies of both surfaces and of the pair over the complete pictures in the window; empty where surfaces have no TRANSFORM
/// of their own.
#[must_use]
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
