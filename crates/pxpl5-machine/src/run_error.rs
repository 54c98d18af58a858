//! Errors that stop a run.

use pxpl5_gp::Fault;
use pxpl5_sim::{Blocked, Time};
use thiserror::Error;

/// The reason why a run ended early.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RunError {
    /// A program failed, for example because a buffer overflowed or a message was invalid.
    #[error("{board} stopped at {time}: {fault}")]
    Fault {
        /// Name of the board that ran the program.
        board: String,
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
        /// The waiting boards. Each entry describes the event that the board waits for.
        blocked: Vec<Blocked>,
    },
    /// The ring could not carry a message.
    #[error("ring, at {time}: {reason}")]
    Ring {
        /// Simulated time of the request.
        time: Time,
        /// Text that describes the error in the message.
        reason: String,
    },
}

impl RunError {
    /// Returns the simulated time at which the run ended.
    #[must_use]
    pub const fn time(&self) -> Time {
        match self {
            Self::Fault { time, .. } | Self::Deadlock { time, .. } | Self::Ring { time, .. } => *time,
        }
    }
}

fn waits(blocked: &[Blocked]) -> String {
    blocked.iter().map(|b| format!(" {} waits for {};", b.board, b.waits_for)).collect()
}
