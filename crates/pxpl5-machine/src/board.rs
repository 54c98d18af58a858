//! Names of boards, and what happens to them.

use pxpl5_sim::Time;
use std::fmt;
use std::str::FromStr;

/// A board of a machine, or its ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Board {
    /// The host workstation.
    Host,
    /// A graphics processor, from 0; the first one is told of retraces.
    Gp(usize),
    /// A renderer, from 0.
    Renderer(usize),
    /// A display with all its ports, from 0.
    Display(usize),
    /// The ring with its arbiter.
    Ring,
}

/// Something that happens to a board at an instant: one event of the simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Happening {
    /// When.
    pub time: Time,
    /// To whom.
    pub board: Board,
    /// What, in words.
    pub what: &'static str,
}

impl Board {
    /// The host or a graphics processor, by its port.
    #[must_use]
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

impl fmt::Display for Happening {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}: {}", self.time, self.board, self.what)
    }
}

impl FromStr for Board {
    type Err = String;

    /// `host`, `ring`, or `gp`, `renderer`, `display` with a number, with or without a space.
    fn from_str(text: &str) -> Result<Self, String> {
        let refused = || format!("expected host, ring, gp N, renderer N or display N, found {text:?}");
        let letters = text.trim_end_matches(|c: char| c.is_ascii_digit());
        let number = text[letters.len()..].parse();
        let name = letters.trim().to_ascii_lowercase();
        match (name.as_str(), number) {
            ("host", Err(_)) if letters == text => Ok(Self::Host),
            ("ring", Err(_)) if letters == text => Ok(Self::Ring),
            ("gp", Ok(number)) => Ok(Self::Gp(number)),
            ("renderer", Ok(number)) => Ok(Self::Renderer(number)),
            ("display", Ok(number)) => Ok(Self::Display(number)),
            _ => Err(refused()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_is_known_by_the_name_that_it_prints() {
        for board in [Board::Host, Board::Gp(12), Board::Renderer(0), Board::Display(1), Board::Ring] {
            assert_eq!(board.to_string().parse(), Ok(board));
            assert_eq!(board.to_string().replace(' ', "").parse(), Ok(board));
        }
    }

    #[test]
    fn other_names_are_refused_with_what_was_expected() {
        for wrong in ["", "gp", "host 3", "GP -1", "renderer x", "7", "display 99999999999999999999999"] {
            let error = wrong.parse::<Board>().expect_err(wrong);
            assert_eq!(error, format!("expected host, ring, gp N, renderer N or display N, found {wrong:?}"));
        }
    }
}
