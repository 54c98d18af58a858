//! Errors that stop a run.

use crate::board::Board;
use pxpl5_gp::Fault;
use pxpl5_ring::RingError;
use pxpl5_sim::Time;
use std::fmt;
use thiserror::Error;

/// The reason why a run ended early.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RunError {
    /// A program failed, for example because a buffer overflowed or a message was invalid.
    #[error("{board} stopped at {time}: {fault}")]
    Fault {
        /// The board that ran the program.
        board: Board,
        /// Simulated time of the failure.
        time: Time,
        /// Description of the failed operation.
        fault: Fault,
    },
    /// Programs wait, and only ticks of the displays are pending.
    #[error("nothing can happen any more at {time}:{}", waits(blocked))]
    Deadlock {
        /// Simulated time at which the deadlock was detected.
        time: Time,
        /// The waiting boards. Each entry names the board and what the board waits for.
        blocked: Vec<Blocked>,
    },
    /// The ring could not carry a message.
    #[error("ring, at {time}: {error}")]
    Ring {
        /// Simulated time of the request.
        time: Time,
        /// The error in the message.
        error: RingError,
    },
}

impl RunError {
    /// Returns the boards that wait at a deadlock. Returns an empty list for other errors.
    #[must_use]
    pub fn blocked(&self) -> &[Blocked] {
        if let Self::Deadlock { blocked, .. } = self { blocked } else { &[] }
    }

    /// Returns the simulated time at which the run ended.
    #[must_use]
    pub const fn time(&self) -> Time {
        match self {
            Self::Fault { time, .. } | Self::Deadlock { time, .. } | Self::Ring { time, .. } => *time,
        }
    }
}

fn waits(blocked: &[Blocked]) -> String {
    blocked.iter().map(|wait| format!(" {wait};")).collect()
}

/// A board that cannot continue, as a line of a deadlock report. The text is `BOARD waits for CONDITION`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Blocked {
    /// The board that waits.
    pub board: Board,
    /// The board that must act before `board` can continue. `None` if a program waits for any message, because the
    /// program does not state a sender.
    pub waits_on: Option<Board>,
    /// Description of the condition that the board waits for.
    pub waits_for: String,
}

impl fmt::Display for Blocked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} waits for {}", self.board, self.waits_for)
    }
}
