//! When and for how long the pixels of a surface are lit.

use pxpl5_sim::Span;
use serde::Serialize;

/// The order in which the pixels of a surface light within a period.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Scan {
    /// Line by line from the top, each from the left: the beam of a tube.
    #[default]
    Down,
    /// Line by line from the bottom, each from the left.
    Up,
    /// Column by column from the left, each from the top.
    Right,
    /// Column by column from the right, each from the top.
    Left,
    /// All at once.
    Global,
}

/// The light of a pixel after the instant at which it begins to shine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Light {
    /// The order of the pixels.
    pub scan: Scan,
    /// Time for which a pixel is driven in a period; zero where it counts as an instant.
    pub persistence: Span,
    /// Time constant with which a pixel follows its drive, a first-order lag; zero where it follows at once.
    pub response: Span,
}

impl Light {
    /// Returns the time from the begin of a pixel's light to its centre of gravity: half of the persistence and one time constant.
    #[must_use]
    pub const fn centre(&self) -> Span {
        Span(self.persistence.0 / 2 + self.response.0)
    }

    /// Returns the length of an even light that is as wide as this one.
    ///
    /// The length is the square root of p^2 + 12 r^2 for a persistence p and a time constant r. The variance of an even
    /// light of length p is p^2 / 12, that of a first-order lag is r^2, and variances add.
    #[must_use]
    pub fn width(&self) -> Span {
        let [persistence, response] = [self.persistence, self.response].map(|span| span.0 as f64);
        Span((persistence * persistence + 12.0 * response * response).sqrt().round() as u64)
    }

    /// Returns true if a pixel's light counts as an instant.
    #[must_use]
    pub const fn is_instant(&self) -> bool {
        self.persistence.0 == 0 && self.response.0 == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(persistence: u64, response: u64) -> Light {
        Light { scan: Scan::Down, persistence: Span(persistence), response: Span(response) }
    }

    #[test]
    fn the_centre_of_an_even_light_is_half_way_and_a_lag_adds_its_time_constant() {
        assert_eq!(light(2_000, 0).centre(), Span(1_000));
        assert_eq!(light(2_000, 300).centre(), Span(1_300));
        assert!(light(0, 0).is_instant() && !light(0, 1).is_instant());
    }

    /// Mean and variance of the light by summing its brightness: it rises as 1 - e^(-t/r) while it is driven and falls as e^(-t/r) after it.
    #[test]
    fn centre_and_width_are_those_of_the_sum_over_the_brightness() {
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
