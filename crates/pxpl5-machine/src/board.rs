use pxpl5_sim::Time;
use pxpl5_sim::parameters::SettingError;
use std::fmt;
use std::str::FromStr;

/// A board of a machine, or the ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Board {
    /// The host workstation.
    Host,
    /// A graphics processor, counted from 0. Graphics processor 0 receives the retrace signal.
    Gp(usize),
    /// A renderer, counted from 0.
    Renderer(usize),
    /// A display. Displays are counted from 0.
    Display(usize),
    /// The ring with its arbiter, which assigns channels to messages.
    Ring,
}

/// A description of one event of the simulation, for a debugger or a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EventDescription {
    /// Simulated time of the event.
    pub time: Time,
    /// Board that handles the event.
    pub board: Board,
    /// Short description of the event in English.
    pub what: &'static str,
}

impl Board {
    /// Returns the board at a ring port: the host for port 0, otherwise graphics processor `port - 1`.
    pub const fn of_processor(port: usize) -> Self {
        match port {
            0 => Self::Host,
            port => Self::Gp(port - 1),
        }
    }
}

impl fmt::Display for Board {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Host => f.write_str("host"),
            Self::Gp(number) => write!(f, "GP {number}"),
            Self::Renderer(number) => write!(f, "renderer {number}"),
            Self::Display(number) => write!(f, "display {number}"),
            Self::Ring => f.write_str("ring"),
        }
    }
}

impl fmt::Display for EventDescription {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}: {}", self.time, self.board, self.what)
    }
}

impl FromStr for Board {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        let refused = SettingError::text("host, ring, gp N, renderer N or display N", text);
        let text = text.to_ascii_lowercase();
        // Split off the digits at the end, then remove an optional space.
        let (name, number) = text.split_at(text.trim_end_matches(|c: char| c.is_ascii_digit()).len());
        match (name, name.strip_suffix(' ').unwrap_or(name), number.parse()) {
            ("host", _, Err(_)) => Ok(Self::Host),
            ("ring", _, Err(_)) => Ok(Self::Ring),
            (_, "gp", Ok(number)) => Ok(Self::Gp(number)),
            (_, "renderer", Ok(number)) => Ok(Self::Renderer(number)),
            (_, "display", Ok(number)) => Ok(Self::Display(number)),
            _ => Err(refused),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_is_parsed_from_the_name_that_it_prints() {
        for board in [Board::Host, Board::Gp(12), Board::Renderer(0), Board::Display(1), Board::Ring] {
            assert_eq!(board.to_string().parse(), Ok(board));
            assert_eq!(board.to_string().replace(' ', "").parse(), Ok(board));
            assert_eq!(board.to_string().to_uppercase().parse(), Ok(board));
        }
    }

    #[test]
    fn events_are_reported_with_time_and_board() {
        let happening = EventDescription { time: Time(7), board: Board::Renderer(3), what: "copy command begins" };
        assert_eq!(happening.to_string(), format!("{} renderer 3: copy command begins", Time(7)));
    }

    #[test]
    fn boards_with_processors_are_numbered_behind_the_host() {
        assert_eq!([0, 1, 4].map(Board::of_processor), [Board::Host, Board::Gp(0), Board::Gp(3)]);
    }

    #[test]
    fn unknown_names_are_refused_with_the_expected_names() {
        let spaces = [" host", "host ", "ring ", " gp 3", "gp 3 ", "gp  3"];
        let others = ["", "gp", "host 3", "ring0", "GP -1", "renderer x", "7", "display 99999999999999999999999"];
        for wrong in spaces.into_iter().chain(others) {
            let error = wrong.parse::<Board>().expect_err(wrong);
            assert_eq!(
                error.to_string(),
                format!("expected host, ring, gp N, renderer N or display N, found {wrong:?}")
            );
        }
    }
}
