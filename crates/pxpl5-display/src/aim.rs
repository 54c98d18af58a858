//! For which instant a picture is drawn.

use pxpl5_sim::Time;
use serde::{Deserialize, Serialize};
use std::fmt;

/// When that which is drawn of one view is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightSpan {
    /// The tick of the display (the retrace) from which on it is shown.
    pub tick: Time,
    /// When its first pixel lights.
    pub first: Time,
    /// When its last pixel lights for the last time.
    pub last: Time,
}

/// The instant of its [`LightSpan`] that a view is predicted for, the same for all pipelines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Aim {
    /// Half-way between the first and the last pixel: of all instants the one with the least error under a steady turn.
    #[default]
    Middle,
    /// When the first pixel lights.
    FirstPixel,
    /// When the last pixel lights.
    LastPixel,
    /// The retrace (the display's tick) from which on it is shown.
    Retrace,
}

impl Aim {
    /// All, by the name on the command line.
    pub const ALL: [(&str, Self); 4] = [
        ("middle", Self::Middle),
        ("first-pixel", Self::FirstPixel),
        ("last-pixel", Self::LastPixel),
        ("retrace", Self::Retrace),
    ];

    /// The instant of what is shown from a view that it is drawn for.
    #[must_use]
    pub fn instant(self, shown: &LightSpan) -> Time {
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
        let shown = LightSpan { tick: Time(10), first: Time(20), last: Time(41) };
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
