use pxpl5_sim::Span;
use serde::Serialize;

/// The order in which the pixels of a surface start to shine within a period.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ScanOrder {
    /// Line by line from the top, and from left to right in each line, like the beam of a cathode-ray tube.
    #[default]
    Down,
    /// Line by line from the bottom, and from left to right in each line.
    Up,
    /// Column by column from the left, and from top to bottom in each column.
    Right,
    /// Column by column from the right, and from top to bottom in each column.
    Left,
    /// All pixels start to shine at the same time.
    Global,
}

/// The brightness of a display's pixels over time: the order in which the pixels start to shine, and the time for which
/// they shine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelLight {
    /// Order in which the pixels start to shine.
    pub scan: ScanOrder,
    /// Time for which a pixel is switched on in each period. Zero means that the pixel shines only for an instant.
    pub persistence: Span,
    /// Time constant of the change of a pixel's brightness (first-order lag) after the pixel is switched on or off.
    /// Zero means an immediate change.
    pub response: Span,
}

impl PixelLight {
    /// Returns the time from the instant at which a pixel starts to shine to the centre of gravity of its brightness.
    /// This time is half of the persistence plus one time constant.
    pub const fn centre(&self) -> Span {
        Span(self.persistence.0 / 2 + self.response.0)
    }

    /// Returns the duration of a constant brightness that has the same variance over time as this light.
    ///
    /// It is the square root of p^2 + 12 r^2 for a persistence p and a time constant r. A constant brightness of
    /// duration p has the variance p^2 / 12, a first-order lag has r^2, and variances add.
    pub fn width(&self) -> Span {
        let [persistence, response] = [self.persistence, self.response].map(|span| span.0 as f64);
        Span((persistence * persistence + 12.0 * response * response).sqrt().round() as u64)
    }

    /// Returns true if each pixel shines only for an instant.
    pub const fn is_instant(&self) -> bool {
        self.persistence.0 == 0 && self.response.0 == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(persistence: u64, response: u64) -> PixelLight {
        PixelLight { scan: ScanOrder::Down, persistence: Span(persistence), response: Span(response) }
    }

    #[test]
    fn the_centre_of_uniform_light_is_half_its_duration_and_a_response_time_is_added() {
        assert_eq!(light(2_000, 0).centre(), Span(1_000));
        assert_eq!(light(2_000, 300).centre(), Span(1_300));
        assert!(light(0, 0).is_instant() && !light(0, 1).is_instant());
    }

    /// Tests the mean time and the width of a pixel's light against a sum over small steps of time. The brightness
    /// rises as 1 - e^(-t/r) while the pixel is driven, and then falls as e^(-t/r). Here r is the response time.
    #[test]
    fn centre_and_width_of_the_light_of_a_pixel_equal_the_numerical_sums() {
        let (persistence, response) = (2_000.0_f64, 400.0_f64);
        let brightness = |t: f64| {
            let rise = |t: f64| 1.0 - (-t / response).exp();
            if t < persistence { rise(t) } else { rise(persistence) * (-(t - persistence) / response).exp() }
        };
        let times = || (0..20_000).map(|i| f64::from(i) + 0.5);
        let sum: f64 = times().map(brightness).sum();
        let mean = times().map(|t| t * brightness(t)).sum::<f64>() / sum;
        let variance = times().map(|t| (t - mean) * (t - mean) * brightness(t)).sum::<f64>() / sum;
        let found = light(2_000, 400);
        assert!((found.centre().0 as f64 - mean).abs() < 1.0, "{mean}");
        assert!((found.width().0 as f64 - (12.0 * variance).sqrt()).abs() < 2.0, "{variance}");
        assert_eq!(light(2_000, 0).width(), Span(2_000));
    }
}
