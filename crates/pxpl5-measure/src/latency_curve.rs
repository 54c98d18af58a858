//! The error that a latency alone causes for a head motion, without any machine.

use tracking::motion::Motion;
use tracking::time::{NTSC_FIELD_PS, PS_PER_MS, PS_PER_S};
use tracking::view::Hmd;

/// Error over time in the middle of the picture, caused by a constant latency. The curve has one point per NTSC field.
#[derive(Clone, Debug, PartialEq)]
pub struct LatencyCurve {
    /// Time from the instant of the drawn pose until the picture is lit, in milliseconds.
    pub latency_ms: u64,
    /// Points of the curve: time in seconds and error in pixels.
    pub points: Vec<(f64, f64)>,
}

impl LatencyCurve {
    /// Computes the curve for the first `seconds` seconds of `motion`. At time t the display shows the head's pose at t
    /// - `latency_ms`.
    ///
    /// The error is the displacement on the screen of a point `distance_m` metres ahead of the head.
    pub fn of(motion: &dyn Motion, latency_ms: u64, seconds: u64, distance_m: f64) -> Self {
        let view = Hmd::unc();
        let latency_ps = latency_ms * PS_PER_MS;
        let times = (0..).map(|n| latency_ps + n * NTSC_FIELD_PS).take_while(|t| *t < seconds * PS_PER_S);
        let points = times.filter_map(|t| {
            let error = view.centre_misregistration(&motion.pose(t - latency_ps), &motion.pose(t), distance_m)?;
            Some((t as f64 / PS_PER_S as f64, error.pixels))
        });
        Self { latency_ms, points: points.collect() }
    }

    /// Returns the mean of the errors at all points of the curve, in pixels.
    pub fn mean_px(&self) -> f64 {
        self.points.iter().map(|p| p.1).sum::<f64>() / self.points.len().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracking::motion::Pan;

    #[test]
    fn the_curve_of_a_pan_is_the_focal_length_times_the_tangent() {
        let curve = LatencyCurve::of(&Pan::at(40.0), 90, 2, 3.0);
        let expected = 320.0 / 30f64.to_radians().tan() * 3.6f64.to_radians().tan();
        assert!((curve.mean_px() - expected).abs() < 1e-9, "{} {expected}", curve.mean_px());
    }
}
