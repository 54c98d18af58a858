//! Cost of updates: draws per second, and savings relative to drawing everything in every frame.

/// Returns the draws per second of memories with the given update rates (1/s) and numbers of segments.
#[must_use]
pub fn draws_per_s(rates_hz: &[f64], segments: &[u64]) -> f64 {
    rates_hz.iter().zip(segments).map(|(rate, segments)| rate * *segments as f64).sum()
}

/// Returns the saving of `draws` relative to `against`, in percent.
#[must_use]
pub fn saved_percent(draws: f64, against: f64) -> f64 {
    100.0 * (1.0 - draws / against)
}
