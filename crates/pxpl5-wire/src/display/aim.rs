use pxpl5_sim::Time;
use serde::{Deserialize, Serialize};

/// The times at which the display shows the picture of one view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightTimes {
    /// Retrace (tick of the display's clock) at which the picture appears.
    pub tick: Time,
    /// Time at which the first pixel of the picture starts to shine.
    pub first: Time,
    /// Last time at which the last pixel of the picture starts to shine. A picture that stays for several periods has
    /// several such times.
    pub last: Time,
}

/// The instant for which the view of a picture is predicted.
///
/// All pipelines use the same choice. It refers to the [`LightTimes`] of the picture, the times at which the display
/// shows it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Aim {
    /// The middle of the time between the first and the last pixel. This instant gives the least error while the head
    /// turns at a constant rate.
    #[default]
    Middle,
    /// The time at which the first pixel of the picture starts to shine.
    FirstPixel,
    /// The time at which the last pixel of the picture starts to shine.
    LastPixel,
    /// The retrace (tick of the display's clock) at which the picture appears.
    Retrace,
}

impl Aim {
    /// All aims, each with its name on the command line.
    pub const ALL: [(&str, Self); 4] = [
        ("middle", Self::Middle),
        ("first-pixel", Self::FirstPixel),
        ("last-pixel", Self::LastPixel),
        ("retrace", Self::Retrace),
    ];

    /// Returns the instant for which a view is predicted. `shown` has the times at which the display shows the picture
    /// of the view.
    pub fn instant(self, shown: &LightTimes) -> Time {
        match self {
            Self::Middle => Time(shown.first.0.midpoint(shown.last.0)),
            Self::FirstPixel => shown.first,
            Self::LastPixel => shown.last,
            Self::Retrace => shown.tick,
        }
    }
}

pxpl5_sim::parameters::named!(Aim, "instant", Aim::ALL);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_aim_is_the_time_in_its_name() {
        let shown = LightTimes { tick: Time(10), first: Time(20), last: Time(41) };
        let instants = Aim::ALL.map(|(name, aim)| (name, aim.instant(&shown).0));
        assert_eq!(instants, [("middle", 30), ("first-pixel", 20), ("last-pixel", 41), ("retrace", 10)]);
    }

    #[test]
    fn an_aim_is_printed_as_on_the_command_line() {
        for (name, aim) in Aim::ALL {
            assert_eq!(aim.to_string(), name);
            assert_eq!(serde_json::to_string(&aim).expect("a name"), format!("\"{name}\""));
        }
    }
}
