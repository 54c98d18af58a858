//! The instant for which the view of a picture is predicted.

use pxpl5_sim::Time;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The times at which the display shows the picture of one view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightTimes {
    /// Tick of the display's clock (retrace) from which on the picture is shown.
    pub tick: Time,
    /// Time at which the first pixel of the picture starts to shine.
    pub first: Time,
    /// Time at which the last pixel of the picture starts to shine for the last time.
    pub last: Time,
}

/// The instant of a [`LightTimes`], the times at which a picture is shown, for which the view is predicted. All
/// pipelines use the same choice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Aim {
    /// Half-way between the first and the last pixel. This instant gives the least error while the head turns steadily.
    #[default]
    Middle,
    /// The time at which the first pixel of the picture starts to shine.
    FirstPixel,
    /// The time at which the last pixel of the picture starts to shine.
    LastPixel,
    /// The tick of the display's clock (retrace) from which on the picture is shown.
    Retrace,
}

impl Aim {
    /// All choices, each with its name on the command line.
    pub const ALL: [(&str, Self); 4] = [
        ("middle", Self::Middle),
        ("first-pixel", Self::FirstPixel),
        ("last-pixel", Self::LastPixel),
        ("retrace", Self::Retrace),
    ];

    /// Returns the instant for which a view is predicted. `shown` has the times at which the view's picture is shown.
    #[must_use]
    pub fn instant(self, shown: &LightTimes) -> Time {
        match self {
            Self::Middle => Time(shown.first.0.midpoint(shown.last.0)),
            Self::FirstPixel => shown.first,
            Self::LastPixel => shown.last,
            Self::Retrace => shown.tick,
        }
    }
}

impl fmt::Display for Aim {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Self::ALL.iter().find(|(_, aim)| aim == self).map_or("", |(name, _)| name);
        f.write_str(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_aim_is_the_instant_that_its_name_says() {
        let shown = LightTimes { tick: Time(10), first: Time(20), last: Time(41) };
        let instants = Aim::ALL.map(|(name, aim)| (name, aim.instant(&shown).0));
        assert_eq!(instants, [("middle", 30), ("first-pixel", 20), ("last-pixel", 41), ("retrace", 10)]);
    }

    #[test]
    fn it_is_written_as_on_the_command_line() {
        for (name, aim) in Aim::ALL {
            assert_eq!(aim.to_string(), name);
            assert_eq!(serde_json::to_string(&aim).expect("a name"), format!("\"{name}\""));
        }
    }
}
