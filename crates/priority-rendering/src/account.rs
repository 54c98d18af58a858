//! What updates cost: draws a second, and what is saved against drawing everything in every frame.

/// Draws a second of memories with these rates (1/s) and so many segments.
#[must_use]
pub fn draws_per_s(rates_hz: &[f64], segments: &[u64]) -> f64 {
    rates_hz.iter().zip(segments).map(|(rate, segments)| rate * *segments as f64).sum()
}

/// Percent saved against a number of draws.
#[must_use]
pub fn saved_percent(draws: f64, against: f64) -> f64 {
    100.0 * (1.0 - draws / against)
}
