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
        /// Reason of the failure.
        fault: Fault,
    },
    /// Programs wait for messages, but no board will send a message any more.
    #[error("nothing can happen any more at {time}:{}", waits(blocked))]
    Deadlock {
        /// Simulated time at which the deadlock was detected.
        time: Time,
        /// The waiting boards, each with the condition for which the board waits.
        blocked: Vec<Blocked>,
    },
    /// The ring could not carry a message.
    #[error("ring, at {time}: {error}")]
    Ring {
        /// Simulated time of the request to send the message.
        time: Time,
        /// The reason why the ring cannot carry the message.
        error: RingError,
    },
}

impl RunError {
    /// Returns the boards that wait at a deadlock. Returns an empty list for other errors.
    pub fn blocked(&self) -> &[Blocked] {
        if let Self::Deadlock { blocked, .. } = self { blocked } else { &[] }
    }

    /// Returns the simulated time at which the run ended.
    pub const fn time(&self) -> Time {
        match self {
            Self::Fault { time, .. } | Self::Deadlock { time, .. } | Self::Ring { time, .. } => *time,
        }
    }
}

fn waits(blocked: &[Blocked]) -> String {
    blocked.iter().map(|wait| format!(" {wait};")).collect()
}

/// A board that waits in a deadlock.
///
/// The text is `BOARD waits for CONDITION`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Blocked {
    /// The board that waits.
    pub board: Board,
    /// The board that must act before `board` can continue. `None` if the program waits for a message from any board.
    pub waits_on: Option<Board>,
    /// Description of the condition for which the board waits.
    pub waits_for: String,
}

impl fmt::Display for Blocked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} waits for {}", self.board, self.waits_for)
    }
}
