//! Cost of updates: drawn segments (parts of objects) per second, and the saving compared with drawing all segments in
//! every frame.

/// Returns the number of segments (parts of objects) drawn per second. For each memory, `rates_hz` holds its updates
/// per second, and `segments` its number of segments.
pub fn draws_per_s(rates_hz: &[f64], segments: &[u64]) -> f64 {
    rates_hz.iter().zip(segments).map(|(rate, segments)| rate * *segments as f64).sum()
}

/// Returns the percentage by which the number `draws` is smaller than `against`.
pub fn saved_percent(draws: f64, against: f64) -> f64 {
    100.0 * (1.0 - draws / against)
}
